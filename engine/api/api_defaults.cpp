// The C API: the defaults of what a host fills in.
#include <cmath>

#include "engine/base/constants.h"
#include "engine/pellicle.h"

extern "C" {

void plc_image_defaults(plc_image* image) {
  if (image == nullptr) return;
  *image = {};
  image->struct_size = sizeof *image;
  for (int i = 0; i < 3; ++i) {
    image->spacing[i] = 1;
    image->direction[4 * i] = 1;
  }
}

void plc_parameters_defaults(plc_parameters* p) {
  if (p == nullptr) return;
  *p = {};
  p->struct_size = sizeof *p;
  p->iso = p->window_low = p->window_high = p->pad_value = NAN;
  p->levels = -1;
  p->reduction = plc::kRefinement;
  p->init = PLC_INIT_BUBBLE;
  p->bubbles[0] = p->bubbles[1] = p->bubbles[2] = 1;
  p->curvature = 0.4;
  p->spring = 0;
  p->rest_length = PLC_REST_MEAN;
  p->rest_length_value = 1.5;
  p->force = PLC_FORCE_ISO;
  p->attraction = 1;
  p->gradient = 0.5;
  p->gradient_tangent = 0;
  p->gradient_bound = 0.1;
  p->mass = 1;
  p->damping = 0.5;
  p->time_step = 1.5;
  p->max_move = 0.4;
  p->bound = PLC_BOUND_CLAMP;
  p->anisotropy = PLC_ANISOTROPY_VOXEL;
  p->epsilon = 5e-6;
  p->max_iterations = 500;
  p->late_bubbles = 1;
  p->sleeping = 1;
}

void plc_extras_defaults(plc_extras* extras) {
  if (extras == nullptr) return;
  *extras = {};
  extras->struct_size = sizeof *extras;
  extras->space = PLC_SPACE_LPS;
}

}  // extern "C"

// The C API: the defaults of what a host fills in.
#include "engine/api/parameter_list.h"
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
  for (const plc_parameter_info& info : plc::parameter_list()) {
    for (int i = 0; i < info.count; ++i) plc::set_parameter(*p, info, i, info.value);
  }
}

const plc_parameter_info* plc_parameter_at(int index) {
  const auto list = plc::parameter_list();
  return index >= 0 && static_cast<size_t>(index) < list.size() ? &list[static_cast<size_t>(index)]
                                                                : nullptr;
}

void plc_extras_defaults(plc_extras* extras) {
  if (extras == nullptr) return;
  *extras = {};
  extras->struct_size = sizeof *extras;
  extras->space = PLC_SPACE_LPS;
}

}  // extern "C"

// The C API: the defaults of what a host fills in.
#include <algorithm>
#include <cmath>

#include "engine/api/parameter_list.h"
#include "engine/pellicle.h"

namespace {

// Of a struct that is only written.
template <typename T>
void clear_output(T* output) {
  *output = {};
  output->struct_size = sizeof *output;
}

}  // namespace

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

void plc_bricks_defaults(plc_bricks* bricks) {
  if (bricks == nullptr) return;
  *bricks = {};
  bricks->struct_size = sizeof *bricks;
  for (int i = 0; i < 3; ++i) {
    bricks->brick[i] = 64;
    bricks->spacing[i] = 1;
    bricks->direction[4 * i] = 1;
  }
  bricks->low = bricks->high = NAN;
}

void plc_brick_counts_defaults(plc_brick_counts* counts) {
  if (counts != nullptr) clear_output(counts);
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
  std::fill_n(extras->room_low, 3, -HUGE_VAL);
  std::fill_n(extras->room_high, 3, HUGE_VAL);
}

void plc_pyramid_level_defaults(plc_pyramid_level* level) {
  if (level == nullptr) return;
  clear_output(level);
}

void plc_run_state_defaults(plc_run_state* state) {
  if (state == nullptr) return;
  clear_output(state);
  clear_output(&state->progress);
}

void plc_measures_defaults(plc_measures* measures) {
  if (measures == nullptr) return;
  clear_output(measures);
}

void plc_level_report_defaults(plc_level_report* report) {
  if (report == nullptr) return;
  clear_output(report);
}

void plc_seconds_defaults(plc_seconds* seconds) {
  if (seconds == nullptr) return;
  clear_output(seconds);
}

void plc_check_defaults(plc_check* check) {
  if (check == nullptr) return;
  clear_output(check);
  clear_output(&check->measures);
}

void plc_component_measures_defaults(plc_component_measures* measures) {
  if (measures == nullptr) return;
  clear_output(measures);
}

void plc_distances_defaults(plc_distances* distances) {
  if (distances == nullptr) return;
  clear_output(distances);
}

void plc_simplify_options_defaults(plc_simplify_options* options) {
  if (options == nullptr) return;
  *options = {};
  options->struct_size = sizeof *options;
}

void plc_simplified_defaults(plc_simplified* simplified) {
  if (simplified == nullptr) return;
  clear_output(simplified);
}

}  // extern "C"

// The C API: versions, defaults and contexts.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <thread>

#include "engine/constants.h"
#include "engine/handles.h"

namespace {

constexpr int kMaxThreads = 1024;

bool target_of(plc_simd simd, plc::SimdTarget& target) {
  switch (simd) {
    case PLC_SIMD_AUTO:
      target = plc::best_simd_target();
      return true;
    case PLC_SIMD_SCALAR:
      target = plc::SimdTarget::kScalar;
      return true;
    case PLC_SIMD_SSE4:
      target = plc::SimdTarget::kSse4;
      return true;
    case PLC_SIMD_AVX2:
      target = plc::SimdTarget::kAvx2;
      return true;
    case PLC_SIMD_AVX512:
      target = plc::SimdTarget::kAvx512;
      return true;
  }
  return false;
}

plc_status refuse(char* error, size_t error_size, plc_status status, const std::string& line) {
  if (error != nullptr && error_size > 0) {
    const size_t n = std::min(error_size - 1, line.size());
    std::memcpy(error, line.data(), n);
    error[n] = '\0';
  }
  return status;
}

}  // namespace

extern "C" {

const char* plc_version_string(void) {
  return PLC_VERSION;
}

void plc_context_options_defaults(plc_context_options* options) {
  *options = {};
  options->struct_size = sizeof *options;
}

plc_status plc_context_create(const plc_context_options* options, plc_context** context,
                              char* error, size_t error_size) {
  if (context == nullptr) {
    return refuse(error, error_size, PLC_INVALID_ARGUMENT, "context: must not be NULL");
  }
  *context = nullptr;
  plc_context_options used;
  plc_context_options_defaults(&used);
  if (options != nullptr) {
    if (options->struct_size != sizeof used) {
      return refuse(error, error_size, PLC_INVALID_ARGUMENT,
                    "options: struct_size is not that of this version");
    }
    used = *options;
  }
  if (used.threads < 0 || used.threads > kMaxThreads) {
    return refuse(error, error_size, PLC_INVALID_ARGUMENT,
                  "threads " + std::to_string(used.threads) + ": must be 0 .. 1024");
  }
  plc::SimdTarget target{};
  if (!target_of(used.simd, target)) {
    return refuse(error, error_size, PLC_INVALID_ARGUMENT, "simd: not a plc_simd");
  }
  if (!plc::simd_target_available(target)) {
    return refuse(
        error, error_size, PLC_INVALID_ARGUMENT,
        "simd " + std::string(plc::simd_target_name(target)) + ": this machine does not have it");
  }
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  try {
    *context = new plc_context(used.threads == 0 ? cores : used.threads, target);
  } catch (const std::exception&) {
    return refuse(error, error_size, PLC_OUT_OF_MEMORY, "out of memory");
  }
  return PLC_OK;
}

void plc_context_destroy(plc_context* context) {
  delete context;
}

const char* plc_context_message(const plc_context* context) {
  return context->message.c_str();
}
int plc_context_threads(const plc_context* context) {
  return context->schedule.threads();
}
const char* plc_context_simd(const plc_context* context) {
  return plc::simd_target_name(context->simd).data();
}

void plc_image_defaults(plc_image* image) {
  *image = {};
  image->struct_size = sizeof *image;
  for (int i = 0; i < 3; ++i) {
    image->spacing[i] = 1;
    image->direction[4 * i] = 1;
  }
}

void plc_parameters_defaults(plc_parameters* p) {
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
  p->slow_vertices = 1;
  p->renumbering = 1;
}

void plc_extras_defaults(plc_extras* extras) {
  *extras = {};
  extras->struct_size = sizeof *extras;
  extras->space = PLC_SPACE_LPS;
}

}  // extern "C"

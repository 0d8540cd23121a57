// What the opaque handles of the C API hold, and how failures cross its boundary.
#pragma once
#include <array>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "engine/frame.h"
#include "engine/mesh.h"
#include "engine/pellicle.h"
#include "engine/recovery.h"
#include "engine/schedule.h"
#include "kernels/simd.h"
#include "pyramid/status.h"

struct plc_context {
  plc_context(int threads, plc::SimdTarget target) : schedule(threads), simd(target) {}
  plc::Schedule schedule;
  plc::SimdTarget simd;
  std::string message;
};

struct plc_surface {
  plc::Mesh mesh;  // ids without gaps, in Morton order
  plc::MeshSpace space;
  plc::Frame frame;
  plc_parameters parameters{};
  plc::VoxelRange range;
  std::vector<plc::LevelRecord> records;
  std::vector<std::array<int64_t, 3>> level_dims;  // as records
  std::vector<double> level_units;                 // mm
  std::vector<double> level_isos;                  // image units
  double seconds_pyramid = 0;                      // everything before the evolution
  double seconds_images = 0;                       // of these, build_pyramid
  double seconds_evolution = 0;
};

namespace plc {

inline plc_status report(plc_context* context, const Status& status) {
  context->message = status.message();
  return static_cast<plc_status>(status.code());
}

// Runs body, which returns a Status; no exception gets past it.
template <typename Body>
plc_status guarded(plc_context* context, Body&& body) {
  try {
    return report(context, body());
  } catch (const std::bad_alloc&) {
    return report(context, {ErrorCode::kOutOfMemory, "out of memory"});
  } catch (const std::exception& e) {
    return report(context, {ErrorCode::kInternal, std::string("internal error: ") + e.what()});
  }
}

}  // namespace plc

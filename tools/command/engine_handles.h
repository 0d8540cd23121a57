// Owners of the engine's handles, and its errors as Failures.
#pragma once
#include <memory>
#include <string>

#include "engine/pellicle.h"
#include "tools/file/failure.h"

namespace plc::tools {

struct EngineDeleter {
  void operator()(plc_context* context) const { plc_context_destroy(context); }
  void operator()(plc_volume* volume) const { plc_volume_destroy(volume); }
  void operator()(plc_surface* surface) const { plc_surface_destroy(surface); }
};

using ContextHandle = std::unique_ptr<plc_context, EngineDeleter>;
using VolumeHandle = std::unique_ptr<plc_volume, EngineDeleter>;
using SurfaceHandle = std::unique_ptr<plc_surface, EngineDeleter>;

inline Failure failure_of(const plc_context* context) {
  return {plc_context_message(context)};
}

// Throws Failure where a call has failed.
inline void demand(const plc_context* context, plc_status status) {
  if (status != PLC_OK) throw failure_of(context);
}

inline ContextHandle make_context(const plc_context_options& options) {
  plc_context* context = nullptr;
  char error[256] = "";
  if (plc_context_create(&options, &context, error, sizeof error) != PLC_OK) throw Failure{error};
  return ContextHandle(context);
}

}  // namespace plc::tools

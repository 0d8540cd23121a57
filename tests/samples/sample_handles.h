// Handles of the C API that go with their scope.
#pragma once
#include <memory>

#include "engine/pellicle.h"

namespace samples {

struct Destroy {
  void operator()(plc_context* context) const { plc_context_destroy(context); }
  void operator()(plc_volume* volume) const { plc_volume_destroy(volume); }
  void operator()(plc_pyramid* pyramid) const { plc_pyramid_destroy(pyramid); }
  void operator()(plc_run* run) const { plc_run_destroy(run); }
  void operator()(plc_surface* surface) const { plc_surface_destroy(surface); }
};
using Context = std::unique_ptr<plc_context, Destroy>;
using VolumeHandle = std::unique_ptr<plc_volume, Destroy>;
using PyramidHandle = std::unique_ptr<plc_pyramid, Destroy>;
using RunHandle = std::unique_ptr<plc_run, Destroy>;
using Surface = std::unique_ptr<plc_surface, Destroy>;

}  // namespace samples

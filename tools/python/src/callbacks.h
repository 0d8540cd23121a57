// Python functions that the engine calls.
#pragma once
#include <chrono>

#include "tools/python/src/context.h"

namespace plc::python {

// What the engine gets as user pointer, where it stands at the time of a call. The functions are
// those of the call under way, so that nothing here keeps Python objects alive.
class Callbacks {
 public:
  explicit Callbacks(std::shared_ptr<Context> context) : context_(std::move(context)) {}
  Callbacks(const Callbacks&) = delete;
  Callbacks& operator=(const Callbacks&) = delete;

  // Python functions of one call, None where there is none: progress(dict), level(dict, Surface)
  // -> plc_verdict, force(level, positions, normals) -> forces or None.
  struct Functions {
    py::object progress, level, force;
  };
  // With progress even where nobody asks for it: it looks for signals.
  void install(plc_extras& extras, const Functions& functions);
  void use(const Functions* functions) { functions_ = functions; }

 private:
  static int on_progress(const plc_progress* progress, void* user);
  static plc_verdict on_level(const plc_level_report* report, const plc_surface* surface,
                              void* user);
  static int on_force(const plc_force_points* points, float* forces, void* user);
  bool time_to_look();

  std::shared_ptr<Context> context_;
  const Functions* functions_ = nullptr;
  std::chrono::steady_clock::time_point looked_{};
};

// The functions are those of the calls in this scope.
class CallbackScope {
 public:
  CallbackScope(Callbacks& callbacks, const Callbacks::Functions& functions)
      : callbacks_(callbacks) {
    callbacks_.use(&functions);
  }
  ~CallbackScope() { callbacks_.use(nullptr); }
  CallbackScope(const CallbackScope&) = delete;
  CallbackScope& operator=(const CallbackScope&) = delete;

 private:
  Callbacks& callbacks_;
};

}  // namespace plc::python

#include "tools/python/src/callbacks.h"

#include <pybind11/numpy.h>

#include <cstring>

#include "tools/python/src/records.h"
#include "tools/python/src/surface.h"

namespace plc::python {

namespace {

// Signals are looked for only so often: for every look the thread waits for the GIL, which another
// one may hold for 5 ms.
constexpr auto kLook = std::chrono::milliseconds(50);

constexpr int kGoOn = 0;
constexpr int kCancel = 1;

py::array_t<float> copy_of(const float* xyz, int64_t count) {
  return py::array_t<float>({static_cast<py::ssize_t>(count), py::ssize_t{3}}, xyz);
}

}  // namespace

void Callbacks::install(plc_extras& extras, const Functions& functions) {
  extras.progress = on_progress;
  extras.progress_user = this;
  if (!functions.level.is_none()) {
    extras.level = on_level;
    extras.level_user = this;
  }
  if (!functions.force.is_none()) {
    extras.force = on_force;
    extras.force_user = this;
  }
}

bool Callbacks::time_to_look() {
  const auto now = std::chrono::steady_clock::now();
  if (now - looked_ < kLook) return false;
  looked_ = now;
  return true;
}

int Callbacks::on_progress(const plc_progress* progress, void* user) {
  auto& self = *static_cast<Callbacks*>(user);
  Context& context = *self.context_;
  const bool called = !self.functions_->progress.is_none();
  if (!context.failed() && (called || self.time_to_look())) {
    context.guarded([&] {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (called) call_python(self.functions_->progress, dict_of(*progress));
    });
  }
  return context.failed() ? kCancel : kGoOn;
}

// A verdict cannot cancel: after a failure the level goes on until progress is asked.
plc_verdict Callbacks::on_level(const plc_level_report* report, const plc_surface* surface,
                                void* user) {
  auto& self = *static_cast<Callbacks*>(user);
  Context& context = *self.context_;
  if (context.failed()) return PLC_VERDICT_MORE;
  plc_verdict verdict = PLC_VERDICT_MORE;
  context.guarded([&] {
    const auto lent = std::make_shared<LentSurface>(self.context_, surface);
    const py::object answer = [&] {
      const LentSurface::Scope scope(*lent);
      return call_python(self.functions_->level, dict_of(*report),
                         std::static_pointer_cast<AnySurface>(lent));
    }();
    verdict = static_cast<plc_verdict>(answer.cast<int>());
  });
  return verdict;
}

int Callbacks::on_force(const plc_force_points* points, float* forces, void* user) {
  auto& self = *static_cast<Callbacks*>(user);
  Context& context = *self.context_;
  if (context.failed()) return kCancel;
  const bool given = context.guarded([&] {
    // Copies, as Python code may keep them.
    const py::object answer =
        call_python(self.functions_->force, points->level, copy_of(points->xyz, points->count),
                    copy_of(points->normals, points->count));
    if (answer.is_none()) return;
    const auto values = answer.cast<py::array_t<float, py::array::c_style>>();
    if (values.ndim() != 2 || values.shape(0) != points->count || values.shape(1) != 3) {
      throw py::value_error("forces must be as many rows of 3 as there are points");
    }
    std::memcpy(forces, values.data(), static_cast<size_t>(values.nbytes()));
  });
  return given ? kGoOn : kCancel;
}

}  // namespace plc::python

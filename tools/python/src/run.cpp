#include "tools/python/src/run.h"

#include <pybind11/stl.h>

#include "tools/python/src/extras.h"
#include "tools/python/src/parameters.h"
#include "tools/python/src/records.h"
#include "tools/python/src/surface.h"

namespace plc::python {

namespace {

class Run {
 public:
  // state: of a saved run, or nullptr: from the start.
  Run(const std::shared_ptr<Context>& context, const Pyramid& pyramid, const py::dict& fields,
      const Extras& extras, const std::optional<py::bytes>& state)
      : callbacks_(context), handle_(context, pyramid.lent()) {
    const plc_parameters parameters = parameters_of(fields);
    const ExtrasView view(extras, callbacks_);
    std::string_view bytes;
    if (state) bytes = *state;
    context->call([&](plc_context* engine) {
      const CallbackScope scope(callbacks_, extras.functions);
      if (!state) {
        return plc_run_create(engine, pyramid.get(), &parameters, view.get(), handle_.out());
      }
      return plc_run_restore(engine, pyramid.get(), &parameters, view.get(), bytes.data(),
                             bytes.size(), handle_.out());
    });
  }

  py::dict advance(int amount, py::object progress, py::object level, py::object force) {
    const Callbacks::Functions functions{std::move(progress), std::move(level), std::move(force)};
    auto state = unwritten<plc_run_state>();
    state.progress.struct_size = sizeof state.progress;
    context()->call([&](plc_context* engine) {
      const CallbackScope scope(callbacks_, functions);
      return plc_run_advance(engine, handle_.get(), static_cast<plc_amount>(amount), &state);
    });
    return dict_of(state);
  }

  py::dict state() const {
    auto state = unwritten<plc_run_state>();
    state.progress.struct_size = sizeof state.progress;
    context()->call(
        [&](plc_context* engine) { return plc_run_get_state(engine, handle_.get(), &state); });
    return dict_of(state);
  }

  std::shared_ptr<AnySurface> surface() const {
    auto copy = std::make_shared<OwnSurface>(context());
    context()->call(
        [&](plc_context* engine) { return plc_run_surface(engine, handle_.get(), copy->out()); });
    return copy;
  }

  py::bytes save() const {
    std::string state;
    context()->call([&](plc_context* engine) {
      size_t size = 0;
      const plc_status status = plc_run_save(engine, handle_.get(), nullptr, 0, &size);
      if (status != PLC_OK) return status;
      state.resize(size);
      return plc_run_save(engine, handle_.get(), state.data(), size, &size);
    });
    return state;
  }

  const std::shared_ptr<Context>& context() const { return handle_.context(); }

 private:
  Callbacks callbacks_;  // the engine has its address
  Handle<plc_run, plc_run_destroy> handle_;
};

}  // namespace

void bind_run(py::module_& module) {
  py::class_<Run>(module, "Run")
      .def(py::init<const std::shared_ptr<Context>&, const Pyramid&, const py::dict&, const Extras&,
                    const std::optional<py::bytes>&>())
      .def_property_readonly("context", &Run::context)
      .def("advance", &Run::advance)
      .def("state", &Run::state)
      .def("surface", &Run::surface)
      .def("save", &Run::save);
}

}  // namespace plc::python

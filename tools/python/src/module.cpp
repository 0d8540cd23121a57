// pellicle._pellicle: the engine's C API for the Python code beside it, which is what users see.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "tools/python/src/context.h"
#include "tools/python/src/extras.h"
#include "tools/python/src/images.h"
#include "tools/python/src/meshes.h"
#include "tools/python/src/parameters.h"
#include "tools/python/src/steps.h"
#include "tools/python/src/surface.h"

namespace plc::python {

namespace {

std::shared_ptr<Context> context_create(int threads, const std::string& simd, int64_t memory_limit,
                                        py::object log) {
  return std::make_shared<Context>(threads, simd_of(simd), memory_limit, std::move(log));
}

py::dict parameter_defaults() {
  plc_parameters parameters;
  plc_parameters_defaults(&parameters);
  return dict_of(parameters);
}

}  // namespace

PYBIND11_MODULE(_pellicle, module) {
  module.doc() = "The engine's C API; use the package pellicle.";
  module.def("version", &plc_version_string);
  module.def("parameter_defaults", &parameter_defaults);
  py::class_<Context, std::shared_ptr<Context>>(module, "Context")
      .def(py::init(&context_create))
      .def_property_readonly("threads", &Context::threads)
      .def_property_readonly("simd", &Context::simd)
      .def("memory", &Context::memory);
  py::class_<Geometry>(module, "Geometry")
      .def(py::init<std::array<double, 3>, std::array<double, 3>, std::array<double, 9>>());
  bind_extras(module);
  bind_surface(module);
  bind_meshes(module);
  bind_steps(module);
}

}  // namespace plc::python

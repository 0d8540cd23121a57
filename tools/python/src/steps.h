// An image to a surface, in one call or in steps.
#pragma once
#include <pybind11/pybind11.h>

namespace plc::python {

void bind_steps(pybind11::module_& module);

}  // namespace plc::python

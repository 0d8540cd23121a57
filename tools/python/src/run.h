// Runs: evolutions in progress.
#pragma once
#include <pybind11/pybind11.h>

namespace plc::python {

void bind_run(pybind11::module_& module);

}  // namespace plc::python

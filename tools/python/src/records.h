// What the engine tells, as dictionaries of the fields' names: pellicle/_records.py makes its
// records of them.
#pragma once
#include <pybind11/pybind11.h>

#include "engine/pellicle.h"

namespace plc::python {

namespace py = pybind11;

py::dict dict_of(const plc_progress& progress);
py::dict dict_of(const plc_run_state& state);
py::dict dict_of(const plc_pyramid_level& level);
py::dict dict_of(const plc_level_report& report);
py::dict dict_of(const plc_seconds& seconds);
py::dict dict_of(const plc_measures& measures);
py::dict dict_of(const plc_check& check);
py::dict dict_of(const plc_component_measures& measures);
py::dict dict_of(const plc_distances& distances);
py::dict dict_of(const plc_simplified& simplified);

// For structs that the engine only writes.
template <class Struct>
Struct unwritten() {
  Struct record{};
  record.struct_size = sizeof record;
  return record;
}

}  // namespace plc::python

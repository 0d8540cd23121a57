// Parameters as dictionaries with the header's names; enumerators as words, None for NAN and -1.
#pragma once
#include <pybind11/pybind11.h>

#include <string>

#include "engine/pellicle.h"

namespace plc::python {

namespace py = pybind11;

py::dict dict_of(const plc_parameters& parameters);
// Names that are not there keep their default. Throws where a value is not of the field's kind;
// whether it is in its range the engine tells.
plc_parameters parameters_of(const py::dict& fields);

// Throw where there is no such word.
plc_space space_of(const std::string& word);
plc_scalar scalar_of(const std::string& word);
plc_simd simd_of(const std::string& word);

}  // namespace plc::python

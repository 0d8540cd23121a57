// Meshes as arrays, and the functions that measure them.
#pragma once
#include <pybind11/numpy.h>

#include <utility>

#include "tools/python/src/context.h"

namespace plc::python {

// vertices (n, 3) and faces (m, 3), C-contiguous.
using MeshArrays =
    std::pair<py::array_t<double, py::array::c_style>, py::array_t<uint32_t, py::array::c_style>>;

// As the engine takes a mesh. Refers to the arrays.
struct MeshView {
  explicit MeshView(const MeshArrays& mesh);
  const double* xyz;
  int64_t vertex_count;
  const uint32_t* abc;
  int64_t face_count;
};

void bind_meshes(py::module_& module);

}  // namespace plc::python

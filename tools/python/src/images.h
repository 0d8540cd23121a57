// Arrays as images of the engine, without a copy.
#pragma once
#include <pybind11/numpy.h>

#include <array>

#include "tools/python/src/context.h"

namespace plc::python {

// Where an image lies: as in plc_image.
struct Geometry {
  std::array<double, 3> spacing;
  std::array<double, 3> origin;
  std::array<double, 9> direction;
};

// Of no voxels.
plc_image image_of(const Geometry& geometry);
// The array is indexed [x, y, z], of a type of plc_voxel_type, aligned, and of any strides but 0.
// Refers to its voxels.
plc_image image_of(const py::array& voxels, const Geometry& geometry);
plc_voxel_type voxel_type_of(const py::dtype& type);
// The voxels of a volume indexed [x, y, z], x fastest, not writable; `owner` keeps them.
py::array array_of(const plc_image& image, const py::object& owner);

}  // namespace plc::python

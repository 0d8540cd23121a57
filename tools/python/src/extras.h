// What goes beyond an image and numbers: plc_extras out of Python's arrays.
#pragma once
#include <pybind11/numpy.h>

#include <optional>
#include <string>

#include "tools/python/src/callbacks.h"
#include "tools/python/src/images.h"
#include "tools/python/src/meshes.h"

namespace plc::python {

struct Extras {
  // Rows of x, y, z, radius, and strength for attachments.
  using Rows = py::array_t<double, py::array::c_style>;

  plc_space space = PLC_SPACE_LPS;
  std::optional<Rows> seeds, attachments, pins;
  std::optional<py::array> mask;  // indexed [x, y, z]
  std::optional<MeshArrays> mesh, obstacles;
  double obstacle_gap = 0;
  Callbacks::Functions functions;
};

// A plc_extras that refers to the arrays.
class ExtrasView {
 public:
  ExtrasView(const Extras& extras, Callbacks& callbacks);
  ExtrasView(const ExtrasView&) = delete;
  ExtrasView& operator=(const ExtrasView&) = delete;
  const plc_extras* get() const { return &view_; }

 private:
  plc_extras view_;
  plc_image mask_;
};

void bind_extras(py::module_& module);

}  // namespace plc::python

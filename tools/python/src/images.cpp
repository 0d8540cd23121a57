#include "tools/python/src/images.h"

#include <algorithm>

namespace plc::python {

namespace {

py::dtype dtype_of(plc_voxel_type type) {
  switch (type) {
    case PLC_U8:
      return py::dtype::of<uint8_t>();
    case PLC_I16:
      return py::dtype::of<int16_t>();
    case PLC_U16:
      return py::dtype::of<uint16_t>();
    case PLC_I32:
      return py::dtype::of<int32_t>();
    case PLC_F32:
      break;
  }
  return py::dtype::of<float>();
}

}  // namespace

plc_voxel_type voxel_type_of(const py::dtype& type) {
  for (const plc_voxel_type known : {PLC_U8, PLC_I16, PLC_U16, PLC_I32, PLC_F32}) {
    if (type.equal(dtype_of(known))) return known;
  }
  throw py::type_error("voxels must be uint8, int16, uint16, int32 or float32");
}

plc_image image_of(const Geometry& geometry) {
  plc_image image;
  plc_image_defaults(&image);
  std::copy(geometry.spacing.begin(), geometry.spacing.end(), image.spacing);
  std::copy(geometry.origin.begin(), geometry.origin.end(), image.origin);
  std::copy(geometry.direction.begin(), geometry.direction.end(), image.direction);
  return image;
}

plc_image image_of(const py::array& voxels, const Geometry& geometry) {
  if (voxels.ndim() != 3) throw py::value_error("voxels must have three axes");
  plc_image image = image_of(geometry);
  image.type = voxel_type_of(voxels.dtype());
  image.voxels = voxels.data();
  bool packed = true;  // x fastest, no gaps: told by strides of 0
  int64_t next = voxels.itemsize();
  for (int a = 0; a < 3; ++a) {
    image.dims[a] = voxels.shape(a);
    image.strides[a] = voxels.strides(a);
    packed = packed && image.strides[a] == next;
    next *= image.dims[a];
  }
  if (packed) std::fill(image.strides, image.strides + 3, 0);
  return image;
}

py::array array_of(const plc_image& image, const py::object& owner) {
  const py::dtype type = dtype_of(image.type);
  const py::ssize_t size = type.itemsize();
  const int64_t* const dims = image.dims;
  py::array voxels(type, {dims[0], dims[1], dims[2]},
                   {size, size * dims[0], size * dims[0] * dims[1]}, image.voxels, owner);
  voxels.attr("flags").attr("writeable") = false;
  return voxels;
}

}  // namespace plc::python

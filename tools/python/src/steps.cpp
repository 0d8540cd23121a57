#include "tools/python/src/steps.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "tools/python/src/extras.h"
#include "tools/python/src/images.h"
#include "tools/python/src/parameters.h"
#include "tools/python/src/records.h"
#include "tools/python/src/run.h"
#include "tools/python/src/surface.h"

namespace plc::python {

namespace {

using ContextPointer = std::shared_ptr<Context>;

std::shared_ptr<AnySurface> extract(const ContextPointer& context, const py::array& voxels,
                                    const Geometry& geometry, const py::dict& fields,
                                    const Extras& extras) {
  const plc_image image = image_of(voxels, geometry);
  const plc_parameters parameters = parameters_of(fields);
  Callbacks callbacks(context);
  const ExtrasView view(extras, callbacks);
  auto surface = std::make_shared<OwnSurface>(context);
  context->call([&](plc_context* handle) {
    const CallbackScope scope(callbacks, extras.functions);
    return plc_extract(handle, &image, &parameters, view.get(), surface->out());
  });
  return surface;
}

std::shared_ptr<Volume> volume_create(const ContextPointer& context, const py::array& voxels,
                                      const Geometry& geometry, bool borrow) {
  const plc_image image = image_of(voxels, geometry);
  auto volume =
      std::make_shared<Volume>(context, borrow ? std::make_shared<py::object>(voxels) : nullptr);
  context->call([&](plc_context* handle) {
    return plc_volume_create(handle, &image, borrow ? PLC_BORROW : PLC_COPY, volume->out());
  });
  return volume;
}

// What a volume of bricks keeps: read(low, high), both x, y, z, gives the voxels between them as an
// array indexed [z, y, x] of the volume's type.
struct BrickReader {
  Context* context;
  py::object read;
  plc_bricks bricks;
  size_t voxel_size;

  static int fetch(const int64_t at[3], void* voxels, char*, size_t, void* user) {
    auto& self = *static_cast<BrickReader*>(user);
    return self.context->guarded([&] { self.put(at, static_cast<char*>(voxels)); }) ? 0 : 1;
  }

  void put(const int64_t at[3], char* voxels) const {
    std::array<int64_t, 3> low{}, high{};
    for (size_t a = 0; a < 3; ++a) {
      low[a] = at[a] * bricks.brick[a];
      high[a] = std::min(low[a] + bricks.brick[a], bricks.dims[a]);
    }
    const auto answer = py::cast<py::array>(call_python(read, low, high));
    const std::array<int64_t, 3> size{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    if (answer.ndim() != 3 || answer.shape(0) != size[2] || answer.shape(1) != size[1] ||
        answer.shape(2) != size[0] || voxel_type_of(answer.dtype()) != bricks.type ||
        (answer.flags() & py::array::c_style) == 0) {
      throw py::value_error("the array gives other voxels than its shape and type tell");
    }
    const auto* from = static_cast<const char*>(answer.data());
    const size_t row = static_cast<size_t>(size[0]) * voxel_size;
    for (int64_t z = 0; z < size[2]; ++z) {
      for (int64_t y = 0; y < size[1]; ++y, from += row) {
        const int64_t to = (z * bricks.brick[1] + y) * bricks.brick[0];
        std::memcpy(voxels + static_cast<size_t>(to) * voxel_size, from, row);
      }
    }
  }
};

std::shared_ptr<Volume> volume_create_bricks(const ContextPointer& context, const py::object& read,
                                             const py::dtype& type,
                                             const std::array<int64_t, 3>& dims,
                                             const std::array<int64_t, 3>& brick,
                                             const Geometry& geometry, int64_t cache) {
  const auto reader = std::make_shared<BrickReader>(BrickReader{context.get(), read, {}, 0});
  plc_bricks& bricks = reader->bricks;
  plc_bricks_defaults(&bricks);
  const plc_image image = image_of(geometry);
  bricks.type = voxel_type_of(type);
  std::copy(dims.begin(), dims.end(), bricks.dims);
  std::copy(brick.begin(), brick.end(), bricks.brick);
  std::copy_n(image.spacing, 3, bricks.spacing);
  std::copy_n(image.origin, 3, bricks.origin);
  std::copy_n(image.direction, 9, bricks.direction);
  bricks.fetch = BrickReader::fetch;
  bricks.user = reader.get();
  bricks.cache = cache;
  reader->voxel_size = static_cast<size_t>(type.itemsize());
  // Kept by what is made of the volume, too.
  auto volume =
      std::make_shared<Volume>(context, std::shared_ptr<py::object>(reader, &reader->read));
  context->call([&](plc_context* handle) {
    return plc_volume_create_bricks(handle, &bricks, volume->out());
  });
  return volume;
}

// Of the image, fetched, fetched again.
std::array<int64_t, 3> volume_brick_counts(const Volume& volume) {
  auto counts = unwritten<plc_brick_counts>();
  volume.context()->call(
      [&](plc_context* handle) { return plc_volume_brick_counts(handle, volume.get(), &counts); });
  return {counts.bricks, counts.read, counts.read_again};
}

std::shared_ptr<AnySurface> extract_volume(const ContextPointer& context, const Volume& volume,
                                           const py::dict& fields, const Extras& extras) {
  const plc_parameters parameters = parameters_of(fields);
  Callbacks callbacks(context);
  const ExtrasView view(extras, callbacks);
  auto surface = std::make_shared<OwnSurface>(context);
  context->call([&](plc_context* handle) {
    const CallbackScope scope(callbacks, extras.functions);
    return plc_extract_volume(handle, volume.get(), &parameters, view.get(), surface->out());
  });
  return surface;
}

std::pair<double, double> volume_range(const Volume& volume) {
  std::pair<double, double> range;
  volume.context()->call([&](plc_context* handle) {
    return plc_volume_range(handle, volume.get(), &range.first, &range.second);
  });
  return range;
}

// Indexed [x, y, z].
py::array volume_voxels(const std::shared_ptr<Volume>& volume) {
  auto image = unwritten<plc_image>();
  volume->context()->call(
      [&](plc_context* handle) { return plc_volume_image(handle, volume->get(), &image); });
  if (image.voxels == nullptr) raise(PLC_INVALID_ARGUMENT, "volume: its voxels are read by bricks");
  return array_of(image, py::cast(volume));
}

std::shared_ptr<Pyramid> pyramid_create(const ContextPointer& context, const Volume& volume,
                                        const py::dict& fields) {
  const plc_parameters parameters = parameters_of(fields);
  auto pyramid = std::make_shared<Pyramid>(context, volume.lent());
  context->call([&](plc_context* handle) {
    return plc_pyramid_create(handle, volume.get(), &parameters, pyramid->out());
  });
  return pyramid;
}

py::dict pyramid_parameters(const Pyramid& pyramid) {
  auto record = unwritten<plc_parameters>();
  pyramid.context()->call(
      [&](plc_context* handle) { return plc_pyramid_parameters(handle, pyramid.get(), &record); });
  return dict_of(record);
}

plc_pyramid_level level_info(const Pyramid& pyramid, int h) {
  auto record = unwritten<plc_pyramid_level>();
  pyramid.context()->call([&](plc_context* handle) {
    return plc_pyramid_level_info(handle, pyramid.get(), h, &record);
  });
  return record;
}

// From I_0 on.
py::list pyramid_levels(const Pyramid& pyramid) {
  py::list levels;
  for (int h = 0; h <= plc_pyramid_levels(pyramid.get()); ++h) {
    levels.append(dict_of(level_info(pyramid, h)));
  }
  return levels;
}

// Indexed [z, y, x].
py::array_t<float> pyramid_values(const Pyramid& pyramid, int h) {
  const plc_pyramid_level info = level_info(pyramid, h);
  py::array_t<float> values({info.dims[2], info.dims[1], info.dims[0]});
  float* const data = values.mutable_data();
  const auto capacity = static_cast<int64_t>(values.size());
  pyramid.context()->call([&](plc_context* handle) {
    return plc_pyramid_values(handle, pyramid.get(), h, data, capacity);
  });
  return values;
}

}  // namespace

void bind_steps(py::module_& module) {
  py::class_<Volume, std::shared_ptr<Volume>>(module, "Volume")
      .def_property_readonly("context", &Volume::context)
      .def("range", &volume_range)
      .def("brick_counts", &volume_brick_counts)
      .def("voxels", &volume_voxels);
  py::class_<Pyramid, std::shared_ptr<Pyramid>>(module, "Pyramid")
      .def_property_readonly("context", &Pyramid::context)
      .def("parameters", &pyramid_parameters)
      .def("levels", &pyramid_levels)
      .def("values", &pyramid_values);
  module.def("extract", &extract);
  module.def("extract_volume", &extract_volume);
  module.def("volume_create", &volume_create);
  module.def("volume_create_bricks", &volume_create_bricks);
  module.def("pyramid_create", &pyramid_create);
  bind_run(module);
}

}  // namespace plc::python

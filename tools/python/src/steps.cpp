#include "tools/python/src/steps.h"

#include <pybind11/stl.h>

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
      .def("voxels", &volume_voxels);
  py::class_<Pyramid, std::shared_ptr<Pyramid>>(module, "Pyramid")
      .def_property_readonly("context", &Pyramid::context)
      .def("parameters", &pyramid_parameters)
      .def("levels", &pyramid_levels)
      .def("values", &pyramid_values);
  module.def("extract", &extract);
  module.def("volume_create", &volume_create);
  module.def("pyramid_create", &pyramid_create);
  bind_run(module);
}

}  // namespace plc::python

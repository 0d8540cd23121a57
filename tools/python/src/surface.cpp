#include "tools/python/src/surface.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <stdexcept>
#include <utility>

#include "tools/python/src/images.h"
#include "tools/python/src/meshes.h"
#include "tools/python/src/parameters.h"
#include "tools/python/src/records.h"

namespace plc::python {

const plc_surface* AnySurface::checked() const {
  const plc_surface* const surface = get();
  if (surface == nullptr) {
    throw std::invalid_argument("the surface of a level callback is gone when that returns");
  }
  return surface;
}

namespace {

using SurfacePointer = std::shared_ptr<AnySurface>;

// The engine writes into the array that Python gets.
template <class T, class Write>
py::array_t<T> rows_of_three(const AnySurface& surface, int64_t rows, Write&& write) {
  py::array_t<T> values({static_cast<py::ssize_t>(rows), py::ssize_t{3}});
  T* const data = values.mutable_data();
  surface.call([&](plc_context* context, const plc_surface* handle) {
    return write(context, handle, data, rows);
  });
  return values;
}

int64_t vertex_count(const AnySurface& surface) {
  return plc_surface_vertex_count(surface.checked());
}

int64_t face_count(const AnySurface& surface) {
  return plc_surface_face_count(surface.checked());
}

py::array_t<float> positions(const AnySurface& surface, const std::string& space) {
  const plc_space s = space_of(space);
  return rows_of_three<float>(
      surface, vertex_count(surface),
      [s](plc_context* context, const plc_surface* handle, float* xyz, int64_t capacity) {
        return plc_surface_positions(context, handle, s, xyz, capacity);
      });
}

py::array_t<double> positions_f64(const AnySurface& surface, const std::string& space) {
  const plc_space s = space_of(space);
  return rows_of_three<double>(
      surface, vertex_count(surface),
      [s](plc_context* context, const plc_surface* handle, double* xyz, int64_t capacity) {
        return plc_surface_positions_f64(context, handle, s, xyz, capacity);
      });
}

py::tuple frozen_sites(const AnySurface& surface, const std::string& space) {
  const plc_space s = space_of(space);
  int64_t count = 0;
  surface.call([&](plc_context* context, const plc_surface* handle) {
    return plc_surface_frozen_sites(context, handle, s, nullptr, nullptr, 0, &count);
  });
  py::array_t<int64_t> vertices(static_cast<py::ssize_t>(count));
  int64_t* const sizes = vertices.mutable_data();
  auto places = rows_of_three<double>(
      surface, count,
      [&](plc_context* context, const plc_surface* handle, double* xyz, int64_t capacity) {
        return plc_surface_frozen_sites(context, handle, s, xyz, sizes, capacity, &count);
      });
  return py::make_tuple(places, vertices);
}

py::array_t<float> normals(const AnySurface& surface, const std::string& space) {
  const plc_space s = space_of(space);
  return rows_of_three<float>(
      surface, vertex_count(surface),
      [s](plc_context* context, const plc_surface* handle, float* xyz, int64_t capacity) {
        return plc_surface_normals(context, handle, s, xyz, capacity);
      });
}

py::array_t<uint32_t> faces(const AnySurface& surface, const std::string& space) {
  const plc_space s = space_of(space);
  return rows_of_three<uint32_t>(
      surface, face_count(surface),
      [s](plc_context* context, const plc_surface* handle, uint32_t* abc, int64_t capacity) {
        return plc_surface_faces(context, handle, s, abc, capacity);
      });
}

py::array_t<float> scalars(const AnySurface& surface, const std::string& name,
                           const std::string& space) {
  const plc_space s = space_of(space);
  const plc_scalar scalar = scalar_of(name);
  const int64_t count = vertex_count(surface);
  py::array_t<float> values(static_cast<py::ssize_t>(count));
  float* const data = values.mutable_data();
  surface.call([&](plc_context* context, const plc_surface* handle) {
    return plc_surface_scalars(context, handle, s, scalar, data, count);
  });
  return values;
}

py::dict measures(const AnySurface& surface, const std::string& space) {
  const plc_space s = space_of(space);
  auto record = unwritten<plc_measures>();
  surface.call([&](plc_context* context, const plc_surface* handle) {
    return plc_surface_measure(context, handle, s, &record);
  });
  return dict_of(record);
}

py::dict check(const AnySurface& surface) {
  auto record = unwritten<plc_check>();
  surface.call([&](plc_context* context, const plc_surface* handle) {
    return plc_surface_check(context, handle, &record);
  });
  return dict_of(record);
}

py::list levels(const AnySurface& surface) {
  py::list reports;
  for (int i = 0; i < plc_surface_level_count(surface.checked()); ++i) {
    auto record = unwritten<plc_level_report>();
    surface.call([&](plc_context* context, const plc_surface* handle) {
      return plc_surface_level(context, handle, i, &record);
    });
    reports.append(dict_of(record));
  }
  return reports;
}

py::dict seconds(const AnySurface& surface) {
  auto record = unwritten<plc_seconds>();
  surface.call([&](plc_context* context, const plc_surface* handle) {
    return plc_surface_seconds(context, handle, &record);
  });
  return dict_of(record);
}

py::dict parameters(const AnySurface& surface) {
  auto record = unwritten<plc_parameters>();
  surface.call([&](plc_context* context, const plc_surface* handle) {
    return plc_surface_parameters(context, handle, &record);
  });
  return dict_of(record);
}

std::pair<double, double> input_range(const AnySurface& surface) {
  std::pair<double, double> range;
  surface.call([&](plc_context* context, const plc_surface* handle) {
    return plc_surface_input_range(context, handle, &range.first, &range.second);
  });
  return range;
}

SurfacePointer create(const std::shared_ptr<Context>& context, const std::string& space,
                      const Geometry& geometry, const MeshArrays& mesh) {
  const plc_space s = space_of(space);
  const plc_image image = image_of(geometry);
  const MeshView view(mesh);
  auto surface = std::make_shared<OwnSurface>(context);
  context->call([&](plc_context* handle) {
    return plc_surface_create(handle, s, &image, view.xyz, view.vertex_count, view.abc,
                              view.face_count, surface->out());
  });
  return surface;
}

}  // namespace

void bind_surface(py::module_& module) {
  py::class_<AnySurface, SurfacePointer>(module, "Surface")
      .def_property_readonly("context", &AnySurface::context)
      .def_property_readonly("vertex_count", &vertex_count)
      .def_property_readonly("face_count", &face_count)
      .def("positions", &positions)
      .def("positions_f64", &positions_f64)
      .def("frozen_sites", &frozen_sites)
      .def("normals", &normals)
      .def("faces", &faces)
      .def("scalars", &scalars)
      .def("hash", [](const AnySurface& surface) { return plc_surface_hash(surface.checked()); })
      .def("measures", &measures)
      .def("check", &check)
      .def("levels", &levels)
      .def("seconds", &seconds)
      .def("parameters", &parameters)
      .def("input_range", &input_range);
  module.def("surface_create", &create);
}

}  // namespace plc::python

#include "tools/python/src/meshes.h"

#include <pybind11/stl.h>

#include <array>
#include <tuple>
#include <vector>

#include "tools/python/src/records.h"

namespace plc::python {

namespace {

using Values = py::array_t<double>;
using Indices = py::array_t<uint32_t>;

void check_rows(const py::array& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw py::value_error(std::string(name) + ": must be rows of 3");
  }
}

py::dict check_mesh(Context& context, const MeshArrays& mesh) {
  const MeshView view(mesh);
  auto record = unwritten<plc_check>();
  context.call([&](plc_context* handle) {
    return plc_check_mesh(handle, view.xyz, view.vertex_count, view.abc, view.face_count, &record);
  });
  return dict_of(record);
}

// Enough for nearly all meshes: others are measured twice.
constexpr int64_t kUsualComponents = 64;

// All together, and each.
std::pair<py::dict, py::list> component_measures(Context& context, const MeshArrays& mesh) {
  const MeshView view(mesh);
  auto whole = unwritten<plc_component_measures>();
  std::vector<plc_component_measures> each;
  context.call([&](plc_context* handle) {
    int64_t count = kUsualComponents;
    plc_status status = PLC_OK;
    do {
      each.resize(static_cast<size_t>(count));
      status = plc_mesh_component_measures(handle, view.xyz, view.vertex_count, view.abc,
                                           view.face_count, &whole, each.data(),
                                           static_cast<int64_t>(each.size()), &count);
    } while (status == PLC_OK && count > static_cast<int64_t>(each.size()));
    each.resize(static_cast<size_t>(status == PLC_OK ? count : 0));
    return status;
  });
  py::list components;
  for (const plc_component_measures& record : each) components.append(dict_of(record));
  return {dict_of(whole), components};
}

std::array<Values, 3> curvature(Context& context, const MeshArrays& mesh) {
  const MeshView view(mesh);
  std::array<Values, 3> result{Values(view.vertex_count), Values(view.vertex_count),
                               Values(view.vertex_count)};
  double* const mean = result[0].mutable_data();
  double* const gaussian = result[1].mutable_data();
  double* const area = result[2].mutable_data();
  context.call([&](plc_context* handle) {
    return plc_mesh_curvature(handle, view.xyz, view.vertex_count, view.abc, view.face_count, mean,
                              gaussian, area);
  });
  return result;
}

int64_t nearest_vertex(Context& context, const MeshArrays& mesh,
                       const std::array<double, 3>& point) {
  const MeshView view(mesh);
  int64_t vertex = -1;
  context.call([&](plc_context* handle) {
    return plc_mesh_nearest_vertex(handle, view.xyz, view.vertex_count, view.abc, view.face_count,
                                   point.data(), &vertex);
  });
  return vertex;
}

Values geodesic(Context& context, const MeshArrays& mesh, int64_t source) {
  const MeshView view(mesh);
  Values result(view.vertex_count);
  double* const distance = result.mutable_data();
  context.call([&](plc_context* handle) {
    return plc_mesh_geodesic(handle, view.xyz, view.vertex_count, view.abc, view.face_count, source,
                             distance);
  });
  return result;
}

std::pair<Values, py::dict> distance(Context& context, const MeshArrays& mesh,
                                     const MeshArrays& other) {
  const MeshView view(mesh);
  const MeshView other_view(other);
  Values result(view.vertex_count);
  double* const values = result.mutable_data();
  auto record = unwritten<plc_distances>();
  context.call([&](plc_context* handle) {
    return plc_mesh_distance(handle, view.xyz, view.vertex_count, view.abc, view.face_count,
                             other_view.xyz, other_view.vertex_count, other_view.abc,
                             other_view.face_count, values, &record);
  });
  return {result, dict_of(record)};
}

std::tuple<Values, Indices, py::dict> simplify(Context& context, const MeshArrays& mesh,
                                               double tolerance, bool one_sided) {
  const MeshView view(mesh);
  std::vector<double> xyz(3 * static_cast<size_t>(view.vertex_count));
  std::vector<uint32_t> abc(3 * static_cast<size_t>(view.face_count));
  plc_simplify_options options;
  plc_simplify_options_defaults(&options);
  options.tolerance = tolerance;
  options.one_sided = one_sided ? 1 : 0;
  auto record = unwritten<plc_simplified>();
  context.call([&](plc_context* handle) {
    return plc_mesh_simplify(handle, view.xyz, view.vertex_count, view.abc, view.face_count,
                             &options, xyz.data(), abc.data(), &record);
  });
  return {Values({record.vertices, int64_t{3}}, xyz.data()),
          Indices({record.faces, int64_t{3}}, abc.data()), dict_of(record)};
}

py::array_t<float> round_mesh(Context& context, const MeshArrays& mesh) {
  const MeshView view(mesh);
  py::array_t<float> rounded({view.vertex_count, int64_t{3}});
  float* xyz = rounded.mutable_data();
  context.call([&](plc_context* handle) {
    return plc_mesh_round(handle, view.xyz, view.vertex_count, view.abc, view.face_count, xyz,
                          nullptr);
  });
  return rounded;
}

}  // namespace

MeshView::MeshView(const MeshArrays& mesh)
    : xyz(mesh.first.data()),
      vertex_count(mesh.first.shape(0)),
      abc(mesh.second.data()),
      face_count(mesh.second.shape(0)) {
  check_rows(mesh.first, "vertices");
  check_rows(mesh.second, "faces");
}

void bind_meshes(py::module_& module) {
  module.def("check_mesh", &check_mesh);
  module.def("component_measures", &component_measures);
  module.def("curvature", &curvature);
  module.def("nearest_vertex", &nearest_vertex);
  module.def("geodesic", &geodesic);
  module.def("distance", &distance);
  module.def("simplify", &simplify);
  module.def("round_mesh", &round_mesh);
}

}  // namespace plc::python

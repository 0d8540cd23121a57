#include "tools/python/src/records.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>

namespace plc::python {

namespace {

using namespace py::literals;

template <class T>
py::tuple triple(const T* values) {
  return py::make_tuple(values[0], values[1], values[2]);
}

template <size_t kRows, size_t kColumns>
py::array_t<double> matrix(const double* values) {
  return py::array_t<double>({kRows, kColumns}, values);
}

// -1 stands for what is not defined.
py::object defined(int64_t value) {
  if (value < 0) return py::none();
  return py::int_(value);
}

// NAN stands for an iso-value that is not set.
py::object iso_of(double value) {
  if (std::isnan(value)) return py::none();
  return py::float_(value);
}

py::array_t<double> second_moments(const double* m) {
  const double full[9] = {m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2]};
  return matrix<3, 3>(full);
}

}  // namespace

py::dict dict_of(const plc_progress& p) {
  return py::dict("level"_a = p.level, "levels"_a = p.levels, "iteration"_a = p.iteration,
                  "vertices"_a = p.vertices, "energy"_a = p.energy, "speed"_a = p.speed,
                  "fraction"_a = p.fraction, "seconds"_a = p.seconds);
}

py::dict dict_of(const plc_run_state& s) {
  return py::dict("done"_a = s.done != 0, "between_levels"_a = s.between_levels != 0,
                  "progress"_a = dict_of(s.progress));
}

py::dict dict_of(const plc_pyramid_level& l) {
  return py::dict("dims"_a = triple(l.dims), "spacing"_a = triple(l.spacing),
                  "origin"_a = triple(l.origin), "unit"_a = l.unit, "iso"_a = iso_of(l.iso));
}

py::dict dict_of(const plc_level_report& r) {
  return py::dict(
      "level"_a = r.level, "dims"_a = triple(r.dims), "unit"_a = r.unit, "delta"_a = r.delta,
      "iso"_a = iso_of(r.iso), "iterations"_a = r.iterations, "vertices"_a = r.vertices,
      "converged"_a = r.converged != 0, "energy"_a = r.energy, "speed"_a = r.speed,
      "seconds_topology"_a = r.seconds_topology, "seconds_normals"_a = r.seconds_normals,
      "seconds_dynamics"_a = r.seconds_dynamics, "seconds_total"_a = r.seconds_total,
      "creations"_a = r.creations, "inversions"_a = r.inversions, "deletions"_a = r.deletions,
      "annular"_a = r.annular, "axial"_a = r.axial, "tetrahedra"_a = r.tetrahedra,
      "refinements"_a = r.refinements, "deferred"_a = r.deferred, "late_bubbles"_a = r.late_bubbles,
      "late_cavities"_a = r.late_cavities, "late_volume"_a = r.late_volume, "moves"_a = r.moves,
      "checks"_a = r.checks, "frozen_sites"_a = r.frozen_sites,
      "frozen_vertices"_a = r.frozen_vertices);
}

py::dict dict_of(const plc_seconds& s) {
  return py::dict("preparation"_a = s.preparation, "images"_a = s.images,
                  "evolution"_a = s.evolution);
}

py::dict dict_of(const plc_measures& m) {
  return py::dict("vertices"_a = m.vertices, "faces"_a = m.faces, "components"_a = m.components,
                  "euler"_a = m.euler, "genus"_a = defined(m.genus), "area"_a = m.area,
                  "volume"_a = m.volume);
}

py::dict dict_of(const plc_check& c) {
  py::object outward = py::none();
  if (c.outward >= 0) outward = py::bool_(c.outward != 0);
  py::object first = py::none();
  if (c.self_intersections > 0) {
    first = py::make_tuple(c.first_intersection[0], c.first_intersection[1]);
  }
  return py::dict(
      "measures"_a = dict_of(c.measures), "valid"_a = c.valid != 0, "closed"_a = c.closed != 0,
      "manifold"_a = c.manifold != 0, "oriented"_a = c.oriented != 0, "outward"_a = outward,
      "border_edges"_a = c.border_edges, "non_manifold_edges"_a = c.non_manifold_edges,
      "non_manifold_vertices"_a = c.non_manifold_vertices,
      "inconsistent_edges"_a = c.inconsistent_edges,
      "wrongly_oriented_components"_a = c.wrongly_oriented_components,
      "degenerate_faces"_a = c.degenerate_faces, "duplicate_points"_a = c.duplicate_points,
      "isolated_vertices"_a = c.isolated_vertices, "self_intersections"_a = c.self_intersections,
      "first_intersection"_a = first, "edge_min"_a = c.edge_min, "edge_mean"_a = c.edge_mean,
      "edge_max"_a = c.edge_max, "min_angle"_a = c.min_angle, "max_angle"_a = c.max_angle,
      "valence_min"_a = c.valence_min, "valence_max"_a = c.valence_max);
}

py::dict dict_of(const plc_component_measures& m) {
  return py::dict("first_face"_a = m.first_face, "vertices"_a = m.vertices, "faces"_a = m.faces,
                  "euler"_a = m.euler, "genus"_a = defined(m.genus), "area"_a = m.area,
                  "volume"_a = m.volume, "low"_a = triple(m.low), "high"_a = triple(m.high),
                  "centroid"_a = triple(m.centroid), "moments"_a = second_moments(m.moments),
                  "principal_moments"_a = triple(m.principal_moments),
                  "principal_axes"_a = matrix<3, 3>(m.principal_axes));
}

py::dict dict_of(const plc_distances& d) {
  return py::dict("mean"_a = d.mean, "rms"_a = d.rms, "max"_a = d.max,
                  "vertex_mean"_a = d.vertex_mean, "vertex_max"_a = d.vertex_max);
}

py::dict dict_of(const plc_simplified& s) {
  return py::dict("from_at_least"_a = s.from_at_least, "from_at_most"_a = s.from_at_most,
                  "to_at_least"_a = s.to_at_least, "to_at_most"_a = s.to_at_most);
}

}  // namespace plc::python

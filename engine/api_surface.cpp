// The C API: what a surface is asked for.
#include <cmath>

#include "engine/edge.h"
#include "engine/handles.h"
#include "engine/state_hash.h"

namespace {

// Mesh space to one of the spaces of the API.
plc::Affine affine_of(const plc_surface& surface, plc_space space) {
  plc::Affine a = surface.frame.to(space);
  for (size_t i = 0; i < 9; ++i) a.m[i] /= surface.space.step[i % 3];
  return a;
}

}  // namespace

extern "C" {

void plc_surface_destroy(plc_surface* surface) {
  delete surface;
}

int64_t plc_surface_vertex_count(const plc_surface* surface) {
  return surface->mesh.vertex_count();
}

// A closed triangulated surface has 2 faces for 3 edges, and the valences count each edge twice.
int64_t plc_surface_face_count(const plc_surface* surface) {
  int64_t ends = 0;
  for (uint32_t v = 0; v < surface->mesh.slots(); ++v) ends += surface->mesh.valence(v);
  return ends / 3;
}

void plc_surface_positions(const plc_surface* surface, plc_space space, float* xyz) {
  const plc::Affine a = affine_of(*surface, space);
  for (uint32_t v = 0; v < surface->mesh.slots(); ++v) {
    const plc::Packed& p = surface->mesh.packed[v];
    const auto at =
        a.point({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    for (const double x : at) *xyz++ = static_cast<float>(x);
  }
}

void plc_surface_faces(const plc_surface* surface, plc_space space, uint32_t* abc) {
  const std::vector<uint32_t> faces = surface->mesh.faces();
  const bool mirrored = affine_of(*surface, space).mirrors();
  for (size_t i = 0; i < faces.size(); i += 3) {
    *abc++ = faces[i];
    *abc++ = faces[mirrored ? i + 2 : i + 1];
    *abc++ = faces[mirrored ? i + 1 : i + 2];
  }
}

void plc_surface_normals(const plc_surface* surface, plc_space space, float* xyz) {
  // Area vectors in the space itself: normals do not map as points do.
  const auto n = static_cast<size_t>(surface->mesh.slots());
  std::vector<float> p(3 * n);
  plc_surface_positions(surface, space, p.data());
  const double sign = affine_of(*surface, space).mirrors() ? -1 : 1;
  const auto at = [&](uint32_t v) {
    const size_t i = static_cast<size_t>(v) * 3;
    return plc::Vec3{p[i], p[i + 1], p[i + 2]};
  };
  for (uint32_t v = 0; v < n; ++v) {
    const uint32_t d = surface->mesh.valence(v);
    plc::Vec3 sum;
    for (uint32_t k = 0; k < d; ++k) {
      const plc::Vec3 a = at(surface->mesh.neighbor(v, k)) - at(v);
      const plc::Vec3 b = at(surface->mesh.neighbor(v, k + 1 == d ? 0 : k + 1)) - at(v);
      sum = sum + plc::cross(a, b);
    }
    const float norm = plc::length(sum);
    const plc::Vec3 normal = norm > 0 ? sum * (static_cast<float>(sign) / norm) : plc::Vec3{};
    *xyz++ = normal.x;
    *xyz++ = normal.y;
    *xyz++ = normal.z;
  }
}

uint64_t plc_surface_hash(const plc_surface* surface) {
  return plc::state_hash(surface->mesh);
}

int plc_surface_level_count(const plc_surface* surface) {
  return static_cast<int>(surface->records.size());
}

plc_status plc_surface_level(const plc_surface* surface, int index, plc_level_report* report) {
  if (report == nullptr || report->struct_size != sizeof *report || index < 0 ||
      index >= plc_surface_level_count(surface)) {
    return PLC_INVALID_ARGUMENT;
  }
  const auto i = static_cast<size_t>(index);
  const plc::LevelRecord& r = surface->records[i];
  report->level = r.level;
  for (size_t a = 0; a < 3; ++a) report->dims[a] = surface->level_dims[i][a];
  report->unit = surface->level_units[i];
  report->delta = r.delta;
  report->iso = surface->level_isos[i];
  report->iterations = r.iterations;
  report->vertices = r.vertices;
  report->converged = r.converged ? 1 : 0;
  report->energy = r.energy;
  report->speed = r.speed;
  report->seconds_topology = r.seconds.topology;
  report->seconds_normals = r.seconds.normals;
  report->seconds_dynamics = r.seconds.dynamics;
  report->seconds_total = r.seconds.total;
  report->creations = r.operations.creation;
  report->inversions = r.operations.inversion;
  report->deletions = r.operations.deletion;
  report->annular = r.operations.annular;
  report->axial = r.operations.axial;
  report->tetrahedra = r.operations.tetrahedron;
  report->refinements = r.operations.refinement;
  report->deferred = r.operations.deferred;
  report->late_bubbles = r.late.bubbles;
  report->late_cavities = r.late.cavities;
  report->late_volume = r.late.volume;
  report->moves = r.operations.moves;
  report->checks = r.operations.checks;
  return PLC_OK;
}

double plc_surface_image_seconds(const plc_surface* surface) {
  return surface->seconds_images;
}

void plc_surface_seconds(const plc_surface* surface, double* pyramid, double* evolution) {
  *pyramid = surface->seconds_pyramid;
  *evolution = surface->seconds_evolution;
}

void plc_surface_parameters(const plc_surface* surface, plc_parameters* parameters) {
  *parameters = surface->parameters;
}

void plc_surface_input_range(const plc_surface* surface, double* low, double* high) {
  *low = surface->range.low;
  *high = surface->range.high;
}

}  // extern "C"

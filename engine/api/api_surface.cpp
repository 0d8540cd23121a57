// The C API: what a surface is asked for.
#include "engine/api/api_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/api_check.h"
#include "engine/base/double3.h"
#include "engine/base/mesh_arrays.h"
#include "engine/measure/curvature.h"
#include "engine/mesh/state_hash.h"
#include "engine/recover/frozen_sites.h"
#include "engine/transform/edge.h"
#include "pyramid/memory.h"

namespace plc {

Affine affine_of(const plc_surface& surface, plc_space space) {
  Affine a = surface.frame.to(space);
  for (size_t i = 0; i < 9; ++i) a.m[i] /= surface.space.step[i % 3];
  return a;
}

namespace {

Status check_surface(const plc_surface* surface, plc_space space) {
  if (surface == nullptr) return bad_argument("surface: must not be NULL");
  if (space < PLC_SPACE_LPS || space > PLC_SPACE_VOXEL) {
    return bad_argument("space: not a plc_space");
  }
  return {};
}

Status check_vertices(const plc_surface* surface, plc_space space, const char* name,
                      const void* data, int64_t capacity) {
  if (Status s = check_surface(surface, space); !s.ok()) return s;
  return check_room(name, data, capacity, plc_surface_vertex_count(surface));
}

template <typename Real>
void write_positions(const plc_surface& surface, const Affine& a, Real* xyz) {
  for (uint32_t v = 0; v < surface.mesh.slots(); ++v) {
    const Float4& p = surface.mesh.position[v];
    const auto at =
        a.point({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
    for (const double x : at) *xyz++ = static_cast<Real>(x);
  }
}

void write_faces(const plc_surface& surface, plc_space space, const Executor& executor,
                 uint32_t* abc) {
  const bool mirrored = affine_of(surface, space).mirrors();
  const Vector<uint32_t> faces = surface.mesh.faces(executor);
  for (size_t i = 0; i < faces.size(); i += 3) {
    *abc++ = faces[i];
    *abc++ = faces[mirrored ? i + 2 : i + 1];
    *abc++ = faces[mirrored ? i + 1 : i + 2];
  }
}

// Whether floats of the space tell the directions of faces: those far from the origin round by much
// of a voxel, and of very small or large units the squares of areas leave their range.
bool floats_tell_normals(const Affine& a, const Buffer<float>& p) {
  constexpr double kRounding = 0x1p-24;
  constexpr double kOfVoxel = 1e-2;
  double step = std::numeric_limits<double>::infinity();
  for (size_t axis = 0; axis < 3; ++axis) {
    step = std::min(step, std::hypot(a.m[axis], a.m[axis + 3], a.m[axis + 6]));
  }
  double farthest = 0;
  for (const float x : p) farthest = std::max(farthest, std::abs(static_cast<double>(x)));
  return step > 1e-8 && step < 1e8 && farthest * kRounding < kOfVoxel * step;
}

// In doubles, about the image's first voxel.
void write_far_normals(const plc_surface& surface, Affine a, float* xyz) {
  const Mesh& mesh = surface.mesh;
  const double sign = a.mirrors() ? -1 : 1;
  a.t = {};
  Buffer<double> p(3 * static_cast<size_t>(mesh.slots()));
  write_positions(surface, a, p.data());
  const auto at = [&](uint32_t v) {
    const size_t i = static_cast<size_t>(v) * 3;
    return Double3{p[i], p[i + 1], p[i + 2]};
  };
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const uint32_t d = mesh.valence(v);
    Double3 sum;
    for (uint32_t k = 0; k < d; ++k) {
      const Double3 to = at(mesh.neighbor(v, k)) - at(v);
      sum = sum + cross(to, at(mesh.neighbor(v, k + 1 == d ? 0 : k + 1)) - at(v));
    }
    const double norm = length(sum);
    const Double3 normal = norm > 0 ? sum * (sign / norm) : Double3{};
    *xyz++ = static_cast<float>(normal.x);
    *xyz++ = static_cast<float>(normal.y);
    *xyz++ = static_cast<float>(normal.z);
  }
}

// Area vectors in the space itself: normals do not map as points do.
void write_normals(const plc_surface& surface, plc_space space, float* xyz) {
  const Mesh& mesh = surface.mesh;
  const auto n = static_cast<size_t>(mesh.slots());
  Buffer<float> p(3 * n);
  write_positions(surface, affine_of(surface, space), p.data());
  if (!floats_tell_normals(affine_of(surface, space), p)) {
    write_far_normals(surface, affine_of(surface, space), xyz);
    return;
  }
  const double sign = affine_of(surface, space).mirrors() ? -1 : 1;
  const auto at = [&](uint32_t v) {
    const size_t i = static_cast<size_t>(v) * 3;
    return Vec3{p[i], p[i + 1], p[i + 2]};
  };
  for (uint32_t v = 0; v < n; ++v) {
    const uint32_t d = mesh.valence(v);
    Vec3 sum;
    for (uint32_t k = 0; k < d; ++k) {
      const Vec3 a = at(mesh.neighbor(v, k)) - at(v);
      const Vec3 b = at(mesh.neighbor(v, k + 1 == d ? 0 : k + 1)) - at(v);
      sum = sum + cross(a, b);
    }
    const float norm = length(sum);
    const Vec3 normal = norm > 0 ? sum * (static_cast<float>(sign) / norm) : Vec3{};
    *xyz++ = normal.x;
    *xyz++ = normal.y;
    *xyz++ = normal.z;
  }
}

// A copy of the surface as functions of any mesh take it: in the units and axes of the space, but
// not rounded to floats in it, which would make what is small beside its distance from the origin
// meet, and about the image's first voxel instead of the origin, for the same reason.
struct PlainMesh {
  Buffer<double> xyz;
  Buffer<uint32_t> abc;
  size_t vertices = 0, faces = 0;

  MeshArrays arrays() const { return {xyz.data(), vertices, abc.data(), faces}; }
};
PlainMesh plain_mesh(const plc_surface& surface, plc_space space, const Executor& executor) {
  PlainMesh mesh;
  mesh.vertices = static_cast<size_t>(plc_surface_vertex_count(&surface));
  mesh.faces = static_cast<size_t>(plc_surface_face_count(&surface));
  Affine in_space = affine_of(surface, space);
  in_space.t = {};
  mesh.xyz.resize_uninitialized(3 * mesh.vertices);
  write_positions(surface, in_space, mesh.xyz.data());
  mesh.abc.resize_uninitialized(3 * mesh.faces);
  write_faces(surface, space, executor, mesh.abc.data());
  return mesh;
}

void write_curvature(const plc_surface& surface, plc_space space, plc_scalar scalar,
                     const Executor& executor, float* values) {
  const PlainMesh mesh = plain_mesh(surface, space, executor);
  Buffer<double> wanted(mesh.vertices);
  double* mean = scalar == PLC_SCALAR_MEAN_CURVATURE ? wanted.data() : nullptr;
  double* gaussian = scalar == PLC_SCALAR_GAUSSIAN_CURVATURE ? wanted.data() : nullptr;
  double* area = scalar == PLC_SCALAR_AREA ? wanted.data() : nullptr;
  vertex_curvature(mesh.arrays(), executor, mean, gaussian, area);
  for (const double x : wanted) *values++ = static_cast<float>(x);
}

void write_scalars(const plc_surface& surface, plc_space space, plc_scalar scalar,
                   const Executor& executor, float* values) {
  const Mesh& mesh = surface.mesh;
  if (scalar == PLC_SCALAR_VALENCE) {
    for (uint32_t v = 0; v < mesh.slots(); ++v) *values++ = static_cast<float>(mesh.valence(v));
  } else if (scalar == PLC_SCALAR_MOVEMENT) {
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      *values++ = dot(mesh.displacement.at(v), mesh.normal.at(v)) / static_cast<float>(mesh.delta);
    }
  } else {
    write_curvature(surface, space, scalar, executor, values);
  }
}

}  // namespace

plc_level_report level_report(const plc_surface& surface, size_t index) {
  plc_level_report report{};
  report.struct_size = sizeof report;
  const LevelRecord& r = surface.records[index];
  report.level = r.level;
  for (size_t a = 0; a < 3; ++a) report.dims[a] = surface.level_dims[index][a];
  report.unit = surface.level_units[index];
  report.delta = r.delta;
  report.iso = surface.parameters.level_iso[index];
  report.iterations = r.iterations;
  report.vertices = r.vertices;
  report.converged = r.converged ? 1 : 0;
  report.energy = r.energy;
  report.speed = r.speed;
  report.seconds_topology = r.seconds.topology;
  report.seconds_normals = r.seconds.normals;
  report.seconds_dynamics = r.seconds.dynamics;
  report.seconds_total = r.seconds.total;
  report.creations = r.operations.creation;
  report.inversions = r.operations.inversion;
  report.deletions = r.operations.deletion;
  report.annular = r.operations.annular;
  report.axial = r.operations.axial;
  report.tetrahedra = r.operations.tetrahedron;
  report.refinements = r.operations.refinement;
  report.deferred = r.operations.deferred;
  report.late_bubbles = r.late.bubbles;
  report.late_cavities = r.late.cavities;
  // The record takes the axes for perpendicular.
  const auto& s = surface.frame.spacing;
  report.late_volume =
      r.late.volume * (surface.frame.to(PLC_SPACE_LPS).volume() / (s[0] * s[1] * s[2]));
  report.moves = r.operations.moves;
  report.checks = r.operations.checks;
  report.frozen_sites = r.frozen_sites;
  report.frozen_vertices = r.frozen_vertices;
  return report;
}

}  // namespace plc

using plc::Status;

extern "C" {

void plc_surface_destroy(plc_surface* surface) {
  delete surface;
}

int64_t plc_surface_vertex_count(const plc_surface* surface) {
  return surface == nullptr ? 0 : surface->mesh.vertex_count();
}

// A closed triangulated surface has 2 faces for 3 edges, and the valences count each edge twice.
int64_t plc_surface_face_count(const plc_surface* surface) {
  if (surface == nullptr) return 0;
  if (surface->mesh.is_patch()) return static_cast<int64_t>(surface->mesh.faces().size() / 3);
  int64_t ends = 0;
  for (uint32_t v = 0; v < surface->mesh.slots(); ++v) ends += surface->mesh.valence(v);
  return ends / 3;
}

plc_status plc_surface_positions(plc_context* context, const plc_surface* surface, plc_space space,
                                 float* xyz, int64_t capacity) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_vertices(surface, space, "xyz", xyz, capacity); !s.ok()) return s;
    plc::write_positions(*surface, plc::affine_of(*surface, space), xyz);
    return {};
  });
}

plc_status plc_surface_positions_f64(plc_context* context, const plc_surface* surface,
                                     plc_space space, double* xyz, int64_t capacity) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_vertices(surface, space, "xyz", xyz, capacity); !s.ok()) return s;
    plc::write_positions(*surface, plc::affine_of(*surface, space), xyz);
    return {};
  });
}

plc_status plc_surface_frozen_sites(plc_context* context, const plc_surface* surface,
                                    plc_space space, double* xyz, int64_t* vertices,
                                    int64_t capacity, int64_t* count) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_surface(surface, space); !s.ok()) return s;
    if (count == nullptr) return plc::bad_argument("count: must not be NULL");
    const auto sites = plc::frozen_sites(surface->mesh);
    *count = static_cast<int64_t>(sites.size());
    if (xyz == nullptr) return {};
    if (Status s = plc::check_room("xyz", xyz, capacity, *count); !s.ok()) return s;
    const plc::Affine a = plc::affine_of(*surface, space);
    for (const plc::FrozenSite& site : sites) {
      const plc::Vec3 p = site.place;
      const auto at =
          a.point({static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
      xyz = std::copy(at.begin(), at.end(), xyz);
      if (vertices != nullptr) *vertices++ = site.vertices;
    }
    return {};
  });
}

plc_status plc_surface_patch(plc_context* context, const plc_surface* surface, int64_t* source,
                             int64_t capacity) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_vertices(surface, PLC_SPACE_LPS, "source", source, capacity);
        !s.ok()) {
      return s;
    }
    const plc::Mesh& mesh = surface->mesh;
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      const uint32_t held = mesh.is_patch() ? mesh.held[v] : 0;
      source[v] = held == 0                    ? PLC_PATCH_FREE
                  : held == plc::Mesh::kAbsent ? PLC_PATCH_ABSENT
                                               : int64_t{held} - 1;
    }
    return {};
  });
}

plc_status plc_surface_faces(plc_context* context, const plc_surface* surface, plc_space space,
                             uint32_t* abc, int64_t capacity) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_surface(surface, space); !s.ok()) return s;
    const int64_t faces = plc_surface_face_count(surface);
    if (Status s = plc::check_room("abc", abc, capacity, faces); !s.ok()) return s;
    plc::write_faces(*surface, space, context->host->schedule, abc);
    return {};
  });
}

plc_status plc_surface_normals(plc_context* context, const plc_surface* surface, plc_space space,
                               float* xyz, int64_t capacity) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_vertices(surface, space, "xyz", xyz, capacity); !s.ok()) return s;
    plc::write_normals(*surface, space, xyz);
    return {};
  });
}

plc_status plc_surface_scalars(plc_context* context, const plc_surface* surface, plc_space space,
                               plc_scalar scalar, float* values, int64_t capacity) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_vertices(surface, space, "values", values, capacity); !s.ok()) {
      return s;
    }
    if (scalar < PLC_SCALAR_MEAN_CURVATURE || scalar > PLC_SCALAR_MOVEMENT) {
      return plc::bad_argument("scalar: not a plc_scalar");
    }
    plc::write_scalars(*surface, space, scalar, context->host->schedule, values);
    return {};
  });
}

uint64_t plc_surface_hash(const plc_surface* surface) {
  return surface == nullptr ? 0 : plc::state_hash(surface->mesh);
}

plc_status plc_surface_measure(plc_context* context, const plc_surface* surface, plc_space space,
                               plc_measures* measures) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_surface(surface, space); !s.ok()) return s;
    if (Status s = plc::check_output(measures, "measures"); !s.ok()) return s;
    const plc::PlainMesh mesh = plc::plain_mesh(*surface, space, context->host->schedule);
    plc::give_struct(plc::record_of(plc::surface_measures(mesh.arrays(), context->host->schedule)),
                     measures);
    return {};
  });
}

plc_status plc_surface_check(plc_context* context, const plc_surface* surface, plc_check* check) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_surface(surface, PLC_SPACE_LPS); !s.ok()) return s;
    if (Status s = plc::check_output(check, "check"); !s.ok()) return s;
    const plc::PlainMesh mesh = plc::plain_mesh(*surface, PLC_SPACE_LPS, context->host->schedule);
    plc::MeshCheck found;
    Status s = plc::check_mesh(mesh.arrays(), context->host->schedule, found);
    if (s.ok()) plc::give_struct(plc::record_of(found), check);
    return s;
  });
}

int plc_surface_level_count(const plc_surface* surface) {
  return surface == nullptr ? 0 : static_cast<int>(surface->records.size());
}

int plc_surface_converged(const plc_surface* surface) {
  if (surface == nullptr) return 0;
  // Records tell of vertices when their level ends, and the last may be of one that goes on.
  const auto& records = surface->records;
  for (const plc::LevelRecord& r : records) {
    const int64_t vertices = &r == &records.back() ? surface->mesh.vertex_count() : r.vertices;
    if (!r.converged && vertices > 0) return 0;
  }
  return 1;
}

plc_status plc_surface_level(plc_context* context, const plc_surface* surface, int index,
                             plc_level_report* report) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_surface(surface, PLC_SPACE_LPS); !s.ok()) return s;
    if (index < 0 || index >= plc_surface_level_count(surface)) {
      return plc::bad_argument("level " + std::to_string(index) + ": the surface has " +
                               std::to_string(plc_surface_level_count(surface)));
    }
    if (Status s = plc::check_output(report, "report"); !s.ok()) return s;
    plc::give_struct(plc::level_report(*surface, static_cast<size_t>(index)), report);
    return {};
  });
}

plc_status plc_surface_seconds(plc_context* context, const plc_surface* surface,
                               plc_seconds* seconds) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_surface(surface, PLC_SPACE_LPS); !s.ok()) return s;
    if (Status s = plc::check_output(seconds, "seconds"); !s.ok()) return s;
    plc::give_struct(surface->seconds, seconds);
    return {};
  });
}

plc_status plc_surface_parameters(plc_context* context, const plc_surface* surface,
                                  plc_parameters* parameters) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_surface(surface, PLC_SPACE_LPS); !s.ok()) return s;
    if (Status s = plc::check_output(parameters, "parameters"); !s.ok()) return s;
    plc::give_struct(surface->parameters, parameters);
    return {};
  });
}

plc_status plc_surface_input_range(plc_context* context, const plc_surface* surface, double* low,
                                   double* high) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_surface(surface, PLC_SPACE_LPS); !s.ok()) return s;
    if (low == nullptr || high == nullptr) {
      return plc::bad_argument("low, high: must not be NULL");
    }
    *low = surface->range.low;
    *high = surface->range.high;
    return {};
  });
}

}  // extern "C"

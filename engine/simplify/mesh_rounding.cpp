#include "engine/simplify/mesh_rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/double3.h"
#include "engine/exact/self_intersection.h"
#include "engine/exact/triangle_intersection.h"
#include "engine/measure/mesh_check.h"

namespace plc {

namespace {

constexpr double kMostOfEdge = 1.0 / 64;
constexpr double kRounding = 0x1p-24;  // of a float, against its magnitude

using Corners = std::array<Double3, 3>;

Double3 point_of(const MeshArrays& mesh, uint32_t v) {
  const double* p = mesh.point(v);
  return {p[0], p[1], p[2]};
}

bool has_corner(const uint32_t* face, uint32_t v) {
  return face[0] == v || face[1] == v || face[2] == v;
}

double largest_coordinate(const MeshArrays& mesh, const uint32_t* face) {
  double most = 0;
  for (int k = 0; k < 3; ++k) {
    const double* p = mesh.point(face[k]);
    most = std::max({most, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  }
  return most;
}

// Two faces that do not meet elsewhere than in what they share.
class Apart {
 public:
  Apart(const uint32_t* f, const uint32_t* g, const MeshArrays& mesh) : f_(f), g_(g) {
    const Double3 origin = point_of(mesh, f[0]);
    for (size_t k = 0; k < 3; ++k) {
      at_f_[k] = point_of(mesh, f[k]) - origin;
      at_g_[k] = point_of(mesh, g[k]) - origin;
    }
  }

  double shortest_edge() const {
    double least = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < 3; ++k) {
      least = std::min({least, length(edge(at_f_, k)), length(edge(at_g_, k))});
    }
    return least;
  }

  // The unit direction from f to g along which what they do not share is farthest apart, of those
  // along which planes part them: one is across a face, or across an edge of each.
  Double3 direction() const {
    Best best;
    best.take(*this, cross(edge(at_f_, 0), edge(at_f_, 1)));
    best.take(*this, cross(edge(at_g_, 0), edge(at_g_, 1)));
    for (size_t i = 0; i < 3; ++i) {
      for (size_t k = 0; k < 3; ++k) best.take(*this, cross(edge(at_f_, i), edge(at_g_, k)));
    }
    return best.direction;
  }

 private:
  struct Best {
    Double3 direction;
    double gap = -std::numeric_limits<double>::infinity();
    void take(const Apart& faces, const Double3& across) {
      const double norm = length(across);
      if (!(norm > 0)) return;
      for (const double sign : {1.0, -1.0}) {
        const Double3 to = across * (sign / norm);
        const double found = faces.gap(to);
        if (found > gap) *this = {to, found};
      }
    }
  };

  static Double3 edge(const Corners& at, size_t k) { return at[(k + 1) % 3] - at[k]; }

  // Along `to`; what they share must lie between the two, and counts against them where it does
  // not.
  double gap(const Double3& to) const {
    constexpr double kAgainst = 1e6;
    double f_end = -std::numeric_limits<double>::infinity(), g_begin = -f_end;
    for (size_t k = 0; k < 3; ++k) {
      if (!has_corner(g_, f_[k])) f_end = std::max(f_end, dot(at_f_[k], to));
      if (!has_corner(f_, g_[k])) g_begin = std::min(g_begin, dot(at_g_[k], to));
    }
    double outside = 0;
    for (size_t k = 0; k < 3; ++k) {
      if (!has_corner(g_, f_[k])) continue;
      const double shared = dot(at_f_[k], to);
      outside = std::max({outside, f_end - shared, shared - g_begin});
    }
    return g_begin - f_end - kAgainst * outside;
  }

  const uint32_t* f_;
  const uint32_t* g_;
  Corners at_f_, at_g_;
};

double to_float(double x) {
  return static_cast<double>(static_cast<float>(x));
}

void round_all(const Vector<double>& from, Vector<double>& to) {
  std::transform(from.begin(), from.end(), to.begin(), to_float);
}

int64_t count_moved(const MeshArrays& mesh, const Vector<double>& xyz) {
  int64_t moved = 0;
  for (size_t v = 0; v < mesh.vertex_count; ++v) {
    bool here = true;
    for (size_t k = 0; k < 3; ++k) here = here && xyz[3 * v + k] == to_float(mesh.point(v)[k]);
    moved += here ? 0 : 1;
  }
  return moved;
}

bool meet(const MeshArrays& mesh, const FacePair& pair) {
  return triangles_intersect(make_triangle(mesh.xyz, mesh.face(pair.first)),
                             make_triangle(mesh.xyz, mesh.face(pair.second)));
}

Status not_held() {
  return {ErrorCode::kInvalidData, "rounded to floats, faces of the mesh meet"};
}

}  // namespace

Status round_to_floats(const MeshArrays& mesh, const Executor& executor, RoundedMesh& rounded) {
  Vector<double> at(mesh.xyz, mesh.xyz + 3 * mesh.vertex_count);
  Vector<double> xyz(at.size());
  round_all(at, xyz);
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::all_of(xyz.begin(), xyz.end(), finite)) return not_held();
  const MeshArrays made{xyz.data(), mesh.vertex_count, mesh.abc, mesh.face_count};
  MeshCheck check;
  Vector<FacePair> meeting;
  for (double roundings = 2;; roundings *= 2) {
    if (Status s = check_mesh(made, executor, check, &meeting); !s.ok()) return s;
    if (check.valid != 0) break;
    const bool met = std::any_of(meeting.begin(), meeting.end(),
                                 [&](const FacePair& pair) { return meet(mesh, pair); });
    if (meeting.empty() || met) {
      Status s = demand_valid(mesh, executor);
      return s.ok() ? not_held() : s;
    }
    for (const auto& [i, k] : meeting) {
      const uint32_t *f = mesh.face(i), *g = mesh.face(k);
      const Apart faces(f, g, mesh);
      const double step = roundings * kRounding *
                          std::max(largest_coordinate(mesh, f), largest_coordinate(mesh, g));
      if (!(step < kMostOfEdge * faces.shortest_edge())) return not_held();
      const Double3 by = faces.direction() * step;
      const auto move = [&](uint32_t v, double sign) {
        double* p = at.data() + 3 * static_cast<size_t>(v);
        p[0] += sign * by.x;
        p[1] += sign * by.y;
        p[2] += sign * by.z;
      };
      for (int c = 0; c < 3; ++c) {
        if (!has_corner(g, f[c])) move(f[c], -1);
        if (!has_corner(f, g[c])) move(g[c], 1);
      }
    }
    round_all(at, xyz);
  }
  rounded.moved = count_moved(mesh, xyz);
  rounded.xyz = std::move(xyz);
  return {};
}

}  // namespace plc

#include "engine/start/mesh_import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "engine/base/constants.h"
#include "engine/exact/face_tree.h"
#include "engine/exact/self_intersection.h"
#include "engine/measure/measures.h"
#include "engine/measure/mesh_check.h"
#include "engine/measure/mesh_topology.h"
#include "engine/measure/nesting.h"
#include "engine/mesh/face_rings.h"
#include "engine/start/patch.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

Status refused(const std::string& message) {
  return {ErrorCode::kInvalidData, message};
}

// Says what is wrong with a mesh that check_mesh() calls invalid, the root of the trouble first.
class Complaint {
 public:
  Complaint(const MeshArrays& mesh, const double* as_given, const Executor& executor)
      : mesh_(mesh), as_given_(as_given), executor_(executor) {}

  std::string of(const MeshCheck& check, bool patch) const {
    if (mesh_.face_count == 0) return "no faces";
    if (const auto f = first_face_with_repeated_vertex()) {
      return "degenerate: a face repeats a vertex: " + face(*f);
    }
    if (check.border_edges != 0 && !patch) {
      return "open: " + std::to_string(check.border_edges) + " border edges, the first " +
             first_edge([](size_t uses, bool) { return uses == 1; });
    }
    if (check.non_manifold_edges != 0) {
      return "not manifold: " + std::to_string(check.non_manifold_edges) +
             " edges of more than two faces, the first " +
             first_edge([](size_t uses, bool) { return uses > 2; });
    }
    if (check.inconsistent_edges != 0) {
      return "inconsistently oriented: " + std::to_string(check.inconsistent_edges) +
             " edges that both faces run in the same direction, the first " +
             first_edge([](size_t uses, bool same) { return uses == 2 && same; });
    }
    if (check.non_manifold_vertices != 0) return pinched(check.non_manifold_vertices);
    if (check.degenerate_faces != 0) return flat(check.degenerate_faces);
    if (check.self_intersections != 0) return meeting(check);
    return inside_out();
  }

 private:
  // As the caller knows it.
  const double* point(size_t v) const { return as_given_ + 3 * v; }

  static std::string at(double x, double y, double z) {
    char line[96];
    std::snprintf(line, sizeof line, "at (%.6g, %.6g, %.6g)", x, y, z);
    return line;
  }

  std::string vertex(size_t v) const {
    const double* p = point(v);
    return std::to_string(v) + " " + at(p[0], p[1], p[2]);
  }

  std::string middle(size_t f) const {
    const double *a = point(mesh_.abc[3 * f]), *b = point(mesh_.abc[3 * f + 1]),
                 *c = point(mesh_.abc[3 * f + 2]);
    return at((a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3, (a[2] + b[2] + c[2]) / 3);
  }

  std::string face(size_t f) const {
    return "face " + std::to_string(f) + " with vertices " + std::to_string(mesh_.abc[3 * f]) +
           ", " + std::to_string(mesh_.abc[3 * f + 1]) + ", " +
           std::to_string(mesh_.abc[3 * f + 2]) + " " + middle(f);
  }

  std::optional<size_t> first_face_with_repeated_vertex() const {
    for (size_t f = 0; f < mesh_.face_count; ++f) {
      const uint32_t* v = mesh_.face(f);
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return f;
    }
    return {};
  }

  // The first edge for which wanted(faces, whether the first two run it in the same direction).
  template <typename Wanted>
  std::string first_edge(const Wanted& wanted) const {
    const EdgeTable edges(mesh_.abc, mesh_.face_count, mesh_.vertex_count, executor_);
    std::string found;
    edges.visit(
        0, mesh_.vertex_count,
        [&](uint32_t low, uint32_t high, const EdgeUse* first, const EdgeUse* last) {
          if (!found.empty()) return;
          const auto uses = static_cast<size_t>(last - first);
          const bool same = uses > 1 && mesh_.abc[first[0].corner] == mesh_.abc[first[1].corner];
          if (!wanted(uses, same)) return;
          const double *p = point(low), *q = point(high);
          found = "between vertices " + std::to_string(low) + " and " + std::to_string(high) + " " +
                  at((p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2);
        });
    return found;
  }

  std::string pinched(int64_t count) const {
    const FaceRings rings(mesh_.abc, mesh_.face_count, mesh_.vertex_count, executor_);
    size_t v = 0;
    while (v + 1 < mesh_.vertex_count && rings.length(v) == rings.faces(v)) ++v;
    return "not manifold: " + std::to_string(count) +
           " vertices where sheets touch, the first vertex " + vertex(v);
  }

  std::string flat(int64_t count) const {
    const Vector<uint32_t> proper = proper_faces(mesh_, executor_);
    size_t f = 0;
    while (f < proper.size() && proper[f] == f) ++f;
    return "degenerate: " + std::to_string(count) + " faces of zero area, the first " + face(f);
  }

  std::string meeting(const MeshCheck& check) const {
    const auto f = static_cast<size_t>(check.first_intersection[0]);
    return "self-intersecting: " +
           std::string(check.self_intersections >= kMaxIntersections ? "at least " : "") +
           std::to_string(check.self_intersections) + " pairs of faces, the first " +
           std::to_string(f) + " and " + std::to_string(check.first_intersection[1]) + " " +
           middle(f);
  }

  std::string inside_out() const {
    const MeshTopology topology =
        mesh_topology(mesh_.abc, mesh_.face_count, mesh_.vertex_count, executor_);
    const auto measures = component_measures(mesh_, topology, executor_);
    Vector<uint32_t> proper = proper_faces(mesh_, executor_);
    FaceTree tree;
    tree.build(mesh_.xyz, mesh_.abc, proper.data(), proper.size(), executor_);
    const auto sides = component_sides(mesh_, topology, measures, tree, executor_);
    size_t wrong = 0;
    size_t first = sides.size();
    for (size_t c = 0; c < sides.size(); ++c) {
      if (!sides[c].wrong) continue;
      ++wrong;
      first = std::min(first, c);
    }
    if (wrong == 0) return "not a valid surface";
    const size_t f = topology.components[first].first_face;
    return "wrongly oriented: " + std::to_string(wrong) + " of " + std::to_string(sides.size()) +
           " components, the first with face " + std::to_string(f) + " " + middle(f) +
           (sides[first].nested ? ", the wall of a cavity, whose faces must be turned inward"
                                : ", whose faces must be turned outward");
  }

  MeshArrays mesh_;
  const double* as_given_;
  const Executor& executor_;
};

bool valid_patch(const MeshCheck& check) {
  return check.manifold == 1 && check.oriented == 1 && check.degenerate_faces == 0 &&
         check.self_intersections == 0 && check.measures.faces > 0;
}

Status check_input(const MeshArrays& mesh, const double* as_given, const char* prefix, bool patch,
                   const Executor& executor) {
  MeshCheck check;
  if (Status s = check_mesh(mesh, executor, check); !s.ok()) {
    return {s.code(), "mesh: " + s.message()};
  }
  if (patch ? valid_patch(check) : check.valid == 1) return {};
  return refused(prefix + Complaint(mesh, as_given, executor).of(check, patch));
}

// Asked first: the search for intersections takes the square of the faces around one vertex.
// Counts and indices out of range are left to others.
Status check_valences(const MeshArrays& mesh) {
  if (mesh.vertex_count > uint64_t{1} << 32U) return {};
  if (mesh.face_count > kMaxFaces || mesh.abc == nullptr) return {};
  Vector<uint32_t> faces(mesh.vertex_count, 0);
  for (size_t c = 0; c < 3 * mesh.face_count; ++c) {
    if (mesh.abc[c] < faces.size()) ++faces[mesh.abc[c]];
  }
  const auto most = std::max_element(faces.begin(), faces.end());
  if (most == faces.end() || *most <= kMaxValence) return {};
  return refused("mesh: vertex " + std::to_string(most - faces.begin()) + " has " +
                 std::to_string(*most) + " faces, at most " + std::to_string(kMaxValence) +
                 " are possible");
}

Status check_range(const MeshArrays& mesh) {
  constexpr double kWidest = kReach;
  Vector<uint8_t> has_face(mesh.vertex_count, 0);
  for (const uint32_t* v = mesh.abc; v != mesh.face(mesh.face_count); ++v) has_face[*v] = 1;
  uint64_t used = 0;
  for (size_t v = 0; v < mesh.vertex_count; ++v) {
    if (has_face[v] == 0) continue;
    ++used;
    for (size_t k = 0; k < 3; ++k) {
      if (std::abs(mesh.point(v)[k]) <= kWidest) continue;
      char line[160];
      std::snprintf(line, sizeof line,
                    "mesh: vertex %zu: %c is %.6g in mesh space, expected -%.0f to %.0f", v,
                    "xyz"[k], mesh.point(v)[k], kWidest, kWidest);
      return refused(line);
    }
  }
  if (used <= kMaxMeshVertices) return {};
  return refused("mesh: too many vertices: " + std::to_string(used) + ", at most " +
                 std::to_string(kMaxMeshVertices) + " are possible");
}

}  // namespace

Status import_mesh(const MeshArrays& given, const Executor& executor, Mesh& mesh,
                   const double* as_given, const uint8_t* held) {
  if (as_given == nullptr) as_given = given.xyz;
  const bool patch = held != nullptr;
  if (Status s = check_valences(given); !s.ok()) return s;
  if (Status s = check_input(given, as_given, "mesh: ", patch, executor); !s.ok()) return s;
  const size_t vertices = given.vertex_count;
  if (Status s = check_range(given); !s.ok()) return s;
  // Rounding moves vertices a little: near sheets may meet then, and thin faces turn over.
  Vector<float> rounded(3 * vertices);
  Vector<double> back(3 * vertices);
  for (const uint32_t* v = given.abc; v != given.face(given.face_count); ++v) {
    for (size_t i = size_t{3} * *v; i < size_t{3} * *v + 3; ++i) {
      rounded[i] = static_cast<float>(given.xyz[i]);
      back[i] = static_cast<double>(rounded[i]);
    }
  }
  if (!std::equal(back.begin(), back.end(), given.xyz)) {
    const MeshArrays moved{back.data(), vertices, given.abc, given.face_count};
    if (Status s = check_input(moved, as_given, "mesh: after rounding to single precision: ", patch,
                               executor);
        !s.ok()) {
      return s;
    }
  }
  if (patch) return fill_patch(given, held, rounded.data(), executor, mesh);
  const FaceRings rings(given.abc, given.face_count, vertices, executor);
  fill_from_rings(mesh, rounded.data(), vertices, rings);
  return {};
}

}  // namespace plc

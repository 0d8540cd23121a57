#include "engine/measure/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include "engine/base/blocks.h"
#include "engine/base/mesh_arrays.h"
#include "engine/exact/face_tree.h"
#include "engine/exact/self_intersection.h"
#include "engine/exact/triangle_intersection.h"
#include "engine/measure/mesh_input.h"
#include "engine/measure/mesh_topology.h"
#include "engine/measure/nesting.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kBlock = 8192;
constexpr double kDegrees = 57.29577951308232;

// ---- what is counted and measured -----------------------------------------------------------

double distance(const double* p, const double* q) {
  const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
  return std::sqrt(x * x + y * y + z * z);
}

void measure_edges(const MeshArrays& mesh, const EdgeTable& edges, int64_t edge_count,
                   const Executor& executor, MeshCheck& check) {
  struct Part {
    double low = std::numeric_limits<double>::infinity(), high = 0, sum = 0;
  };
  Vector<Part> parts(block_count(mesh.vertex_count, kBlock));
  run_blocks(executor, mesh.vertex_count, kBlock, [&](size_t block, size_t begin, size_t end) {
    Part part;
    edges.visit(begin, end, [&](uint32_t a, uint32_t b, const EdgeUse*, const EdgeUse*) {
      const double length = distance(mesh.point(a), mesh.point(b));
      part.low = std::min(part.low, length);
      part.high = std::max(part.high, length);
      part.sum += length;
    });
    parts[block] = part;
  });
  Part all;
  for (const Part& part : parts) {
    all.low = std::min(all.low, part.low);
    all.high = std::max(all.high, part.high);
    all.sum += part.sum;
  }
  if (edge_count == 0) return;
  check.edge_min = all.low;
  check.edge_max = all.high;
  check.edge_mean = all.sum / static_cast<double>(edge_count);
}

// The angle at a, by its cotangent, which falls from infinity at 0 to -infinity at 180 degrees:
// cheaper than an arc tangent. From the edges at a itself: the differences of two corners that
// nearly coincide are exact then. 0 degrees where two corners do coincide.
double cotangent(const double* a, const double* b, const double* c) {
  const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
  const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
  const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
  const double dot = ux * vx + uy * vy + uz * vz;
  const double area = std::sqrt(x * x + y * y + z * z);
  if (area > 0) return dot / area;
  return dot < 0 ? -std::numeric_limits<double>::infinity()
                 : std::numeric_limits<double>::infinity();
}

void measure_angles(const MeshArrays& mesh, const Executor& executor, MeshCheck& check) {
  struct Part {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
  };
  Vector<Part> parts(block_count(mesh.face_count, kBlock));
  run_blocks(executor, mesh.face_count, kBlock, [&](size_t block, size_t begin, size_t end) {
    Part part;
    for (size_t f = begin; f < end; ++f) {
      const double* p[3];
      for (size_t k = 0; k < 3; ++k) p[k] = mesh.corner(3 * f + k);
      for (size_t k = 0; k < 3; ++k) {
        const double cot = cotangent(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
        part.low = std::min(part.low, cot);
        part.high = std::max(part.high, cot);
      }
    }
    parts[block] = part;
  });
  Part all;
  for (const Part& part : parts) {
    all.low = std::min(all.low, part.low);
    all.high = std::max(all.high, part.high);
  }
  if (mesh.face_count == 0) return;
  check.min_angle = std::atan2(1, all.high) * kDegrees;
  check.max_angle = std::atan2(1, all.low) * kDegrees;
}

// By a hash table: open addressing, at most half full. -0 equals 0.
int64_t count_duplicates(const MeshArrays& mesh) {
  constexpr uint32_t kEmpty = std::numeric_limits<uint32_t>::max();
  size_t capacity = 16;
  while (capacity < 2 * mesh.vertex_count) capacity *= 2;
  Vector<uint32_t> table(capacity, kEmpty);
  int64_t duplicates = 0;
  for (size_t v = 0; v < mesh.vertex_count; ++v) {
    const double* p = mesh.point(v);
    uint64_t hash = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double x = p[k] + 0.0;  // -0 becomes 0
      uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      hash = (hash ^ bits) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29U;
    }
    for (size_t slot = hash & (capacity - 1);; slot = (slot + 1) & (capacity - 1)) {
      if (table[slot] == kEmpty) {
        table[slot] = static_cast<uint32_t>(v);
        break;
      }
      const double* q = mesh.point(table[slot]);
      if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) {
        ++duplicates;
        break;
      }
    }
  }
  return duplicates;
}

void note_topology(const MeshTopology& t, MeshCheck& check) {
  const bool proper = t.repeated_vertex_faces == 0;
  check.closed = proper && t.border_edges == 0 && t.odd_edges == 0 ? 1 : 0;
  check.manifold = proper && t.non_manifold_edges == 0 && t.non_manifold_vertices == 0 ? 1 : 0;
  check.oriented = proper && t.non_manifold_edges == 0 && t.inconsistent_edges == 0 ? 1 : 0;
  check.border_edges = t.border_edges;
  check.non_manifold_edges = t.non_manifold_edges;
  check.non_manifold_vertices = t.non_manifold_vertices;
  check.inconsistent_edges = t.inconsistent_edges;
  check.isolated_vertices = t.isolated_vertices;
  check.valence_min = t.valence_min;
  check.valence_max = t.valence_max;
}

Vector<FacePair> find_intersections(const MeshArrays& mesh, const FaceTree& tree,
                                    const Executor& executor, MeshCheck& check) {
  Vector<FacePair> pairs =
      self_intersections(mesh, tree, executor, static_cast<size_t>(kMaxIntersections));
  check.self_intersections = static_cast<int64_t>(pairs.size());
  check.first_intersection[0] = pairs.empty() ? -1 : static_cast<int64_t>(pairs[0].first);
  check.first_intersection[1] = pairs.empty() ? -1 : static_cast<int64_t>(pairs[0].second);
  return pairs;
}

std::string count_of(int64_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace

Status check_mesh(const MeshArrays& mesh, const Executor& executor, MeshCheck& check,
                  Vector<FacePair>* intersections) {
  if (Status s = check_mesh_input(mesh, executor); !s.ok()) return s;

  MeshCheck c;
  const EdgeTable edges(mesh.abc, mesh.face_count, mesh.vertex_count, executor);
  const MeshTopology topology =
      mesh_topology(mesh.abc, mesh.face_count, mesh.vertex_count, edges, executor);
  note_topology(topology, c);
  const auto components = component_measures(mesh, topology, executor);
  c.measures = total_measures(mesh.vertex_count, topology, components);
  measure_edges(mesh, edges, topology.edges, executor, c);
  measure_angles(mesh, executor, c);
  c.duplicate_points = count_duplicates(mesh);

  const Vector<uint32_t> proper = proper_faces(mesh, executor);
  c.degenerate_faces = static_cast<int64_t>(mesh.face_count - proper.size());
  FaceTree tree;
  tree.build(mesh.xyz, mesh.abc, proper.data(), proper.size(), executor);
  Vector<FacePair> pairs = find_intersections(mesh, tree, executor, c);
  c.outward = -1;
  if (mesh.face_count != 0 && c.closed != 0 && c.oriented != 0) {
    for (const ComponentSide& side : component_sides(mesh, topology, components, tree, executor)) {
      c.wrongly_oriented_components += side.wrong ? 1 : 0;
    }
    c.outward = c.wrongly_oriented_components == 0 ? 1 : 0;
  }
  c.valid = c.closed == 1 && c.manifold == 1 && c.oriented == 1 && c.outward == 1 &&
                    c.degenerate_faces == 0 && c.self_intersections == 0
                ? 1
                : 0;
  check = c;
  if (intersections != nullptr) *intersections = std::move(pairs);
  return {};
}

std::string fault_of(const MeshCheck& c) {
  if (c.measures.faces == 0) return "it has no face";
  if (c.closed == 0) return count_of(c.border_edges, "edge has", "edges have") + " one face";
  if (c.manifold == 0) {
    return count_of(c.non_manifold_edges, "edge has", "edges have") + " more than two faces, " +
           count_of(c.non_manifold_vertices, "vertex", "vertices") + " more than one umbrella";
  }
  if (c.oriented == 0) {
    return "the faces of " + count_of(c.inconsistent_edges, "edge", "edges") + " run it one way";
  }
  if (c.degenerate_faces > 0) {
    return count_of(c.degenerate_faces, "face has", "faces have") + " no area";
  }
  if (c.self_intersections > 0) {
    return count_of(c.self_intersections, "pair", "pairs") + " of faces meet, the first " +
           std::to_string(c.first_intersection[0]) + " and " +
           std::to_string(c.first_intersection[1]);
  }
  return count_of(c.wrongly_oriented_components, "component faces", "components face") +
         " the wrong way";
}

Status demand_valid(const MeshArrays& mesh, const Executor& executor) {
  MeshCheck check;
  Status status = check_mesh(mesh, executor, check);
  if (!status.ok() || check.valid != 0) return status;
  return {ErrorCode::kInvalidData, "the mesh is not a valid surface: " + fault_of(check)};
}

}  // namespace plc

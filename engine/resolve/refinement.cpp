#include "engine/resolve/refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/exact/predicates.h"
#include "engine/guard/self_meeting.h"
#include "engine/transform/deletion.h"
#include "engine/transform/edge.h"
#include "engine/transform/inversion.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// Spreads the low 21 bits of x to every third bit.
uint64_t spread(uint64_t x) {
  x &= 0x1FFFFF;
  x = (x | x << 32) & 0x1F00000000FFFFULL;
  x = (x | x << 16) & 0x1F0000FF0000FFULL;
  x = (x | x << 8) & 0x100F00F00F00F00FULL;
  x = (x | x << 4) & 0x10C30C30C30C30C3ULL;
  return (x | x << 2) & 0x1249249249249249ULL;
}

uint64_t morton_key(Vec3 p, double delta) {
  const auto cell = [&](float x) {
    constexpr double kMiddle = 1 << 20;
    return static_cast<uint64_t>(std::clamp(std::floor(x / delta) + kMiddle, 0.0, 2 * kMiddle - 1));
  };
  return spread(cell(p.x)) | spread(cell(p.y)) << 1 | spread(cell(p.z)) << 2;
}

struct Keyed {
  uint64_t key;
  uint32_t id;
};

// A stable radix sort: those of equal keys keep their order.
void sort_by_key(Vector<Keyed>& keyed) {
  constexpr uint32_t kDigit = 11, kDigits = 6;
  constexpr size_t kValues = size_t{1} << kDigit;
  const auto digit = [](uint64_t key, uint32_t d) {
    return static_cast<size_t>(key >> (kDigit * d) & (kValues - 1));
  };
  Vector<std::array<uint32_t, kValues>> count(kDigits);
  for (const Keyed& k : keyed) {
    for (uint32_t d = 0; d < kDigits; ++d) ++count[d][digit(k.key, d)];
  }
  Vector<Keyed> sorted(keyed.size());
  for (uint32_t d = 0; d < kDigits; ++d) {
    if (keyed.empty() || count[d][digit(keyed[0].key, d)] == keyed.size()) continue;  // all alike
    uint32_t next = 0;
    for (uint32_t& c : count[d]) next += std::exchange(c, next);
    for (const Keyed& k : keyed) sorted[count[d][digit(k.key, d)]++] = k;
    keyed.swap(sorted);
  }
}

// Slot k of v stands for the face (v, slot k, slot k + 1). face_of[first[v] + k] is the vertex that
// was created in it.
struct FaceVertices {
  Vector<uint32_t> first;
  Vector<uint32_t> of_slot;
};

// The vertex of the face (u, w, x) where w is a neighbour of u and x follows it.
uint32_t vertex_of(const Mesh& mesh, const FaceVertices& faces, uint32_t u, uint32_t w) {
  uint32_t k = 0;
  while (mesh.neighbor(u, k) != w) ++k;
  return faces.of_slot[faces.first[u] + k];
}

constexpr size_t kVertices = 1024;  // per task

// visit(k, a, b) for the faces (v, a, b) of v whose smallest vertex it is: a is slot k.
template <typename Visit>
void visit_own_faces(const Mesh& mesh, uint32_t v, const Visit& visit) {
  const uint32_t d = mesh.valence(v);
  for (uint32_t k = 0; k < d; ++k) {
    const uint32_t a = mesh.neighbor(v, k);
    const uint32_t b = mesh.neighbor(v, k + 1 == d ? 0 : k + 1);
    if (a > v && b > v) visit(k, a, b);
  }
}

// In the order of faces by their smallest vertex, then around it.
FaceVertices create_face_vertices(Mesh& mesh, uint32_t old_slots, const Executor& executor) {
  const size_t blocks = block_count(old_slots, kVertices);
  Vector<uint32_t> block_first(blocks);  // its first vertex in a face
  FaceVertices faces;
  faces.first.resize(old_slots);
  run_blocks(executor, old_slots, kVertices, [&](size_t block, size_t begin, size_t end) {
    uint32_t count = 0;
    for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
      visit_own_faces(mesh, v, [&](uint32_t, uint32_t, uint32_t) { ++count; });
    }
    block_first[block] = count;
  });
  uint32_t slots = 0, count = 0;
  for (uint32_t v = 0; v < old_slots; ++v) {
    faces.first[v] = slots;
    slots += mesh.valence(v);
  }
  for (uint32_t& first : block_first) count += std::exchange(first, count);
  faces.of_slot.resize(slots);
  const uint32_t first_created = mesh.create_many(
      count, [](uint32_t) { return 6U; }, executor);
  run_blocks(executor, old_slots, kVertices, [&](size_t block, size_t begin, size_t end) {
    uint32_t c = first_created + block_first[block];
    const auto set = [&](uint32_t x, uint32_t k) { faces.of_slot[faces.first[x] + k] = c; };
    const auto slot_of = [&](uint32_t x, uint32_t y) {
      uint32_t k = 0;
      while (mesh.neighbor(x, k) != y) ++k;
      return k;
    };
    for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
      visit_own_faces(mesh, v, [&](uint32_t k, uint32_t a, uint32_t b) {
        mesh.place(c, (mesh.at(v) + mesh.at(a) + mesh.at(b)) * (1.0F / 3.0F));
        mesh.velocity.set(
            c, (mesh.velocity.at(v) + mesh.velocity.at(a) + mesh.velocity.at(b)) * (1.0F / 3.0F));
        set(v, k);
        set(a, slot_of(a, b));
        set(b, slot_of(b, v));
        ++c;
      });
    }
  });
  return faces;
}

using Corners = std::array<uint32_t, 3>;

// The faces that meet others, and those that have no area.
Vector<Corners> wrong_faces(const Mesh& mesh, const Executor& executor) {
  constexpr size_t kBlock = 4096;
  Vector<Corners> wrong = meeting_faces(mesh, executor);
  std::vector<Vector<Corners>> flat(block_count(mesh.slots(), kBlock));
  const auto point = [&](uint32_t v) { return Point3{mesh.at(v).x, mesh.at(v).y, mesh.at(v).z}; };
  run_blocks(executor, mesh.slots(), kBlock, [&](size_t block, size_t begin, size_t end) {
    for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
      if (mesh.is_absent(v)) continue;
      visit_own_faces(mesh, v, [&](uint32_t, uint32_t a, uint32_t b) {
        if (mesh.is_absent(a) || mesh.is_absent(b)) return;
        if (collinear(point(v), point(a), point(b))) flat[block].push_back({v, a, b});
      });
    }
  });
  for (const auto& some : flat) wrong.insert(wrong.end(), some.begin(), some.end());
  return wrong;
}

// Undoes an inversion: where c and d were created in faces, the edge between them becomes the old
// edge that these faces had in common. False where there is no such edge.
bool give_back(Mesh& mesh, const Vector<uint8_t>& of_face, uint32_t c, uint32_t d) {
  if (of_face[c] == 0 || of_face[d] == 0 || !mesh.adjacent(c, d)) return false;
  invert_edge(mesh, edge_between(mesh, c, d));
  return true;
}

// Deletes c, which was created in a face, so that the face is there again.
void give_back_face(Mesh& mesh, const Vector<uint8_t>& of_face, uint32_t c) {
  for (uint32_t k = 0; k < mesh.valence(c);) {
    if (!give_back(mesh, of_face, c, mesh.neighbor(c, k))) ++k;
  }
  const uint32_t corner = mesh.neighbor(c, 0);
  delete_edge(mesh, edge_between(mesh, corner, c), mesh.at(corner));
}

// Undoes the refinement where the surface meets itself now, as it did not before. Each round undoes
// the inversions next to all wrong faces. Where none is left to undo, rounding has put a vertex on
// the far side of a part of the surface that is nearer than a float can tell, and the face that it
// was created in is restored.
// of_face: by id, whether a vertex was created in a face.
void undo_where_meeting(Mesh& mesh, const Vector<uint8_t>& of_face, const Executor& executor) {
  for (;;) {
    const auto wrong = wrong_faces(mesh, executor);
    if (wrong.empty()) return;
    bool undone = false;
    for (const auto& [a, b, c] : wrong) {
      for (const auto& [x, y] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        undone = give_back(mesh, of_face, x, y) || undone;
      }
    }
    if (undone) continue;
    for (const Corners& face : wrong) {
      for (const uint32_t v : face) {
        if (of_face[v] == 0 || !mesh.alive(v)) continue;
        give_back_face(mesh, of_face, v);
        undone = true;
      }
    }
    if (!undone) return;
  }
}

// What has just been refined gets its last ids. Vertices below old_slots were there before.
void finish(Mesh& mesh, uint32_t old_slots, const Executor& executor, bool renumbering) {
  // Searches for faces that meet are fast where ids follow space.
  const auto order = renumbering ? morton_order(mesh, executor) : living_order(mesh);
  Vector<uint8_t> of_face(order.size());
  for (size_t i = 0; i < order.size(); ++i) of_face[i] = order[i] >= old_slots ? 1 : 0;
  mesh.renumber(order, executor);
  undo_where_meeting(mesh, of_face, executor);
  if (mesh.vertex_count() != mesh.slots()) {
    mesh.renumber(renumbering ? morton_order(mesh, executor) : living_order(mesh), executor);
  }
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.wake(v);
}

}  // namespace

Vector<uint32_t> morton_order(const Vector<Vec3>& points, double cell, const Executor& executor) {
  constexpr size_t kBlock = 4096;
  Vector<Keyed> keyed(points.size());
  run_blocks(executor, points.size(), kBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      keyed[i] = {morton_key(points[i], cell), static_cast<uint32_t>(i)};
    }
  });
  sort_by_key(keyed);
  Vector<uint32_t> order(points.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].id;
  return order;
}

Vector<uint32_t> morton_order(const Mesh& mesh, const Executor& executor) {
  const Vector<uint32_t> living = living_order(mesh);
  Vector<Vec3> points(living.size());
  for (size_t i = 0; i < living.size(); ++i) points[i] = mesh.at(living[i]);
  Vector<uint32_t> order = morton_order(points, mesh.delta, executor);
  for (uint32_t& v : order) v = living[v];
  return order;
}

Vector<uint32_t> living_order(const Mesh& mesh) {
  Vector<uint32_t> order;
  order.reserve(mesh.vertex_count());
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (mesh.alive(v)) order.push_back(v);
  }
  return order;
}

void refine(Mesh& mesh, const Executor& executor, bool renumbering) {
  // Old vertices get the low ids, without gaps, so that ids tell new and old ones apart.
  if (!mesh.in_order())
    mesh.renumber(renumbering ? morton_order(mesh, executor) : living_order(mesh), executor);
  const uint32_t old_slots = mesh.slots();
  // A vertex for each face: two per old one but for 2 (1 - genus) of each component.
  mesh.reserve(uint64_t{old_slots} * 3);
  const FaceVertices faces = create_face_vertices(mesh, old_slots, executor);
  // The vertex of a face (v, a, b) gets its three corners and the vertices of the faces across the
  // edges; an old vertex gets the vertices of its faces.
  run_blocks(executor, old_slots, kVertices, [&](size_t, size_t begin, size_t end) {
    for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
      visit_own_faces(mesh, v, [&](uint32_t k, uint32_t a, uint32_t b) {
        Neighbors ring;
        // Across v-a lies the face (a, v, x): v follows a in it, seen from a.
        for (const auto& [x, y] : {std::pair{v, a}, std::pair{a, b}, std::pair{b, v}}) {
          ring.push_back(x);
          ring.push_back(vertex_of(mesh, faces, y, x));
        }
        mesh.exchange_ring(faces.of_slot[faces.first[v] + k], ring);
      });
    }
  });
  run_blocks(executor, old_slots, kVertices, [&](size_t, size_t begin, size_t end) {
    for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
      Neighbors ring;
      for (uint32_t k = 0; k < mesh.valence(v); ++k)
        ring.push_back(faces.of_slot[faces.first[v] + k]);
      mesh.exchange_ring(v, ring);
    }
  });
  mesh.delta /= kRefinement;
  finish(mesh, old_slots, executor, renumbering);
}

void refine_marked(Mesh& mesh, const Vector<uint8_t>& marked, const Executor& executor) {
  assert(mesh.vertex_count() == mesh.slots() && marked.size() == mesh.slots());
  const uint32_t old_slots = mesh.slots();
  const Vector<uint32_t> abc = mesh.faces();
  Vector<std::array<uint32_t, 2>> edges;
  for (size_t f = 0; f < abc.size(); f += 3) {
    const uint32_t* v = &abc[f];
    if (marked[v[0]] == 0 || marked[v[1]] == 0 || marked[v[2]] == 0) continue;
    const uint32_t c =
        mesh.create((mesh.at(v[0]) + mesh.at(v[1]) + mesh.at(v[2])) * (1.0F / 3.0F), {});
    Neighbors ring;
    for (size_t k = 0; k < 3; ++k) {
      ring.push_back(v[k]);
      const uint32_t next = v[(k + 1) % 3];
      mesh.insert_after(v[k], next, c);
      edges.push_back({std::min(v[k], next), std::max(v[k], next)});
    }
    mesh.set_ring(c, ring);
  }
  // Those with two such faces are there twice.
  std::sort(edges.begin(), edges.end());
  for (size_t i = 1; i < edges.size(); ++i) {
    if (edges[i] == edges[i - 1]) invert_edge(mesh, edge_between(mesh, edges[i][0], edges[i][1]));
  }
  finish(mesh, old_slots, executor, true);
}

// The half-way marks between 0, 1, 2 ... refinements that lie below the ratio; a quotient of
// logarithms would differ between C libraries.
int refinements_between(double from, double to) {
  int steps = 0;
  double mark = std::sqrt(kRefinement);
  while (from / to > mark) {
    ++steps;
    mark *= kRefinement;
  }
  return steps;
}

}  // namespace plc

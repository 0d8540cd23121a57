#include "engine/measure/mesh_topology.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/base/blocks.h"
#include "engine/base/disjoint_sets.h"
#include "engine/base/marks.h"
#include "engine/measure/vertex_corners.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kVertexBlock = 4096;

// Joins the corners of the two faces of an edge at each of its ends.
void join_umbrellas(const uint32_t* abc, uint32_t c, uint32_t d, DisjointSets& corners) {
  const uint32_t c_end = next_corner(c), d_end = next_corner(d);
  const bool opposite = abc[c] != abc[d];
  corners.join(c, opposite ? d_end : d);
  corners.join(c_end, opposite ? d : d_end);
}

void number_components(size_t face_count, DisjointSets& faces, MeshTopology& m) {
  m.component.resize(face_count);
  for (size_t f = 0; f < face_count; ++f) {
    const uint32_t root = faces.find(static_cast<uint32_t>(f));
    if (root == f) {
      m.component[f] = static_cast<uint32_t>(m.components.size());
      m.components.emplace_back().first_face = static_cast<uint32_t>(f);
    } else {
      m.component[f] = m.component[root];
    }
    ++m.components[m.component[f]].faces;
  }
}

void count_vertices(const uint32_t* abc, size_t face_count, size_t vertex_count,
                    DisjointSets& corners, MeshTopology& m) {
  constexpr uint8_t kUsed = 1, kSeen = 2, kSeveral = 4;
  Vector<uint8_t> state(vertex_count, 0);
  for (size_t f = 0; f < face_count; ++f) {
    const bool repeated = has_repeated_vertex(abc + 3 * f);
    ComponentTopology& component = m.components[m.component[f]];
    if (repeated) {
      ++m.repeated_vertex_faces;
      component.closed_oriented = false;
    }
    for (size_t c = 3 * f; c < 3 * f + 3; ++c) {
      uint8_t& s = state[abc[c]];
      s |= kUsed;
      if (repeated || corners.find(static_cast<uint32_t>(c)) != c) continue;
      ++component.vertices;
      s = static_cast<uint8_t>(s | ((s & kSeen) != 0 ? kSeveral : kSeen));
    }
  }
  for (const uint8_t s : state) {
    m.isolated_vertices += (s & kUsed) == 0 ? 1 : 0;
    m.non_manifold_vertices += (s & kSeveral) != 0 ? 1 : 0;
  }
}

void count_valences(const Vector<uint32_t>& valence, MeshTopology& m) {
  uint32_t low = std::numeric_limits<uint32_t>::max(), high = 0;
  for (const uint32_t v : valence) {
    if (v != 0) low = std::min(low, v);
    high = std::max(high, v);
  }
  m.valence_min = high == 0 ? 0 : static_cast<int32_t>(low);
  m.valence_max = static_cast<int32_t>(high);
}

}  // namespace

EdgeTable::EdgeTable(const uint32_t* abc, size_t face_count, size_t vertex_count,
                     const Executor& executor) {
  // A counting sort by the smaller vertex, then each vertex's few uses by the larger one.
  begin_.resize(vertex_count + 1);
  const auto for_uses = [&](const auto& visit) {
    for (size_t f = 0; f < face_count; ++f) {
      const uint32_t* t = abc + 3 * f;
      if (has_repeated_vertex(t)) continue;
      for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t a = t[k], b = t[k == 2 ? 0 : k + 1];
        visit(std::min(a, b), EdgeUse{std::max(a, b), static_cast<uint32_t>(3 * f) + k});
      }
    }
  };
  for_uses([&](uint32_t low, const EdgeUse&) { ++begin_[low]; });
  uint32_t total = 0;
  for (uint32_t& b : begin_) {
    total += b;
    b = total;
  }
  uses_.resize_uninitialized(total);
  for_uses([&](uint32_t low, const EdgeUse& use) { uses_[--begin_[low]] = use; });
  run_blocks(executor, vertex_count, kVertexBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      std::sort(uses_.data() + begin_[v], uses_.data() + begin_[v + 1],
                [](const EdgeUse& a, const EdgeUse& b) {
                  return a.high != b.high ? a.high < b.high : a.corner < b.corner;
                });
    }
  });
}

MeshTopology mesh_topology(const uint32_t* abc, size_t face_count, size_t vertex_count,
                           const EdgeTable& edges, const Executor& executor) {
  MeshTopology m;
  DisjointSets faces(face_count), corners(3 * face_count);
  Vector<uint32_t> valence(vertex_count, 0);
  run_blocks(executor, vertex_count, kVertexBlock, [&](size_t, size_t first, size_t last) {
    edges.visit(first, last,
                [&](uint32_t low, uint32_t high, const EdgeUse* use, const EdgeUse* end) {
                  add_to_mark(valence[low], 1);
                  add_to_mark(valence[high], 1);
                  for (const EdgeUse* u = use + 1; u != end; ++u) {
                    faces.join(use->corner / 3, u->corner / 3);
                  }
                  if (end - use == 2) join_umbrellas(abc, use[0].corner, use[1].corner, corners);
                });
  });
  number_components(face_count, faces, m);
  edges.visit(0, vertex_count, [&](uint32_t low, uint32_t, const EdgeUse* use, const EdgeUse* end) {
    ComponentTopology& component = m.components[m.component[use->corner / 3]];
    const auto count = end - use;
    const bool same_direction = count == 2 && abc[use[0].corner] == abc[use[1].corner];
    ++m.edges;
    ++component.edges;
    m.border_edges += count == 1 ? 1 : 0;
    m.non_manifold_edges += count > 2 ? 1 : 0;
    m.odd_edges += count > 2 && count % 2 == 1 ? 1 : 0;
    m.inconsistent_edges += same_direction ? 1 : 0;
    if (count != 2 || same_direction) component.closed_oriented = false;
    const auto upwards =
        std::count_if(use, end, [&](const EdgeUse& u) { return abc[u.corner] == low; });
    if (2 * upwards != count) component.encloses = false;
  });
  count_vertices(abc, face_count, vertex_count, corners, m);
  count_valences(valence, m);
  m.euler = static_cast<int64_t>(vertex_count) - m.isolated_vertices - m.edges +
            static_cast<int64_t>(face_count) - m.repeated_vertex_faces;
  return m;
}

MeshTopology mesh_topology(const uint32_t* abc, size_t face_count, size_t vertex_count,
                           const Executor& executor) {
  return mesh_topology(abc, face_count, vertex_count,
                       EdgeTable(abc, face_count, vertex_count, executor), executor);
}

}  // namespace plc

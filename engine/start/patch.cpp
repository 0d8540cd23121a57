#include "engine/start/patch.h"

#include <algorithm>
#include <string>

#include "engine/measure/mesh_topology.h"
#include "engine/mesh/face_rings.h"
#include "engine/resolve/refinement.h"

namespace plc {

namespace {

constexpr uint32_t kNone = ~0U;
// Neighbours on the border that a vertex of a ring around a long border has.
constexpr size_t kShare = 64;

// By vertex: the next one of the border, so that the hole lies to the left; kNone within the mesh.
Vector<uint32_t> borders_of(size_t vertex_count, const Vector<uint32_t>& abc,
                            const Executor& executor) {
  Vector<uint32_t> next(vertex_count, kNone);
  const EdgeTable edges(abc.data(), abc.size() / 3, vertex_count, executor);
  edges.visit(0, vertex_count,
              [&](uint32_t low, uint32_t high, const EdgeUse* first, const EdgeUse* last) {
                if (last - first != 1) return;
                const uint32_t from = abc[first->corner];
                next[from == low ? high : low] = from;
              });
  return next;
}

// Fills the hole to the left of a closed walk; count: of all vertices so far.
void fill_hole(Vector<uint32_t> walk, size_t& count, Vector<uint32_t>& abc) {
  while (walk.size() > kMostClosing) {
    const size_t shares = walk.size() / kShare;
    Vector<uint32_t> ring;
    for (size_t i = 0; i < shares; ++i) ring.push_back(static_cast<uint32_t>(count + i));
    for (size_t i = 0; i < walk.size(); ++i) {
      const size_t share = std::min(i / kShare, shares - 1);
      const size_t after = i + 1 == walk.size() ? 0 : std::min((i + 1) / kShare, shares - 1);
      const uint32_t end = walk[(i + 1) % walk.size()];
      abc.insert(abc.end(), {walk[i], end, ring[share]});
      if (after != share) abc.insert(abc.end(), {ring[share], end, ring[after]});
    }
    count += shares;
    walk = std::move(ring);
  }
  for (size_t i = 0; i < walk.size(); ++i) {
    abc.insert(abc.end(), {walk[i], walk[(i + 1) % walk.size()], static_cast<uint32_t>(count)});
  }
  ++count;
}

// What is held has to be two edges wide at borders: forces and guards look at the faces around the
// neighbours of what moves.
Status check_held(const MeshArrays& given, const uint8_t* held, const Vector<uint32_t>& border) {
  for (size_t f = 0; f < given.face_count; ++f) {
    const uint32_t* v = given.face(f);
    for (int k = 0; k < 3; ++k) {
      if (border[v[k]] == kNone) continue;
      for (int i = 0; i < 3; ++i) {
        if (held[v[i]] == kHeld) continue;
        return {ErrorCode::kInvalidData, "mesh: vertex " + std::to_string(v[i]) +
                                             " is not held, but next to the border at vertex " +
                                             std::to_string(v[k])};
      }
    }
  }
  return {};
}

}  // namespace

size_t close_borders(size_t vertex_count, Vector<uint32_t>& abc, const Executor& executor) {
  Vector<uint32_t> next = borders_of(vertex_count, abc, executor);
  size_t count = vertex_count;
  for (size_t v = 0; v < vertex_count; ++v) {
    if (next[v] == kNone) continue;
    Vector<uint32_t> walk;
    for (auto at = static_cast<uint32_t>(v); next[at] != kNone;) {
      walk.push_back(at);
      const uint32_t to = next[at];
      next[at] = kNone;
      at = to;
    }
    fill_hole(std::move(walk), count, abc);
  }
  return count - vertex_count;
}

Status fill_patch(const MeshArrays& given, const uint8_t* held, const float* rounded,
                  const Executor& executor, Mesh& mesh) {
  const size_t vertices = given.vertex_count;
  Vector<uint32_t> abc(given.abc, given.face(given.face_count));
  if (Status s = check_held(given, held, borders_of(vertices, abc, executor)); !s.ok()) return s;
  const size_t absent = close_borders(vertices, abc, executor);
  const FaceRings rings(abc.data(), abc.size() / 3, vertices + absent, executor);
  Vector<float> xyz(rounded, rounded + 3 * vertices);
  Vector<uint32_t> ids;
  Vector<uint8_t> coarse;
  for (size_t v = 0; v < vertices + absent; ++v) {
    if (rings.faces(v) == 0) continue;
    const auto id = static_cast<uint32_t>(v + 1);
    ids.push_back(v >= vertices ? Mesh::kAbsent : held[v] == kHeld ? id : 0);
    coarse.push_back(v < vertices && held[v] == kCoarse ? 1 : 0);
  }
  // Where a neighbour is: nobody looks, but coordinates have a range.
  for (size_t v = vertices; v < vertices + absent; ++v) {
    const size_t beside = rings.ring(v)[0];
    for (size_t a = 0; a < 3; ++a) xyz.push_back(xyz[3 * beside + a]);
  }
  if (ids.size() > kMaxMeshVertices) return too_many_vertices();
  fill_from_rings(mesh, xyz.data(), vertices + absent, rings);
  mesh.hold(ids);
  if (std::find(coarse.begin(), coarse.end(), 1) != coarse.end()) {
    refine_marked(mesh, coarse, executor);
  }
  return {};
}

}  // namespace plc

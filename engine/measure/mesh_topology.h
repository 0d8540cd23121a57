// What the indices of any triangle mesh say: edges, umbrellas, components. Positions play no part.
#pragma once
#include <cstddef>
#include <cstdint>

#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// A face's edge. Corner c = 3 f + k begins it: it runs from abc[c] to the face's next corner.
struct EdgeUse {
  uint32_t high;    // the larger of its two vertices
  uint32_t corner;  // c
};

// The uses of edges by their smaller vertex, then the larger, then the corner. Faces with a
// repeated vertex are left out. 12 bytes per use, 4 per vertex.
class EdgeTable {
 public:
  EdgeTable(const uint32_t* abc, size_t face_count, size_t vertex_count, const Executor& executor);

  // edge(low, high, first use, end of uses) for every edge whose smaller vertex is in [begin, end).
  template <typename Visit>
  void visit(size_t begin, size_t end, const Visit& edge) const {
    for (size_t v = begin; v < end; ++v) {
      const EdgeUse* last = uses_.data() + begin_[v + 1];
      for (const EdgeUse* first = uses_.data() + begin_[v]; first != last;) {
        const EdgeUse* next = first + 1;
        while (next != last && next->high == first->high) ++next;
        edge(static_cast<uint32_t>(v), first->high, first, next);
        first = next;
      }
    }
  }

 private:
  Buffer<uint32_t> begin_;  // per vertex: its first use as the smaller vertex
  Buffer<EdgeUse> uses_;
};

// A set of faces connected over edges. A face with a repeated vertex is a component of its own.
struct ComponentTopology {
  uint32_t first_face = 0;
  int64_t faces = 0;
  int64_t edges = 0;
  int64_t vertices = 0;  // umbrellas: a vertex where the component touches itself counts again
  bool closed_oriented = true;  // every edge has two faces that run it in opposite directions
  bool encloses = true;  // every edge is run as often one way as the other: a volume is defined
  int64_t euler() const { return vertices - edges + faces; }
  // Of the closed orientable surface; -1 for any other.
  int64_t genus() const { return closed_oriented ? (2 - euler()) / 2 : -1; }
};

struct MeshTopology {
  int64_t edges = 0;
  int64_t border_edges = 0;        // of one face
  int64_t odd_edges = 0;           // of 3, 5, ... faces
  int64_t non_manifold_edges = 0;  // of more than two faces
  int64_t inconsistent_edges = 0;  // of two faces that run it in the same direction
  int64_t repeated_vertex_faces = 0;
  int64_t isolated_vertices = 0;      // of no face
  int64_t non_manifold_vertices = 0;  // of more than one umbrella (faces connected around it)
  int32_t valence_min = 0;            // edges at a vertex that has any
  int32_t valence_max = 0;
  int64_t euler = 0;  // V - E + F, without isolated vertices and faces with a repeated vertex
  Vector<uint32_t> component;  // of each face, numbered by their first faces
  Vector<ComponentTopology> components;
};

// Three indices per face, each below vertex_count; at most kMaxFaces faces.
inline constexpr int64_t kMaxFaces = 1431655764;
MeshTopology mesh_topology(const uint32_t* abc, size_t face_count, size_t vertex_count,
                           const EdgeTable& edges, const Executor& executor);
// The same where the table of edges is wanted for nothing else.
MeshTopology mesh_topology(const uint32_t* abc, size_t face_count, size_t vertex_count,
                           const Executor& executor);

}  // namespace plc

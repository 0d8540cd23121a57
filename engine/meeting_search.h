// The faces of the engine's mesh that meet since some vertices moved; for asking in every step.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/box_lanes.h"
#include "engine/self_intersection.h"
#include "kernels/ring.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// Faces that share a vertex are looked at vertex by vertex (vertex_star.h), and one by one only
// where that leaves a doubt. For all others there is a tree of boxes, 8 children to a node, over
// the faces in the order of ids: vertices are numbered along a space-filling curve, so nothing has
// to be sorted and boxes are tight; with any other numbering results are the same and searches
// slow. Only the faces around marked vertices and their neighbours are listed.
//
//   buffer    bytes per listed face   what
//   vertices  2                       marked vertices and their neighbours
//   faces     12                      three ids, the first listed vertex in front, in its order
//   begin     2                       per listed vertex: its first face
//   boxes     27.4                    per node: boxes of 8 faces or nodes, lane by lane
//   marked    0.15                    per node: in which of the 8 a face is marked
//
// and a byte per vertex that tells the listed ones. Buffers are kept from call to call. Not
// thread-safe: one search at a time.
class MeetingSearch {
 public:
  // rings and positions of ids below `slots`; deleted vertices (valence 0) are skipped. marked: per
  // id, not 0 where the vertex may have part in a meeting; NULL: all may. Returns the pairs (f, g),
  // f < g, of faces that meet elsewhere than in what they share (triangle_intersection.h: exact,
  // faces of zero area left out) and both have a marked vertex - one of them, where they share a
  // vertex -, sorted, until the next call. The same for any executor. The mesh is closed and a
  // manifold.
  const Vector<FacePair>& find(const RingView& rings, uint32_t slots, const Packed* positions,
                               const uint8_t* marked, const Executor& executor);

  // The faces of the last call; none where nothing was marked.
  size_t face_count() const { return faces_.size() / 3; }
  const uint32_t* face(uint32_t f) const { return faces_.data() + 3 * static_cast<size_t>(f); }

 private:
  static constexpr uint32_t kLanes = BoxLanes::kLanes;
  // Level 0: nodes of faces; level k: nodes of nodes of level k - 1.
  struct Level {
    Buffer<BoxLanes> boxes;
    Buffer<uint8_t> marked;  // a bit per child: some face in it is
  };
  struct Mesh {
    RingView rings;
    uint32_t slots;
    const Packed* positions;
    const uint8_t* marks;
    bool marked(uint32_t v) const { return marks == nullptr || marks[v] != 0; }
    bool marked(const uint32_t* abc) const {
      return marked(abc[0]) || marked(abc[1]) || marked(abc[2]);
    }
  };
  using Pairs = Vector<FacePair>;

  static Box3 all_lanes(const BoxLanes& boxes);

  void list_vertices(const Mesh& mesh);
  void list_faces(const Mesh& mesh, const Executor& executor);
  void build_leaves(const Mesh& mesh, const Executor& executor);
  void build_level(size_t level, const Executor& executor);
  void search_star(const Mesh& mesh, uint32_t v, Pairs& pairs) const;
  void search_leaf(const Mesh& mesh, uint32_t leaf, Pairs& pairs) const;
  void search_leaves(const Mesh& mesh, uint32_t leaf, const Box3& box, uint32_t other,
                     Pairs& pairs) const;
  uint32_t index_of(uint32_t a, uint32_t b, uint32_t c) const;

  Buffer<uint32_t> vertices_;  // ascending
  Buffer<uint8_t> listed_;     // per vertex
  Buffer<uint32_t> faces_;
  Buffer<uint32_t> begin_;  // per listed vertex, and one more
  Buffer<uint32_t> block_faces_;
  Vector<Level> levels_;
  size_t level_count_ = 0;
  Vector<Pairs> found_;
  Pairs pairs_;
};

}  // namespace plc

// The faces of the engine's mesh that meet since some vertices moved; for asking in every step.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/base/four.h"
#include "engine/base/spares.h"
#include "engine/exact/self_intersection.h"
#include "engine/guard/box_tree.h"
#include "engine/mesh/mesh.h"
#include "kernels/ring.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// Faces that share a vertex are looked at vertex by vertex (vertex_star.h), and one by one only
// where that leaves a doubt. For all others there is a tree of boxes (box_tree.h) over the faces in
// the order of ids: vertices are numbered along a space-filling curve; with any other numbering
// results are the same and searches slow. Only the faces around marked vertices are listed.
//
//   buffer    bytes per listed face   what
//   faces     12                      three ids, that which they are listed with in front
//   tree      27.6                    box_tree.h
//   vertices  4 per vertex            marked vertices and their neighbours
//   begin     4 per vertex            of those: the first face
//
// and a byte per vertex of the mesh that tells the listed ones. Buffers are kept from call to call.
// Not thread-safe: one search at a time.
class MeetingSearch {
 public:
  // rings and positions of ids below `slots`; deleted vertices (valence 0) are skipped. marked: per
  // id, not 0 where the vertex may have part in a meeting; NULL: all may. before: where the
  // vertices were when no two faces met; NULL: all have moved. Returns the pairs (f, g), f < g, of
  // faces that meet elsewhere than in what they share (triangle_intersection.h: exact, faces of
  // zero area left out), both have a marked vertex, and one has a vertex that has moved; sorted,
  // until the next call. The same for any executor. The mesh is closed and a manifold. held: of
  // a patch (mesh.h); faces of absent vertices meet nothing; NULL: there are none. strays: per id,
  // not 0 where it does not tell where the vertex is; NULL: nowhere. They are listed behind a
  // neighbour: a face far from those beside it makes the boxes above it large, and a few such in a
  // hundred make searches several times as slow. Results are the same.
  const Vector<FacePair>& find(const RingView& rings, uint32_t slots, const Float4* positions,
                               const uint8_t* marked, const Executor& executor,
                               const Float4* before = nullptr, const uint32_t* held = nullptr,
                               const uint8_t* strays = nullptr);

  // After find(), when a few vertices have moved since: the pairs that find() would list, of which
  // one face has one of these vertices. changed: their ids, some twice; no other has moved since
  // the last call of either. What find() was given must still be there. Takes the time of their
  // faces, and of a byte per eight listed ones.
  const Vector<FacePair>& find_changed(const uint32_t* changed, size_t count,
                                       const Executor& executor);

  // The faces of the last find(); none where nothing was marked.
  size_t face_count() const { return face_count_; }
  const uint32_t* face(uint32_t f) const { return faces_.data() + 3 * static_cast<size_t>(f); }

 private:
  struct Mesh {
    RingView rings;
    uint32_t slots = 0;
    const Float4* positions = nullptr;
    const uint8_t* marks = nullptr;
    const Float4* before = nullptr;
    const uint8_t* changed =
        nullptr;  // a byte per vertex, not 0 where it has moved; or NULL: see before
    const uint32_t* held = nullptr;
    const uint8_t* strays = nullptr;
    bool absent(uint32_t v) const { return held != nullptr && held[v] == plc::Mesh::kAbsent; }
    bool marked(uint32_t v) const { return marks == nullptr || marks[v] != 0; }
    bool marked(const uint32_t* abc) const {
      return marked(abc[0]) || marked(abc[1]) || marked(abc[2]);
    }
    // Whether a face of a marked x and of y is not listed with y.
    bool precedes(uint32_t x, uint32_t y) const {
      if (!marked(y)) return true;
      return stray(x) == stray(y) ? x < y : stray(y);
    }
    bool stray(uint32_t v) const { return strays != nullptr && strays[v] != 0; }
    // A face of the surface with a marked corner.
    bool listed(const uint32_t* abc) const {
      return marked(abc) && !absent(abc[0]) && !absent(abc[1]) && !absent(abc[2]);
    }
    bool moved(uint32_t v) const {
      if (changed != nullptr) return changed[v] != 0;
      return before == nullptr || !same_four(load_four(positions[v]), load_four(before[v]));
    }
    bool moved(const uint32_t* abc) const {
      return moved(abc[0]) || moved(abc[1]) || moved(abc[2]);
    }
  };
  using Pairs = Vector<FacePair>;

  // Where a vertex is listed: vertices lie in the order of these numbers.
  static uint64_t where_listed(const Mesh& mesh, uint32_t v);

  void list_vertices(const Mesh& mesh);
  void sort_vertices(uint32_t slots);
  void place_strays(const Mesh& mesh);
  void list_faces(const Mesh& mesh, const Executor& executor);
  void build_tree(const Mesh& mesh, const Executor& executor);
  void update_tree(const Mesh& mesh, const uint32_t* changed, size_t count);
  void list_stars(const Mesh& mesh, const uint32_t* changed, size_t count);
  void search_star(const Mesh& mesh, uint32_t v, Pairs& pairs) const;
  void search(const Mesh& mesh, std::span<const uint32_t> stars, const Executor& executor);
  uint32_t index_of(const Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) const;
  uint64_t place_of(const Mesh& mesh, uint32_t f) const;
  void sort_pairs(const Mesh& mesh);

  Spares<BoxTree::Scratch> scratches_;
  Mesh mesh_;                  // of the last find()
  Buffer<uint32_t> vertices_;  // by where_listed()
  Buffer<uint8_t> listed_;     // per vertex
  Buffer<uint8_t> changed_;    // per vertex; 0 between calls
  Vector<uint32_t> stars_;     // around which faces are tested against each other
  size_t face_count_ = 0;
  Buffer<uint32_t> faces_;
  Buffer<uint32_t> begin_;  // per listed vertex, and one more
  Buffer<uint32_t> block_faces_;
  BoxTree tree_;
  Vector<Pairs> found_;
  Pairs pairs_;
};

}  // namespace plc

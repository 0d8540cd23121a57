// A closed triangle mesh by its half-edges, out of which edges can be contracted: 24 bytes a face,
// where the rings and streams of mesh.h take ten times as much.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "pyramid/buffer.h"
#include "pyramid/executor.h"

namespace plc {

// Half-edge h = 3 f + k leads from corner k of face f to the next one, counter-clockwise seen from
// outside.
//
//   corner  uint32 per half-edge  where it begins; kNone of a face that is gone
//   twin    uint32 per half-edge  the one in the opposite direction
//   out     uint32 per vertex     one that leaves it; kNone of a vertex that is gone
//
// Not thread-safe, but contractions whose ends have no neighbour in common may go on at once, and
// ask for what is around their ends and the neighbours of these.
class HalfEdges {
 public:
  static constexpr uint32_t kNone = ~0U;

  // Of a mesh that is closed, oriented, a manifold; every vertex has a face. abc: three indices
  // below `vertices` per face. The same for any executor.
  HalfEdges(Buffer<uint32_t>&& abc, size_t vertices, const Executor& executor);

  static uint32_t next(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static uint32_t previous(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  uint32_t from(uint32_t h) const { return corner_[h]; }
  uint32_t to(uint32_t h) const { return corner_[next(h)]; }
  uint32_t twin(uint32_t h) const { return twin_[h]; }
  uint32_t out(uint32_t v) const { return out_[v]; }
  // The next that leaves where h does.
  uint32_t around(uint32_t h) const { return twin_[previous(h)]; }
  // visit(h) for those that leave v, counter-clockwise, that of out() first.
  template <typename Visit>
  void visit_ring(uint32_t v, const Visit& visit) const {
    const uint32_t first = out_[v];
    uint32_t h = first;
    do {
      visit(h);
      h = around(h);
    } while (h != first);
  }
  bool alive(uint32_t v) const { return out_[v] != kNone; }
  size_t vertex_slots() const { return out_.size(); }
  size_t face_slots() const { return corner_.size() / 3; }
  // The three corners of a face that is not gone.
  const uint32_t* face(size_t f) const { return corner_.data() + 3 * f; }
  bool face_alive(size_t f) const { return corner_[3 * f] != kNone; }

  // What it takes to undo a contraction.
  struct Contraction {
    uint32_t h, v, w;  // of v -> w, that w was merged into v by
    std::array<uint32_t, 4>
        outs;  // as out() was of v, w, and the neighbours that they had in common
  };
  // Merges to(h) into from(h). Their ends have two neighbours in common, of more than three
  // neighbours each.
  Contraction contract(uint32_t h);
  // Of contractions around the same vertices the last one first.
  void undo(const Contraction& done);

 private:
  void join(uint32_t g, uint32_t h) {
    twin_[g] = h;
    twin_[h] = g;
  }
  void remove_face(uint32_t h);

  Buffer<uint32_t> corner_, twin_, out_;
};

}  // namespace plc

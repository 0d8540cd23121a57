// The triangulated mesh (3.1): structure-of-arrays vertex streams and oriented neighbour rings.
#pragma once
#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <functional>
#include <new>

#include "engine/base/constants.h"
#include "engine/base/vec3.h"
#include "engine/mesh/neighbors.h"
#include "engine/mesh/sizing.h"
#include "engine/mesh/vertex_bytes.h"
#include "kernels/ring.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

class Obstacles;
class StateReader;
class StateWriter;

// Ids up to which the engine's buffers can be indexed: 12 columns per vertex within 32 bits.
inline constexpr uint32_t kMaxMeshVertices =
    static_cast<uint32_t>((uint64_t{1} << 32) / kRingColumns - kRingLanes);
// Valences are 16 bit.
inline constexpr uint32_t kMaxValence = 65535;

// Thrown before there would be more ids than the mesh may have, or more neighbours beyond the
// columns than can be indexed.
class TooManyVertices : public std::bad_alloc {
 public:
  const char* what() const noexcept override { return "too many vertices"; }
};

// Three float streams of one vector quantity, 12 bytes per vertex.
struct Streams3 {
  Buffer<float> x, y, z;
  // room: for so many, from now on.
  void resize(size_t n, size_t room = 0);
  Vec3 at(uint32_t v) const { return {x[v], y[v], z[v]}; }
  void set(uint32_t v, Vec3 a) { x[v] = a.x, y[v] = a.y, z[v] = a.z; }
};

// Vertices have dense ids 0 .. slots()-1; a deleted one has valence 0 and waits in the free list.
// All streams are 64-byte aligned and padded to whole blocks of kRingLanes vertices.
//
//   stream         bytes  unit          written by
//   position       16     mesh units    move, transformations; a record of four, as it is fetched
//                                       by neighbour index: w is by how much the size there is
//                                       above delta, in delta (size_field.h); 0 in a uniform mesh
//   velocity       12     per time      move, transformations
//   normal         12     1             normals
//   displacement   12     mesh units    stages, move
//   path           4      mesh units    move; reset when the constraints of v are checked
//   turns          1      turns.h       sleep.h, transformations, motion guard
//   cut            4+4    id, iteration annular: which cut made v, and when (exemption from (3))
//   rings          48+2   id            transformations (kernels/ring.h)
//
//   held           4      id + 1        mesh_import.h; only where some vertices are held
//
// What single algorithms know of each vertex is theirs, and attached to the mesh (VertexBytes).
//
// Coordinates are of the mesh space: voxels of I_0 (method 2 of 4.4) or mm over U_0 (method 1).
// Not thread-safe; distinct vertices may be written concurrently where a pass says so.
class Mesh {
 public:
  Mesh() = default;
  // Copies are made by copy() alone: their view is of their own rings.
  Mesh(Mesh&&) = default;
  // The surface of another mesh instead of its own.
  void take(Mesh&& other);

  Streams3 velocity, normal, displacement;
  Buffer<Float4> position;
  Buffer<float> path;
  Buffer<uint8_t> turns;
  Buffer<uint32_t> cut_id;
  Buffer<uint32_t> cut_iteration;
  // A patch of a larger surface: vertices that stay where they are, with all faces between them.
  // 0: free; else 1 + the vertex's id in what was imported, or kAbsent. Empty: all are free.
  Buffer<uint32_t> held;
  // Of a vertex that closes a border of the patch: its faces are not of the surface.
  static constexpr uint32_t kAbsent = ~0U;

  // The invariant of (1)-(3), mesh units.
  double delta = 1;
  // By how much delta is larger or smaller, by place; null: by nothing. Borrowed.
  const Sizing* sizing = nullptr;
  // Normals point into the object: the surface is one of cavities alone.
  bool inside_out = false;
  // What the surface may not meet (guard/obstacles.h); null: nothing. Borrowed.
  const Obstacles* obstacles = nullptr;
  // By how much edges may be longer than (2) has them at the sizes of their ends: more where a
  // level starts with the mesh of another.
  float stretch = 1;
  // delta where v is; where an edge is.
  float size(uint32_t v) const { return static_cast<float>(delta) * (1 + position[v].w); }
  float size_between(uint32_t u, uint32_t v) const {
    return static_cast<float>(delta) * (1 + 0.5F * (position[u].w + position[v].w));
  }
  bool is_patch() const { return patch_; }
  bool is_held(uint32_t v) const { return is_patch() && held[v] != 0; }
  bool is_absent(uint32_t v) const { return is_patch() && held[v] == kAbsent; }
  // Vertices that move.
  uint32_t free_count() const { return alive_ - held_; }
  // Which of them, by id, is no part of the surface; null: none.
  const uint32_t* held_ids() const { return is_patch() ? held.data() : nullptr; }
  // Makes it a patch; to: as many as slots.
  void hold(const Vector<uint32_t>& to);

  // Of the largest size there may be.
  float longest_sized_edge() const {
    return kSizedStretch * kMaxEdge * static_cast<float>(delta) * sizing->field.coarsest();
  }
  // In an adaptive mesh no edge is longer; mesh units.
  float longest_edge = 0;
  // How far one has to look, where the size is `from`, for all that is no farther than `reach`
  // sizes of where it is itself: sizes grow with the distance.
  float far_reach(float reach, float from) const {
    if (sizing == nullptr) return reach * from * stretch;
    const float most = reach * longest_edge / kMaxEdge;
    reach *= stretch;
    const float slope = reach * sizing->field.slope();
    return slope < 1 ? std::min(most, reach * from / (1 - slope)) : most;
  }
  // Whether every size is delta.
  bool uniform() const {
    return std::all_of(position.begin(), position.end(), [](const Float4& p) { return p.w == 0; });
  }
  // Looks up the size where v is now, after a movement.
  void resize(uint32_t v) {
    Float4& p = position[v];
    if (sizing != nullptr) p.w = sizing->field.above_delta(p.x, p.y, p.z);
  }

  // Ids are below the first. No vertex gets more neighbours than the second: transformations that
  // would give it more are refused (resolution.h).
  uint32_t most_vertices = kMaxMeshVertices;
  uint32_t most_neighbors = kMaxValence;

  uint32_t slots() const { return slots_; }         // ids are below this
  uint32_t padded() const;                          // slots, up to whole blocks
  uint32_t vertex_count() const { return alive_; }  // not deleted
  // Slots there is memory for: more are had by copying all streams.
  size_t room() const { return valence_.capacity(); }
  bool alive(uint32_t v) const { return valence(v) != 0; }
  uint32_t valence(uint32_t v) const {
    assert(v < slots_);
    return valence_[v];
  }
  uint32_t neighbor(uint32_t v, uint32_t k) const {
    assert(k < valence(v));
    return view_.slot(v, k);
  }
  bool adjacent(uint32_t u, uint32_t v) const;
  RingView rings() const { return view_; }
  Neighbors ring(uint32_t v) const;
  Vec3 at(uint32_t v) const {
    assert(v < slots_);
    return {position[v].x, position[v].y, position[v].z};
  }

  void place(uint32_t v, Vec3 p);
  // Takes an id from the free list (last freed first) or a new one, or throws TooManyVertices; its
  // ring is still empty, it counts as alive from set_ring on, and it is due for a check.
  uint32_t create(Vec3 p, Vec3 velocity);
  // New ids that follow one another, at the origin, at rest and due for a check. They are alive at
  // once: each gets its ring by exchange_ring(), that of first + i with valence(i) >= 3 neighbours.
  // Only where no vertex has been deleted. Throws TooManyVertices.
  uint32_t create_many(uint32_t count, const std::function<uint32_t(uint32_t i)>& valence,
                       const Executor& executor);
  void destroy(uint32_t v);
  void set_ring(uint32_t v, const Neighbors& ring);
  // As many neighbours as v has. Distinct vertices may be written concurrently.
  void exchange_ring(uint32_t v, const Neighbors& ring);
  // Edits of one ring that the transformations are made of.
  void replace(uint32_t v, uint32_t old_neighbor, uint32_t new_neighbor);
  void replace(uint32_t v, uint32_t old_neighbor, uint32_t first, uint32_t second);
  void insert_after(uint32_t v, uint32_t neighbor, uint32_t added);
  void remove(uint32_t v, uint32_t neighbor);

  // v has changed: it does not sleep.
  void touch(uint32_t v) { reset_bytes(v, VertexBytes::Reset::kTouched); }
  // Makes every constraint of v be checked at the next opportunity, too.
  void wake(uint32_t v) { reset_bytes(v, VertexBytes::Reset::kWoken); }

  void clear();
  void reserve(uint64_t vertices);  // throws TooManyVertices
  // Vertices created since the ids were last renumbered: how far ids have strayed from space order.
  uint32_t created() const { return created_; }
  // No id was created or freed since then.
  bool in_order() const { return created_ == 0 && alive_ == slots_; }
  // Of deleted vertices; create() takes the last one.
  const Vector<uint32_t>& free_ids() const { return free_; }
  // New ids: new id = rank of v in `order`, which lists every living vertex once. Nothing but the
  // ids changes.
  void renumber(const Vector<uint32_t>& order, const Executor& executor = SerialExecutor());
  // visit(v, r[i], r[i + 1]) for the faces of the surface whose smallest id v is in [begin, end),
  // in order of v, then of its ring.
  template <typename Visit>
  void visit_faces(uint32_t begin, uint32_t end, const Visit& visit) const {
    for (uint32_t v = begin; v < end; ++v) {
      if (is_absent(v)) continue;
      const uint32_t d = valence(v);
      for (uint32_t k = 0; k < d; ++k) {
        const uint32_t a = neighbor(v, k), b = neighbor(v, k + 1 == d ? 0 : k + 1);
        if (v < a && v < b && !is_absent(a) && !is_absent(b)) visit(v, a, b);
      }
    }
  }
  // Their corners, of all faces.
  Vector<uint32_t> faces(const Executor& executor = SerialExecutor()) const;
  uint64_t bytes() const;
  Mesh copy() const;

  // All of it but the places of tails in their arena (mesh_state.cpp). restore() replaces what is
  // there; false where what is read is no mesh that holds its invariants: it is then of no use.
  void save(StateWriter& to) const;
  bool restore(StateReader& from);

 private:
  friend class VertexBytes;

  Mesh(const Mesh&) = default;
  Mesh& operator=(Mesh&&) = default;
  void attach(VertexBytes& bytes);
  void detach(VertexBytes& bytes) { attached_.remove(bytes); }
  void reset_bytes(uint32_t v, VertexBytes::Reset event) {
    for (VertexBytes* bytes : attached_) {
      if (bytes->reset_ <= event) bytes->bytes_[v] = bytes->first_;
    }
  }
  void start_bytes(VertexBytes& bytes);
  // visit(stream of a, stream of b) for every stream of the vertices but the rings.
  template <typename A, typename B, typename Visit>
  static void visit_streams(A& a, B& b, const Visit& visit);
  template <typename Self, typename Visit>
  static void visit_streams(Self& mesh, const Visit& visit) {
    visit_streams(mesh, mesh, [&](auto& stream, auto&) { visit(stream); });
  }
  void start_vertex(uint32_t v);
  bool restore_rings(StateReader& from);
  void grow(uint64_t slots);
  void carry_rings(const Vector<uint32_t>& order, Mesh& to, const Executor& executor) const;
  void set_valence(uint32_t v, uint32_t valence);
  uint32_t& column(uint32_t v, uint32_t k) {
    return columns_[(v / kRingLanes * kRingColumns + k) * kRingLanes + v % kRingLanes];
  }
  uint32_t allocate_tail(uint32_t length);
  void free_tail(uint32_t offset, uint32_t length);
  void refresh_view() { view_ = {columns_.data(), valence_.data(), tail_.data()}; }

  uint32_t slots_ = 0;
  uint32_t alive_ = 0;
  uint32_t held_ = 0;  // of them
  bool patch_ = false;
  uint32_t created_ = 0;
  Buffer<uint32_t> columns_;
  Buffer<uint16_t> valence_;
  Buffer<uint32_t> tail_;
  std::array<Vector<uint32_t>, 16> free_tails_;  // by size class
  Vector<uint32_t> free_;
  RingView view_;
  AttachedBytes attached_;
};

// Of an adaptive mesh, or a patch, that may not be of its sizes yet: sets stretch and longest_edge
// to what its edges are.
void measure_edges(Mesh& mesh);

template <typename A, typename B, typename Visit>
void Mesh::visit_streams(A& a, B& b, const Visit& visit) {
  const auto visit3 = [&](auto& s, auto& t) {
    visit(s.x, t.x);
    visit(s.y, t.y);
    visit(s.z, t.z);
  };
  visit3(a.velocity, b.velocity);
  visit3(a.normal, b.normal);
  visit3(a.displacement, b.displacement);
  visit(a.position, b.position);
  visit(a.path, b.path);
  visit(a.turns, b.turns);
  visit(a.cut_id, b.cut_id);
  visit(a.cut_iteration, b.cut_iteration);
}

}  // namespace plc

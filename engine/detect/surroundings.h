// What lies around the vertices that are due for a check: one search for constraint (3) and, where
// vertices have moved, for the motion guard.
#pragma once
#include <cstdint>

#include "engine/base/spares.h"
#include "engine/detect/spatial_hash.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/vertex_bytes.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

struct VertexPair {
  uint32_t u, w;
  friend bool operator==(const VertexPair& a, const VertexPair& b) {
    return a.u == b.u && a.w == b.w;
  }
  friend bool operator<(const VertexPair& a, const VertexPair& b) {
    return a.u != b.u ? a.u < b.u : a.w < b.w;
  }
};

// Due vertices that are neighbours in memory lie near each other: what is around a group of them is
// fetched once, into streams, and searched for each of them by a kernel.
class Surroundings {
 public:
  Surroundings(const Mesh& mesh, const Executor& executor) : mesh_(mesh), executor_(executor) {}

  // due: ascending. The hash holds every living vertex. Normals are those of mesh.normal; a vertex
  // that the surface folds around has none. risk: the flags of risk.h, known for all vertices;
  // null: the surface folds nowhere.
  void search(const Vector<uint32_t>& due, const SpatialHash& hash,
              const VertexBytes* risk = nullptr);
  // Only the risk, of vertices around which the surface folds since the last movement: what is at
  // risk with them is added to what search() has found. folded: ascending.
  void search_folded(const Vector<uint32_t>& folded, const SpatialHash& hash,
                     const VertexBytes& risk);
  // Only what is too near, for constraint (3), around all living vertices: a smaller box, no
  // normals, and each pair is seen from one side.
  void search_near(const Vector<uint32_t>& all, const SpatialHash& hash);

  // Of the last search: the non-neighbours u < w, one of them due, that are nearer than (3) allows;
  // sorted.
  const Vector<VertexPair>& too_near() const { return too_near_; }
  // Of the last search: the vertices at risk (risk.h), one of each two at least due; ascending.
  // None after search_near().
  const Vector<uint32_t>& at_risk() const { return at_risk_; }

 private:
  // What one task has found.
  struct Task {
    Vector<VertexPair> too_near;
  };
  // What it works with.
  struct Scratch {
    SpatialHash::Collected around;  // the group
    Vector<float> streams[6];       // their places and normals
    Vector<uint32_t> hits;
    Vector<uint32_t> turned;
  };
  enum class Wanted { kNear, kNearAndRisk };
  static constexpr uint32_t kBits = 64;
  // Fills the tasks; returns how many.
  size_t search(const Vector<uint32_t>& due, const SpatialHash& hash, Wanted wanted);
  void gather_near(size_t tasks);
  void gather_at_risk();
  Vec3 sheet_normal(uint32_t v) const;
  void fetch(Wanted wanted, Scratch& scratch) const;
  void search_group(const uint32_t* due, size_t count, Wanted wanted, Scratch& scratch, Task& task);
  bool is_due(uint32_t v) const { return (is_due_[v / kBits] >> v % kBits & 1) != 0; }
  bool too_near(uint32_t v, uint32_t w) const;
  void list_near(uint32_t v, uint32_t hits, const Scratch& scratch, Task& task) const;
  void judge(uint32_t v, uint32_t hits, Scratch& scratch, Task& task);
  // turned: what is turned against v, and near enough.
  void mark_risk(uint32_t v, const Vector<uint32_t>& turned);
  size_t group_size(const uint32_t* due, size_t count, Vec3& low, Vec3& high, float& largest) const;

  const Mesh& mesh_;
  const Executor& executor_;
  const VertexBytes* risk_ = nullptr;  // of this search
  Vector<Task> tasks_;
  Spares<Scratch> scratches_;
  Vector<uint64_t> is_due_;  // a bit per vertex: in this search
  Vector<VertexPair> too_near_;
  Buffer<uint8_t> risks_;  // a mark per vertex
  Vector<uint32_t> at_risk_;
};

}  // namespace plc

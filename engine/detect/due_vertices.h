// The slow-vertex rule (3.6): which vertices are due for a check of their constraints.
#pragma once
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "engine/mesh/vertex_bytes.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// A vertex is due when it has moved kCheckPath since its last check, or kCheckPeriod iterations
// have passed; its period starts anew then. What sleeps, or might, has none.
//
//   idle           1      iterations    attached to the mesh: since the constraints of v were
//                                       checked; above the period where v has been woken
class DueVertices {
 public:
  DueVertices(Mesh& mesh, const Executor& executor)
      : mesh_(mesh), executor_(executor), idle_(mesh, kAwake, VertexBytes::Reset::kWoken) {}

  // Lists those of all vertices, none of which sleeps, or of these blocks of kRingLanes; once per
  // iteration. calm: for how long each vertex has been calm (sleep.h).
  void list_due();
  void list_due(const Vector<uint32_t>& blocks, const VertexBytes& calm);
  // Every living vertex is due.
  void list_all();
  // Ascending.
  const Vector<uint32_t>& list() const { return due_; }
  const VertexBytes& idle() const { return idle_; }
  // restore(): after that of the mesh.
  void save(StateWriter& to) const { idle_.save(to); }
  void restore(StateReader& from) { idle_.restore(from); }

 private:
  static constexpr uint8_t kAwake = 255;

  const Vector<uint32_t>& all_blocks();
  // calm: null where none sleeps.
  void list(const Vector<uint32_t>& blocks, const VertexBytes* calm, bool all);
  uint16_t due_lanes(uint32_t first, const uint8_t* calm, bool all);

  Mesh& mesh_;
  const Executor& executor_;
  VertexBytes idle_;
  Vector<uint32_t> due_;
  Vector<uint32_t> blocks_;     // all
  Vector<uint16_t> lanes_;      // per block: those that are due, as bits
  Vector<uint32_t> first_due_;  // per task
};

}  // namespace plc

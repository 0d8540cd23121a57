// The slow-vertex rule (3.6): which vertices are due for a check of their constraints.
#pragma once
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// A vertex is due when it has moved kCheckPath since its last check, or kCheckPeriod iterations
// have passed; its period starts anew then. What sleeps, or might, has none.
class DueVertices {
 public:
  DueVertices(Mesh& mesh, const Executor& executor) : mesh_(mesh), executor_(executor) {}

  // Lists those of all vertices, or of these blocks of kRingLanes; once per iteration.
  void list_due();
  void list_due(const Vector<uint32_t>& blocks);
  // Every living vertex is due.
  void list_all();
  // Ascending.
  const Vector<uint32_t>& list() const { return due_; }

 private:
  const Vector<uint32_t>& all_blocks();
  void list(const Vector<uint32_t>& blocks, bool all);
  uint16_t due_lanes(uint32_t first, bool all);

  Mesh& mesh_;
  const Executor& executor_;
  Vector<uint32_t> due_;
  Vector<uint32_t> blocks_;     // all
  Vector<uint16_t> lanes_;      // per block: those that are due, as bits
  Vector<uint32_t> first_due_;  // per task
};

}  // namespace plc

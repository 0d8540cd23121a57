// What the embedding guard says of many candidates, asked in parallel before they are applied one
// after the other.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/guard/embedding_guard.h"
#include "engine/transform/candidate.h"
#include "kernels/box_lanes.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// A trial sees the mesh as it was when the run started. The answer may be another one only where
// faces have gone or come since within the box of the new faces that were tried; then the guard is
// asked again: of what had been admitted only against the faces that have come. So admitted() says
// what the guard would say of the mesh as it is now, whatever had been tried.
//
// All but axial transformations are tried; deletions at each place that the merged vertex may
// have, until the guard admits one.
class Trials {
 public:
  Trials(const Mesh& mesh, const SpatialHash& hash, const Executor& executor)
      : mesh_(mesh), hash_(hash), executor_(executor) {}

  static constexpr uint32_t kRefused = ~0U;
  static constexpr size_t kUntried = ~size_t{0};
  // Places that a deletion tries, in this order: the mid-point, u, v.
  static constexpr uint32_t kPlaces = 3;
  static Vec3 deletion_place(const Mesh& mesh, const Edge& edge, uint32_t place);
  // Whether run() takes this candidate.
  static bool can_try(const Mesh& mesh, const Candidate& candidate);

  // A new run: trial i is of candidates[i].
  void run(const Vector<const Candidate*>& candidates);
  // The first place that the guard admits, 0 for all but deletions; or kRefused. trial: of this
  // candidate, or kUntried. No vertex of the candidate's footprint has changed since the run.
  uint32_t admitted(const Candidate& candidate, size_t trial);

  // What is applied after the run: first begin(), with the vertices of all faces that go; then
  // changed() of vertices around which all new faces lie; and end() when it has been applied.
  void begin(const Vector<uint32_t>& footprint);
  void changed(uint32_t v);
  void end();

 private:
  struct Trial {
    uint32_t admitted;
    Box3 box;
  };
  uint32_t first_admitted(const Candidate& candidate, EmbeddingGuard& guard, Box3* tried) const;
  bool find_overlapping(const Box3& box);

  const Mesh& mesh_;
  const SpatialHash& hash_;
  const Executor& executor_;
  Vector<Trial> trials_;
  Vector<EmbeddingGuard> guards_;  // by task
  EmbeddingGuard guard_;
  // What has been applied since the run.
  Vector<BoxLanes> boxes_;
  Vector<uint32_t> first_centre_;  // by operation, and one more
  Vector<uint32_t> centres_;
  Box3 box_{};               // of the operation at hand
  Vector<uint32_t> around_;  // centres of what find_overlapping() has found
};

}  // namespace plc

// Detection and resolution of the three constraints: the loop of figure 9, in deterministic rounds.
#pragma once

#include "engine/base/statistics.h"
#include "engine/detect/due_vertices.h"
#include "engine/detect/spatial_hash.h"
#include "engine/detect/surroundings.h"
#include "engine/detect/tiny_components.h"
#include "engine/guard/embedding_guard.h"
#include "engine/guard/trials.h"
#include "engine/mesh/mesh.h"
#include "engine/transform/candidate.h"
#include "kernels/simd.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// One round: collect candidates (parallel, reading only), order them by a total key, and go through
// them in that order: a candidate whose footprint - the closed rings of its vertices - an earlier
// one of the round has claimed is put off to the next round, the others are applied. Nothing
// depends on threads or addresses.
class Resolution {
 public:
  Resolution(Mesh& mesh, const Executor& executor, SimdTarget simd);

  // Everything that is known about single vertices is forgotten: new ids, new level.
  void restart();
  // What the next pass knows of those before it.
  void save(StateWriter& to) const;
  void restore(StateReader& from);
  // The vertices that are due for a check by the slow-vertex rule (3.6) - all of them: check_all -
  // in ascending order; their periods start anew. Also brings the hash up to date and searches what
  // is around those vertices.
  const Vector<uint32_t>& take_due(bool check_all);
  // All of them, for their constraints only: nothing has moved, or will be asked of the motion
  // guard.
  const Vector<uint32_t>& take_all();
  // Of the vertices of these blocks of kRingLanes only, ascending: those of sleep.h.
  const Vector<uint32_t>& take_due(const Vector<uint32_t>& awake);
  SpatialHash& hash() { return hash_; }
  // What take_due() has found.
  const Surroundings& surroundings() const { return surroundings_; }
  // These have been moved since take_due(): their constraints are checked, too.
  void add_due(const Vector<uint32_t>& vertices);
  // One pass of figure 9 over the vertices that take_due() returned, and those added.
  void run(uint32_t iteration, OperationCounts& counts);

 private:
  const Vector<uint32_t>& look_around(bool all);
  void start_check(bool all);
  void update_hash(bool all);
  void queue_violated_edges();
  void resolve_edges(OperationCounts& counts);
  bool resolve_pairs(bool first, OperationCounts& counts);
  Vector<Candidate> edge_candidates(const Vector<uint32_t>& queue);
  Vector<Candidate> pair_candidates(const Vector<uint32_t>& queue, bool first);
  // Applies what does not conflict; the vertices of what does are appended to `later`.
  void apply_round(const Vector<Candidate>& candidates, Vector<uint32_t>& later,
                   OperationCounts& counts);
  void try_candidates(const Candidate* candidates, size_t count, size_t* trial);
  bool free_footprint(const Candidate& candidate, uint32_t claim);
  bool within_limit(const Candidate& candidate);
  void apply_in_turn(const Candidate& candidate, size_t trial, Vector<uint32_t>& later,
                     OperationCounts& counts);
  bool apply(const Candidate& candidate, size_t trial, OperationCounts& counts);
  bool apply_inversion(const Candidate& candidate, size_t trial);
  bool apply_deletion(const Candidate& candidate, size_t trial, OperationCounts& counts);
  bool apply_annular(const Candidate& candidate);
  bool apply_axial(const Candidate& candidate);
  bool apply_creation(const Candidate& candidate, size_t trial);
  // v has changed: its constraints are checked again in this pass.
  void involve(uint32_t v);
  void moved(uint32_t v);
  uint32_t stamp_queue(const Vector<uint32_t>& queue);
  void unique(Vector<uint32_t>& queue);

  Mesh& mesh_;
  const Executor& executor_;
  SimdTarget simd_;
  DueVertices due_;  // of take_due()
  SpatialHash hash_;
  bool hash_valid_ = false;
  Surroundings surroundings_;
  TinyComponents tiny_;
  uint32_t iteration_ = 0;
  uint32_t next_cut_ = 1;

  Buffer<uint8_t> flags_;        // edge violations by the kernel
  Vector<uint32_t> blocks_;      // of kRingLanes vertices, with one that is due
  Vector<uint32_t> edge_queue_;  // vertices whose edges are to be checked
  Vector<uint32_t> pair_queue_;  // ... whose distance to non-neighbours is to be checked
  Vector<uint32_t> changed_;     // where components may have become tiny
  Vector<uint32_t> stamp_;       // by vertex: the queue it was last in, or what has claimed it
  Vector<uint32_t> footprint_;   // of the candidate at hand
  EmbeddingGuard guard_;
  Trials trials_;
  Vector<const Candidate*> tried_;  // of the run at hand
  uint32_t stamps_ = 0;             // so far
  uint32_t round_ = 0;              // the claim of what the round has applied
};

}  // namespace plc

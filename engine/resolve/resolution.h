// Resolution of the three constraints: the loop of figure 9, in deterministic rounds.
#pragma once

#include "engine/base/statistics.h"
#include "engine/detect/detection.h"
#include "engine/detect/tiny_components.h"
#include "engine/guard/embedding_guard.h"
#include "engine/guard/trials.h"
#include "engine/mesh/mesh.h"
#include "engine/transform/candidate.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// One round: collect candidates (parallel, reading only), order them by a total key, and go through
// them in that order: a candidate whose footprint - the closed rings of its vertices - an earlier
// one of the round has claimed is put off to the next round, the others are applied. Nothing
// depends on threads or addresses.
class Resolution {
 public:
  // detection: of the same mesh; it outlives this.
  Resolution(Mesh& mesh, const Executor& executor, Detection& detection);

  // Whether (3) is asked for in an iteration (kFirstPairs).
  static bool asks_for_pairs(const Mesh& mesh, uint32_t iteration);
  // Everything that is known about single vertices is forgotten: new ids, new level.
  void restart();
  // What the next pass knows of those before it.
  void save(StateWriter& to) const;
  void restore(StateReader& from);
  // One pass of figure 9 over the vertices that the detection has found to be due, and over those
  // that have been moved since.
  void run(uint32_t iteration, const Vector<uint32_t>& moved_since, OperationCounts& counts);

 private:
  TinyComponents::Stays staying() const;
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
  bool apply_annular(const Candidate& candidate, size_t trial);
  bool apply_axial(const Candidate& candidate);
  bool apply_creation(const Candidate& candidate, size_t trial);
  // v has changed: its constraints are checked again in this pass.
  void check_again(uint32_t v);
  void enter_and_check(uint32_t v);
  void look_for_cycles(uint32_t v);
  void inherit_operations(uint32_t created, uint32_t from);
  uint32_t stamp_queue(const Vector<uint32_t>& queue);
  void unique(Vector<uint32_t>& queue);

  Mesh& mesh_;
  const Executor& executor_;
  Detection& detection_;
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
  Buffer<uint8_t> operations_;   // by vertex: in this pass, on it or on what it was made of
  Buffer<uint8_t> cycles_due_;   // ... of an adaptive mesh: whether to look for denied cycles
  EmbeddingGuard guard_;
  Trials trials_;
  Vector<const Candidate*> tried_;  // of the run at hand
  uint32_t stamps_ = 0;             // so far
  uint32_t round_ = 0;              // the claim of what the round has applied
};

}  // namespace plc

// One iteration of deformation: the procedure Evolution of figure 9, as a table of passes.
#pragma once
#include <limits>

#include "engine/base/schedule.h"
#include "engine/base/statistics.h"
#include "engine/detect/detection.h"
#include "engine/guard/motion_guard.h"
#include "engine/motion/dynamics.h"
#include "engine/motion/sleep.h"
#include "engine/recover/pass_observer.h"
#include "engine/resolve/resolution.h"
#include "pyramid/memory.h"

namespace plc {

// Beyond the model of the paper.
struct EvolutionOptions {
  Sleep::Speeds speeds{};                                  // nothing sleeps, nothing freezes
  float counted = std::numeric_limits<float>::infinity();  // see Dynamics
  bool slow_vertices = true;  // 3.6; false: every vertex is checked in every iteration
};

class Evolution {
 public:
  Evolution(Mesh& mesh, const Schedule& schedule, const Model& model,
            const EvolutionOptions& options = {});

  // The ids or delta of the mesh have changed: at the start of a level.
  void restart();
  // The surface sets out on a way of at most so many iterations (motion/travel.h).
  void travel(int most) { sleep_.travel(most); }
  bool travelling() const { return sleep_.travelling(); }
  // Moves the vertices, takes back what would make the surface meet itself, resolves the
  // constraints of the vertices that are due (of all: check_all). Fails where the user's force
  // does.
  Status iterate(const Guide& guide, Seconds& seconds, OperationCounts& counts);
  // The constraints of all vertices, without a movement, until nothing changes any more: at the end
  // of a level.
  void check_all(Seconds& seconds, OperationCounts& counts);
  // Tests all faces, not only those at risk. False when some meet; their vertices are at risk from
  // then on, so that the next iterations part them.
  bool embedded();
  // Whether some vertices slept through the last iteration.
  bool any_asleep() const { return sleep_.any_asleep(); }
  void wake_all() { sleep_.wake_all(); }
  // All sleep but what is touched from then on.
  void settle() { sleep_.settle(); }
  // Kinetic energy along the normals of the last iteration (5.1).
  double energy() const { return dynamics_.energy(); }
  // The longest movement of the last iteration, in delta per time.
  double speed() const { return dynamics_.speed(); }

  // Between two iterations; not the mesh, which is to be restored before.
  void save(StateWriter& to) const;
  void restore(StateReader& from);

  // For tests. Empty: nobody looks, which costs nothing.
  void set_observer(PassObserver observer) { observer_ = std::move(observer); }
  // Tells the observer; also of what is no pass of an iteration.
  void notify(const std::string& pass, uint32_t writes = kEverything) const {
    if (observer_) observer_(pass, writes, *this);
  }
  // The state as it is now, part by part: between passes all that the next ones read.
  std::vector<PartHash> hashes() const;
  // Vertices, padding included, in blocks that took part in the last iteration.
  size_t awake() const { return sleep_.awake().size() * kRingLanes; }

 private:
  void append_movement(const Guide& guide, Seconds& seconds, std::vector<Pass>& table);
  void append_topology(Seconds& seconds, OperationCounts& counts, std::vector<Pass>& table);

  Mesh& mesh_;
  const Schedule& schedule_;
  bool slow_vertices_;
  Sleep sleep_;
  Dynamics dynamics_;
  Detection detection_;
  MotionGuard guard_;
  Resolution resolution_;
  Vector<uint32_t> back_;  // vertices that the guard has taken back
  uint32_t iteration_ = 0;
  PassObserver observer_;
};

}  // namespace plc

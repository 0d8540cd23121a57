// Regions where nothing has moved for long sleep whole, beyond the slow vertices of 3.6: they are
// neither moved nor checked.
//
// Streams, each attached to the mesh:
//
//   calm           1      iterations    for how long v has been calm, up to 255
//   drift          1      1/256 of      movement along the normal since v last woke its neighbours
//                         kWakeMove
//
// A vertex is calm in an iteration in which it has moved less than the calm speed along its normal,
// and less than kCalmSlide times that in all: sliding within the surface changes samples, not
// shape. A block of kRingLanes vertices sleeps when all of them have been calm kCalmPeriod times in
// a row, or when a surface at rest settles, so that only what is added to it moves. It is awake
// again when a transformation or the motion guard has touched one of them, when a neighbour has
// moved kWakeMove along its normal since it last woke others, and when all are woken: at the start
// of a level, and before a level may end. Nothing depends on threads.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/base/constants.h"
#include "engine/base/state_io.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/vertex_bytes.h"
#include "engine/motion/travel.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

class Sleep {
 public:
  // Along the normal, delta per iteration.
  struct Speeds {
    float calm = 0;                                       // 0: nothing ever sleeps
    float turn = std::numeric_limits<float>::infinity();  // slower movements are no turns (turns.h)
  };
  Sleep(Mesh& mesh, const Executor& executor, const Speeds& speeds)
      : mesh_(mesh),
        executor_(executor),
        speeds_(speeds),
        calm_(mesh, 0, VertexBytes::Reset::kTouched),
        drift_(mesh, 0, VertexBytes::Reset::kCreated) {}

  // Chooses the blocks of the coming step. Those that fall asleep lose their velocities and
  // displacements. all: every block, whatever has been.
  void choose(bool all);
  // Ascending block indices: vertices kRingLanes * block .. Those that have fallen asleep just now
  // in the second list.
  const Vector<uint32_t>& awake() const { return awake_; }
  const Vector<uint32_t>& fallen() const { return fallen_; }
  // The awake ones and those that sleep but have a neighbour of an awake vertex.
  const Vector<uint32_t>& awake_and_rim() const { return awake_and_rim_; }
  // Whether some blocks were left out by the last choose().
  bool any_asleep() const { return any_asleep_; }
  // After the step: who was calm, who has turned, and who wakes its neighbours. Normals and
  // displacements are those of the step.
  void observe();
  void wake_all() { calm_.fill(0); }
  // All count as calm for long: they sleep until they are touched.
  void settle() { calm_.fill(kCalmPeriod); }
  // The surface sets out on a way of at most so many iterations, on which turns do not count.
  void travel(int most) { travel_.start(most); }
  bool travelling() const { return travel_.going(); }
  const VertexBytes& calm() const { return calm_; }
  const VertexBytes& drift() const { return drift_; }
  // Ids have changed: everything that sleeps counts as fallen asleep just now.
  void restart() { asleep_.clear(); }
  // The streams, and which blocks are asleep: those that fell asleep before are not treated as new
  // ones. restore(): after that of the mesh.
  void save(StateWriter& to) const;
  void restore(StateReader& from);

 private:
  bool all_calm(uint32_t block) const;
  void find_rim();

  Mesh& mesh_;
  const Executor& executor_;
  Speeds speeds_;
  VertexBytes calm_, drift_;
  bool any_asleep_ = false;
  Vector<uint32_t> awake_, fallen_, awake_and_rim_;
  Vector<uint8_t> asleep_, to_sleep_, touched_;  // by block
  std::vector<Vector<uint32_t>> found_;          // per task
  Vector<int64_t> excess_;                       // per task
  Travel travel_;
};

}  // namespace plc

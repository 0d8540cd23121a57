// Whether a surface is still on its way to what it is to approach.
//
// A bubble around the image shrinks through hundreds of voxels. In noise its front swings, tips
// grow behind it, are cut off and vanish, while it goes on: turns (mesh/turns.h) that are counted
// there freeze it halfway. So turns count from where the surface as a whole has arrived: as many
// vertices go outwards as inwards, but for kArrived of all, in the mean of the iterations, each
// weighing 1 - 1 / kTravelMemory of the next; so a surface that swings around its place has
// arrived, too. One that never arrives has done so after as many iterations as a vertex takes to
// cross the image.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/base/constants.h"
#include "engine/base/state_io.h"

namespace plc {

class Travel {
 public:
  // The surface sets out, for at most so many iterations.
  void start(int most) {
    left_ = most;
    gone_ = 0;
    share_ = 0;
  }
  bool going() const { return left_ > 0; }
  // While it is going: an iteration, in which so many more of the vertices went outwards than
  // inwards.
  void observe(int64_t excess, uint32_t vertices) {
    const double share = vertices == 0 ? 0 : static_cast<double>(excess) / vertices;
    share_ += (share - share_) / kTravelMemory;
    ++gone_;
    const bool arrived = gone_ >= kTravelMemory && std::abs(share_) < kArrived;
    left_ = arrived ? 0 : left_ - 1;
  }

  void save(StateWriter& to) const {
    to.add(left_);
    to.add(gone_);
    to.add(share_);
  }
  void restore(StateReader& from) {
    from.read(left_);
    from.read(gone_);
    from.read(share_);
    from.demand(left_ >= 0 && gone_ >= 0 && gone_ <= std::numeric_limits<int>::max() / 2 &&
                std::abs(share_) <= 1);
  }

 private:
  int left_ = 0, gone_ = 0;  // iterations
  double share_ = 0;
};

}  // namespace plc

// What is compared of two runs' dynamics after a pass.
#include <array>

#include "engine/motion/dynamics.h"

namespace plc {

void Dynamics::append_hashes(std::vector<PartHash>& hashes) const {
  Fnv step;
  step.add(time_step_);
  step.add(energy_);
  step.add(speed_of_fastest_);
  for (const kernels::Movement& m : movement_) {
    step.add(m.energy);
    step.add(m.longest2);
  }
  hashes.insert(hashes.end(), {{"step", step.value()},
                               part_hash("rest length", std::array{rest_length_}),
                               part_hash("blocks", blocks_),
                               part_hash("laplacian", laplacian_),
                               part_hash("force", force_),
                               part_hash("user force", user_force_),
                               part_hash("stage velocity", speed_),
                               part_hash("new velocity", rate_),
                               part_hash("stage position", stage_[0]),
                               part_hash("other stage position", stage_[1]),
                               part_hash("metric normal", metric_normal_),
                               part_hash("metric step", metric_step_)});
}

}  // namespace plc

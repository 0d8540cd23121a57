#include "engine/sleep.h"

#include <algorithm>
#include <cmath>

#include "engine/blocks.h"
#include "engine/constants.h"

namespace plc {

namespace {

constexpr size_t kTaskBlocks = kGrain / kRingLanes;

bool all_calm(const Mesh& mesh, uint32_t block) {
  const uint8_t* calm = mesh.calm.data() + size_t{block} * kRingLanes;
  return *std::min_element(calm, calm + kRingLanes) >= kCalmPeriod;
}

}  // namespace

void Sleep::choose(bool all) {
  const uint32_t blocks = mesh_.padded() / kRingLanes;
  asleep_.resize(blocks, 0);
  awake_.clear();
  fallen_.clear();
  for (uint32_t block = 0; block < blocks; ++block) {
    const bool asleep = !all && calm_speed_ > 0 && all_calm(mesh_, block);
    if (!asleep) {
      awake_.push_back(block);
    } else if (asleep_[block] == 0) {
      fallen_.push_back(block);
      for (uint32_t v = block * kRingLanes; v < (block + 1) * kRingLanes; ++v) {
        mesh_.velocity.set(v, {});
        mesh_.displacement.set(v, {});
      }
    }
    asleep_[block] = asleep ? 1 : 0;
  }
  any_asleep_ = awake_.size() < blocks;
  find_rim();
}

void Sleep::find_rim() {
  awake_and_rim_ = awake_;
  if (!any_asleep()) return;
  const size_t tasks = block_count(awake_.size(), kTaskBlocks);
  found_.resize(std::max(found_.size(), tasks));
  run_blocks(executor_, awake_.size(), kTaskBlocks, [&](size_t task, size_t begin, size_t end) {
    auto& rim = found_[task];
    rim.clear();
    for (size_t i = begin; i < end; ++i) {
      for (uint32_t v = awake_[i] * kRingLanes; v < (awake_[i] + 1) * kRingLanes; ++v) {
        const uint32_t d = mesh_.rings().valence[v];
        for (uint32_t k = 0; k < d; ++k) {
          const uint32_t block = mesh_.neighbor(v, k) / kRingLanes;
          if (asleep_[block] != 0 && (rim.empty() || rim.back() != block)) rim.push_back(block);
        }
      }
    }
  });
  for (size_t task = 0; task < tasks; ++task) {
    awake_and_rim_.insert(awake_and_rim_.end(), found_[task].begin(), found_[task].end());
  }
  std::sort(awake_and_rim_.begin(), awake_and_rim_.end());
  awake_and_rim_.erase(std::unique(awake_and_rim_.begin(), awake_and_rim_.end()),
                       awake_and_rim_.end());
}

void Sleep::observe() {
  if (calm_speed_ == 0) return;
  const float along = calm_speed_ * static_cast<float>(mesh_.delta);
  const float slide = kCalmSlide * along;
  const float steps = 256 / (kWakeMove * static_cast<float>(mesh_.delta));
  found_.resize(std::max(found_.size(), block_count(awake_.size(), kTaskBlocks)));
  run_blocks(executor_, awake_.size(), kTaskBlocks, [&](size_t task, size_t begin, size_t end) {
    auto& wakers = found_[task];
    wakers.clear();
    for (size_t i = begin; i < end; ++i) {
      const uint32_t first = awake_[i] * kRingLanes;
      for (uint32_t v = first; v < first + kRingLanes; ++v) {
        const Vec3 moved = mesh_.displacement.at(v);
        const float normal = std::abs(dot(moved, mesh_.normal.at(v)));
        const bool calm = normal < along && dot(moved, moved) < slide * slide;
        mesh_.calm[v] = calm ? static_cast<uint8_t>(std::min(mesh_.calm[v] + 1, 255)) : uint8_t{0};
        // Whole steps only: what moves less than one in an iteration wakes nobody.
        const float moved_steps = std::min(normal * steps, 256.0F);
        const int stir = mesh_.stir[v] + static_cast<int>(moved_steps);
        if (stir >= 256) wakers.push_back(v);
        mesh_.stir[v] = stir >= 256 ? uint8_t{0} : static_cast<uint8_t>(stir);
      }
    }
  });
  for (size_t task = 0; task < block_count(awake_.size(), kTaskBlocks); ++task) {
    for (const uint32_t v : found_[task]) {
      const uint32_t d = mesh_.valence(v);
      for (uint32_t k = 0; k < d; ++k) mesh_.calm[mesh_.neighbor(v, k)] = 0;
    }
  }
}

void Sleep::wake_all() {
  std::fill(mesh_.calm.begin(), mesh_.calm.end(), uint8_t{0});
}

}  // namespace plc

#include "engine/motion/sleep.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numeric>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/base/marks.h"
#include "engine/mesh/turns.h"

namespace plc {

namespace {

constexpr size_t kTaskCalm = 512;  // blocks

struct Limits {
  float along;          // of calm vertices: less than this along the normal
  float slide_squared;  // ... and in all
  float steps;          // of drift, per mesh unit
  float turn;           // more than this along the normal, to the other side, is a turn
};

// Brings calm, drift and turns of a block's vertices up to date. Returns those that wake their
// neighbours, as bits. Loops over whole blocks without branches, which compilers make vector code
// of.
uint32_t observe_block(Mesh& mesh, uint8_t* calm_for, uint8_t* drifted, uint32_t first,
                       const Limits& limits) {
  const Streams3 &move = mesh.displacement, &normal = mesh.normal;
  const float *dx = &move.x[first], *dy = &move.y[first], *dz = &move.z[first];
  const float *nx = &normal.x[first], *ny = &normal.y[first], *nz = &normal.z[first];
  int32_t calm[kRingLanes], drift[kRingLanes];
  uint32_t side[kRingLanes];
  for (uint32_t k = 0; k < kRingLanes; ++k) {
    const float outwards = dx[k] * nx[k] + dy[k] * ny[k] + dz[k] * nz[k];
    const float along = std::abs(outwards);
    side[k] = static_cast<uint32_t>(outwards > limits.turn) +
              2 * static_cast<uint32_t>(outwards < -limits.turn);
    const float squared = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k];
    calm[k] = static_cast<int32_t>(along < limits.along) &
              static_cast<int32_t>(squared < limits.slide_squared);
    // Whole steps only: what moves less than one in an iteration wakes nobody.
    drift[k] = static_cast<int32_t>(std::min(along * limits.steps, 256.0F));
  }
  uint8_t* const turns = &mesh.turns[first];
  for (uint32_t k = 0; k < kRingLanes; ++k) turns[k] = moved_to_side(turns[k], side[k]);
  int32_t most = 0;
  for (uint32_t k = 0; k < kRingLanes; ++k) {
    calm_for[k] = static_cast<uint8_t>(calm[k] * std::min(calm_for[k] + 1, 255));
    drift[k] += drifted[k];
    most = std::max(most, drift[k]);
  }
  uint32_t wakers = 0;
  for (uint32_t k = 0; k < kRingLanes; ++k) {
    drifted[k] = drift[k] >= 256 ? uint8_t{0} : static_cast<uint8_t>(drift[k]);
  }
  if (most < 256) return 0;
  for (uint32_t k = 0; k < kRingLanes; ++k) wakers |= static_cast<uint32_t>(drift[k] >= 256) << k;
  return wakers;
}

// Forgets the turns of a block's vertices, which have none from before this iteration. Returns how
// many more of them have gone outwards than inwards.
int64_t forget_turns(uint8_t* turns) {
  int64_t excess = 0;
  for (uint32_t k = 0; k < kRingLanes; ++k) excess += outwards_of(turns[k]);
  std::fill_n(turns, kRingLanes, uint8_t{0});
  return excess;
}

}  // namespace

bool Sleep::all_calm(uint32_t block) const {
  const uint8_t* calm = calm_.data() + size_t{block} * kRingLanes;
  // Without a minimum, which GCC 12 looks for one by one.
  uint8_t restless[kRingLanes];
  for (uint32_t lane = 0; lane < kRingLanes; ++lane) restless[lane] = calm[lane] < kCalmPeriod;
  uint64_t halves[2];
  static_assert(sizeof halves == sizeof restless);
  std::memcpy(halves, restless, sizeof halves);
  return (halves[0] | halves[1]) == 0;
}

void Sleep::choose(bool all) {
  const uint32_t blocks = mesh_.padded() / kRingLanes;
  asleep_.resize(blocks, 0);
  to_sleep_.resize(blocks);
  run_blocks(executor_, blocks, kTaskCalm, [&](size_t, size_t begin, size_t end) {
    for (size_t block = begin; block < end; ++block) {
      to_sleep_[block] = !all && speeds_.calm > 0 && all_calm(static_cast<uint32_t>(block));
    }
  });
  awake_.clear();
  fallen_.clear();
  for (uint32_t block = 0; block < blocks; ++block) {
    if (to_sleep_[block] == 0) {
      awake_.push_back(block);
    } else if (asleep_[block] == 0) {
      fallen_.push_back(block);
      for (uint32_t v = block * kRingLanes; v < (block + 1) * kRingLanes; ++v) {
        mesh_.velocity.set(v, {});
        mesh_.displacement.set(v, {});
      }
    }
  }
  asleep_.swap(to_sleep_);
  any_asleep_ = awake_.size() < blocks;
  find_rim();
}

void Sleep::find_rim() {
  if (!any_asleep()) {
    awake_and_rim_ = awake_;
    return;
  }
  touched_.assign(asleep_.size(), 0);
  const RingView rings = mesh_.rings();
  run_blocks(executor_, awake_.size(), kTaskBlocks, [&](size_t, size_t begin, size_t end) {
    // Several tasks may write the same 1. Only where there is none yet: each write takes the cache
    // line from the other threads.
    const auto touch = [&](uint32_t block) {
      if (read_mark(touched_[block]) == 0) set_mark(touched_[block], 1);
    };
    for (size_t i = begin; i < end; ++i) {
      touch(awake_[i]);
      const uint32_t first = awake_[i] * kRingLanes;
      const uint16_t most =
          *std::max_element(rings.valence + first, rings.valence + first + kRingLanes);
      for (uint32_t k = 0; k < std::min<uint32_t>(most, kRingSlots); ++k) {
        // Slots past the valence hold the vertex itself.
        const uint32_t* column =
            rings.columns + (size_t{awake_[i]} * kRingColumns + k) * kRingLanes;
        uint32_t block[kRingLanes];
        for (uint32_t lane = 0; lane < kRingLanes; ++lane) block[lane] = column[lane] / kRingLanes;
        for (uint32_t lane = 0; lane < kRingLanes; ++lane) touch(block[lane]);
      }
      if (most <= kRingSlots) continue;
      for (uint32_t v = first; v < first + kRingLanes; ++v) {
        for (uint32_t k = kRingSlots; k < rings.valence[v]; ++k)
          touch(rings.slot(v, k) / kRingLanes);
      }
    }
  });
  awake_and_rim_.clear();
  for (uint32_t block = 0; block < touched_.size(); ++block) {
    if (touched_[block] != 0) awake_and_rim_.push_back(block);
  }
}

void Sleep::observe() {
  assert(to_sleep_.size() == mesh_.padded() / kRingLanes);  // choose() came before
  const auto delta = static_cast<float>(mesh_.delta);
  const float along = speeds_.calm * delta;
  const float slide = kCalmSlide * along;
  const Limits limits{along, slide * slide, 256 / (kWakeMove * delta), speeds_.turn * delta};
  found_.resize(std::max(found_.size(), block_count(awake_.size(), kTaskBlocks)));
  excess_.assign(block_count(awake_.size(), kTaskBlocks), 0);
  run_blocks(executor_, awake_.size(), kTaskBlocks, [&](size_t task, size_t begin, size_t end) {
    auto& wakers = found_[task];
    wakers.clear();
    for (size_t i = begin; i < end; ++i) {
      const uint32_t first = awake_[i] * kRingLanes;
      uint32_t waking = observe_block(mesh_, &calm_[first], &drift_[first], first, limits);
      if (travel_.going()) excess_[task] += forget_turns(&mesh_.turns[first]);
      for (; waking != 0; waking &= waking - 1) {
        wakers.push_back(first + static_cast<uint32_t>(std::countr_zero(waking)));
      }
    }
  });
  // Several tasks may write the same 0.
  executor_.run(block_count(awake_.size(), kTaskBlocks), [&](size_t task) {
    for (const uint32_t v : found_[task]) {
      const uint32_t d = mesh_.valence(v);
      for (uint32_t k = 0; k < d; ++k) {
        set_mark(calm_[mesh_.neighbor(v, k)], 0);
      }
    }
  });
  if (travel_.going()) {
    travel_.observe(std::accumulate(excess_.begin(), excess_.end(), int64_t{0}),
                    mesh_.vertex_count());
  }
}

void Sleep::save(StateWriter& to) const {
  calm_.save(to);
  drift_.save(to);
  to.add_all(asleep_);
  travel_.save(to);
}

void Sleep::restore(StateReader& from) {
  calm_.restore(from);
  drift_.restore(from);
  from.read_all(asleep_);
  travel_.restore(from);
  from.demand(asleep_.size() <= mesh_.padded() / kRingLanes);
}

}  // namespace plc

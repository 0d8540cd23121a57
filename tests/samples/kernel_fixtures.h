// Inputs for the tests of kernels/ and pyramid/: random rings, bitwise comparison, threads.
#pragma once
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include "kernels/ring.h"
#include "kernels/separable.h"
#include "kernels/simd.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace fixtures {

// Index of the first value whose bits differ (every NaN counts as the same), or -1.
inline int64_t first_difference(const std::vector<float>& a, const std::vector<float>& b) {
  if (a.size() != b.size()) return 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) && std::isnan(b[i])) continue;
    if (std::memcmp(&a[i], &b[i], sizeof a[i]) != 0) {
      return static_cast<int64_t>(i);
    }
  }
  return -1;
}

inline std::vector<float> flatten(const std::vector<plc::Float4>& records) {
  std::vector<float> all;
  for (const plc::Float4& r : records) all.insert(all.end(), {r.x, r.y, r.z, r.w});
  return all;
}

// Not the distributions of the standard library: golden values must not depend on whose it is.
inline float random_float(std::mt19937& random, float low, float high) {
  return low + (high - low) * (static_cast<float>(random() >> 8) / 16777216.0F);
}
inline uint32_t random_integer(std::mt19937& random, uint32_t low, uint32_t high) {
  return low + static_cast<uint32_t>(random() % (high - low + 1));
}
inline std::vector<float> random_floats(size_t count, float low, float high, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> values(count);
  for (float& v : values) v = random_float(random, low, high);
  return values;
}

// A sentinel for output that must stay as it is.
inline constexpr float kUntouched = 1234.5F;

// Rings of random neighbours: not a surface, which the kernels do not ask for.
class RandomRings {
 public:
  // valence_of(v) may be anything; neighbours are other vertices of valence > 0, all different from
  // their centre.
  template <typename ValenceOf>
  RandomRings(uint32_t blocks, uint32_t seed, const ValenceOf& valence_of)
      : columns_(size_t{blocks} * plc::kRingColumns * plc::kRingLanes),
        valence_(size_t{blocks} * plc::kRingLanes),
        rings(size_t{blocks} * plc::kRingLanes),
        position(size_t{blocks} * plc::kRingLanes) {
    std::mt19937 random(seed);
    const auto count = static_cast<uint32_t>(rings.size());
    for (uint32_t v = 0; v < count; ++v) valence_[v] = static_cast<uint16_t>(valence_of(v, random));
    for (uint32_t v = 0; v < count; ++v) {
      while (rings[v].size() < valence_[v]) {
        const uint32_t u = random_integer(random, 0, count - 1);
        if (u != v && valence_[u] != 0) rings[v].push_back(u);
      }
    }
    for (plc::Float4& p : position) {
      for (float* c : {&p.x, &p.y, &p.z}) *c = random_float(random, -40.0F, 250.0F);
      p.w = 0;
    }
    lay_out();
  }

  uint32_t count() const { return static_cast<uint32_t>(rings.size()); }
  plc::RingView view() const { return {columns_.data(), valence_.data(), tail_.data()}; }

 private:
  plc::Vector<uint32_t> columns_;
  std::vector<uint16_t> valence_;
  plc::Vector<uint32_t> tail_;

  void lay_out() {
    for (uint32_t v = 0; v < count(); ++v) {
      const auto column = [&](uint32_t c) -> uint32_t& {
        return columns_[(v / plc::kRingLanes * plc::kRingColumns + c) * plc::kRingLanes +
                        v % plc::kRingLanes];
      };
      for (uint32_t k = 0; k < plc::kRingSlots; ++k) {
        column(k) = k < rings[v].size() ? rings[v][k] : v;
      }
      // Where there is no tail the offset is nonsense, as it may be in the engine.
      column(plc::kRingSlots) = 0xDEADBEEFU;
      if (rings[v].size() <= plc::kRingSlots) continue;
      column(plc::kRingSlots) = static_cast<uint32_t>(tail_.size());
      tail_.insert(tail_.end(), rings[v].begin() + plc::kRingSlots, rings[v].end());
    }
  }

 public:
  std::vector<plc::Vector<uint32_t>> rings;
  std::vector<plc::Float4> position;
};

// Dead vertices, common valences and long tails side by side.
inline RandomRings mixed_rings(uint32_t blocks, uint32_t seed) {
  return {blocks, seed, [](uint32_t v, std::mt19937& random) {
            if (v % 7 == 3) return 0U;
            if (v % 16 == 6) return plc::kRingSlots;  // the longest ring that needs no tail
            return v % 16 == 5 ? random_integer(random, 12, 30) : random_integer(random, 3, 10);
          }};
}

// Any taps: irregular first places, random weights.
struct Taps {
  std::vector<int32_t> first;
  std::vector<float> weights;
  plc::kernels::TapsView view;
  Taps(size_t inputs, size_t outputs, int32_t taps, uint32_t seed)
      : weights(random_floats(outputs * static_cast<size_t>(taps), 0.0F, 0.4F, seed)) {
    const size_t last = inputs - static_cast<size_t>(taps);
    for (size_t i = 0; i < outputs; ++i) {
      first.push_back(static_cast<int32_t>(outputs == 1 ? last : i * last / (outputs - 1)));
    }
    view = {first.data(), weights.data(), taps};
  }
};

class ThreadExecutor final : public plc::Executor {
 public:
  explicit ThreadExecutor(unsigned threads, plc::SimdTarget simd = plc::best_simd_target())
      : Executor(simd), threads_(threads) {}
  void run(size_t tasks, const std::function<void(size_t)>& body) const override {
    std::atomic<size_t> next{tasks};  // from the last to the first: unlike SerialExecutor
    std::vector<std::thread> threads;
    for (unsigned t = 0; t < threads_; ++t) {
      threads.emplace_back([&] {
        for (size_t left = next--; left != 0 && left <= tasks; left = next--) body(left - 1);
      });
    }
    for (std::thread& thread : threads) thread.join();
  }

 private:
  unsigned threads_;
};

}  // namespace fixtures

// Neighbour rings of closed sample meshes.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/ring.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_meshes.h"

namespace samples {

struct Rings {
  plc::Vector<uint32_t> columns;
  std::vector<uint16_t> valence;
  plc::Vector<uint32_t> tail;
  std::vector<plc::Float4> positions;

  plc::RingView view() const { return {columns.data(), valence.data(), tail.data()}; }
  uint32_t slots() const { return static_cast<uint32_t>(positions.size()); }
};

// Vertices keep their ids and are rounded to floats; those of no face are deleted ones.
inline Rings rings_of(const Soup& m) {
  const auto count = static_cast<uint32_t>(m.vertex_count());
  const uint32_t blocks = (count + plc::kRingLanes - 1) / plc::kRingLanes;
  Rings r;
  r.columns.assign(blocks * plc::kRingColumns * plc::kRingLanes, 0);
  r.valence.assign(blocks * plc::kRingLanes, 0);
  std::vector<std::vector<std::array<uint32_t, 2>>> steps(count);
  for (size_t f = 0; f < m.abc.size(); f += 3) {
    for (size_t k = 0; k < 3; ++k) {
      steps[m.abc[f + k]].push_back({m.abc[f + (k + 1) % 3], m.abc[f + (k + 2) % 3]});
    }
  }
  for (uint32_t v = 0; v < count; ++v) {
    r.positions.push_back({static_cast<float>(m.xyz[3 * v]), static_cast<float>(m.xyz[3 * v + 1]),
                           static_cast<float>(m.xyz[3 * v + 2]), 0});
    plc::Vector<uint32_t> ring;
    if (!steps[v].empty()) ring.push_back(steps[v][0][0]);
    while (ring.size() < steps[v].size()) {
      for (const auto& step : steps[v]) {
        if (step[0] == ring.back()) {
          ring.push_back(step[1]);
          break;
        }
      }
    }
    r.valence[v] = static_cast<uint16_t>(ring.size());
    const auto column = [&](uint32_t k) -> uint32_t& {
      return r.columns[(v / plc::kRingLanes * plc::kRingColumns + k) * plc::kRingLanes +
                       v % plc::kRingLanes];
    };
    for (uint32_t k = 0; k < plc::kRingSlots; ++k) column(k) = k < ring.size() ? ring[k] : v;
    column(plc::kRingSlots) = static_cast<uint32_t>(r.tail.size());
    for (size_t k = plc::kRingSlots; k < ring.size(); ++k) r.tail.push_back(ring[k]);
  }
  return r;
}

}  // namespace samples

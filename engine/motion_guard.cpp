#include "engine/motion_guard.h"

#include <algorithm>
#include <utility>

#include "engine/constants.h"
#include "engine/edge.h"

namespace plc {

namespace {

constexpr size_t kChunk = 256;  // vertices per task

}  // namespace

int64_t MotionGuard::take_back(const Buffer<Packed>& before, const std::vector<uint32_t>& due,
                               SpatialHash& hash) {
  assess(due, hash);
  int64_t taken_back = 0;
  for (int64_t now = 1; now != 0; taken_back += now) {
    now = 0;
    const auto& pairs = search_.find(mesh_.rings(), mesh_.slots(), mesh_.packed.data(),
                                     mesh_.risk.data(), executor_);
    for (const auto& [f, g] : pairs) {
      now += put_back(search_.face(f), before, hash) + put_back(search_.face(g), before, hash);
    }
  }
  return taken_back;
}

// Returns how many of the face's vertices were not where they had been.
int64_t MotionGuard::put_back(const uint32_t* face, const Buffer<Packed>& before,
                              SpatialHash& hash) {
  int64_t count = 0;
  for (int i = 0; i < 3; ++i) {
    const uint32_t v = face[i];
    const Packed& b = before[v];
    const Packed& p = mesh_.packed[v];
    mesh_.velocity.set(v, {});
    if (b.x == p.x && b.y == p.y && b.z == p.z) continue;
    mesh_.place(v, {b.x, b.y, b.z});
    hash.insert(v, mesh_.at(v));
    ++count;
  }
  return count;
}

void MotionGuard::assess(const std::vector<uint32_t>& due, const SpatialHash& hash) {
  // Normals of the movement's start are at hand for all: sheets do not turn over in a step.
  const size_t chunks = (due.size() + kChunk - 1) / kChunk;
  risks_.resize(std::max(risks_.size(), chunks));
  executor_.run(chunks, [&](size_t chunk) {
    risks_[chunk].clear();
    const size_t end = std::min((chunk + 1) * kChunk, due.size());
    for (size_t i = chunk * kChunk; i < end; ++i) list_risks(due[i], hash, risks_[chunk]);
  });
  for (const uint32_t v : due) mesh_.risk[v] = 0;
  for (size_t chunk = 0; chunk < chunks; ++chunk) {
    for (const uint32_t v : risks_[chunk]) mesh_.risk[v] = 1;
  }
}

bool MotionGuard::folded(uint32_t v, const Neighbors& ring) const {
  const Vec3 p = mesh_.at(v);
  const Vec3 n = mesh_.normal.at(v);
  for (uint32_t k = 0; k < ring.size(); ++k) {
    const Vec3 area = area_vector(p, mesh_.at(ring[k]), mesh_.at(ring.next(k)));
    if (dot(area, n) <= kRiskDot * length(area)) return true;
  }
  return false;
}

// Appends v and what it is at risk with, if any.
void MotionGuard::list_risks(uint32_t v, const SpatialHash& hash,
                             std::vector<uint32_t>& risks) const {
  const Vec3 p = mesh_.at(v);
  const Vec3 n = mesh_.normal.at(v);
  const Neighbors ring = mesh_.ring(v);
  const size_t before = risks.size();
  const float reach = kRiskReach * static_cast<float>(mesh_.delta);
  const Vec3 span{reach, reach, reach};
  hash.visit_box(mesh_, p - span, p + span, [&](uint32_t w, Vec3 q) {
    if (w == v || squared_distance(p, q) > reach * reach) return;
    if (dot(n, mesh_.normal.at(w)) <= kRiskDot && !ring.contains(w) && !apart(v, ring, w)) {
      risks.push_back(w);
    }
  });
  if (risks.size() != before || folded(v, ring)) risks.push_back(v);
}

// A plane across the normal of v or of w lies between their faces, with room on both sides. They
// may face each other, or turn their backs.
bool MotionGuard::apart(uint32_t v, const Neighbors& ring, uint32_t w) const {
  const float gap = kRiskGap * static_cast<float>(mesh_.delta);
  const Neighbors other = mesh_.ring(w);
  const auto extent = [&](uint32_t centre, const Neighbors& around, Vec3 axis) {
    float low = dot(mesh_.at(centre), axis);
    float high = low;
    for (const uint32_t x : around) {
      const float at = dot(mesh_.at(x), axis);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    return std::pair{low, high};
  };
  for (const Vec3 axis : {mesh_.normal.at(v), mesh_.normal.at(w)}) {
    const auto [low_v, high_v] = extent(v, ring, axis);
    const auto [low_w, high_w] = extent(w, other, axis);
    if (low_w - high_v >= gap || low_v - high_w >= gap) return true;
  }
  return false;
}

}  // namespace plc

#include "engine/guard/motion_guard.h"

#include <algorithm>
#include <cassert>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/mesh/turns.h"
#include "kernels/ring_forces.h"
#include "pyramid/memory.h"

namespace plc {

void MotionGuard::find_folds(const Vector<uint32_t>& blocks) {
  assert(std::is_sorted(blocks.begin(), blocks.end()));
  assert(blocks.empty() || blocks.back() < mesh_.padded() / kRingLanes);
  folds_.resize_uninitialized(mesh_.padded());
  const Streams3& n = mesh_.normal;
  const size_t tasks = block_count(blocks.size(), kTaskBlocks);
  found_.resize(std::max(found_.size(), tasks));
  run_blocks(executor_, blocks.size(), kTaskBlocks, [&](size_t task, size_t begin, size_t end) {
    Vector<uint32_t>& found = found_[task];
    found.clear();
    const Blocks part = Blocks::of(blocks.data(), blocks.size(), begin, end);
    kernels::turned_faces(executor_.simd(), mesh_.rings(), mesh_.position.data(), part,
                          {n.x.data(), n.y.data(), n.z.data()}, kRiskDot, folds_.data());
    for (size_t i = 0; i < part.count; ++i) {
      for (uint32_t v = part.begin(i); v < part.begin(i) + kRingLanes; ++v) {
        if (folds_[v] != 0 && (risk_[v] & kFoldRisk) == 0) found.push_back(v);
        const uint32_t near = risk_[v] & kNearRisk;
        risk_[v] = static_cast<uint8_t>(near | uint32_t{folds_[v]} * kFoldRisk);
      }
    }
  });
  newly_folded_.clear();
  for (size_t task = 0; task < tasks; ++task) {
    newly_folded_.insert(newly_folded_.end(), found_[task].begin(), found_[task].end());
  }
}

void MotionGuard::assess(const Vector<uint32_t>& due, const Vector<uint32_t>& at_risk) {
  for (const uint32_t v : due) risk_[v] &= kFoldRisk;
  for (const uint32_t v : at_risk) risk_[v] |= kNearRisk;
}

int64_t MotionGuard::take_back(const Buffer<Float4>& before, SpatialHash& hash,
                               Vector<uint32_t>& back) {
  const size_t first = back.size();
  const Vector<FacePair>* pairs = &search_.find(mesh_.rings(), mesh_.slots(), mesh_.position.data(),
                                                risk_.data(), executor_, before.data());
  // All corners of two faces that meet go back: what can meet then has a corner among them.
  for (size_t done = first;; done = back.size()) {
    for (const auto& [f, g] : *pairs) {
      put_back(search_.face(f), before, hash, back);
      put_back(search_.face(g), before, hash, back);
    }
    if (back.size() == done) break;
    pairs = &search_.find_changed(back.data() + done, back.size() - done, executor_);
  }
  return static_cast<int64_t>(back.size() - first);
}

// Those corners of the face that are not where they had been.
void MotionGuard::put_back(const uint32_t* face, const Buffer<Float4>& before, SpatialHash& hash,
                           Vector<uint32_t>& back) {
  for (int i = 0; i < 3; ++i) {
    const uint32_t v = face[i];
    const Float4& b = before[v];
    const Float4& p = mesh_.position[v];
    mesh_.velocity.set(v, {});
    if (b.x == p.x && b.y == p.y && b.z == p.z) continue;
    mesh_.place(v, {b.x, b.y, b.z});
    hash.insert(v, mesh_.at(v));
    back.push_back(v);
    mesh_.turns[v] = turned(mesh_.turns[v], 1);
  }
}

}  // namespace plc

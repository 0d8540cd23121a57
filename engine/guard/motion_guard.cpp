#include "engine/guard/motion_guard.h"

#include <algorithm>
#include <cassert>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/base/four.h"
#include "engine/guard/obstacles.h"
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
  const Vector<FacePair>* pairs =
      &search_.find(mesh_.rings(), mesh_.slots(), mesh_.position.data(), risk_.data(), executor_,
                    before.data(), mesh_.held_ids(), strays_.data());
  // All corners of two faces that meet go back: what can meet then has a corner among them.
  for (size_t done = first;; done = back.size()) {
    for (const auto& [f, g] : *pairs) {
      put_back(search_.face(f), before, hash, back);
      put_back(search_.face(g), before, hash, back);
    }
    const bool pressed = mesh_.obstacles != nullptr && keep_clear(before, hash, back);
    if (back.size() == done) break;
    // What obstacles hold is at risk where it was not listed.
    pairs = pressed
                ? &search_.find(mesh_.rings(), mesh_.slots(), mesh_.position.data(), risk_.data(),
                                executor_, before.data(), mesh_.held_ids(), strays_.data())
                : &search_.find_changed(back.data() + done, back.size() - done, executor_);
  }
  return static_cast<int64_t>(back.size() - first);
}

// visit(corners, where they are, where they were) of each face around vertices begin .. end - 1 of
// which it has the lowest id, and that has moved.
template <typename Visit>
void MotionGuard::visit_moved(size_t begin, size_t end, const Buffer<Float4>& before,
                              const Visit& visit) const {
  const auto was = [&](uint32_t v) { return Vec3{before[v].x, before[v].y, before[v].z}; };
  const auto moved = [&](uint32_t v) {
    return !same_four(load_four(mesh_.position[v]), load_four(before[v]));
  };
  for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
    const uint32_t d = mesh_.valence(v);
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t a = mesh_.neighbor(v, k), b = mesh_.neighbor(v, k + 1 == d ? 0 : k + 1);
      if (a < v || b < v || !(moved(v) || moved(a) || moved(b))) continue;
      visit(std::array{v, a, b}, Corners{mesh_.at(v), mesh_.at(a), mesh_.at(b)},
            Corners{was(v), was(a), was(b)});
    }
  }
}

void MotionGuard::press(size_t begin, size_t end, const Buffer<Float4>& before,
                        Pressed& found) const {
  found.refused.clear();
  found.near.clear();
  visit_moved(begin, end, before,
              [&](const std::array<uint32_t, 3>& face, const Corners& now, const Corners& was) {
                const Corners both[2] = {now, was};
                if (mesh_.obstacles->refuse(now, &was, 1)) {
                  found.refused.push_back(face);
                } else if (mesh_.obstacles->any_near(both, 2)) {
                  found.near.push_back(face);
                }
              });
}

bool MotionGuard::passes_over(const Buffer<Float4>& before) const {
  Vector<Corners> all_before, all_now;
  visit_moved(0, mesh_.slots(), before,
              [&](const std::array<uint32_t, 3>&, const Corners& now, const Corners& was) {
                all_now.push_back(now);
                all_before.push_back(was);
              });
  return mesh_.obstacles->passed_over(all_before, all_now);
}

// Puts back what the obstacles refuse. Around it the surface has become another one than that whose
// risk is known, so that all of it is at risk. Whether anything went back.
bool MotionGuard::keep_clear(const Buffer<Float4>& before, SpatialHash& hash,
                             Vector<uint32_t>& back) {
  const size_t tasks = block_count(mesh_.slots(), kGrain);
  pressed_.resize(std::max(pressed_.size(), tasks));
  run_blocks(executor_, mesh_.slots(), kGrain, [&](size_t task, size_t begin, size_t end) {
    press(begin, end, before, pressed_[task]);
  });
  const auto any = [&](const auto& list) {
    return std::any_of(pressed_.begin(), pressed_.begin() + static_cast<ptrdiff_t>(tasks),
                       [&](const Pressed& p) { return !list(p).empty(); });
  };
  const auto refused = [](const Pressed& p) -> const auto& {
    return p.refused;
  };
  const auto near = [](const Pressed& p) -> const auto& {
    return p.near;
  };
  const bool passing = !any(refused) && any(near) && passes_over(before);
  const size_t before_it = back.size();
  for (size_t task = 0; task < tasks; ++task) {
    for (const auto& face : passing ? pressed_[task].near : pressed_[task].refused) {
      put_back(face.data(), before, hash, back);
      for (const uint32_t v : face) {
        risk_[v] |= kNearRisk;
        for (uint32_t k = 0; k < mesh_.valence(v); ++k) risk_[mesh_.neighbor(v, k)] |= kNearRisk;
      }
    }
  }
  return back.size() > before_it;
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

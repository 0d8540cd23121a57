#include "engine/motion_guard.h"

namespace plc {

void MotionGuard::assess(const std::vector<uint32_t>& due, const std::vector<uint32_t>& at_risk) {
  for (const uint32_t v : due) mesh_.risk[v] = 0;
  for (const uint32_t v : at_risk) mesh_.risk[v] = 1;
}

int64_t MotionGuard::take_back(const Buffer<Packed>& before, SpatialHash& hash,
                               std::vector<uint32_t>& back) {
  int64_t taken_back = 0;
  for (int64_t now = 1; now != 0; taken_back += now) {
    now = 0;
    const auto& pairs = search_.find(mesh_.rings(), mesh_.slots(), mesh_.packed.data(),
                                     mesh_.risk.data(), executor_);
    for (const auto& [f, g] : pairs) {
      now += put_back(search_.face(f), before, hash, back) +
             put_back(search_.face(g), before, hash, back);
    }
  }
  return taken_back;
}

// Returns how many of the face's vertices were not where they had been.
int64_t MotionGuard::put_back(const uint32_t* face, const Buffer<Packed>& before, SpatialHash& hash,
                              std::vector<uint32_t>& back) {
  int64_t count = 0;
  for (int i = 0; i < 3; ++i) {
    const uint32_t v = face[i];
    const Packed& b = before[v];
    const Packed& p = mesh_.packed[v];
    mesh_.velocity.set(v, {});
    if (b.x == p.x && b.y == p.y && b.z == p.z) continue;
    mesh_.place(v, {b.x, b.y, b.z});
    hash.insert(v, mesh_.at(v));
    back.push_back(v);
    ++count;
  }
  return count;
}

}  // namespace plc

#include "engine/motion_guard.h"

#include "engine/self_meeting.h"

namespace plc {

int64_t MotionGuard::take_back(const Buffer<Packed>& before) {
  int64_t taken_back = 0;
  for (;;) {
    const auto meeting = meeting_faces(mesh_, executor_);
    int64_t now = 0;
    for (const auto& face : meeting) {
      for (const uint32_t v : face) {
        const Packed& b = before[v];
        const Packed& p = mesh_.packed[v];
        mesh_.velocity.set(v, {});
        if (b.x == p.x && b.y == p.y && b.z == p.z) continue;
        mesh_.place(v, {b.x, b.y, b.z});
        ++now;
      }
    }
    if (now == 0) return taken_back;
    taken_back += now;
  }
}

}  // namespace plc

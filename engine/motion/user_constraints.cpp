#include "engine/motion/user_constraints.h"

#include <algorithm>
#include <cmath>

namespace plc {

namespace {

float squared_millimetres(const UserConstraints& user, Vec3 a) {
  const auto& s = user.millimetres;
  const Vec3 scaled{a.x * s[0], a.y * s[1], a.z * s[2]};
  const auto& c = user.cosines;
  return dot(scaled, scaled) +
         2 * (c[0] * scaled.x * scaled.y + c[1] * scaled.y * scaled.z + c[2] * scaled.z * scaled.x);
}

// The attachments that reach into the box of the vertices begin .. end-1: these are near each other
// in space, as ids follow a space-filling curve.
std::vector<Attachment> reaching(const UserConstraints& user, const Float4* position,
                                 uint32_t begin, uint32_t end) {
  Vec3 low{position[begin].x, position[begin].y, position[begin].z};
  Vec3 high = low;
  for (uint32_t v = begin; v < end; ++v) {
    const Float4& p = position[v];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  std::vector<Attachment> near;
  for (const Attachment& a : user.attachments) {
    const auto outside = [](float x, float least, float most) {
      return std::max({least - x, x - most, 0.0F});
    };
    const Vec3 away{outside(a.place.x, low.x, high.x), outside(a.place.y, low.y, high.y),
                    outside(a.place.z, low.z, high.z)};
    // Where axes lean the nearest point of the box may be another one: all are taken.
    const bool leaning = user.cosines != std::array<float, 3>{};
    if (leaning || squared_millimetres(user, away) < a.radius * a.radius) near.push_back(a);
  }
  return near;
}

}  // namespace

float UserConstraints::stiffness() const {
  float most = 0;
  for (const Attachment& a : attachments) most = std::max(most, a.strength);
  return most;
}

void attach(const UserConstraints& user, const Motion& motion, const Float4* position,
            const Streams3& normal, uint32_t begin, uint32_t end, Streams3& force) {
  if (begin == end) return;
  const std::vector<Attachment> near = reaching(user, position, begin, end);
  if (near.empty()) return;
  for (uint32_t v = begin; v < end; ++v) {
    const Vec3 p{position[v].x, position[v].y, position[v].z};
    const Vec3 n = normal.at(v);
    float weights = 0;
    float stiffness = 0;
    float pull = 0;
    for (const Attachment& a : near) {
      const Vec3 way = a.place - p;
      const float part = squared_millimetres(user, way) / (a.radius * a.radius);
      if (!(part < 1)) continue;
      const float w = (1 - part) * (1 - part);
      weights += w;
      stiffness += w * a.strength;
      pull += w * a.strength * dot(way, n);
    }
    const float most = std::max(1.0F, weights);
    const float critical = 2 * std::sqrt(stiffness / most * motion.mass);
    const float damping = std::max(0.0F, critical - motion.damping);
    force.set(v, force.at(v) + n * (pull / most - damping * dot(motion.velocity.at(v), n)));
  }
}

bool pinned(const UserConstraints& user, Vec3 p) {
  return std::any_of(user.pins.begin(), user.pins.end(), [&](const Pin& pin) {
    return squared_millimetres(user, p - pin.place) < pin.radius * pin.radius;
  });
}

}  // namespace plc

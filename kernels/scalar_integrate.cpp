// Scalar twins of kernels/integrate.h and guided_stage.h.
#include <cmath>

#include "kernels/lane_sum.h"
#include "kernels/scalar.h"

namespace plc::kernels::scalar {

namespace {

Triple at(const ConstFloat3s& s, uint32_t i) {
  return {s.x[i], s.y[i], s.z[i]};
}
Triple at(const Float3s& s, uint32_t i) {
  return {s.x[i], s.y[i], s.z[i]};
}
void set(const Float3s& s, uint32_t i, const Triple& a) {
  s.x[i] = a.x;
  s.y[i] = a.y;
  s.z[i] = a.z;
}
float dot(const Triple& a, const Triple& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Triple times(const Triple& a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}

// One coordinate of one vertex; returns that coordinate of the next stage's position.
float rk4_coordinate(int stage, const Rk4Coefficients& c, float p, float v, float f, float& s,
                     float& d, float& a) {
  const float w = stage == 0 ? v : s;
  const float acceleration = (f - c.damping * w) * c.inverse_mass;
  if (stage == 3) {
    const float sixth = c.time_step / 6.0F;
    d = (d + w) * sixth;
    a = v + (a + acceleration) * sixth;
    return p;
  }
  if (stage != 0) d = (stage == 1 ? v : d) + (w + w);
  a = stage == 0 ? acceleration : a + (acceleration + acceleration);
  const float step = stage == 2 ? c.time_step : c.time_step * 0.5F;
  s = v + step * acceleration;
  return p + step * w;
}

// What stages change of a vertex.
struct Rk4State {
  Triple speed, moved, rate;
};

// Returns the next stage's position.
Float4 rk4_vertex(int stage, const Rk4Coefficients& c, const Rk4Streams& s, const Triple& force,
                  uint32_t i, Rk4State& state) {
  state = {at(s.speed, i), at(s.moved, i), at(s.rate, i)};
  const Float4& p = s.position[i];
  const Triple v = at(s.velocity, i);
  Rk4State& t = state;
  const float x = rk4_coordinate(stage, c, p.x, v.x, force.x, t.speed.x, t.moved.x, t.rate.x);
  const float y = rk4_coordinate(stage, c, p.y, v.y, force.y, t.speed.y, t.moved.y, t.rate.y);
  const float z = rk4_coordinate(stage, c, p.z, v.z, force.z, t.speed.z, t.moved.z, t.rate.z);
  return {x, y, z, 0.0F};
}

void advance_vertex(int stage, const Rk4Coefficients& c, const Rk4Streams& s, const Triple& force,
                    uint32_t i) {
  Rk4State state;
  const Float4 next = rk4_vertex(stage, c, s, force, i, state);
  set(s.moved, i, state.moved);
  set(s.rate, i, state.rate);
  if (stage == 3) return;
  set(s.speed, i, state.speed);
  s.stage[i] = next;
}

// What (5) is multiplied by where the size of an adaptive mesh is so much above delta.
float stiffness(const SurfaceForces& f, float above) {
  const float size = above > 0.0F ? 1.0F + above : 1.0F;
  const float part = 1.0F / (size * size);
  return (f.curvature * part + f.smoothing) * part;
}

// (5) and (7).
Triple surface_force(const SurfaceForces& f, float value, float above, uint32_t i) {
  Triple bent;
  if (f.ring.valence[i] != 0) {
    const Triple around =
        times(record_sum(f.ring, f.laplacian, i), 1.0F / static_cast<float>(f.ring.valence[i]));
    const Float4& own = f.laplacian[i];
    bent = times({own.x - around.x, own.y - around.y, own.z - around.z},
                 f.sized ? stiffness(f, above) : f.curvature);
  }
  const Triple push = times(at(f.normal, i), f.attraction * (f.iso - value));
  const Triple sum{bent.x + push.x, bent.y + push.y, bent.z + push.z};
  return f.sized ? times(sum, f.compliance[i]) : sum;
}

// Where the image is sampled for a vertex.
Float4 sampled_place(const SurfaceForces& f, uint32_t i) {
  const Float4& p = f.position[i];
  if (!f.sized) return p;
  const Triple n = at(f.normal, i);
  const Float4& l = f.laplacian[i];
  const float off = f.facets * dot({l.x, l.y, l.z}, n);
  return {p.x + n.x * off, p.y + n.y * off, p.z + n.z * off, 0.0F};
}

// What the mean over the middles of its edges adds to the value of a vertex.
float value_from_star(const SurfaceForces& f, const Float4* sizes, float own, uint32_t v) {
  const uint32_t valence = f.ring.valence[v];
  const float above = sizes[v].w > 0.0F ? sizes[v].w : 0.0F;
  const float part = above < f.star ? above : f.star;
  if (valence == 0 || valence > kRingSlots || !(part > 0.0F)) return 0;
  Float4 middle[kRingSlots];
  float value[kRingSlots];
  for (uint32_t k = 0; k < valence; ++k) {
    const Float4 &p = f.position[v], &q = f.position[f.ring.slot(v, k)];
    middle[k] = {(p.x + q.x) * 0.5F, (p.y + q.y) * 0.5F, (p.z + q.z) * 0.5F, 0.0F};
  }
  sample_trilinear(f.image, middle, 0, valence, value);
  float sum = 0;
  for (uint32_t k = 0; k < valence; ++k) sum += value[k];
  return (sum * (1.0F / static_cast<float>(valence)) - own) * part;
}

// The inverse of the stiffness of a vertex's forces.
float compliance(const SurfaceForces& f, const Float4* sizes, uint32_t v) {
  const Float4 p = sampled_place(f, v);
  const Triple reach = times(at(f.normal, v), f.reach);
  const Float4 ends[2] = {{p.x + reach.x, p.y + reach.y, p.z + reach.z, 0.0F},
                          {p.x - reach.x, p.y - reach.y, p.z - reach.z, 0.0F}};
  float value[2];
  sample_trilinear(f.image, ends, 0, 2, value);
  const float pull = std::abs((value[0] - value[1]) * (f.attraction / (f.reach + f.reach)));
  const float most = 1.0F / (pull + static_cast<float>(kBendStiffness) * stiffness(f, sizes[v].w));
  return most < kMostCompliance ? most : kMostCompliance;
}

// The image's values for the vertices of a block.
void block_values(int stage, const SurfaceForces& f, const Float4* sizes, uint32_t begin,
                  float* values) {
  Float4 places[kRingLanes];
  for (uint32_t l = 0; l < kRingLanes; ++l) places[l] = sampled_place(f, begin + l);
  sample_trilinear(f.image, places, 0, kRingLanes, values);
  if (!f.sized) return;
  for (uint32_t l = 0; l < kRingLanes; ++l) {
    float& from_star = f.from_star[begin + l];
    if (stage == 0) {
      from_star = value_from_star(f, sizes, values[l], begin + l);
      f.compliance[begin + l] = compliance(f, sizes, begin + l);
    }
    values[l] = values[l] + from_star;
  }
}

// visit(vertex, its force) for every vertex of the blocks.
template <typename Visit>
void for_forces(int stage, const SurfaceForces& f, const Rk4Streams& s, const Blocks& blocks,
                const Visit& visit) {
  for (size_t b = 0; b < blocks.count; ++b) {
    const uint32_t begin = blocks.begin(b);
    float values[kRingLanes];
    block_values(stage, f, s.position, begin, values);
    for (uint32_t l = 0; l < kRingLanes; ++l) {
      visit(begin + l, surface_force(f, values[l], s.position[begin + l].w, begin + l));
    }
  }
}

Triple shortened(const Triple& a, float longest) {
  const float length = std::sqrt(dot(a, a));
  return length > longest ? times(a, longest / length) : a;
}

// The sums of move().
struct Sums {
  float counted;
  double lane[kRingLanes] = {};
  float longest = 0;
  void add(const Triple& by, const Triple& normal, uint32_t i) {
    const float along = std::abs(dot(by, normal));
    const auto counts = static_cast<double>(along < counted ? along : counted);
    lane[i % kRingLanes] += counts * counts;
    longest = dot(by, by) > longest ? dot(by, by) : longest;
  }
};

float slowness(uint32_t turns, uint32_t free_turns) {
  if (turns <= free_turns) return 1;
  const uint32_t beyond = turns - free_turns;
  return beyond < kSlowingTurns ? 1.0F / static_cast<float>(1U << beyond) : 0.0F;
}

void move_vertex(const MoveBound& bound, const Triple& displacement, const Triple& new_velocity,
                 const Float3s& moved, const MoveStreams& s, uint32_t i, Sums& sums) {
  const uint32_t turns = s.turns[i] & kTurnsMask;
  const Float4& p = s.position[i];
  const float slowed = slowness(turns, bound.free_turns) * (1.0F + p.w < 1.0F ? 1.0F + p.w : 1.0F);
  const Triple by = shortened(displacement, bound.length * slowed);
  set(moved, i, by);
  const float fastest = turns <= bound.swinging_turns ? bound.speed * slowed : 0;
  set(s.velocity, i, shortened(new_velocity, fastest));
  s.moved_to[i] = {p.x + by.x, p.y + by.y, p.z + by.z, p.w};
  s.path[i] += std::sqrt(dot(by, by));
  sums.add(by, at(s.normal, i), i);
}

}  // namespace

void rk4_stage(int stage, const Rk4Coefficients& coefficients, const Rk4Streams& streams,
               const ConstFloat3s& force, const Blocks& blocks) {
  for_vertices(blocks,
               [&](uint32_t i) { advance_vertex(stage, coefficients, streams, at(force, i), i); });
}

float max_squared(const ConstFloat3s& moved, const Blocks& blocks) {
  float longest = 0;
  for_vertices(blocks, [&](uint32_t i) {
    const float length = dot(at(moved, i), at(moved, i));
    longest = length > longest ? length : longest;
  });
  return longest;
}

Movement move(const MoveBound& bound, const Float3s& moved, const ConstFloat3s& new_velocity,
              const MoveStreams& streams, const Blocks& blocks) {
  Sums sums{bound.counted};
  for_vertices(blocks, [&](uint32_t i) {
    move_vertex(bound, at(moved, i), at(new_velocity, i), moved, streams, i, sums);
  });
  return {add_lanes(sums.lane), sums.longest};
}

void guided_stage(int stage, const Rk4Coefficients& coefficients, const SurfaceForces& forces,
                  const Rk4Streams& streams, const Blocks& blocks) {
  for_forces(stage, forces, streams, blocks, [&](uint32_t i, const Triple& force) {
    advance_vertex(stage, coefficients, streams, force, i);
  });
}

Movement guided_move(const Rk4Coefficients& coefficients, const SurfaceForces& forces,
                     const Rk4Streams& streams, const MoveBound& bound, const MoveStreams& ends,
                     const Blocks& blocks) {
  Sums sums{bound.counted};
  for_forces(3, forces, streams, blocks, [&](uint32_t i, const Triple& force) {
    Rk4State end;
    rk4_vertex(3, coefficients, streams, force, i, end);
    move_vertex(bound, end.moved, end.rate, streams.moved, ends, i, sums);
  });
  return {add_lanes(sums.lane), sums.longest};
}

void sized_iso_force(int stage, const SurfaceForces& forces, const Float4* sizes, uint32_t begin,
                     uint32_t end, Float3s force) {
  for (uint32_t first = begin; first < end; first += kRingLanes) {
    float values[kRingLanes];
    block_values(stage, forces, sizes, first, values);
    for (uint32_t i = first; i < first + kRingLanes; ++i) {
      const float push = forces.attraction * (forces.iso - values[i - first]);
      const Triple n = times(at(forces.normal, i), push);
      force.x[i] = force.x[i] + n.x;
      force.y[i] = force.y[i] + n.y;
      force.z[i] = force.z[i] + n.z;
    }
  }
}

}  // namespace plc::kernels::scalar

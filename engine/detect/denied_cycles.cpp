#include "engine/detect/denied_cycles.h"

#include <algorithm>

namespace plc {

namespace {

// Cosine of an angle by which a face turns from the normal at its corner, wherever three or four
// edges go around: at the corners of a square tube by 45 degrees.
constexpr float kBend = 0.8F;
// Vertices on one side of a cycle that goes around nothing, at most.
constexpr uint32_t kFew = 8;

Vec3 centre_of(const Mesh& mesh, const Cycle& cycle) {
  Vec3 sum;
  for (uint32_t i = 0; i < cycle.size; ++i) sum = sum + mesh.at(cycle.corner[i]);
  return sum * (1.0F / static_cast<float>(cycle.size));
}

// By the surface; else around a way through it.
bool is_around_object(const Mesh& mesh, const Cycle& cycle, Vec3 centre) {
  float outward = 0;
  for (uint32_t i = 0; i < cycle.size; ++i) {
    const uint32_t v = cycle.corner[i];
    outward += dot(vertex_normal(mesh, v), mesh.at(v) - centre);
  }
  return (outward > 0) != mesh.inside_out;
}

bool bounds_few(const Mesh& mesh, const Cycle& cycle, bool left) {
  const auto begin = cycle.corner.begin(), end = begin + cycle.size;
  const uint32_t next = cycle.corner[1], previous = cycle.corner[cycle.size - 1];
  Neighbors reached =
      arc_between(mesh, cycle.corner[0], left ? next : previous, left ? previous : next);
  for (uint32_t i = 0; i < reached.size() && reached.size() <= kFew; ++i) {
    const uint32_t d = mesh.valence(reached[i]);
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t w = mesh.neighbor(reached[i], k);
      if (std::find(begin, end, w) == end && !reached.contains(w)) reached.push_back(w);
    }
  }
  return reached.size() <= kFew;
}
bool bounds_few(const Mesh& mesh, const Cycle& cycle) {
  return bounds_few(mesh, cycle, true) || bounds_few(mesh, cycle, false);
}

// Steps from u along two edges that lead away from its ring.
struct Steps {
  Neighbors to;
  Neighbors by;  // which neighbour of u
};

// Also fills in the steps from u.
std::optional<Cycle> denied_triangle(const Mesh& mesh, uint32_t u, const Neighbors& ring,
                                     Steps& steps) {
  for (uint32_t i = 0; i < ring.size(); ++i) {
    const uint32_t v = ring[i], d = mesh.valence(v);
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t w = mesh.neighbor(v, k);
      if (w == u || w == ring.next(i) || w == ring.previous(i)) continue;
      if (!ring.contains(w)) {
        steps.to.push_back(w);
        steps.by.push_back(i);
        continue;
      }
      const Cycle cycle{{u, v, w}};
      if (!image_has(mesh, cycle) && !bounds_few(mesh, cycle)) return cycle;
    }
  }
  return std::nullopt;
}

std::optional<Cycle> denied_quadrangle(const Mesh& mesh, uint32_t u, const Neighbors& ring,
                                       const Steps& steps) {
  for (uint32_t p = 0; p < steps.to.size(); ++p) {
    for (uint32_t q = p + 1; q < steps.to.size(); ++q) {
      if (steps.to[p] != steps.to[q]) continue;
      const uint32_t v = ring[steps.by[p]], w = ring[steps.by[q]], across = steps.to[p];
      if (w == ring.next(steps.by[p]) || w == ring.previous(steps.by[p])) continue;
      Cycle cycle{{u, v, across, w}, 4};
      const float from_u = squared_distance(mesh.at(u), mesh.at(across));
      const float from_v = squared_distance(mesh.at(v), mesh.at(w));
      if (from_v < from_u) cycle.corner = {v, across, w, u};  // the shorter one becomes an edge
      const Vec3 centre = centre_of(mesh, cycle);
      const bool filled = mesh.sizing->inside(centre) && !is_around_object(mesh, cycle, centre);
      if (filled && !mesh.adjacent(v, w) && !bounds_few(mesh, cycle)) return cycle;
    }
  }
  return std::nullopt;
}

}  // namespace

bool image_has(const Mesh& mesh, const Cycle& cycle) {
  const Vec3 centre = centre_of(mesh, cycle);
  const bool object = is_around_object(mesh, cycle, centre);
  if (mesh.sizing->inside(centre) == object) return true;
  if (!object) return false;
  for (uint32_t i = 0; i < cycle.size; ++i) {
    const Vec3 a = mesh.at(cycle.corner[i]), b = mesh.at(cycle.corner[cycle.next(i)]);
    if (mesh.sizing->inside(midpoint(a, b))) return true;
  }
  return false;
}

std::optional<Candidate> denied_cycle(const Mesh& mesh, uint32_t u) {
  if (mesh.sizing == nullptr || !bends(mesh, u, kBend)) return std::nullopt;
  const Neighbors ring = mesh.ring(u);
  Steps steps;
  auto cycle = denied_triangle(mesh, u, ring, steps);
  if (!cycle) cycle = denied_quadrangle(mesh, u, ring, steps);
  if (!cycle) return std::nullopt;
  return cut_along(*cycle, squared_distance(mesh.at(cycle->corner[0]), mesh.at(cycle->corner[1])));
}

}  // namespace plc

#include "engine/transform/annular.h"

#include <cassert>

#include "engine/mesh/turns.h"

namespace plc {

namespace {

// The neighbours of v strictly between `from` and `to`, counter-clockwise.
Neighbors arc_between(const Mesh& mesh, uint32_t v, uint32_t from, uint32_t to) {
  const Neighbors ring = mesh.ring(v);
  assert(ring.contains(from) && ring.contains(to) && from != to);
  Neighbors arc;
  for (uint32_t k = ring.find(from);;) {
    k = k + 1 == ring.size() ? 0 : k + 1;
    if (ring[k] == to) return arc;
    arc.push_back(ring[k]);
  }
}

Vec3 retreated(const Mesh& mesh, uint32_t v, const Neighbors& arc, float retreat) {
  assert(arc.size() > 0);  // else the cycle is a face
  Vec3 mean;
  for (const uint32_t w : arc) mean = mean + mesh.at(w);
  mean = mean * (1.0F / static_cast<float>(arc.size()));
  return mesh.at(v) + (mean - mesh.at(v)) * retreat;
}

}  // namespace

std::array<CutCopy, 6> annular_copies(const Mesh& mesh, const Cycle& cycle, float retreat) {
  std::array<CutCopy, 6> copies;
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t v = cycle.corner[i];
    const uint32_t next = cycle.corner[(i + 1) % 3];
    const uint32_t previous = cycle.corner[(i + 2) % 3];
    copies[i].arc = arc_between(mesh, v, next, previous);
    copies[i + 3].arc = arc_between(mesh, v, previous, next);
    for (CutCopy* copy : {&copies[i], &copies[i + 3]}) {
      copy->place = retreated(mesh, v, copy->arc, retreat);
    }
  }
  return copies;
}

std::array<uint32_t, 3> cut_cycle(Mesh& mesh, const Cycle& cycle,
                                  const std::array<CutCopy, 6>& copies, uint32_t cut_id,
                                  uint32_t iteration) {
  std::array<uint32_t, 3> right{};
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t v = cycle.corner[i];
    right[i] = mesh.create(copies[i + 3].place, mesh.velocity.at(v));
    mesh.turns[v] = turned(mesh.turns[v], kTransformationTurns);
    mesh.turns[right[i]] = with_turns(0, turns_of(mesh.turns[v]));
  }
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t v = cycle.corner[i];
    for (const uint32_t w : copies[i + 3].arc) mesh.replace(w, v, right[i]);
  }
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t next = (i + 1) % 3;
    const uint32_t previous = (i + 2) % 3;
    Neighbors left_ring;
    left_ring.push_back(cycle.corner[next]);
    for (const uint32_t w : copies[i].arc) left_ring.push_back(w);
    left_ring.push_back(cycle.corner[previous]);
    Neighbors right_ring;
    right_ring.push_back(right[previous]);
    for (const uint32_t w : copies[i + 3].arc) right_ring.push_back(w);
    right_ring.push_back(right[next]);
    mesh.set_ring(cycle.corner[i], left_ring);
    mesh.set_ring(right[i], right_ring);
    mesh.place(cycle.corner[i], copies[i].place);
    for (const uint32_t v : {cycle.corner[i], right[i]}) {
      mesh.cut_id[v] = cut_id;
      mesh.cut_iteration[v] = iteration;
    }
  }
  return right;
}

}  // namespace plc

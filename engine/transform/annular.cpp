#include "engine/transform/annular.h"

#include <cassert>

#include "engine/mesh/turns.h"

namespace plc {

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

namespace {

Vec3 retreated(const Mesh& mesh, uint32_t v, const Neighbors& arc, float retreat) {
  assert(arc.size() > 0);  // else the cycle is a face
  Vec3 mean;
  for (const uint32_t w : arc) mean = mean + mesh.at(w);
  mean = mean * (1.0F / static_cast<float>(arc.size()));
  return mesh.at(v) + (mean - mesh.at(v)) * retreat;
}

}  // namespace

CutCopies annular_copies(const Mesh& mesh, const Cycle& cycle, float retreat) {
  CutCopies copies;
  for (uint32_t i = 0; i < cycle.size; ++i) {
    const uint32_t v = cycle.corner[i];
    const uint32_t next = cycle.corner[cycle.next(i)];
    const uint32_t previous = cycle.corner[cycle.previous(i)];
    copies[0][i].arc = arc_between(mesh, v, next, previous);
    copies[1][i].arc = arc_between(mesh, v, previous, next);
    for (auto& side : copies) side[i].place = retreated(mesh, v, side[i].arc, retreat);
  }
  return copies;
}

std::array<uint32_t, Cycle::kMost> cut_cycle(Mesh& mesh, const Cycle& cycle,
                                             const CutCopies& copies, uint32_t cut_id,
                                             uint32_t iteration) {
  const auto& left = cycle.corner;
  std::array<uint32_t, Cycle::kMost> right{};
  for (uint32_t i = 0; i < cycle.size; ++i) {
    const uint32_t v = left[i];
    right[i] = mesh.create(copies[1][i].place, mesh.velocity.at(v));
    mesh.turns[v] = turned(mesh.turns[v], kTransformationTurns);
    mesh.turns[right[i]] = with_turns(0, turns_of(mesh.turns[v]));
  }
  for (uint32_t i = 0; i < cycle.size; ++i) {
    for (const uint32_t w : copies[1][i].arc) mesh.replace(w, left[i], right[i]);
  }
  for (uint32_t i = 0; i < cycle.size; ++i) {
    const uint32_t next = cycle.next(i), previous = cycle.previous(i);
    Neighbors left_ring;
    left_ring.push_back(left[next]);
    for (const uint32_t w : copies[0][i].arc) left_ring.push_back(w);
    left_ring.push_back(left[previous]);
    Neighbors right_ring;
    right_ring.push_back(right[previous]);
    for (const uint32_t w : copies[1][i].arc) right_ring.push_back(w);
    right_ring.push_back(right[next]);
    if (cycle.on_diagonal(i)) {
      left_ring.push_back(left[(i + 2) % 4]);
      right_ring.push_back(right[(i + 2) % 4]);
    }
    mesh.set_ring(left[i], left_ring);
    mesh.set_ring(right[i], right_ring);
    mesh.place(left[i], copies[0][i].place);
    for (const uint32_t v : {left[i], right[i]}) {
      mesh.cut_id[v] = cut_id;
      mesh.cut_iteration[v] = iteration;
    }
  }
  return right;
}

}  // namespace plc

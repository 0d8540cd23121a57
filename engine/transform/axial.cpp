#include "engine/transform/axial.h"

#include <algorithm>
#include <cassert>

#include "engine/base/constants.h"
#include "engine/mesh/turns.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

Vector<Vec3> intermediary_points(const Mesh& mesh, uint32_t u, const Neighbors& ring) {
  Vector<Vec3> points;
  for (const uint32_t a : ring) {
    points.push_back(mesh.at(u) + (mesh.at(a) - mesh.at(u)) * kAxialReach);
  }
  return points;
}

// The intermediary vertices of u: p_i on u-a_i, the quadrilateral p_i a_i a_i+1 p_i+1 cut along
// p_i a_i+1. Their rings lack what takes the place of u.
Vector<uint32_t> create_intermediary(Mesh& mesh, uint32_t u, const Neighbors& ring,
                                     const Vector<Vec3>& points) {
  const uint32_t d = ring.size();
  Vector<uint32_t> p;
  for (uint32_t i = 0; i < d; ++i) {
    const Vec3 speed =
        mesh.velocity.at(u) + (mesh.velocity.at(ring[i]) - mesh.velocity.at(u)) * kAxialReach;
    p.push_back(mesh.create(points[i], speed));
    mesh.turns[p.back()] = with_turns(0, turns_of(mesh.turns[u]) + kTransformationTurns);
  }
  for (uint32_t i = 0; i < d; ++i) {
    mesh.replace(ring[i], u, p[i], p[(i + d - 1) % d]);
  }
  return p;
}

// The ring of p_i: p_i-1, a_i, a_i+1, p_i+1, then the other ends of its rungs.
void set_intermediary_ring(Mesh& mesh, const Vector<uint32_t>& p, uint32_t i, const Neighbors& ring,
                           const Vector<uint32_t>& across) {
  const auto d = static_cast<uint32_t>(p.size());
  Neighbors own;
  own.push_back(p[(i + d - 1) % d]);
  own.push_back(ring[i]);
  own.push_back(ring.next(i));
  own.push_back(p[(i + 1) % d]);
  for (const uint32_t q : across) own.push_back(q);
  mesh.set_ring(p[i], own);
}

}  // namespace

AxialPlan plan_axial(const Mesh& mesh, uint32_t u, uint32_t v) {
  assert(u != v && mesh.alive(u) && mesh.alive(v) && !mesh.adjacent(u, v));
  AxialPlan plan;
  plan.u = u;
  plan.v = v;
  plan.ring_u = mesh.ring(u);
  plan.ring_v = mesh.ring(v);
  plan.p = intermediary_points(mesh, u, plan.ring_u);
  plan.q = intermediary_points(mesh, v, plan.ring_v);
  plan.rungs = shortest_strip(plan.p, plan.q);
  return plan;
}

Vector<uint32_t> join(Mesh& mesh, const AxialPlan& plan) {
  const Vector<uint32_t> p = create_intermediary(mesh, plan.u, plan.ring_u, plan.p);
  const Vector<uint32_t> q = create_intermediary(mesh, plan.v, plan.ring_v, plan.q);
  // The faces between successive rungs are (p_i, p_i+1, q_j) where i grows and (p_i, q_j-1, q_j)
  // where j falls: counter-clockwise from p_i+1 on, the rungs of p_i come in reverse strip order;
  // from q_j+1 on, those of q_j in strip order.
  const auto n = static_cast<uint32_t>(plan.rungs.size());
  const auto set_rings = [&](const Vector<uint32_t>& own, const Neighbors& ring,
                             const Vector<uint32_t>& other, bool of_p) {
    for (uint32_t i = 0; i < own.size(); ++i) {
      const auto mine = [&](const Rung& r) { return (of_p ? r.i : r.j) == i; };
      // The rungs of one corner follow one another cyclically: start at the first of the run.
      uint32_t first = 0;
      while (!mine(plan.rungs[first]) || mine(plan.rungs[(first + n - 1) % n])) ++first;
      Vector<uint32_t> across;
      for (uint32_t k = first; mine(plan.rungs[k % n]); ++k) {
        across.push_back(of_p ? other[plan.rungs[k % n].j] : other[plan.rungs[k % n].i]);
      }
      if (of_p) std::reverse(across.begin(), across.end());
      set_intermediary_ring(mesh, own, i, ring, across);
    }
  };
  set_rings(p, plan.ring_u, q, true);
  set_rings(q, plan.ring_v, p, false);
  mesh.destroy(plan.u);
  mesh.destroy(plan.v);
  Vector<uint32_t> created = p;
  created.insert(created.end(), q.begin(), q.end());
  return created;
}

}  // namespace plc

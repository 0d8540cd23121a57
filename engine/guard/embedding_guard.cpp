#include "engine/guard/embedding_guard.h"

#include <algorithm>

#include "engine/base/constants.h"
#include "engine/exact/vertex_star.h"
#include "engine/guard/obstacles.h"
#include "engine/transform/deletion.h"
#include "kernels/prefetch.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

Proposal::Face face_of(const Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
  return {{a, b, c}, {mesh.at(a), mesh.at(b), mesh.at(c)}};
}

Point3 point(Vec3 p) {
  return {p.x, p.y, p.z};
}

Float4 position_of(Vec3 p) {
  return {p.x, p.y, p.z, 0};
}

Triangle triangle_of(const Proposal::Face& face) {
  return {{point(face.place[0]), point(face.place[1]), point(face.place[2])},
          {face.id[0], face.id[1], face.id[2]}};
}

bool contains(const FaceBox& box, const Float4& p) {
  const Four at = load_four(p);
  return overlap_four(at, at, load_four(box.low), load_four(box.high));
}

FaceBox widened(const Box3& box) {
  return {{box.low[0], box.low[1], box.low[2], 0}, {box.high[0], box.high[1], box.high[2], 0}};
}

void include(FaceBox& all, const FaceBox& box) {
  for (int k = 0; k < 4; ++k) {
    all.low[k] = std::min(all.low[k], box.low[k]);
    all.high[k] = std::max(all.high[k], box.high[k]);
  }
}

// Whether the faces around a vertex will meet nowhere once its ring has changed. The vertex stays
// where it is.
bool ring_is_embedded(const Mesh& mesh, const Proposal::RingChange& change) {
  const uint32_t v = change.vertex;
  Fan fan(mesh.at(v));
  const uint32_t d = mesh.valence(v);
  for (uint32_t k = 0; k < d; ++k) {
    const uint32_t w = mesh.neighbor(v, k);
    if (w == change.gone) continue;
    if (w != change.neighbor || change.keeps) fan.add(mesh.at(w));
    if (w == change.neighbor) fan.add(change.place);
  }
  return fan.is_embedded();
}

// visit(a, b) of the faces (v, a, b) around v.
template <typename Visit>
void visit_faces(const Mesh& mesh, uint32_t v, const Visit& visit) {
  const uint32_t d = mesh.valence(v);
  for (uint32_t k = 0; k < d; ++k)
    visit(mesh.neighbor(v, k), mesh.neighbor(v, k + 1 == d ? 0 : k + 1));
}

// Each once: from the first of its corners among those that go, or from one end of the edge.
Vector<Corners> faces_that_go(const Mesh& mesh, const Proposal& proposal) {
  Vector<Corners> faces;
  const auto& gone = proposal.removed_corners;
  for (auto c = gone.begin(); c != gone.end(); ++c) {
    const auto earlier = [&](uint32_t v) { return std::find(gone.begin(), c, v) != c; };
    visit_faces(mesh, *c, [&](uint32_t a, uint32_t b) {
      if (!earlier(a) && !earlier(b)) faces.push_back({mesh.at(*c), mesh.at(a), mesh.at(b)});
    });
  }
  const uint32_t u = proposal.removed_edge[0], w = proposal.removed_edge[1];
  if (!gone.empty()) return faces;
  visit_faces(mesh, u, [&](uint32_t a, uint32_t b) {
    if (a == w || b == w) faces.push_back({mesh.at(u), mesh.at(a), mesh.at(b)});
  });
  return faces;
}

}  // namespace

Proposal propose_creation(const Mesh& mesh, const Edge& e) {
  Proposal proposal;
  const uint32_t fresh = mesh.slots();
  const Vec3 place = midpoint(mesh.at(e.u), mesh.at(e.v));
  const std::array<uint32_t, 4> ring{e.u, e.a, e.v, e.b};
  std::array<Vec3, 4> around;
  for (size_t k = 0; k < 4; ++k) around[k] = mesh.at(ring[k]);
  for (size_t k = 0; k < 4; ++k) {
    const size_t next = (k + 1) % 4;
    proposal.faces.push_back({{fresh, ring[k], ring[next]}, {place, around[k], around[next]}});
  }
  proposal.embedded = fan_is_embedded(place, around.data(), around.size());
  proposal.removed_edge = {e.u, e.v};
  // Around a, u comes after v; around b, v after u.
  proposal.rings = {{e.u, e.v, place, false},
                    {e.v, e.u, place, false},
                    {e.a, e.v, place, true},
                    {e.b, e.u, place, true}};
  return proposal;
}

Proposal propose_inversion(const Mesh& mesh, const Edge& e) {
  Proposal proposal;
  proposal.faces = {face_of(mesh, e.u, e.a, e.b), face_of(mesh, e.a, e.v, e.b)};
  proposal.removed_edge = {e.u, e.v};
  proposal.rings = {{e.u, ~0U, {}, false, e.v},
                    {e.v, ~0U, {}, false, e.u},
                    {e.a, e.v, mesh.at(e.b), true},
                    {e.b, e.u, mesh.at(e.a), true}};
  return proposal;
}

Proposal propose_deletion(const Mesh& mesh, const Edge& e, Vec3 place) {
  Proposal proposal;
  const Neighbors ring = merged_ring(mesh, e);
  Vector<Vec3> around;
  for (const uint32_t v : ring) around.push_back(mesh.at(v));
  for (uint32_t k = 0; k < ring.size(); ++k) {
    const uint32_t next = k + 1 == ring.size() ? 0 : k + 1;
    proposal.faces.push_back({{e.u, ring[k], ring[next]}, {place, around[k], around[next]}});
  }
  proposal.embedded = fan_is_embedded(place, around.data(), around.size());
  proposal.removed_corners = {e.u, e.v};
  // First those that u has beside v, from b to a, then the others of v.
  bool of_u = true;
  for (const uint32_t w : ring) {
    if (proposal.rings.size() == Proposal::kMaxRings) break;
    const uint32_t other = w == e.a || w == e.b ? e.v : ~0U;
    proposal.rings.push_back({w, of_u ? e.u : e.v, place, false, other});
    of_u &= w != e.a;
  }
  return proposal;
}

Proposal propose_annular(const Mesh& mesh, const Cycle& cycle, const CutCopies& copies) {
  Proposal proposal;
  const uint32_t size = cycle.size;
  for (uint32_t side = 0; side < 2; ++side) {
    const auto corner = [&](uint32_t i) {
      return std::pair(side == 0 ? cycle.corner[i] : mesh.slots() + i, copies[side][i].place);
    };
    const auto add = [&](const auto& a, const auto& b, const auto& c) {
      proposal.faces.push_back({{a.first, b.first, c.first}, {a.second, b.second, c.second}});
    };
    for (uint32_t i = 0; i < size; ++i) {
      // The ring of a left copy is next, arc, previous; of a right one previous, arc, next. The
      // face of a copy and the last comes from the last.
      auto before = corner(side == 0 ? cycle.next(i) : cycle.previous(i));
      for (const uint32_t w : copies[side][i].arc) {
        const std::pair of_arc(w, mesh.at(w));
        add(corner(i), before, of_arc);
        before = of_arc;
      }
    }
    for (uint32_t i = 2; i < size; ++i) {
      if (side == 0) {
        add(corner(0), corner(i), corner(i - 1));
      } else {
        add(corner(0), corner(i - 1), corner(i));
      }
    }
  }
  proposal.removed_corners.assign(cycle.corner.begin(), cycle.corner.begin() + size);
  return proposal;
}

Proposal propose_axial(const Mesh& mesh, const AxialPlan& plan) {
  Proposal proposal;
  const uint32_t first_p = mesh.slots();
  const auto first_q = first_p + static_cast<uint32_t>(plan.p.size());
  const auto collar = [&](const Neighbors& ring, const Vector<Vec3>& points, uint32_t first) {
    for (uint32_t i = 0; i < ring.size(); ++i) {
      const uint32_t j = i + 1 == ring.size() ? 0 : i + 1;
      proposal.faces.push_back(
          {{first + i, ring[i], ring[j]}, {points[i], mesh.at(ring[i]), mesh.at(ring[j])}});
      proposal.faces.push_back(
          {{first + i, ring[j], first + j}, {points[i], mesh.at(ring[j]), points[j]}});
    }
  };
  collar(plan.ring_u, plan.p, first_p);
  collar(plan.ring_v, plan.q, first_q);
  for (size_t k = 0; k < plan.rungs.size(); ++k) {
    const Rung& r = plan.rungs[k];
    const Rung& n = plan.rungs[(k + 1) % plan.rungs.size()];
    if (n.i != r.i) {
      proposal.faces.push_back(
          {{first_p + r.i, first_p + n.i, first_q + r.j}, {plan.p[r.i], plan.p[n.i], plan.q[r.j]}});
    } else {
      proposal.faces.push_back(
          {{first_q + n.j, first_q + r.j, first_p + r.i}, {plan.q[n.j], plan.q[r.j], plan.p[r.i]}});
    }
  }
  proposal.removed_corners = {plan.u, plan.v};
  return proposal;
}

void EmbeddingGuard::take(const Mesh& mesh, const Proposal& proposal) {
  faces_.clear();
  boxes_.clear();
  for (const auto& face : proposal.faces) {
    faces_.push_back(triangle_of(face));
    boxes_.push_back(face_box(position_of(face.place[0]), position_of(face.place[1]),
                              position_of(face.place[2])));
  }
  FaceBox all = boxes_[0];
  for (const FaceBox& box : boxes_) include(all, box);
  std::copy_n(all.low, 3, box_.low);
  std::copy_n(all.high, 3, box_.high);
  embedded_.clear();
  for (const auto& change : proposal.rings) {
    if (ring_is_embedded(mesh, change)) embedded_.push_back(change.vertex);
  }
  embedded_of_face_.clear();
  for (const auto& face : proposal.faces)
    embedded_of_face_.push_back(embedded_corners(face.id.data()));
}

// Which of the vertices in embedded_ are corners of a face, as bits.
uint32_t EmbeddingGuard::embedded_corners(const uint32_t* abc) const {
  uint32_t bits = 0;
  for (size_t i = 0; i < embedded_.size(); ++i) {
    const uint32_t v = embedded_[i];
    bits |= static_cast<uint32_t>(v == abc[0] || v == abc[1] || v == abc[2]) << i;
  }
  return bits;
}

bool EmbeddingGuard::embeds(const Mesh& mesh, const SpatialHash& hash, const Proposal& proposal) {
  take(mesh, proposal);
  if (!proposal.embedded && new_faces_meet()) return false;
  // Faces are as large as those that they meet are, two edges on.
  float size = static_cast<float>(mesh.delta);
  if (mesh.sizing != nullptr) {
    size = 0;
    for (const auto& face : proposal.faces) {
      for (const uint32_t v : face.id) {
        if (v < mesh.slots()) size = std::max(size, mesh.size(v));
      }
    }
    size *= 1 + kMaxEdge * mesh.sizing->field.slope();
  }
  const float reach = mesh.far_reach(kFaceReach, size);
  FaceBox searched = widened(box_);
  for (int k = 0; k < 3; ++k) {
    searched.low[k] -= reach;
    searched.high[k] += reach;
  }
  hash.collect(mesh, {searched.low[0], searched.low[1], searched.low[2]},
               {searched.high[0], searched.high[1], searched.high[2]}, around_);
  // Each face once: from its smallest corner within the box.
  return (mesh.obstacles == nullptr || clear_of_obstacles(mesh, proposal)) &&
         clear_of(mesh, proposal, around_.ids.data(), around_.ids.size(),
                  [&](uint32_t x, uint32_t a, uint32_t b) {
                    return (a > x || !contains(searched, mesh.position[a])) &&
                           (b > x || !contains(searched, mesh.position[b]));
                  });
}

bool EmbeddingGuard::clear_of_obstacles(const Mesh& mesh, const Proposal& proposal) const {
  Vector<Corners> now;
  for (const auto& face : proposal.faces) now.push_back(face.place);
  const Vector<Corners> before = faces_that_go(mesh, proposal);
  for (const Corners& face : now) {
    if (mesh.obstacles->refuse(face, before.data(), before.size())) return false;
  }
  return !mesh.obstacles->passed_over(before, now);
}

bool EmbeddingGuard::embeds_beside(const Mesh& mesh, const Proposal& proposal,
                                   const Vector<uint32_t>& centres) {
  take(mesh, proposal);
  return clear_of(mesh, proposal, centres.data(), centres.size(),
                  [](uint32_t, uint32_t, uint32_t) { return true; });
}

// The faces (x, a, b) around the given vertices that stay and for which counts(x, a, b).
template <typename Counts>
bool EmbeddingGuard::clear_of(const Mesh& mesh, const Proposal& proposal, const uint32_t* ids,
                              size_t count, const Counts& counts) const {
  const auto removed = [&](uint32_t v) {
    const auto& gone = proposal.removed_corners;
    return std::find(gone.begin(), gone.end(), v) != gone.end();
  };
  const auto removed_edge = [&](uint32_t x, uint32_t a, uint32_t b) {
    const auto has = [&](uint32_t v) { return v == x || v == a || v == b; };
    return has(proposal.removed_edge[0]) && has(proposal.removed_edge[1]);
  };
  const RingView rings = mesh.rings();
  const Float4* const at = mesh.position.data();
  const Four low{box_.low[0], box_.low[1], box_.low[2], 0};
  const Four high{box_.high[0], box_.high[1], box_.high[2], 0};
  // What transformations are asked for lies anywhere: the rings come from far away in memory.
  for (const uint32_t* id = ids; id != ids + count; ++id) prefetch_ring_of(rings, *id);
  for (const uint32_t* id = ids; id != ids + count; ++id) {
    const uint32_t x = *id, d = rings.valence[x];
    if (d == 0 || removed(x) || mesh.is_absent(x)) continue;
    const Four at_x = load_four(at[x]);
    uint32_t b = rings.slot(x, d - 1);
    // Of the edge that the face before this one shares with it.
    Four edge_low = min_four(at_x, load_four(at[b])), edge_high = max_four(at_x, load_four(at[b]));
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t a = b;
      b = rings.slot(x, k);
      const Four at_b = load_four(at[b]);
      const Four face_low = min_four(edge_low, at_b), face_high = max_four(edge_high, at_b);
      edge_low = min_four(at_x, at_b);
      edge_high = max_four(at_x, at_b);
      if (!overlap_four(face_low, face_high, low, high) || !counts(x, a, b)) continue;
      if (mesh.is_absent(a) || mesh.is_absent(b)) continue;
      if (removed(a) || removed(b) || removed_edge(x, a, b)) continue;
      const uint32_t corners[3] = {x, a, b};
      const uint32_t embedded = embedded_corners(corners);
      const Triangle face = make_triangle(at, corners);
      FaceBox box;
      store_four(face_low, box.low);
      store_four(face_high, box.high);
      for (size_t i = 0; i < boxes_.size(); ++i) {
        // The faces around an embedded vertex do not meet each other.
        if ((embedded & embedded_of_face_[i]) == 0 && boxes_overlap(boxes_[i], box) &&
            triangles_intersect(faces_[i], face)) {
          return false;
        }
      }
    }
  }
  return true;
}

// New faces against one another. Faces of zero area meet nothing by the definition of
// triangle_intersection.h; they may not be made.
bool EmbeddingGuard::new_faces_meet() const {
  for (size_t i = 0; i < faces_.size(); ++i) {
    const Point3* p = faces_[i].corner;
    if (collinear(p[0], p[1], p[2])) return true;
    for (size_t j = 0; j < i; ++j) {
      if (boxes_overlap(boxes_[i], boxes_[j]) && triangles_intersect(faces_[i], faces_[j])) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace plc

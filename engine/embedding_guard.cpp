#include "engine/embedding_guard.h"

#include <algorithm>

#include "engine/constants.h"
#include "engine/deletion.h"
#include "engine/triangle_intersection.h"

namespace plc {

namespace {

Proposal::Face face_of(const Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
  return {{a, b, c}, {mesh.at(a), mesh.at(b), mesh.at(c)}};
}

struct Box {
  Vec3 low, high;

  static Box around(const std::array<Vec3, 3>& p) {
    Box box{p[0], p[0]};
    box.add(p[1]);
    box.add(p[2]);
    return box;
  }
  void add(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  bool meets(const Box& o) const {
    return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y &&
           low.z <= o.high.z && o.low.z <= high.z;
  }
  bool contains(Vec3 p) const {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z &&
           p.z <= high.z;
  }
};

bool meet(const Proposal::Face& f, const Proposal::Face& g) {
  const auto triangle = [](const Proposal::Face& face) {
    Triangle t{};
    for (size_t i = 0; i < 3; ++i) {
      t.corner[i] = {face.place[i].x, face.place[i].y, face.place[i].z};
      t.vertex[i] = face.id[i];
    }
    return t;
  };
  return triangles_intersect(triangle(f), triangle(g));
}

// Faces of zero area meet nothing by the definition of triangle_intersection.h; they may not be
// made.
bool any_degenerate(const Proposal& proposal) {
  return std::any_of(proposal.faces.begin(), proposal.faces.end(), [](const Proposal::Face& face) {
    const auto point = [&](size_t i) {
      return Point3{face.place[i].x, face.place[i].y, face.place[i].z};
    };
    return collinear(point(0), point(1), point(2));
  });
}

// New faces against one another.
bool new_faces_meet(const Proposal& proposal, const std::vector<Box>& boxes) {
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (boxes[i].meets(boxes[j]) && meet(proposal.faces[i], proposal.faces[j])) return true;
    }
  }
  return false;
}

}  // namespace

Proposal propose_inversion(const Mesh& mesh, const Edge& e) {
  Proposal proposal;
  proposal.faces = {face_of(mesh, e.u, e.a, e.b), face_of(mesh, e.a, e.v, e.b)};
  proposal.removed_edge = {e.u, e.v};
  return proposal;
}

Proposal propose_deletion(const Mesh& mesh, const Edge& e, Vec3 place) {
  Proposal proposal;
  const Neighbors ring = merged_ring(mesh, e);
  for (uint32_t k = 0; k < ring.size(); ++k) {
    const uint32_t a = ring[k];
    const uint32_t b = ring.next(k);
    proposal.faces.push_back({{e.u, a, b}, {place, mesh.at(a), mesh.at(b)}});
  }
  proposal.removed_corners = {e.u, e.v};
  return proposal;
}

Proposal propose_annular(const Mesh& mesh, const Cycle& cycle,
                         const std::array<CutCopy, 6>& copies) {
  Proposal proposal;
  const uint32_t fresh = mesh.slots();
  const auto id = [&](uint32_t copy) { return copy < 3 ? cycle.corner[copy] : fresh + copy - 3; };
  for (uint32_t copy = 0; copy < 6; ++copy) {
    const uint32_t i = copy % 3;
    const uint32_t side = copy - i;
    // The ring of a left copy is next, arc, previous; of a right one previous, arc, next.
    const uint32_t first = side + (side == 0 ? (i + 1) % 3 : (i + 2) % 3);
    const uint32_t last = side + (side == 0 ? (i + 2) % 3 : (i + 1) % 3);
    std::vector<uint32_t> ring{id(first)};
    std::vector<Vec3> place{copies[first].place};
    for (const uint32_t w : copies[copy].arc) {
      ring.push_back(w);
      place.push_back(mesh.at(w));
    }
    ring.push_back(id(last));
    place.push_back(copies[last].place);
    // Faces with several copies come from the copy that has the face's first edge to another copy.
    for (size_t k = 0; k < ring.size(); ++k) {
      const size_t next = (k + 1) % ring.size();
      const bool closing = next == 0;            // the triangle that closes the hole
      const bool shared = k + 2 == ring.size();  // (copy, arc's end, last): also seen from last
      if ((closing && i != 0) || shared) continue;
      proposal.faces.push_back(
          {{id(copy), ring[k], ring[next]}, {copies[copy].place, place[k], place[next]}});
    }
  }
  proposal.removed_corners.assign(cycle.corner.begin(), cycle.corner.end());
  return proposal;
}

Proposal propose_axial(const Mesh& mesh, const AxialPlan& plan) {
  Proposal proposal;
  const uint32_t first_p = mesh.slots();
  const auto first_q = first_p + static_cast<uint32_t>(plan.p.size());
  const auto collar = [&](const Neighbors& ring, const std::vector<Vec3>& points, uint32_t first) {
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

bool embeds(const Mesh& mesh, const SpatialHash& hash, const Proposal& proposal) {
  std::vector<Box> boxes;
  for (const auto& face : proposal.faces) boxes.push_back(Box::around(face.place));
  if (any_degenerate(proposal) || new_faces_meet(proposal, boxes)) return false;
  Box all = boxes[0];
  for (const Box& box : boxes) {
    all.add(box.low);
    all.add(box.high);
  }
  const float reach = kFaceReach * static_cast<float>(mesh.delta);
  const Vec3 span{reach, reach, reach};
  const Box searched{all.low - span, all.high + span};
  const auto removed = [&](uint32_t v) {
    const auto& gone = proposal.removed_corners;
    return std::find(gone.begin(), gone.end(), v) != gone.end();
  };
  const auto removed_edge = [&](uint32_t x, uint32_t a, uint32_t b) {
    const auto has = [&](uint32_t v) { return v == x || v == a || v == b; };
    return has(proposal.removed_edge[0]) && has(proposal.removed_edge[1]);
  };
  bool clear = true;
  hash.visit_box(mesh, searched.low, searched.high, [&](uint32_t x, Vec3 p) {
    if (!clear || removed(x)) return;
    const uint32_t d = mesh.valence(x);
    for (uint32_t k = 0; k < d && clear; ++k) {
      const uint32_t a = mesh.neighbor(x, k);
      const uint32_t b = mesh.neighbor(x, k + 1 == d ? 0 : k + 1);
      // Each face once: from its smallest corner within the box.
      const Vec3 pa = mesh.at(a);
      const Vec3 pb = mesh.at(b);
      if ((a < x && searched.contains(pa)) || (b < x && searched.contains(pb))) continue;
      const Proposal::Face face{{x, a, b}, {p, pa, pb}};
      const Box box = Box::around(face.place);
      if (!box.meets(all) || removed(a) || removed(b) || removed_edge(x, a, b)) continue;
      for (size_t i = 0; i < boxes.size() && clear; ++i) {
        clear = !boxes[i].meets(box) || !meet(proposal.faces[i], face);
      }
    }
  });
  return clear;
}

}  // namespace plc

#include "engine/simplify/trial.h"

#include <algorithm>
#include <cmath>

#include "engine/exact/predicates.h"

namespace plc {
namespace {

// Cosine between a face and what becomes of it: below, it has nearly turned over.
constexpr double kLeastTurn = 0.1;
// Neighbours around a vertex.
constexpr size_t kMostNeighbours = 64;
constexpr size_t kMostUses = 32;

Point3 point3(const Double3& p) {
  return {p.x, p.y, p.z};
}
Double3 double3(const Point3& p) {
  return {p.x, p.y, p.z};
}
Corners3 corners_of(const Triangle& t) {
  return {double3(t.corner[0]), double3(t.corner[1]), double3(t.corner[2])};
}

}  // namespace

// Faces that a proof may use, and those that it has.
class Trier::Near {
 public:
  explicit Near(Trier& trier) : trier_(trier) {}
  Corners3 corners(uint32_t face) const { return trier_.candidates_[face]; }
  double nearest(const Double3& p, uint32_t& face) {
    const Local found = trier_.nearest_candidate(p, 0, trier_.candidates_.size());
    face = found.face;
    return found.squared;
  }
  void use(uint32_t face) {
    for (size_t i = 0; i < count_; ++i) {
      if (used_[i] == face) return;
    }
    if (count_ == kMostUses) {
      overflow_ = true;
      return;
    }
    used_[count_++] = face;
  }
  void clear() { count_ = 0; }
  bool overflow() const { return overflow_; }
  const uint32_t* begin() const { return used_; }
  const uint32_t* end() const { return used_ + count_; }

 private:
  Trier& trier_;
  uint32_t used_[kMostUses] = {};
  size_t count_ = 0;
  bool overflow_ = false;
};

Trier::Local Trier::nearest_candidate(const Double3& p, size_t from, size_t to) const {
  Local best{INFINITY, 0};
  for (size_t i = from; i < to; ++i) {
    if (!(candidate_bounds_[i].squared_distance(p) < best.squared)) continue;
    const double squared = squared_distance_to_triangle(p, candidates_[i]);
    if (squared < best.squared) best = {squared, static_cast<uint32_t>(i)};
  }
  return best;
}

// The faces, what becomes of them, and the link condition (T. K. Dey, H. Edelsbrunner, S. Guha,
// D. V. Nekhayev, "Topology Preserving Edge Contraction", 1999): the surface stays as it is
// connected.
bool Trier::gather_star(Trial& trial) {
  const CollapseMesh& mesh = around_->mesh;
  const uint32_t u = trial.u, v = trial.v;
  const uint32_t first = previous_corner(trial.corner), second = mesh.across(first);
  trial.dying[0] = first / 3, trial.dying[1] = second / 3;
  trial.faces.clear(), trial.shape.clear(), star_.clear(), link_.clear();
  trial.bounds = {};
  bool once = true;
  size_t common = 0;
  for (const uint32_t centre : {u, v}) {
    mesh.around(centre, [&](uint32_t c) {
      const uint32_t neighbour = mesh.vertex(next_corner(c)), f = c / 3;
      if (neighbour != u && neighbour != v) {
        if (vertex_mark_[neighbour] == number_) {
          ++common;
        } else {
          vertex_mark_[neighbour] = number_;
          link_.push_back(neighbour);
        }
      }
      if (face_mark_[f] == number_) return;
      face_mark_[f] = number_;
      star_.push_back(f);
      if (f == trial.dying[0] || f == trial.dying[1]) return;
      Triangle t = make_triangle(mesh.xyz(), mesh.face(f));
      for (int k = 0; k < 3; ++k) {
        if (t.vertex[k] != u && t.vertex[k] != v) continue;
        t.corner[k] = point3(trial.place);
        t.vertex[k] = u;
      }
      trial.faces.push_back(f);
      trial.shape.push_back(t);
      trial.bounds.add(bounds_of(corners_of(t)));
    });
  }
  for (const uint32_t apex : {mesh.vertex(first), mesh.vertex(second)}) {
    size_t neighbours = 0;
    mesh.around(apex, [&](uint32_t) { ++neighbours; });
    once = once && neighbours > 3;
  }
  return once && common == 2 && trial.faces.size() >= 3 && trial.faces.size() <= kMostNeighbours;
}

// No face turns over or loses its area.
bool Trier::keeps_sides(const Trial& trial) const {
  for (size_t i = 0; i < trial.faces.size(); ++i) {
    const Corners3 before = around_->mesh.corners(trial.faces[i]);
    const Corners3 after = corners_of(trial.shape[i]);
    const Double3 n = cross(before[1] - before[0], before[2] - before[0]);
    const Double3 m = cross(after[1] - after[0], after[2] - after[0]);
    if (!(dot(n, m) > kLeastTurn * length(n) * length(m))) return false;
    const Triangle& t = trial.shape[i];
    if (collinear(t.corner[0], t.corner[1], t.corner[2])) return false;
  }
  return true;
}

// Whether a vertex of another component lies in what the faces sweep over: between a face as it is
// and the new place of the vertex. No faces would meet, but the component would lie on the other
// side.
bool Trier::swallows(const Trial& trial, uint32_t face) const {
  const CollapseMesh& mesh = around_->mesh;
  const Point3 apex = point3(trial.place);
  for (const uint32_t f : star_) {
    const Triangle t = make_triangle(mesh.xyz(), mesh.face(f));
    for (uint32_t k = 0; k < 3; ++k) {
      const Point3 p = point3(mesh.at(mesh.face(face)[k]));
      int low = 1, high = -1;
      const auto note = [&](int side) { low = std::min(low, side), high = std::max(high, side); };
      note(orient3d(t.corner[0], t.corner[1], t.corner[2], p));
      for (int e = 0; e < 3; ++e) note(orient3d(t.corner[(e + 1) % 3], t.corner[e], apex, p));
      if (low >= 0 || high <= 0) return true;
    }
  }
  return false;
}

bool Trier::meets_nothing(const Trial& trial) {
  const CollapseMesh& mesh = around_->mesh;
  for (size_t i = 0; i < trial.shape.size(); ++i) {
    for (size_t j = i + 1; j < trial.shape.size(); ++j) {
      if (triangles_intersect(trial.shape[i], trial.shape[j])) return false;
    }
  }
  Bounds boxes[kMostNeighbours];
  for (size_t i = 0; i < trial.shape.size(); ++i) boxes[i] = bounds_of(corners_of(trial.shape[i]));
  Bounds swept = trial.bounds;
  swept.add(mesh.at(trial.u));
  swept.add(mesh.at(trial.v));
  const uint32_t component = around_->component[star_[0]];
  bool free = true;
  around_->tree.within(swept, [&](uint32_t face) {
    if (!free || face_mark_[face] == number_) return;
    const Triangle t = make_triangle(mesh.xyz(), mesh.face(face));
    const Bounds box = bounds_of(corners_of(t));
    for (size_t i = 0; i < trial.shape.size() && free; ++i) {
      if (boxes[i].overlaps(box)) free = !triangles_intersect(trial.shape[i], t);
    }
    if (free && around_->component[face] != component) free = !swallows(trial, face);
  });
  return free;
}

void Trier::add_candidate(const Corners3& corners, uint32_t face) {
  candidates_.push_back(corners);
  candidate_bounds_.push_back(bounds_of(corners));
  candidate_face_.push_back(face);
}

// The faces that touch the star.
void Trier::add_ring() {
  if (has_ring_) return;
  has_ring_ = true;
  for (const uint32_t x : link_) {
    around_->mesh.around(x, [&](uint32_t c) {
      const uint32_t f = c / 3;
      if (face_mark_[f] == number_) return;
      face_mark_[f] = number_;
      add_candidate(around_->mesh.corners(f), f);
    });
  }
}

// What becomes of the faces: the first that proofs may use.
void Trier::gather_candidates(Trial& trial) {
  candidates_.clear(), candidate_bounds_.clear(), candidate_face_.clear();
  has_ring_ = false;
  for (size_t i = 0; i < trial.faces.size(); ++i) {
    add_candidate(corners_of(trial.shape[i]), trial.faces[i]);
  }
  trial.originals.clear(), trial.uses.clear();
}

// The originals that are to be proved again, and whether their corners are near enough.
bool Trier::gather_originals(Trial& trial) {
  local_.clear();
  const size_t own = candidates_.size();
  const MeshArrays& original = around_->original.mesh();
  bool near = true;
  for (const uint32_t f : star_) {
    around_->proofs.of(f, [&](uint32_t t) {
      if (!near || original_mark_[t] == number_) return;
      original_mark_[t] = number_;
      trial.originals.push_back(t);
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t x = original.abc[3 * static_cast<size_t>(t) + k];
        if (corner_mark_[x] == number_) continue;
        corner_mark_[x] = number_;
        corner_local_[x] = static_cast<uint32_t>(local_.size());
        const Double3 p = point_of(original.xyz, x);
        Local found = nearest_candidate(p, 0, own);
        if (found.squared > around_->limit) {
          add_ring();
          found = nearest_candidate(p, own, candidates_.size());
          near = near && found.squared <= around_->limit;
        }
        local_.push_back(found);
      }
    });
    if (!near) return false;
  }
  return true;
}

bool Trier::prove_originals(Trial& trial) {
  const MeshArrays& original = around_->original.mesh();
  Near near(*this);
  const auto use = [&](uint32_t t, uint32_t candidate) {
    trial.uses.push_back({t, candidate_face_[candidate]});
  };
  for (const uint32_t t : trial.originals) {
    const uint32_t* ids = original.abc + 3 * static_cast<size_t>(t);
    const Corners3 corners = around_->original.corners(t);
    uint32_t home = kNoFace;
    for (size_t k = 0; k < 3 && home == kNoFace; ++k) {
      const uint32_t face = local_[corner_local_[ids[k]]].face;
      home = face;
      for (size_t i = 0; i < 3 && home != kNoFace; ++i) {
        const Local& at = local_[corner_local_[ids[i]]];
        if (at.face != face &&
            squared_distance_to_triangle(corners[i], candidates_[face]) > around_->limit) {
          home = kNoFace;
        }
      }
    }
    if (home != kNoFace) {
      use(t, home);
      continue;
    }
    add_ring();
    near.clear();
    CoverBound bound{around_->limit};
    if (!cover_.run(near, corners, local_[corner_local_[ids[0]]].face, bound)) return false;
    for (const uint32_t face : near) use(t, face);
  }
  return !near.overflow();
}

// That the new faces are near the original; `nearest` is its face nearest to the new place.
bool Trier::prove_shape(const Trial& trial, uint32_t nearest) {
  for (size_t i = 0; i < trial.shape.size(); ++i) {
    const Corners3 corners = candidates_[i];
    uint32_t start = nearest;
    around_->proofs.of(trial.faces[i], [&](uint32_t t) { start = t; });
    CoverBound bound{around_->limit};
    if (!cover_.run(around_->original, corners, start, bound)) return false;
  }
  return true;
}

void Trier::run(const TrialContext& around, Trial& trial) {
  around_ = &around;
  if (++number_ == 1) {
    face_mark_.resize(around_->mesh.face_count());
    vertex_mark_.resize(around_->mesh.vertex_count());
    original_mark_.resize(around_->mesh.face_count());
    corner_mark_.resize(around_->mesh.vertex_count());
    corner_local_.resize(around_->mesh.vertex_count());
  }
  trial.good = false;
  if (!gather_star(trial)) return;
  if (!keeps_sides(trial)) return;
  uint32_t nearest = 0;
  if (!(around_->original.nearest_within(trial.place, around_->limit, nearest) < around_->limit)) {
    return;
  }
  gather_candidates(trial);
  if (around_->two_sided && !gather_originals(trial)) return;
  if (!prove_shape(trial, nearest)) return;
  if (around_->two_sided && !prove_originals(trial)) return;
  // add_ring() has marked faces that are not of the star.
  if (has_ring_) {
    for (size_t i = trial.faces.size(); i < candidate_face_.size(); ++i) {
      face_mark_[candidate_face_[i]] = 0;
    }
  }
  trial.good = meets_nothing(trial);
}

}  // namespace plc

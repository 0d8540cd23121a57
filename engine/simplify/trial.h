// Whether an edge can be collapsed: without touching the mesh, so that many are tried at once.
#pragma once
#include <cstdint>

#include "engine/exact/triangle_intersection.h"
#include "engine/measure/cover.h"
#include "engine/measure/mesh_target.h"
#include "engine/simplify/collapse_mesh.h"
#include "engine/simplify/living_tree.h"
#include "engine/simplify/proofs.h"
#include "pyramid/buffer.h"
#include "pyramid/memory.h"

namespace plc {

// The collapse of the edge from a corner to the next one, and what it would leave.
struct Trial {
  struct Use {
    uint32_t original, face;
  };

  uint32_t corner = kNoCorner;
  uint32_t u = 0, v = 0;
  Double3 place;

  bool good = false;
  uint32_t dying[2] = {kNoFace, kNoFace};
  Vector<uint32_t> faces;      // of u or v, but for the dying ones
  Vector<Triangle> shape;      // what becomes of them
  Vector<uint32_t> originals;  // whose proofs used any of all these
  Vector<Use> uses;            // their new proofs, each original's together
  Bounds bounds;               // of shape
};

// What trials ask, and do not change.
struct TrialContext {
  const CollapseMesh& mesh;
  const LivingTree& tree;
  const Proofs& proofs;
  const MeshTarget& original;
  const Vector<uint32_t>& component;  // of each face
  double limit;                       // the tolerance, squared
  bool two_sided;                     // whether the original is to be near the mesh, too
};

// What it holds serves one trial after the other.
class Trier {
 public:
  // trial.corner, u, v and place are given. The same mesh in every call.
  void run(const TrialContext& around, Trial& trial);

 private:
  // Faces that a proof may use: brute force, there are few.
  class Near;
  struct Local {
    double squared;
    uint32_t face;  // in candidates_
  };

  bool gather_star(Trial& trial);
  bool keeps_sides(const Trial& trial) const;
  bool meets_nothing(const Trial& trial);
  bool swallows(const Trial& trial, uint32_t face) const;
  void gather_candidates(Trial& trial);
  bool gather_originals(Trial& trial);
  bool prove_originals(Trial& trial);
  bool prove_shape(const Trial& trial, uint32_t nearest);
  void add_candidate(const Corners3& corners, uint32_t face);
  void add_ring();
  Local nearest_candidate(const Double3& p, size_t from, size_t to) const;

  const TrialContext* around_ = nullptr;
  Cover cover_;
  Vector<uint32_t> star_;        // faces of u and v, dying ones included
  Vector<uint32_t> link_;        // vertices around
  Vector<Corners3> candidates_;  // shape, then the ring around it
  Vector<Bounds> candidate_bounds_;
  Vector<uint32_t> candidate_face_;
  bool has_ring_ = false;
  Vector<Local> local_;  // of each corner of originals that has been looked at
  // Marks: the number of the trial where they have been set in this one.
  Buffer<uint32_t> face_mark_, vertex_mark_, original_mark_, corner_mark_, corner_local_;
  uint32_t number_ = 0;
};

}  // namespace plc

// Going past the paper: a transformation is refused when its new faces would meet the surface.
#pragma once
#include <array>

#include "engine/detect/spatial_hash.h"
#include "engine/exact/triangle_intersection.h"
#include "engine/transform/annular.h"
#include "engine/transform/axial.h"
#include "kernels/box_lanes.h"
#include "pyramid/memory.h"

namespace plc {

// The faces that a transformation makes and those that it takes away. Vertices that do not exist
// yet have ids from mesh.slots() on.
struct Proposal {
  struct Face {
    std::array<uint32_t, 3> id;
    std::array<Vec3, 3> place;
  };
  Vector<Face> faces;
  // Existing faces with any of these corners go, ...
  Vector<uint32_t> removed_corners;
  // ... and those that have both ends of this edge.
  std::array<uint32_t, 2> removed_edge{~0U, ~0U};
  // What becomes of the rings of the vertices that stay and have new faces.
  struct RingChange {
    uint32_t vertex;
    uint32_t neighbor = ~0U;  // leaves the ring; where `keeps`, it stays, and `place` follows it
    Vec3 place{};             // enters the ring, in place of `neighbor` where that leaves
    bool keeps = false;
    uint32_t gone = ~0U;  // another neighbour that leaves
  };
  // Up to kMaxRings; where some are not known, more is tested one by one.
  Vector<RingChange> rings;
  static constexpr size_t kMaxRings = 32;
  // The new faces are known to have an area and to meet each other nowhere (vertex_star.h).
  bool embedded = false;
};

// Proposals for the transformations of the same names, as the headers of transform/ do them; the
// new vertex of a creation lies where creation.h puts it.
Proposal propose_creation(const Mesh& mesh, const Edge& edge);
Proposal propose_inversion(const Mesh& mesh, const Edge& edge);
Proposal propose_deletion(const Mesh& mesh, const Edge& edge, Vec3 place);
Proposal propose_annular(const Mesh& mesh, const Cycle& cycle, const CutCopies& copies);
Proposal propose_axial(const Mesh& mesh, const AxialPlan& plan);

// Keeps its buffers from call to call; not thread-safe.
class EmbeddingGuard {
 public:
  // True when no new face meets another new face, or a face that stays, elsewhere than in common
  // corners and edges, or an obstacle of the mesh, and none of those is passed over; exact. The
  // hash must hold every living vertex at its place. Faces with edges beyond those that kFaceReach
  // allows for may be overlooked.
  bool embeds(const Mesh& mesh, const SpatialHash& hash, const Proposal& proposal);
  // Of the faces that stay only those around these vertices, and no new faces against each other.
  bool embeds_beside(const Mesh& mesh, const Proposal& proposal, const Vector<uint32_t>& centres);
  // Around the new faces of the last call.
  const Box3& box() const { return box_; }

 private:
  void take(const Mesh& mesh, const Proposal& proposal);
  bool new_faces_meet() const;
  bool clear_of_obstacles(const Mesh& mesh, const Proposal& proposal) const;
  uint32_t embedded_corners(const uint32_t* abc) const;
  template <typename Counts>
  bool clear_of(const Mesh& mesh, const Proposal& proposal, const uint32_t* ids, size_t count,
                const Counts& counts) const;

  Vector<Triangle> faces_;  // the new ones
  Vector<FaceBox> boxes_;
  Box3 box_{};
  // Those of `rings` around which no faces will meet each other; which of them each new face has.
  Vector<uint32_t> embedded_;
  Vector<uint32_t> embedded_of_face_;
  SpatialHash::Collected around_;
};

}  // namespace plc

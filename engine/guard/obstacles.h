// Going past the paper: faces from elsewhere that never move, and that the surface may not meet.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/exact/face_tree.h"
#include "engine/exact/triangle_intersection.h"
#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// Of a face: its corners.
using Corners = std::array<Vec3, 3>;

// The faces need not be closed, nor free of self-intersections; none is of zero area. The surface
// that evolves among them begins apart from them, and stays so, exactly: no face that moves or
// comes meets one of them, and none of their components changes from the surface's outside to its
// inside or back by being passed over. Moreover nothing comes nearer to them than the gap; what is
// nearer from the start on comes no nearer. This distance is computed in doubles, not exact.
//
// Made once, and read by any number of threads. The mesh points to it (mesh.h).
class Obstacles {
 public:
  // xyz: three values of mesh space per vertex; abc: three of them per face; gap: mesh units, >= 0.
  Obstacles(Vector<double> xyz, Vector<uint32_t> abc, double gap, const Executor& executor);

  // Whether a face that was at `before`, or a new one in place of several, may not be at `now`: it
  // meets an obstacle, or is nearer to one than the gap and than what was there before.
  bool refuse(const Corners& now, const Corners* before, size_t count) const;
  // Whether faces that turn from `before` to `now`, which have the same border, pass over a
  // component of the obstacles: one whole component is on another side of the surface then.
  bool passed_over(const Vector<Corners>& before, const Vector<Corners>& now) const;
  // Whether a component of the surface, given by all of its vertices, holds one of theirs.
  bool any_inside(const Mesh& mesh, const Vector<uint32_t>& component) const;
  // Whether a component has a corner within the box of these: only then can they pass over it.
  bool any_near(const Corners* faces, size_t count) const;

  // The first face of the mesh, in the order of ids, that meets an obstacle.
  struct Meeting {
    std::array<uint32_t, 3> face;
    uint32_t obstacle;
  };
  bool find_meeting(const Mesh& mesh, Meeting& meeting) const;

 private:
  Triangle triangle(uint32_t face) const;
  // Squared; of the nearest obstacle, but for those that are farther than the gap.
  double squared_distance(const Corners& face, double limit) const;
  template <typename Visit>
  void visit_near(const Corners& face, double reach, const Visit& visit) const;

  Vector<double> xyz_;
  Vector<uint32_t> abc_;
  double gap_;
  FaceTree tree_;
  // One vertex of each component, as a face of its own.
  Vector<uint32_t> points_;
  FaceTree point_tree_;
};

}  // namespace plc

// A mesh that stays as it is, for searches of the nearest face and as covers (cover.h) take it.
#pragma once
#include <numeric>

#include "engine/base/mesh_arrays.h"
#include "engine/exact/face_tree.h"
#include "engine/measure/cover.h"
#include "pyramid/memory.h"

namespace plc {

class MeshTarget {
 public:
  // Borrows the arrays of the mesh, which has a face.
  MeshTarget(const MeshArrays& mesh, const Executor& executor) : mesh_(mesh) {
    Vector<uint32_t> ids(mesh.face_count);
    std::iota(ids.begin(), ids.end(), 0U);
    tree_.build(mesh.xyz, mesh.abc, ids.data(), ids.size(), executor);
  }

  const MeshArrays& mesh() const { return mesh_; }
  Corners3 corners(uint32_t face) const {
    const uint32_t* ids = mesh_.abc + 3 * static_cast<size_t>(face);
    return {point_of(mesh_.xyz, ids[0]), point_of(mesh_.xyz, ids[1]), point_of(mesh_.xyz, ids[2])};
  }
  double nearest(const Double3& p, uint32_t& face) const {
    // The guess itself is to be found again: what is no nearer than the limit is not.
    return nearest_within(p, squared_distance_to_triangle(p, corners(face)), face);
  }
  // The least of `limit` and the squared distances; face stays as it is where none is less.
  double nearest_within(const Double3& p, double limit, uint32_t& face) const {
    return tree_.nearest({p.x, p.y, p.z}, limit, [&](uint32_t f) {
      const double squared = squared_distance_to_triangle(p, corners(f));
      if (squared < limit) limit = squared, face = f;
      return squared;
    });
  }
  void use(uint32_t /*face*/) const {}

 private:
  MeshArrays mesh_;
  FaceTree tree_;
};

}  // namespace plc

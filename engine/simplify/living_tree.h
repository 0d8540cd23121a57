// Boxes over the living faces of a mesh that changes: what a new face could meet.
//
// The order of faces is that of a FaceTree; the boxes are those of a complete binary tree over
// leaves of eight, which grow and shrink with their faces. Faces stay near where they were: the
// order is made anew when half of them have died, for what is left to be dense.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/base/double3.h"
#include "engine/simplify/collapse_mesh.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"

namespace plc {

struct Bounds {
  Double3 low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};
  static constexpr double kFar = 1e300;

  void add(const Double3& p) {
    low = {p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y, p.z < low.z ? p.z : low.z};
    high = {p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y, p.z > high.z ? p.z : high.z};
  }
  void add(const Bounds& b) {
    add(b.low);
    add(b.high);
  }
  bool overlaps(const Bounds& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y &&
           low.z <= b.high.z && b.low.z <= high.z;
  }
  double squared_distance(const Double3& p) const {
    const auto beyond = [](double least, double x, double most) {
      const double below = least - x, above = x - most;
      const double out = below > above ? below : above;
      return out > 0 ? out : 0.0;
    };
    const Double3 d{beyond(low.x, p.x, high.x), beyond(low.y, p.y, high.y),
                    beyond(low.z, p.z, high.z)};
    return dot(d, d);
  }
  bool operator==(const Bounds& b) const {
    return low.x == b.low.x && low.y == b.low.y && low.z == b.low.z && high.x == b.high.x &&
           high.y == b.high.y && high.z == b.high.z;
  }
};

inline Bounds bounds_of(const Corners3& t) {
  Bounds b;
  for (const Double3& p : t) b.add(p);
  return b;
}

class LivingTree {
 public:
  // Of the living faces of the mesh, which is borrowed.
  void build(const CollapseMesh& mesh, const Executor& executor);
  // Anew, where half of its faces have died.
  void refresh(const Executor& executor);
  // The faces have been changed, or have died.
  void change(const uint32_t* faces, size_t count);

  // visit(face) for every living face whose box meets this one.
  template <typename Visit>
  void within(const Bounds& bounds, const Visit& visit) const;

 private:
  static constexpr uint32_t kLeaf = 8;

  Bounds leaf_bounds(size_t leaf) const;

  const CollapseMesh* mesh_ = nullptr;
  size_t count_ = 0;        // faces in order_
  size_t leaves_ = 0;       // a power of two
  Buffer<uint32_t> order_;  // faces
  Buffer<uint32_t> place_;  // of each face in order_
  Buffer<Bounds> nodes_;    // node i has 2 i and 2 i + 1, the root is 1, leaf l is leaves_ + l
};

// ---- implementation -------------------------------------------------------------------------

template <typename Visit>
void LivingTree::within(const Bounds& bounds, const Visit& visit) const {
  std::array<uint32_t, 64> stack{};
  size_t size = 0;
  stack[size++] = 1;
  while (size > 0) {
    const uint32_t node = stack[--size];
    if (!nodes_[node].overlaps(bounds)) continue;
    if (node < leaves_) {
      stack[size++] = 2 * node + 1;
      stack[size++] = 2 * node;
      continue;
    }
    const size_t first = (node - leaves_) * kLeaf;
    for (size_t i = first; i < first + kLeaf && i < count_; ++i) {
      const uint32_t face = order_[i];
      if (mesh_->face_lives(face) && bounds_of(mesh_->corners(face)).overlaps(bounds)) visit(face);
    }
  }
}

}  // namespace plc

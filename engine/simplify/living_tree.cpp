#include "engine/simplify/living_tree.h"

#include <bit>

#include "engine/base/blocks.h"
#include "engine/exact/face_tree.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kBlock = 512;
// Below so many faces the order stays.
constexpr size_t kFew = 1000;

}  // namespace

Bounds LivingTree::leaf_bounds(size_t leaf) const {
  Bounds bounds;
  for (size_t i = leaf * kLeaf; i < (leaf + 1) * kLeaf && i < count_; ++i) {
    if (mesh_->face_lives(order_[i])) bounds.add(bounds_of(mesh_->corners(order_[i])));
  }
  return bounds;
}

void LivingTree::build(const CollapseMesh& mesh, const Executor& executor) {
  mesh_ = &mesh;
  Vector<uint32_t> faces;
  faces.reserve(mesh.living_faces());
  for (uint32_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_lives(f)) faces.push_back(f);
  }
  FaceTree tree;
  tree.build(mesh.xyz(), mesh.abc(), faces.data(), faces.size(), executor);
  count_ = faces.size();
  order_.resize_uninitialized(count_);
  place_.resize_uninitialized(mesh.face_count());
  for (size_t i = 0; i < count_; ++i) {
    order_[i] = tree.face_at(i);
    place_[order_[i]] = static_cast<uint32_t>(i);
  }
  leaves_ = std::bit_ceil(block_count(count_, kLeaf));
  nodes_.resize_uninitialized(2 * leaves_);
  run_blocks(executor, leaves_, kBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t leaf = begin; leaf < end; ++leaf) nodes_[leaves_ + leaf] = leaf_bounds(leaf);
  });
  for (size_t i = leaves_; i-- > 1;) {
    nodes_[i] = nodes_[2 * i];
    nodes_[i].add(nodes_[2 * i + 1]);
  }
}

void LivingTree::refresh(const Executor& executor) {
  if (count_ > kFew && mesh_->living_faces() < count_ / 2) build(*mesh_, executor);
}

void LivingTree::change(const uint32_t* faces, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    size_t node = leaves_ + place_[faces[i]] / kLeaf;
    Bounds bounds = leaf_bounds(node - leaves_);
    while (!(nodes_[node] == bounds)) {
      nodes_[node] = bounds;
      if (node == 1) break;
      node /= 2;
      bounds = nodes_[2 * node];
      bounds.add(nodes_[2 * node + 1]);
    }
  }
}

}  // namespace plc

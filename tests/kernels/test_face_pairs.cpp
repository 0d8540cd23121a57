#include "kernels/face_pairs.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <set>
#include <utility>

#include "tests/kernels/face_tree_samples.h"

namespace {

namespace kernels = plc::kernels;
using plc::SimdTarget;
using samples::Box3;
using samples::FaceTreeSample;
using Pairs = std::vector<std::pair<uint32_t, uint32_t>>;

// Of all leaves, each with its own node and those after it.
Pairs found(SimdTarget simd, const FaceTreeSample& tree) {
  Pairs all;
  std::vector<uint32_t> nodes(tree.node_count());
  std::iota(nodes.begin(), nodes.end(), 0U);
  std::vector<kernels::CandidatePair> pairs(kernels::kMostPairs * nodes.size());
  for (uint32_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    const size_t own = leaf / plc::BoxLanes::kLanes;
    const size_t count = kernels::face_pairs(simd, tree.view(), leaf, nodes.data() + own,
                                             nodes.size() - own, pairs.data());
    for (size_t i = 0; i < count; ++i) all.emplace_back(pairs[i].f, pairs[i].g);
  }
  return all;
}

bool overlap(const Box3& a, const Box3& b) {
  bool overlapping = true;
  for (int axis = 0; axis < 3; ++axis) {
    overlapping &= a.low[axis] <= b.high[axis] && b.low[axis] <= a.high[axis];
  }
  return overlapping;
}

Pairs expected(const FaceTreeSample& tree) {
  Pairs all;
  for (uint32_t f = 0; f < tree.faces; ++f) {
    const std::set<uint32_t> of_f(&tree.corners[size_t{3} * f], &tree.corners[size_t{3} * f] + 3);
    for (uint32_t g = f + 1; g < tree.faces; ++g) {
      const uint32_t* of_g = &tree.corners[size_t{3} * g];
      const bool share =
          std::any_of(of_g, of_g + 3, [&](uint32_t v) { return of_f.count(v) != 0; });
      if (tree.present[f] && tree.present[g] && (tree.moved[f] || tree.moved[g]) && !share &&
          overlap(tree.box[f], tree.box[g])) {
        all.emplace_back(f, g);
      }
    }
  }
  return all;
}

}  // namespace

TEST_CASE("pairs of faces: present, one moved, without a common corner, boxes overlapping",
          "[kernels]") {
  for (const uint32_t faces : {1U, 8U, 9U, 63U, 64U, 65U, 200U, 611U}) {
    for (const auto& [present, moved] :
         {std::pair{100U, 100U}, std::pair{60U, 30U}, std::pair{100U, 5U}, std::pair{20U, 0U}}) {
      const FaceTreeSample tree(faces, faces + present, present, moved);
      const Pairs wanted = expected(tree);
      if (faces > 100 && moved > 0) CHECK(wanted.size() > 3);
      const Pairs twin = found(SimdTarget::kScalar, tree);
      Pairs sorted = twin;
      std::sort(sorted.begin(), sorted.end());
      CHECK(sorted == wanted);
      for (const SimdTarget simd : plc::available_simd_targets()) {
        CAPTURE(faces, present, moved, plc::simd_target_name(simd));
        CHECK(found(simd, tree) == twin);
      }
    }
  }
}

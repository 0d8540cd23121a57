#include "kernels/face_pairs.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/face_pairs.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::face_pairs;
#else

using Eight = hn::CappedTag<float, BoxLanes::kLanes>;
using EightIds = hn::RebindToUnsigned<Eight>;
// Two vectors where one has four lanes.
inline constexpr uint32_t kPart = static_cast<uint32_t>(hn::MaxLanes(Eight()));

HWY_INLINE uint32_t bits_of(hn::Mask<Eight> mask) {
  uint8_t bits[8];
  hn::StoreMaskBits(Eight(), mask, bits);
  return bits[0];
}

// BoxLanes::overlapping, as it is there: by the widest gap. One comparison, as masks are joined
// more slowly than vectors.
HWY_INLINE uint32_t overlapping(const BoxLanes& boxes, const Box3& box) {
  const Eight d;
  uint32_t bits = 0;
  for (uint32_t part = 0; part < BoxLanes::kLanes; part += kPart) {
    const auto gap = [&](int axis) {
      return hn::Max(hn::Sub(hn::LoadU(d, boxes.low[axis] + part), hn::Set(d, box.high[axis])),
                     hn::Sub(hn::Set(d, box.low[axis]), hn::LoadU(d, boxes.high[axis] + part)));
    };
    const auto widest = hn::Max(gap(0), hn::Max(gap(1), gap(2)));
    bits |= bits_of(hn::Le(widest, hn::Zero(d))) << part;
  }
  return bits;
}

// The corners of the faces of a leaf, one vector or two for each of the three.
class LeafCorners {
 public:
  HWY_INLINE explicit LeafCorners(const uint32_t* corners) {
    const EightIds d;
    for (uint32_t part = 0; part < BoxLanes::kLanes; part += kPart) {
      hn::Vec<EightIds> a, b, c;
      hn::LoadInterleaved3(d, corners + size_t{3} * part, a, b, c);
      hn::StoreU(a, d, id_[0] + part);
      hn::StoreU(b, d, id_[1] + part);
      hn::StoreU(c, d, id_[2] + part);
    }
  }
  // Which of the faces have a corner of this one.
  HWY_INLINE uint32_t sharing(const uint32_t* face) const {
    const EightIds d;
    uint32_t bits = 0;
    for (uint32_t part = 0; part < BoxLanes::kLanes; part += kPart) {
      // 0 where an id is v.
      const auto apart = [&](uint32_t v) {
        const auto id = hn::Set(d, v);
        return hn::Min(hn::Xor(hn::LoadU(d, id_[0] + part), id),
                       hn::Min(hn::Xor(hn::LoadU(d, id_[1] + part), id),
                               hn::Xor(hn::LoadU(d, id_[2] + part), id)));
      };
      const auto all = hn::Min(apart(face[0]), hn::Min(apart(face[1]), apart(face[2])));
      bits |= bits_of(hn::RebindMask(Eight(), hn::Eq(all, hn::Zero(d)))) << part;
    }
    return bits;
  }

 private:
  uint32_t id_[3][BoxLanes::kLanes];
};

HWY_INLINE uint32_t lowest_bit(uint32_t bits) {
  return static_cast<uint32_t>(std::countr_zero(bits));
}

// Of `leaf` with a later leaf, or itself, whose box is other_box.
HWY_INLINE size_t pairs_of_leaves(const FaceBoxes& tree, uint32_t leaf, const Box3& other_box,
                                  uint32_t other, CandidatePair* pairs) {
  const uint32_t moved = tree.leaf_moved[leaf];
  uint32_t near = overlapping(tree.leaves[leaf], other_box);
  if (tree.leaf_moved[other] == 0) near &= moved;
  if (near == 0) return 0;
  size_t found = 0;
  for (; near != 0; near &= near - 1) {
    const uint32_t k = lowest_bit(near), f = leaf * BoxLanes::kLanes + k;
    uint32_t hits = overlapping(tree.leaves[other], tree.leaves[leaf].at(k));
    if ((moved >> k & 1) == 0) hits &= tree.leaf_moved[other];
    if (other == leaf) hits &= ~((2U << k) - 1);
    if (hits == 0) continue;
    const LeafCorners corners(tree.corners + size_t{3} * other * BoxLanes::kLanes);
    hits &= ~corners.sharing(tree.corners + size_t{3} * f);
    for (; hits != 0; hits &= hits - 1) {
      pairs[found++] = {f, other * BoxLanes::kLanes + lowest_bit(hits)};
    }
  }
  return found;
}

size_t face_pairs(const FaceBoxes& tree, uint32_t leaf, const uint32_t* nodes, size_t count,
                  CandidatePair* pairs) {
  const uint32_t own = leaf / BoxLanes::kLanes, lane = leaf % BoxLanes::kLanes;
  const Box3 box = tree.nodes[own].at(lane);
  const bool moved = tree.leaf_moved[leaf] != 0;
  size_t found = 0;
  for (size_t n = 0; n < count; ++n) {
    const uint32_t node = nodes[n];
    if (node < own) continue;
    uint32_t hits = overlapping(tree.nodes[node], box);
    if (!moved) hits &= tree.node_moved[node];
    if (node == own) hits &= ~((1U << lane) - 1);
    for (; hits != 0; hits &= hits - 1) {
      const uint32_t k = lowest_bit(hits);
      found += pairs_of_leaves(tree, leaf, tree.nodes[node].at(k), node * BoxLanes::kLanes + k,
                               pairs + found);
    }
  }
  return found;
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(face_pairs);

size_t face_pairs(SimdTarget simd, const FaceBoxes& tree, uint32_t leaf, const uint32_t* nodes,
                  size_t count, CandidatePair* pairs) {
  return PLC_DISPATCH(simd, face_pairs)(tree, leaf, nodes, count, pairs);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE

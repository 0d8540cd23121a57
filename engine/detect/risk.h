// Where the surface may soon meet itself: what the motion guard keeps an eye on.
//
// Two faces that meet share a vertex around which the surface folds, or each has a corner within
// kRiskReach of the other's: an edge of one pierces the other, and is at most half its length from
// the piercing point, as a corner of the pierced face is at most 1/sqrt 3 of its longest edge.
// Parts whose normals agree by more than kRiskDot are one sheet, or the outer two of three sheets,
// and then the middle one is at risk with both: if it is so large that its vertices' normals show
// it. Where it is a few faces that are turned over, the vertices around them have no normal to
// compare, and all that is near counts as turned against them. So a vertex v is at risk when
//   - a face around it is turned by more than kRiskDot against its normal: looked at after every
//     movement, around all that may have moved (a thin face turns over when it hardly moves), or
//   - for a vertex w within kRiskReach that is no neighbour and is turned against it by more than
//     that, a face of v and one of w that have no common vertex are not kRiskGap apart; w is then
//     at risk, too. Like the constraints, this is looked at when a vertex is due, and when a face
//     around it has turned over: of two vertices the later look counts, and since then neither has
//     moved by more than kCheckPath.
#pragma once
#include <array>

#include "engine/mesh/mesh.h"

namespace plc {

// A vertex's flags: something is near; the surface folds around it.
inline constexpr uint8_t kNearRisk = 1, kFoldRisk = 2;

// Stars of larger valence are not looked at closely: at risk. One bit per vertex of a star.
inline constexpr uint32_t kRiskRing = 31;

// A vertex, number 0, and its ring. Face k has the numbers 0, k + 1 and the next one's.
struct RiskStar {
  // Filled with those of number 0 up to whole vectors; there is room for one more.
  using Stream = std::array<float, kRiskRing + 5>;
  struct Extent {
    float low, high;
  };

  // valence of v <= kRiskRing.
  RiskStar(const Mesh& mesh, uint32_t v);
  Vec3 at(uint32_t k) const { return {x[k], y[k], z[k]}; }
  uint32_t next(uint32_t k) const { return k + 1 == faces ? 1 : k + 2; }
  // Where all of them lie along an axis.
  Stream along(Vec3 axis) const;
  Extent extent(const Stream& along) const;

  uint32_t faces, padded;  // padded > faces
  std::array<uint32_t, kRiskRing + 1> id;
  Stream x, y, z;
};

// What may meet the faces of one vertex.
class Risk {
 public:
  // valence of v <= kRiskRing.
  Risk(const Mesh& mesh, uint32_t v);
  // False when planes that have kRiskGap room lie between the faces of v and those of w, but for
  // pairs of faces with a common vertex. v and w are not neighbours. What is said of v and w is
  // good for w and v, too: the room is that of the larger of both.
  bool may_meet(uint32_t w) const;

 private:
  const Mesh& mesh_;
  float steps_;
  RiskStar star_;
  // Along the normal of v.
  Vec3 normal_;
  RiskStar::Stream along_;
  RiskStar::Extent extent_;
};

}  // namespace plc

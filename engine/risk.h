// Where the surface may soon meet itself: what the motion guard keeps an eye on.
//
// Two faces that meet share a vertex around which the surface folds, or each has a corner within
// kRiskReach of the other's: an edge of one pierces the other, and is at most half its length from
// the piercing point, as a corner of the pierced face is at most 1/sqrt 3 of its longest edge.
// Parts whose normals agree by more than kRiskDot are one sheet, or the outer two of three sheets,
// and then the middle one is at risk with both. So a vertex v is at risk when
//   - a face around it is turned by more than kRiskDot against its normal: looked at after every
//     movement, around all that may have moved (a thin face turns over when it hardly moves), or
//   - for a vertex w within kRiskReach that is no neighbour and has a normal turned by more than
//     that, a face of v and one of w that have no common vertex are not kRiskGap apart; w is then
//     at risk, too. Like the constraints, this is looked at when a vertex is due: of two vertices
//     the later look counts, and since then neither has moved by more than kCheckPath.
#pragma once
#include "engine/mesh.h"

namespace plc {

// False when planes that have kRiskGap room lie between the faces of v and those of w, but for
// pairs of faces with a common vertex. v and w are not neighbours; ring is that of v.
bool may_meet(const Mesh& mesh, uint32_t v, const Neighbors& ring, uint32_t w);

}  // namespace plc

// How often a vertex has turned, which is what ends every level.
//
// On noise, and on parts thinner than (3) allows, the model never rests: tips grow, are cut off and
// vanish, sheets join, are cut and recede. A vertex turns when it moves along its normal to the
// side that it did not move to last, and when the motion guard takes it back; an annular or axial
// transformation is kTransformationTurns at once for the vertices that it makes. With more than
// kSwingingTurns it keeps no velocity; beyond kFreeTurns each turn halves how far it may move; with
// kFrozenTurns it is frozen: it stays where it is until the level ends. The turns that a vertex has
// left only become fewer while the level lasts; one that two merge into has no more left than
// either, one between two others no more than the mean of theirs. What moves for ever within an
// image turns for ever, so all of it freezes. Not covered is what makes new vertices with turns
// left for ever: what goes along the surface carries vertices from where they are made to where
// they are merged. That is beta_gradI, and in a stretched metric every movement along the normals
// of the metric. --max-iterations ends that.
//
// Of bubbles that start on I_0 turns do not count before they have come to what they approach, see
// motion/travel.h.
//
// What has turned kFreeTurns times is not cut any more, and what is frozen not joined
// (transform/candidate.h): thin parts that break and grow again end as one piece. In an adaptive
// mesh only what the image does not have is cut, whatever has turned; without joins, which end,
// cuts end.
//
// One byte of a stream of the mesh: the number of turns, and above it the side of the last
// movement, 1 outwards, 2 inwards, 0 none yet.
#pragma once
#include <algorithm>
#include <cstdint>

#include "engine/base/constants.h"
#include "kernels/integrate.h"

namespace plc {

inline constexpr uint32_t kFrozenTurns = kFreeTurns + kernels::kSlowingTurns;
static_assert(kFrozenTurns <= kernels::kTurnsMask);
inline constexpr uint32_t kSideShift = 6;
static_assert(kernels::kTurnsMask == (1U << kSideShift) - 1);

inline uint32_t turns_of(uint8_t state) {
  return state & kernels::kTurnsMask;
}
inline bool frozen(uint8_t state) {
  return turns_of(state) >= kFrozenTurns;
}
inline uint8_t with_turns(uint8_t state, uint32_t turns) {
  return static_cast<uint8_t>((state & ~kernels::kTurnsMask) | std::min(turns, kFrozenTurns));
}
// The state after so many more turns.
inline uint8_t turned(uint8_t state, uint32_t turns) {
  return with_turns(state, turns_of(state) + turns);
}
// The state after a movement to a side of the surface, 1 or 2, or one too slow to count, 0. Without
// branches: it is run over whole blocks.
inline uint8_t moved_to_side(uint8_t state, uint32_t side) {
  const uint32_t last = uint32_t{state} >> kSideShift;
  const uint32_t turn = static_cast<uint32_t>(side + last == 3);
  return static_cast<uint8_t>(std::min(turns_of(state) + turn, kFrozenTurns) |
                              (side == 0 ? last : side) << kSideShift);
}
// Of the last movement: 1 outwards, -1 inwards, 0 none.
inline int outwards_of(uint8_t state) {
  const uint32_t side = uint32_t{state} >> kSideShift;
  return static_cast<int>(side & 1) - static_cast<int>(side >> 1);
}
// The state of a new vertex between two others.
inline uint8_t turns_between(uint8_t a, uint8_t b) {
  return with_turns(0, (turns_of(a) + turns_of(b) + 1) / 2);
}

}  // namespace plc

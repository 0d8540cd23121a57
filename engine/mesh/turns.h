// How often a vertex has turned, which is what ends every level.
//
// On noise, and on parts thinner than (3) allows, the model never rests: tips grow, are cut off and
// vanish, sheets join, are cut and recede. A vertex turns when it moves along its normal to the
// side that it did not move to last, and when the motion guard takes it back; an annular or axial
// transformation is kTransformationTurns at once for the vertices that it makes. From kFreeTurns on
// each turn halves how far it may move; with kFrozenTurns it is frozen: it stays where it is until
// the level ends. Turns are never taken back, and what is created starts with those of what it is
// created from: a place goes round in circles so many times and no more.
//
// What has turned kFreeTurns times is not cut any more, and what is frozen not joined
// (resolution.h): thin parts that break and grow again end as one piece.
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

inline uint32_t turns_of(uint8_t state) {
  return state & kernels::kTurnsMask;
}
inline bool frozen(uint8_t state) {
  return turns_of(state) >= kFrozenTurns;
}
inline uint8_t with_turns(uint8_t state, uint32_t turns) {
  return static_cast<uint8_t>((state & ~kernels::kTurnsMask) | std::min(turns, kFrozenTurns));
}
// After so many more.
inline uint8_t turned(uint8_t state, uint32_t turns) {
  return with_turns(state, turns_of(state) + turns);
}
// Of a vertex between two others.
inline uint8_t turns_between(uint8_t a, uint8_t b) {
  return with_turns(0, (turns_of(a) + turns_of(b) + 1) / 2);
}

}  // namespace plc

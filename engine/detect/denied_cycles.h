// Going past the paper: what an adaptive mesh cuts, by the word of the image.
//
// A hole that closes in a thin plate, as a coarse level tears them, ends as a pore: sheets go on
// from its border, nothing draws that into it, and its edges are no longer short. A bridge between
// two parts ends likewise as a tube. Where three edges go around either, the image tells.
#pragma once
#include <optional>

#include "engine/transform/candidate.h"

namespace plc {

// Of a mesh of sizes: whether the image says that what the cycle goes around is what the surface
// says it is, a part of the object or a way through it. The centre of what goes around a thin part
// may lie beside it: there the middle of an edge may tell that it is the object's.
bool image_has(const Mesh& mesh, const Cycle& cycle);

// An annular transformation along a cycle of three edges through u that goes around what the image
// does not have; else of four, around a way through the object that the image does not have. Where
// an adaptive mesh bends at u; not of cycles that have a few vertices alone on one side: those go
// around a tip, or around a vertex of three or four neighbours in a flat part.
std::optional<Candidate> denied_cycle(const Mesh& mesh, uint32_t u);

}  // namespace plc

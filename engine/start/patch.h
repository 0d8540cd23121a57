// A part of a larger surface as a mesh of the engine: what is held stays where it is, exactly, and
// the rest evolves as if all of the surface were there.
#pragma once
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"
#include "pyramid/status.h"

namespace plc {

// Adds faces to those of a manifold, oriented mesh until it is closed: around every border one
// vertex that is not in it, or, around a long one, a ring of them that is closed likewise, so that
// none has more than kMostClosing neighbours. abc: three ids per face; the new vertices are
// vertex_count and up. Returns how many there are.
inline constexpr size_t kMostClosing = 512;
size_t close_borders(size_t vertex_count, Vector<uint32_t>& abc, const Executor& executor);

// Of a vertex: it is held; it is free; it is free, and of the level above, so that the faces
// between such are refined (3.4).
inline constexpr uint8_t kFree = 0, kHeld = 1, kCoarse = 2;

// As import_mesh(), of what that has found to be a manifold without self-intersections. rounded:
// three floats per vertex.
Status fill_patch(const MeshArrays& given, const uint8_t* held, const float* rounded,
                  const Executor& executor, Mesh& mesh);

}  // namespace plc

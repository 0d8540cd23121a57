// The iso-surface of an image, of which regular_iso_surface.h makes what surfaces start from.
#pragma once
#include <cstdint>
#include <functional>

#include "engine/mesh/mesh.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/image_object.h"
#include "pyramid/memory.h"
#include "pyramid/status.h"

namespace plc {

// A vertex on a lattice edge stays this part of the edge away from its ends, so that no face
// degenerates and rounding has room. 0 would give faces of zero area, 1/2 a surface of steps.
inline constexpr double kIsoMargin = 0.1;

// Replaces what is in the mesh, but for delta, by the closed surface around the voxels of the
// object, by marching tetrahedra (cell_faces.h). Faces are outward. What reaches the image's border
// is closed half a voxel beyond it.
//
// Positions are of mesh space: voxel coordinate c = scale p + offset, scale > 0. Each image.dims >=
// 1. Ids in scan order of the voxels, 7 edges to a voxel; memory O(vertices + a few slices per
// thread); the same bits for any executor. About 4.5 vertices per square voxel of surface.
//
// Errors, the mesh unchanged: kInvalidData when all voxels are outside, kOutOfMemory for more
// vertices than ids have room for; throws std::bad_alloc.
Status iso_surface(const ImageObject& object, const Executor& executor, Mesh& mesh);

// Values that are computed as they are asked for, by any thread.
struct LatticeValues {
  // Of each x of a row, x growing: 1 where it is inside, 0 where not.
  std::function<void(int32_t y, int32_t z, uint8_t* inside)> sides;
  // Asked for at the ends of edges that lead from one side to the other.
  std::function<float(int32_t x, int32_t y, int32_t z)> at;
};

// Of an object, which outlives them.
LatticeValues values_of(const ImageObject& object);

// The same of such values; of the object the image's dims, scale and offset are read, and iso.
// `voxel` gets, for each vertex, a number of the voxel inside on whose edge it lies.
Status iso_surface(const ImageObject& object, const LatticeValues& values, const Executor& executor,
                   Mesh& mesh, Vector<uint64_t>* voxel = nullptr);

// The surface by marching cubes (cell_faces.h), about 1.5 vertices per square voxel, without what
// makes it a mesh of the engine's.
struct Crossings {
  Buffer<float> xyz;     // three per vertex, in mesh space
  Buffer<uint32_t> abc;  // three per face
};

// Components that enclose fewer than `least` voxels - parts of the object with all that is in them,
// and cavities - are left out, but for those that enclose most.
Status iso_crossings(const ImageObject& object, const LatticeValues& values, int64_t least,
                     const Executor& executor, Crossings& crossings);

}  // namespace plc

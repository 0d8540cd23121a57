// Where an image and a surface disagree about the side, too far from the surface to be its matter.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "engine/mesh.h"
#include "kernels/image.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"

namespace plc {

enum class Missed : uint8_t { kPart, kCavity };

// Of a voxel of the image.
inline size_t voxel_index(const ImageView& image, const std::array<int32_t, 3>& v) {
  const auto size = [](int32_t n) { return static_cast<size_t>(n); };
  return (size(v[2]) * size(image.dims[1]) + size(v[1])) * size(image.dims[0]) + size(v[0]);
}

struct MissedPlaces {
  // By voxel: 0, or 1 + the kind of a place that is to get a bubble.
  Buffer<uint8_t> kind;
  std::array<int64_t, 2> count{0, 0};  // places of each kind
  // Their box, voxels; low > high where there are none.
  std::array<std::array<int32_t, 3>, 2> low, high;

  bool is(size_t voxel, Missed m) const { return kind[voxel] == 1 + static_cast<uint8_t>(m); }
};

// Places are sets of voxels connected by faces, edges or corners: of the object (a value >= iso, or
// <= iso), outside the surface - or not of it, and inside - and none within `clearance` of a vertex
// (mesh units). Those that hold no ball of `radius`, and those with a voxel that `tried` marks, are
// left out; the others are marked in it, which is empty or has a byte per voxel.
MissedPlaces find_missed_places(const Mesh& mesh, const ImageView& image, float iso,
                                bool inside_above, float clearance, float radius,
                                const Executor& executor, Buffer<uint8_t>& tried);

}  // namespace plc

// A shape in a volume: where it lies, and what the volume does to it.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/double3.h"
#include "perf/truth/shapes.h"

namespace truth {

using Matrix = std::array<double, 9>;  // row-major

plc::Double3 times(const Matrix& m, const plc::Double3& p);
plc::Double3 transposed_times(const Matrix& m, const plc::Double3& p);

// Places are "of the volume" in mm from the centre of voxel (0,0,0) along its axes, unless said
// otherwise. The geometric mean of the spacing is 1 mm: distances in mm are distances in voxels.
struct Scene {
  Shape shape;
  double sigma = 0;  // of the Gaussian, voxels along each axis
  double noise = 0;  // standard deviation, of the contrast
  uint64_t seed = 1;
  std::array<double, 3> spacing{1, 1, 1};  // mm
  std::array<int, 3> dims{};
  Matrix turn{};                                // the shape's axes to the volume's
  plc::Double3 centre;                          // of the shape
  Matrix direction{1, 0, 0, 0, 1, 0, 0, 0, 1};  // columns are the volume's axes in LPS
  plc::Double3 origin;                          // LPS, of voxel (0,0,0)

  double signed_distance(const plc::Double3& p) const {
    return shape.distance(transposed_times(turn, p - centre));
  }
  plc::Double3 from_lps(const plc::Double3& p) const {
    return transposed_times(direction, p - origin);
  }
  plc::Double3 to_lps(const plc::Double3& p) const { return origin + times(direction, p); }
};

// What the programs' help says of a scene.
extern const char* const kSceneHelp;

// Takes the options of a scene and its shape, the first word that is no option, out of `words`;
// the rest stays. Throws Failure.
Scene take_scene(std::vector<std::string>& words);

}  // namespace truth

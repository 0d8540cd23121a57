// The pyramid of images of any reduction factor (paper, 4.2, eq. (9)-(13), appendix A).
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/image.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/status.h"
#include "pyramid/volume.h"

namespace plc {

class CachedBricks;
class ReducedBricks;

// One image I_h, values in [0,1], x fastest. I_0 is the caller's volume where it lies: borrowed, in
// its own type, padded and normalised as it is read, or a copy of its integers in floats, read so.
// Where that cannot be (see build_pyramid) and on the levels above it is a buffer of floats; or, of
// a volume of bricks, bricks, too.
struct PyramidLevel {
  std::array<int64_t, 3> dims{0, 0, 0};  // M_h, N_h, P_h (11)
  std::array<double, 3> voxel{0, 0, 0};  // mu/M_h, nu/N_h, pi/P_h, mm
  double unit = 0;                       // U_h = rho^h U_0 (11), mm
  Buffer<float> values;                  // empty where the voxels are borrowed, and once released
  const void* borrowed = nullptr;        // else null
  VoxelForm form;                        // how either are read, and bricks
  std::shared_ptr<const CachedBricks>
      bricks{};  // of I_0, and of levels above it those of `reduced`
  std::shared_ptr<ReducedBricks> reduced{};

  // What the evolution needs no longer.
  void release() {
    values = Buffer<float>();
    bricks.reset();
    reduced.reset();
  }
};

// The voxels of a level as the kernels read them, each at its index: scale 1, offset 0.
ImageView level_image(const PyramidLevel& level);
// The levels without their values: what is left to know when the images are not needed any more.
struct Pyramid;
Pyramid without_values(const Pyramid& pyramid);

struct PyramidSpec {
  double reduction = 1.7320508075688772;   // rho, 1 < rho <= 2
  int levels = 3;                          // levels above I_0, >= 0
  double window_low = 0, window_high = 1;  // mapped to 0 and 1, clipped; low < high
  double pad_value = 0;                    // in the image's units
  int pad_voxels = 6;                      // added on every side of I_0
  bool sparse = false;  // of bricks: every level above I_0 is made where it is read
};

struct Pyramid {
  std::vector<PyramidLevel> levels;  // [0] is I_0, padded and normalised
};

// The smallest and largest voxel and whether all are finite; every voxel is read once.
struct VoxelRange {
  double low = 0, high = 0;
  int64_t not_finite = 0;  // number of NaN or infinite voxels
};
VoxelRange voxel_range(const VolumeView& volume, const Executor& executor);

// The most levels above I_0 whose coarsest image has at least kMinLevelDim voxels on every axis.
inline constexpr int64_t kMinLevelDim = 4;
int max_levels(const std::array<int64_t, 3>& padded_dims, double reduction);

// The value that a voxel of the volume with `value` has on I_0, the same bits: an iso-value between
// voxels stays between them, one that is a voxel's value stays it.
float base_value(const VolumeView& volume, const PyramidSpec& spec, double value);

// The size of I_0: `dims`, of a volume that check_volume has passed, with the padding on every
// side.
std::array<int64_t, 3> padded_dims(const std::array<int64_t, 3>& dims, int pad_voxels);
// kInvalidData: that is too large for a volume, or for an image of floats, which 32-bit integers
// become.
Status check_padded(const VolumeView& volume, int pad_voxels);

// Builds levels 0 .. spec.levels. I_0 borrows volume.voxels, which must outlive the pyramid; 32-bit
// integers, and what has a window beyond the range of floats, become floats. Errors:
// kInvalidArgument (reduction, window, level count too deep for the size), kInvalidData (dims, a
// level of floats of 2^31 voxels or more), kOutOfMemory. The same bits for any executor and any
// target. Of a volume of bricks the levels from the coarsest on that fit into the limit of its
// cache together are built whole, the others by bricks as they are read.
Status build_pyramid(const VolumeView& volume, const PyramidSpec& spec, const Executor& executor,
                     Pyramid& pyramid);

// The part of the object that a coarse level may lose from sight; see covering_isos.
inline constexpr double kUncoveredPart = 0.05;

// The iso value of each level, in [0,1]: that of I_0, and on a coarse level the one nearest to it
// at which the level's object (>= iso when inside_above, else <= iso) still holds the centres of
// all but kUncoveredPart of the voxels of the object on I_0, but never beyond `bound`: what
// surrounds the object would be taken for it. Thin parts fade on coarse levels (4.2, 5.3): at one
// value for all they would be lost there, and a surface that has shrunk past a part does not come
// back to it. result[0] == iso_0; all lie in (0,1). The same for any executor and target.
std::vector<double> covering_isos(const Pyramid& pyramid, double iso_0, bool inside_above,
                                  double bound, const Executor& executor);

}  // namespace plc

// How fine a mesh is to be where it is, from the image alone: small where the iso-surface bends,
// large where it is flat, and of a bounded slope between. After Lachaud and Taton, Deformable model
// with a complexity independent from image resolution (CVIU 2005), whose structure tensor tells how
// much normals turn within a window; here sizes are the same in all directions of the tangent
// plane, and how near sheets may come is left to the image (engine/mesh/sizing.h).
#pragma once
#include <array>
#include <cstdint>

#include "kernels/image.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/status.h"
#include "pyramid/voxel_room.h"

namespace plc {

// Edges of a mesh are so many sizes long, in the mean.
inline constexpr double kMeanEdge = 1.5;

// What sizes are asked for, in delta of the level's uniform mesh: there every size is 1.
struct SizeSpec {
  double finest = 0.5, coarsest = 4;  // within [1/32, 255/32]
  // Of facets from a surface that bends as the image's does, the mean distance along its normal.
  double tolerance = 0.05;
  double slope = 0.1;  // by how much sizes grow with the distance, at most
};

// SizeField::noise() of an image as build() takes it, from some of the places that the iso-surface
// passes, before there is a field.
float surface_noise(const ImageView& image, float iso, double delta, const Executor& executor);

// Sizes of cubes of voxels: a byte each, in steps of 1/32 delta. Read by any thread, but for while
// they are built or lowered.
class SizeField {
 public:
  static constexpr float kStep = 1.0F / 32;
  // The range of above_delta(), in delta.
  static constexpr float kLeast = kStep - 1, kMost = 255 * kStep - 1;

  // image: of the level, its scale and offset those of mesh space; clipped to its window most of it
  // is even, and noise is not seen. delta: in mesh units. The same bits for any executor. Where the
  // iso-surface is not near, sizes are the coarsest that the slope allows. padding: voxels on each
  // side that nobody measured, which have no noise. room: what alone is looked at and has sizes of
  // its own, with up to 15 voxels around it. Errors: kOutOfMemory.
  Status build(const ImageView& image, float iso, double delta, const SizeSpec& spec,
               const Executor& executor, int32_t padding, const VoxelRoom& room);
  Status build(const ImageView& image, float iso, double delta, const SizeSpec& spec,
               const Executor& executor) {
    return build(image, iso, delta, spec, executor, image.form.pad, whole_room(image));
  }

  // In the cube of a voxel of the image, and in `around` cubes on all sides of it, sizes become
  // `most` delta or less, but not less than the finest. bound_slope() brings those around them back
  // within the slope: what comes out depends on all voxels that were lowered, not on their order
  // nor on how often it was called.
  void lower(const std::array<int32_t, 3>& voxel, float most, int32_t around);
  void bound_slope();

  // By how much the size at a place of mesh space is above delta, in delta: what a mesh keeps with
  // its vertices. Trilinear between the centres of the cubes; beyond the image that of its border.
  float above_delta(float x, float y, float z) const;

  // The smallest and the largest size asked for, in delta.
  float finest() const { return finest_; }
  float coarsest() const { return coarsest_; }
  // What the image's noise moves its iso-surface by, standard deviation in delta: that of a voxel
  // over the gradient there, the median over where the surface passes. 0 where there is none.
  float noise() const { return noise_; }
  // No size is larger than another by more than this times their distance.
  float slope() const { return slope_; }

 private:
  class Builder;
  void sweep(int direction);

  std::array<int32_t, 3> first_{0, 0, 0};  // cell of the image
  std::array<int32_t, 3> cells_{0, 0, 0};
  std::array<float, 3> scale_{1, 1, 1}, offset_{0, 0, 0};  // mesh space to cells
  float slope_ = 0, finest_ = 1, coarsest_ = 1, noise_ = 0;
  Buffer<uint8_t> sizes_;
  std::array<int, 4> steps_{};  // of codes, to the next cube: itself, by a face, an edge, a corner
  std::array<int32_t, 3> low_{}, high_{};  // cells that were lowered; low > high: none
};

}  // namespace plc

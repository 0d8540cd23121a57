// I_0: the volume in a border of one value, its window mapped to [0,1]; borrowed, or written.
#pragma once
#include <array>
#include <cstdint>

#include "kernels/image.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/volume.h"

namespace plc {

struct Window {
  double low = 0;   // maps to 0, as does everything below and NaN
  double high = 1;  // maps to 1, as does everything above
  // 0 where there is nothing between them: all maps to 0.
  double scale() const { return low < high ? 1 / (high - low) : 0; }
};

// How the volume's own voxels are read as I_0: (v - low) scale in floats, as kernels/image.h has
// it. Type kUnit where they cannot be: 32-bit integers, and windows beyond the range of floats.
VoxelForm borrowed_form(const VolumeView& volume, const Window& window, int64_t pad,
                        double pad_value);

// The same of 32-bit integers as floats, which are written into `voxels` and read as the form has
// it: the bits of equal voxels of a type that can be borrowed. Nothing is written, and the type is
// kUnit, where floats do not hold the window.
VoxelForm converted_form(const VolumeView& volume, const Window& window, int64_t pad,
                         double pad_value, const Executor& executor, Buffer<float>& voxels);

// What a voxel of this value has on I_0: the same bits as the voxel itself.
float window_value(const VolumeView& volume, const Window& window, double value);

// Writes (M + 2 pad) (N + 2 pad) (P + 2 pad) values, x fastest: the bits of the borrowed image
// where there is one, and those of equal voxels of another type. Windows beyond the range of
// floats, or of the integers that floats hold, are mapped by double arithmetic.
void make_base_image(const VolumeView& volume, const Window& window, int64_t pad, double pad_value,
                     const Executor& executor, float* values);

}  // namespace plc

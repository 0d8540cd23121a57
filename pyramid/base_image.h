// I_0: the volume in a border of one value, its window mapped to [0,1].
#pragma once
#include <array>
#include <cstdint>

#include "kernels/simd.h"
#include "pyramid/executor.h"
#include "pyramid/volume.h"

namespace plc {

struct Window {
  double low = 0;    // maps to 0, as does everything below and NaN
  double scale = 1;  // 1 / (high - low); high and everything above map to 1
};

// Writes (M + 2 pad) (N + 2 pad) (P + 2 pad) values, x fastest.
void make_base_image(const VolumeView& volume, const Window& window, int64_t pad, double pad_value,
                     const Executor& executor, SimdTarget simd, float* values);

}  // namespace plc

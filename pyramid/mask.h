// A mask: where a volume is not 0.
#pragma once
#include <cstdint>

#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/volume.h"

namespace plc {

// Whether a voxel is neither 0 nor NaN.
bool is_any_set(const VolumeView& volume, const Executor& executor);

// object[i] = 1 where voxel i is neither 0 nor NaN, else 0. False where there is none.
bool set_voxels(const VolumeView& volume, const Executor& executor, Buffer<uint8_t>& object);

}  // namespace plc

// Hashes that tell whether a saved run is restored with what it was saved with.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/api/frame.h"
#include "engine/pellicle.h"
#include "engine/recover/recovery.h"
#include "pyramid/executor.h"
#include "pyramid/volume.h"

namespace plc {

// Of bytes, eight at a time: as fast as memory. Against accidents, not against forgery.
uint64_t words_hash(const void* data, size_t size);
// Of the size, the spacing and the voxels. The same for any executor.
uint64_t voxels_hash(const VolumeView& volume, const Executor& executor);
// Of every field.
uint64_t frame_hash(const Frame& frame);
uint64_t parameters_hash(const plc_parameters& parameters);
// Of seeds, start mesh, attachments and pins, and whether there is a force.
uint64_t given_hash(const RecoverySpec& spec);

}  // namespace plc

// Voxels as files store them, made into those that the engine takes by bricks.
#pragma once
#include <cstddef>
#include <optional>

#include "engine/pellicle.h"
#include "tools/volume/volume_io_itk.h"

namespace plc::tools {

struct StoredVoxels {
  ItkComponent component = ItkComponent::kU8;
  bool big_endian = false;
  // What a voxel v stands for is slope * v + intercept.
  double slope = 1, intercept = 0;

  bool scaled() const { return slope != 1 || intercept != 0; }
};

// The type that they become, the one that read_volume() gives; nothing where it depends on their
// values, or the engine does not take it.
std::optional<plc_voxel_type> brick_type(const StoredVoxels& stored);
// Whether they are of that type as they stand.
bool as_stored(const StoredVoxels& stored);

// `count` voxels, as they stand in the file, to the type of brick_type().
void convert(const StoredVoxels& stored, std::byte* from, size_t count, std::byte* to);

}  // namespace plc::tools

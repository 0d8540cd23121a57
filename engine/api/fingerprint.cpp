#include "engine/api/fingerprint.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "engine/api/parameter_list.h"
#include "engine/base/blocks.h"
#include "engine/base/fnv.h"

namespace plc {

namespace {

constexpr size_t kBlock = size_t{1} << 20U;

size_t voxel_bytes(VoxelType type) {
  switch (type) {
    case VoxelType::kU8:
      return 1;
    case VoxelType::kI16:
    case VoxelType::kU16:
      return 2;
    default:
      return 4;
  }
}

void add(Fnv& hash, Vec3 v) {
  for (const float x : {v.x, v.y, v.z}) hash.add(x);
}

}  // namespace

uint64_t words_hash(const void* data, size_t size) {
  const auto* bytes = static_cast<const uint8_t*>(data);
  uint64_t hash = 0xCBF29CE484222325ULL ^ size;
  const auto mix = [&hash](uint64_t word) {
    hash = std::rotl((hash ^ word) * 0x9E3779B97F4A7C15ULL, 29);
  };
  size_t i = 0;
  for (; size - i >= sizeof(uint64_t); i += sizeof(uint64_t)) {
    uint64_t word;
    std::memcpy(&word, bytes + i, sizeof word);
    mix(word);
  }
  uint64_t rest = 0;
  if (i < size) std::memcpy(&rest, bytes + i, size - i);
  mix(rest);
  return hash ^ hash >> 32U;
}

uint64_t voxels_hash(const VolumeView& volume, const Executor& executor) {
  size_t bytes = voxel_bytes(volume.type);
  Fnv hash;
  hash.add(static_cast<uint32_t>(volume.type));
  for (size_t a = 0; a < 3; ++a) {
    hash.add(static_cast<uint64_t>(volume.dims[a]));
    hash.add(volume.spacing[a]);
    bytes *= static_cast<size_t>(volume.dims[a]);
  }
  std::vector<uint64_t> part(block_count(bytes, kBlock));
  run_blocks(executor, bytes, kBlock, [&](size_t index, size_t begin, size_t end) {
    if (volume.bricks == nullptr) {
      part[index] = words_hash(static_cast<const uint8_t*>(volume.voxels) + begin, end - begin);
      return;
    }
    Vector<uint8_t> block(end - begin);
    const size_t size = voxel_bytes(volume.type);
    read_voxels(volume, begin / size, block.size() / size, block.data());
    part[index] = words_hash(block.data(), block.size());
  });
  hash.add_all(part);
  return hash.value();
}

uint64_t frame_hash(const Frame& frame) {
  Fnv hash;
  hash.add_all(frame.spacing);
  hash.add_all(frame.origin);
  hash.add_all(frame.direction);
  return hash.value();
}

uint64_t parameters_hash(const plc_parameters& p) {
  Fnv hash;
  for (const plc_parameter_info& info : parameter_list()) {
    for (int i = 0; i < given_values(p, info); ++i) hash.add(parameter_value(p, info, i));
  }
  return hash.value();
}

uint64_t given_hash(const RecoverySpec& spec) {
  Fnv hash;
  for (const Seed& s : spec.start.seeds) {
    hash.add_all(s.centre);
    hash.add_all(s.radii);
  }
  hash.add_all(spec.start.xyz);
  hash.add_all(spec.start.abc);
  for (const Attachment& a : spec.user.attachments) {
    add(hash, a.place);
    hash.add(a.radius);
    hash.add(a.strength);
  }
  for (const Pin& p : spec.user.pins) {
    add(hash, p.place);
    hash.add(p.radius);
  }
  for (const size_t n : {spec.start.seeds.size(), spec.start.xyz.size(),
                         spec.user.attachments.size(), spec.user.pins.size()}) {
    hash.add(static_cast<uint64_t>(n));
  }
  hash.add(static_cast<uint32_t>(spec.force ? 1 : 0));
  if (!spec.obstacle_abc.empty()) {
    hash.add_all(spec.obstacle_xyz);
    hash.add_all(spec.obstacle_abc);
    hash.add(spec.obstacle_gap);
  }
  return hash.value();
}

}  // namespace plc

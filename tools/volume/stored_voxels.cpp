#include "tools/volume/stored_voxels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace plc::tools {

namespace {

template <typename From, typename To>
void convert(const StoredVoxels& stored, const std::byte* from, size_t count, std::byte* to) {
  for (size_t i = 0; i < count; ++i) {
    From voxel;
    std::memcpy(&voxel, from + i * sizeof voxel, sizeof voxel);
    auto value = static_cast<To>(voxel);  // NOLINT(bugprone-signed-char-misuse): a number
    if (stored.scaled()) {
      value = static_cast<To>(stored.slope * static_cast<double>(voxel) + stored.intercept);
    }
    std::memcpy(to + i * sizeof value, &value, sizeof value);
  }
}

}  // namespace

std::optional<plc_voxel_type> brick_type(const StoredVoxels& stored) {
  if (stored.scaled()) return PLC_F32;
  switch (stored.component) {
    case ItkComponent::kU8:
      return PLC_U8;
    case ItkComponent::kI8:
    case ItkComponent::kI16:
      return PLC_I16;
    case ItkComponent::kU16:
      return PLC_U16;
    case ItkComponent::kF32:
    case ItkComponent::kF64:
      return PLC_F32;
    case ItkComponent::kI32:
    case ItkComponent::kU32:
    case ItkComponent::kI64:
    case ItkComponent::kU64:
      break;
  }
  return std::nullopt;
}

bool as_stored(const StoredVoxels& stored) {
  return !stored.scaled() && stored.component != ItkComponent::kI8 &&
         stored.component != ItkComponent::kF64;
}

void convert(const StoredVoxels& stored, std::byte* from, size_t count, std::byte* to) {
  const size_t size = component_size(stored.component);
  if (stored.big_endian) {
    for (size_t i = 0; i < count; ++i) std::reverse(from + i * size, from + (i + 1) * size);
  }
  if (as_stored(stored)) {
    std::memcpy(to, from, count * size);
    return;
  }
  switch (stored.component) {
    case ItkComponent::kU8:
      return convert<uint8_t, float>(stored, from, count, to);
    case ItkComponent::kI8:
      if (!stored.scaled()) return convert<int8_t, int16_t>(stored, from, count, to);
      return convert<int8_t, float>(stored, from, count, to);
    case ItkComponent::kU16:
      return convert<uint16_t, float>(stored, from, count, to);
    case ItkComponent::kI16:
      return convert<int16_t, float>(stored, from, count, to);
    case ItkComponent::kU32:
      return convert<uint32_t, float>(stored, from, count, to);
    case ItkComponent::kI32:
      return convert<int32_t, float>(stored, from, count, to);
    case ItkComponent::kU64:
      return convert<uint64_t, float>(stored, from, count, to);
    case ItkComponent::kI64:
      return convert<int64_t, float>(stored, from, count, to);
    case ItkComponent::kF32:
      return convert<float, float>(stored, from, count, to);
    case ItkComponent::kF64:
      return convert<double, float>(stored, from, count, to);
  }
}

}  // namespace plc::tools

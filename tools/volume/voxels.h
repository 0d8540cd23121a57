// The voxels of an image in memory, in their type.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/pellicle.h"

namespace plc::tools {

// Returns visit(first, last): of the voxels, x fastest, without gaps.
template <typename Visit>
auto with_voxels(const plc_image& image, const Visit& visit) {
  const auto count = static_cast<size_t>(image.dims[0] * image.dims[1] * image.dims[2]);
  const auto all = [&]<typename T>(T) {
    const T* first = static_cast<const T*>(image.voxels);
    return visit(first, first + count);
  };
  switch (image.type) {
    case PLC_U8:
      return all(uint8_t{});
    case PLC_I16:
      return all(int16_t{});
    case PLC_U16:
      return all(uint16_t{});
    case PLC_I32:
      return all(int32_t{});
    case PLC_F32:
      break;
  }
  return all(float{});
}

}  // namespace plc::tools

// What the programs for comparison share: the volume as floats, a clock, the report.
#pragma once
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/volume/volume_io.h"

namespace peer {

struct Volume {
  std::array<int, 3> dims{};
  std::array<double, 3> spacing{};
  std::array<double, 3> origin{};     // LPS, mm: the centre of voxel (0,0,0)
  std::array<double, 9> direction{};  // row-major, columns are the axes in LPS
  std::vector<float> values;          // as in the file, x fastest
};

template <typename T>
void widen(const plc::tools::LoadedVolume& loaded, std::vector<float>& values) {
  const auto* voxels = static_cast<const T*>(loaded.image.voxels);
  for (float& value : values) value = static_cast<float>(*voxels++);
}

// Throws Failure.
inline Volume read(const std::string& path) {
  const plc::tools::LoadedVolume loaded = plc::tools::read_volume(path);
  Volume volume;
  size_t count = 1;
  for (size_t a = 0; a < 3; ++a) {
    volume.dims[a] = static_cast<int>(loaded.image.dims[a]);
    volume.spacing[a] = loaded.image.spacing[a];
    volume.origin[a] = loaded.image.origin[a];
    count *= static_cast<size_t>(loaded.image.dims[a]);
  }
  std::copy_n(loaded.image.direction, 9, volume.direction.begin());
  volume.values.resize(count);
  switch (loaded.image.type) {
    case PLC_U8:
      widen<uint8_t>(loaded, volume.values);
      break;
    case PLC_I16:
      widen<int16_t>(loaded, volume.values);
      break;
    case PLC_U16:
      widen<uint16_t>(loaded, volume.values);
      break;
    case PLC_I32:
      widen<int32_t>(loaded, volume.values);
      break;
    case PLC_F32:
      widen<float>(loaded, volume.values);
      break;
  }
  return volume;
}

// `voxels` voxels of `value` more on every side: what the border cuts comes out closed. Voxel
// (0,0,0) of the result lies outside of the volume; the origin stays that of the volume.
inline Volume padded(const Volume& volume, int voxels, float value) {
  Volume out = volume;
  for (int& n : out.dims) n += 2 * voxels;
  const auto size = [](int n) { return static_cast<size_t>(n); };
  out.values.assign(size(out.dims[0]) * size(out.dims[1]) * size(out.dims[2]), value);
  auto from = volume.values.begin();
  for (int z = 0; z < volume.dims[2]; ++z) {
    for (int y = 0; y < volume.dims[1]; ++y) {
      const size_t row = size(z + voxels) * size(out.dims[1]) + size(y + voxels);
      const auto to =
          out.values.begin() + static_cast<std::ptrdiff_t>(row * size(out.dims[0]) + size(voxels));
      std::copy(from, from + volume.dims[0], to);
      from += volume.dims[0];
    }
  }
  return out;
}

// Seconds of body().
inline double timed(const std::function<void()>& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace peer

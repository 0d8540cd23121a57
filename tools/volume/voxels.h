// The voxels of an image, in their type, wherever they are.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/pellicle.h"
#include "tools/volume/brick_source.h"
#include "tools/volume/volume_io_memory.h"

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

// In memory, or read by bricks; borrowed.
class Voxels {
 public:
  Voxels(const plc_image& image) : image_(image) {}  // NOLINT(google-explicit-constructor): is one
  explicit Voxels(const BrickSource& source) : image_(source.image()), source_(&source) {}

  plc_voxel_type type() const { return image_.type; }
  // visit(first, last): of pieces that are all of the image together, one after the other.
  template <typename Visit>
  void visit(const Visit& visit) const {
    if (source_ == nullptr) return with_voxels(image_, visit);
    std::vector<std::byte> voxels;
    VoxelBox box{};
    const auto next = [&](size_t a, int64_t low) {
      box.low[a] = low;
      box.high[a] = std::min(low + source_->brick()[a], image_.dims[a]) - 1;
      return low < image_.dims[a];
    };
    for (int64_t z = 0; next(2, z); z += source_->brick()[2]) {
      for (int64_t y = 0; next(1, y); y += source_->brick()[1]) {
        for (int64_t x = 0; next(0, x); x += source_->brick()[0]) {
          plc_image piece = image_;
          for (size_t a = 0; a < 3; ++a) piece.dims[a] = box.high[a] - box.low[a] + 1;
          voxels.resize(static_cast<size_t>(piece.dims[0] * piece.dims[1] * piece.dims[2]) *
                        voxel_size(image_.type));
          source_->read(box, voxels.data());
          piece.voxels = voxels.data();
          with_voxels(piece, visit);
        }
      }
    }
  }

 private:
  plc_image image_;
  const BrickSource* source_ = nullptr;
};

}  // namespace plc::tools

#include "tests/fuzz/random_arguments.h"

#include <algorithm>

namespace fuzz {

namespace {

int64_t voxel_size(plc_voxel_type type) {
  switch (type) {
    case PLC_I16:
    case PLC_U16:
      return 2;
    case PLC_I32:
    case PLC_F32:
      return 4;
    default:
      return 1;
  }
}

}  // namespace

RandomImage::RandomImage(Input& input) {
  plc_image_defaults(&image_);
  image_.type = random_enum<plc_voxel_type>(input, 5);
  const int64_t voxel = voxel_size(image_.type);
  for (int64_t& dim : image_.dims) dim = 6 + input.below(5);
  make_layout(input, voxel);
  constexpr int64_t kDims[] = {1, 0, -1, INT64_MIN, INT64_MAX, int64_t{1} << 62};
  switch (input.below(8)) {
    case 0:  // refused for its size
      image_.dims[input.below(3)] = input.one_of(kDims);
      break;
    case 1:
      image_.voxels = nullptr;
      break;
    case 2:
      image_.spacing[input.below(3)] = random_double(input);
      image_.origin[input.below(3)] = random_double(input);
      break;
    case 3:
      image_.direction[input.below(9)] = random_double(input);
      break;
    default:
      break;
  }
}

void RandomImage::make_layout(Input& input, int64_t voxel) {
  int64_t reach = voxel;  // bytes from the first to behind the last voxel
  int64_t before = 0;     // of it before voxel (0,0,0)
  if (input.below(3) == 0) {
    for (int axis = 0; axis < 3; ++axis) {
      const int64_t step = reach + voxel * input.below(3);  // gaps
      const int64_t span = step * (image_.dims[axis] - 1);
      const bool turned = input.flag();
      image_.strides[axis] = turned ? -step : step;
      if (turned) before += span;
      reach += span;
    }
  } else {
    for (const int64_t dim : image_.dims) reach *= dim;
  }
  voxels_ = std::make_unique<Room<unsigned char>>(reach);
  // A ball, about.
  for (int64_t i = 0; i < reach / voxel; ++i) {
    const int64_t line = i % (image_.dims[0] * image_.dims[1]);
    const bool inside = std::abs(line - image_.dims[0] * image_.dims[1] / 2) < image_.dims[0] * 2;
    unsigned char* at = voxels_->data() + i * voxel;
    if (image_.type == PLC_F32) {
      const float value = inside ? 1.0F : 0.0F;
      std::memcpy(at, &value, sizeof value);
    } else {
      std::memset(at, 0, static_cast<size_t>(voxel));
      *at = inside ? 100 : 0;
    }
  }
  if (image_.type == PLC_F32 && input.below(16) == 0) {
    const auto value = static_cast<float>(random_double(input));
    std::memcpy(voxels_->data() + reach / voxel / 2 * voxel, &value, sizeof value);
  }
  image_.voxels = voxels_->data() + before;
  if (voxel > 1 && input.below(16) == 0) image_.strides[input.below(3)] = 1;  // no multiple
}

plc_parameters random_parameters(Input& input) {
  plc_parameters p;
  plc_parameters_defaults(&p);
  p.iso = input.flag() ? 0.5 : 50;
  p.levels = static_cast<int>(input.below(3));
  p.max_iterations = 3;
  p.init = random_enum<plc_init>(input, 6);
  const size_t first = offsetof(plc_parameters, iso);
  for (uint32_t changes = input.below(4); changes > 0; --changes) {
    auto* bytes = reinterpret_cast<unsigned char*>(&p);
    const size_t at = first + input.raw<uint16_t>() % ((sizeof p - first) / 4) * 4;
    if (at % 8 == 0 && at + 8 <= sizeof p && input.flag()) {
      const double value = random_double(input);
      std::memcpy(bytes + at, &value, sizeof value);
    } else {
      const int value = random_int(input);
      std::memcpy(bytes + at, &value, sizeof value);
    }
  }
  if (p.max_iterations > 3) p.max_iterations = 3;
  for (int& count : p.bubbles) {
    if (count > 3 && count <= 256) count = 3;
  }
  return p;
}

}  // namespace fuzz

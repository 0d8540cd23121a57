#include "pyramid/border.h"

#include <catch2/catch.hpp>
#include <vector>

namespace {

using Dims = std::array<int64_t, 3>;

plc::PyramidLevel level_of(const Dims& dims, float value) {
  plc::PyramidLevel level;
  level.dims = dims;
  level.values.resize(static_cast<size_t>(dims[0] * dims[1] * dims[2]));
  for (float& v : level.values) v = value;
  return level;
}

bool at_border(const Dims& dims, size_t voxel) {
  auto rest = static_cast<int64_t>(voxel);
  for (const int64_t dim : dims) {
    if (rest % dim == 0 || rest % dim == dim - 1) return true;
    rest /= dim;
  }
  return false;
}

}  // namespace

TEST_CASE("every voxel at the border is visited once, and no other", "[border]") {
  for (const Dims& dims :
       {Dims{4, 4, 4}, Dims{2, 5, 3}, Dims{7, 1, 4}, Dims{1, 6, 5}, Dims{3, 3, 3}}) {
    std::vector<int> visits(static_cast<size_t>(dims[0] * dims[1] * dims[2]), 0);
    plc::visit_border(dims, [&](size_t voxel) { ++visits.at(voxel); });
    for (size_t i = 0; i < visits.size(); ++i) {
      CAPTURE(dims[0], dims[1], dims[2], i);
      CHECK(visits[i] == (at_border(dims, i) ? 1 : 0));
    }
  }
}

TEST_CASE("what the border holds of the object is brought half way outside, all else stays",
          "[border]") {
  const Dims dims{5, 4, 6};
  plc::PyramidLevel bright = level_of(dims, 0.75F), faint = level_of(dims, 0.4F);
  plc::close_border(bright, 0.5, 0.25);
  plc::close_border(faint, 0.5, 0.25);
  for (size_t i = 0; i < bright.values.size(); ++i) {
    CHECK(bright.values[i] == (at_border(dims, i) ? 0.375F : 0.75F));
    CHECK(faint.values[i] == 0.4F);
  }
  plc::PyramidLevel dark = level_of(dims, 0.5F);
  plc::close_border(dark, 0.5, 1);
  CHECK(dark.values[0] == 0.75F);
  CHECK(dark.values[static_cast<size_t>(dims[0] * dims[1] * 2 + dims[0] + 2)] == 0.5F);
}

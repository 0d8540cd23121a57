// An image that is the object everywhere, or nowhere.
#pragma once
#include <vector>

#include "engine/mesh/sizing.h"

namespace samples {

struct FullImage {
  explicit FullImage(bool object) : values(8, object ? 1.0F : 0.0F) {
    sizing.object = {{values.data(), {2, 2, 2}, {1, 1, 1}, {0, 0, 0}, {}}, 0.5F, true};
  }
  std::vector<float> values;
  plc::Sizing sizing;
};

}  // namespace samples

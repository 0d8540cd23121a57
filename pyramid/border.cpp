#include "pyramid/border.h"

namespace plc {

void close_border(PyramidLevel& level, double iso, double outside) {
  const auto half_way = static_cast<float>((iso + outside) / 2);
  const auto level_iso = static_cast<float>(iso);
  visit_border(level.dims, [&](size_t voxel) {
    float& value = level.values[voxel];
    if (outside < iso ? value >= level_iso : value <= level_iso) value = half_way;
  });
}

}  // namespace plc

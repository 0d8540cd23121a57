#include "pyramid/border.h"

#include "pyramid/reduced_bricks.h"

namespace plc {

void close_border(PyramidLevel& level, double iso, double outside) {
  if (level.reduced != nullptr) return level.reduced->close_border(iso, outside);
  const ClosedBorder closed(iso, outside);
  visit_border(level.dims,
               [&](size_t voxel) { level.values[voxel] = closed(level.values[voxel]); });
}

}  // namespace plc

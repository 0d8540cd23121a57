#include "engine/recover/cost.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/constants.h"
#include "kernels/image_value.h"
#include "pyramid/image_object.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// The area that belongs to a vertex, in delta^2, where edges are 1.6 delta long in the mean.
constexpr double kAreaPerVertex = 2.2;
// The mesh and everything that works on it (perf/results/targets.md).
constexpr double kBytesPerVertex = 250;
// Crossings of the iso-surface and what thins them out, for each square voxel of it: the peak of
// all that was asked for was 577 MB for 1.3 million of a brain, 135 MB for 286,000 of thin bone.
constexpr double kBytesToStart = 480;
// Faces of voxels have 3/2 of the area of a smooth surface between them, in the mean over all
// directions.
constexpr double kStairs = 1.5;
// About so many voxels of a level are looked at, in slices at equal distances.
constexpr double kLooked = 1 << 20;

// Counts the faces of voxels between the object and what is not, by the axis that they are
// perpendicular to: those within slice z, and those between it and the next slice.
std::array<int64_t, 3> faces_of(const ImageObject& object, int32_t z) {
  const ImageView& image = object.image;
  const auto width = static_cast<size_t>(image.dims[0]);
  Vector<float> values(width);
  Vector<uint8_t> last(width), row(width), next(width);
  std::array<int64_t, 3> faces{};
  const auto read = [&](int32_t y, int32_t plane, Vector<uint8_t>& side) {
    image_row(image, y, plane, values.data());
    for (size_t x = 0; x < width; ++x) side[x] = object.has(values[x]) ? 1 : 0;
  };
  for (int32_t y = 0; y < image.dims[1]; ++y) {
    read(y, z, row);
    read(y, z + 1, next);
    for (size_t x = 0; x < width; ++x) {
      faces[0] += x > 0 && row[x] != row[x - 1] ? 1 : 0;
      faces[1] += y > 0 && row[x] != last[x] ? 1 : 0;
      faces[2] += row[x] != next[x] ? 1 : 0;
    }
    std::swap(last, row);
  }
  return faces;
}

// The area of the object's surface, in mesh units squared.
double area_of(const ImageObject& object, const Executor& executor) {
  const ImageView& image = object.image;
  const double voxels = static_cast<double>(image.dims[0]) * image.dims[1] * image.dims[2];
  const auto step = static_cast<int32_t>(std::max(1.0, voxels / kLooked));
  const int32_t count = (image.dims[2] - 2) / step + 1;
  const auto slices = static_cast<size_t>(count);
  Vector<std::array<int64_t, 3>> parts(slices);
  executor.run(slices,
               [&](size_t i) { parts[i] = faces_of(object, static_cast<int32_t>(i) * step); });
  double area = 0;
  for (const auto& part : parts) {
    for (size_t a = 0; a < 3; ++a) {
      const auto b = (a + 1) % 3, c = (a + 2) % 3;
      area += static_cast<double>(part[a]) / static_cast<double>(image.scale[b] * image.scale[c]);
    }
  }
  const double share = static_cast<double>(slices) / (image.dims[2] - 1);
  return area / share / kStairs;
}

}  // namespace

double most_vertices(const Pyramid& pyramid, int h, int pad, const MeshScale& scale) {
  const ImageView image = image_view(pyramid, h, pad, mesh_space(pyramid, h, scale.anisotropy));
  const double delta = level_delta(pyramid, h, scale);
  double vertices = 1;
  for (size_t a = 0; a < 3; ++a) {
    vertices *= image.dims[a] / static_cast<double>(image.scale[a]) / delta;
  }
  return vertices;
}

Cost expected_cost(const Pyramid& pyramid, const std::vector<double>& isos, bool inside_above,
                   int pad, const MeshScale& scale, bool from_iso, const Executor& executor) {
  Cost cost;
  cost.voxels = 1;
  for (const int64_t dim : pyramid.levels[0].dims) {
    cost.voxels *= static_cast<double>(dim - 2 * int64_t{pad});
  }
  for (size_t level = 0; level < isos.size(); ++level) {
    const int h = static_cast<int>(level);
    const ImageView image = image_view(pyramid, h, pad, mesh_space(pyramid, h, scale.anisotropy));
    const double area = area_of({image, static_cast<float>(isos[level]), inside_above}, executor);
    const double delta = level_delta(pyramid, h, scale);
    const double vertices =
        std::min(area / (kAreaPerVertex * delta * delta), most_vertices(pyramid, h, pad, scale));
    cost.vertices = std::max(cost.vertices, vertices);
    if (h == 0 && from_iso) cost.bytes = area * kBytesToStart;
  }
  cost.bytes = std::max(cost.bytes, cost.vertices * kBytesPerVertex);
  return cost;
}

}  // namespace plc

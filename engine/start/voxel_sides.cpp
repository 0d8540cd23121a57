#include "engine/start/voxel_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace plc {

namespace {

// Rows lie this far beside the voxel centres, in voxels: vertices of meshes that were laid out on
// the voxel grid lie on the centres, and a row through a vertex has no parity.
constexpr double kBesideY = 0.000913;
constexpr double kBesideZ = 0.000617;

using Point = std::array<double, 3>;

// Twice the signed area of (a, b, row) in the plane yz. The ends of an edge come in one order
// whichever face asks: both faces of an edge agree on which side of it the row is.
double side(const Point& a, const Point& b, double y, double z) {
  if (b < a) return -side(b, a, y, z);
  return (b[1] - a[1]) * (z - a[2]) - (b[2] - a[2]) * (y - a[1]);
}

class Rows {
 public:
  Rows(const Mesh& mesh, const ImageView& image, VoxelSet& flips)
      : mesh_(mesh), image_(image), flips_(flips) {}

  // Flips the first voxel behind each crossing of the face with a row.
  void cross(uint32_t u, uint32_t v, uint32_t w) {
    const std::array<Point, 3> p{voxel(u), voxel(v), voxel(w)};
    const auto [y0, y1] = range(p, 1, kBesideY);
    const auto [z0, z1] = range(p, 2, kBesideZ);
    for (int64_t k = z0; k <= z1; ++k) {
      for (int64_t j = y0; j <= y1; ++j) {
        cross_row(p, j, k);
      }
    }
  }

 private:
  Point voxel(uint32_t v) const {
    const Float4& p = mesh_.position[v];
    const float at[3] = {p.x, p.y, p.z};
    Point c;
    for (size_t a = 0; a < 3; ++a) {
      c[a] = static_cast<double>(image_.scale[a]) * static_cast<double>(at[a]) +
             static_cast<double>(image_.offset[a]);
    }
    return c;
  }

  // Rows of the image within the face's extent on an axis.
  std::pair<int64_t, int64_t> range(const std::array<Point, 3>& p, size_t axis,
                                    double beside) const {
    const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
    return {
        std::max<int64_t>(0, static_cast<int64_t>(std::ceil(low - beside))),
        std::min<int64_t>(image_.dims[axis] - 1, static_cast<int64_t>(std::floor(high - beside)))};
  }

  void cross_row(const std::array<Point, 3>& p, int64_t j, int64_t k) {
    const double y = static_cast<double>(j) + kBesideY;
    const double z = static_cast<double>(k) + kBesideZ;
    const double a = side(p[1], p[2], y, z);
    const double b = side(p[2], p[0], y, z);
    const double c = side(p[0], p[1], y, z);
    const bool within = (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
    if (!within) return;
    const double x = (a * p[0][0] + b * p[1][0] + c * p[2][0]) / (a + b + c);
    const auto first = static_cast<int64_t>(std::ceil(std::max(x, 0.0)));
    if (first >= image_.dims[0]) return;
    flips_.flip({static_cast<int32_t>(first), static_cast<int32_t>(j), static_cast<int32_t>(k)});
  }

  const Mesh& mesh_;
  const ImageView& image_;
  VoxelSet& flips_;
};

}  // namespace

VoxelSides::VoxelSides(const Mesh& mesh, const ImageView& image)
    : width_(image.dims[0]), flips_(image.dims) {
  Rows crossings(mesh, image, flips_);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const uint32_t valence = mesh.valence(v);
    for (uint32_t k = 0; k < valence; ++k) {
      const uint32_t a = mesh.neighbor(v, k);
      const uint32_t b = mesh.neighbor(v, k + 1 == valence ? 0 : k + 1);
      if (v < a && v < b) crossings.cross(v, a, b);
    }
  }
}

bool VoxelSides::row(int32_t y, int32_t z, uint8_t* inside) const {
  int32_t from = 0;
  uint8_t side = 0;
  bool any = false;
  flips_.visit_row(y, z, 0, width_, [&](int32_t x) {
    std::fill(inside + from, inside + x, side);
    from = x;
    side ^= 1;
    any = true;
  });
  std::fill(inside + from, inside + width_, side);
  return any;
}

}  // namespace plc

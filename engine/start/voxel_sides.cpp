#include "engine/start/voxel_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace plc {

namespace {

// Rows lie this far beside the voxel centres, in voxels: vertices of meshes that were laid out on
// the voxel grid lie on the centres, and a row through a vertex has no parity.
constexpr double kBesideY = 0.000913;
constexpr double kBesideZ = 0.000617;
// Of the plane in which the rows of a patch begin, before the room's first voxels.
constexpr double kBefore = 0.413;

using Point = std::array<double, 3>;

// Twice the signed area of (a, b, line) in the plane of two axes. The ends of an edge come in one
// order whichever face asks: both faces of an edge agree on which side of it the line is.
double side(const Point& a, const Point& b, size_t u, size_t v, double at_u, double at_v) {
  if (b < a) return -side(b, a, u, v, at_u, at_v);
  return (b[u] - a[u]) * (at_v - a[v]) - (b[v] - a[v]) * (at_u - a[u]);
}

// Where a face crosses the line along `axis` through (at_u, at_v) of the other two, in the order of
// the axes, if it does.
std::optional<double> crossing(const std::array<Point, 3>& p, size_t axis, double at_u,
                               double at_v) {
  const size_t u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  const double a = side(p[1], p[2], u, v, at_u, at_v);
  const double b = side(p[2], p[0], u, v, at_u, at_v);
  const double c = side(p[0], p[1], u, v, at_u, at_v);
  const bool within = (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
  if (!within) return std::nullopt;
  return (a * p[0][axis] + b * p[1][axis] + c * p[2][axis]) / (a + b + c);
}

// Whether x grows to the outside through the face.
bool leads_out(const std::array<Point, 3>& p) {
  return (p[1][1] - p[0][1]) * (p[2][2] - p[0][2]) - (p[1][2] - p[0][2]) * (p[2][1] - p[0][1]) > 0;
}

}  // namespace

class VoxelSides::Rows {
 public:
  Rows(const Mesh& mesh, const ImageView& image, const VoxelRoom& room)
      : mesh_(mesh), image_(image), room_(room) {}

  // visit(corners in voxels) for the faces of the surface.
  template <typename Visit>
  void visit_faces(const Visit& visit) const {
    for (uint32_t v = 0; v < mesh_.slots(); ++v) {
      if (mesh_.is_absent(v)) continue;
      const uint32_t valence = mesh_.valence(v);
      for (uint32_t k = 0; k < valence; ++k) {
        const uint32_t a = mesh_.neighbor(v, k);
        const uint32_t b = mesh_.neighbor(v, k + 1 == valence ? 0 : k + 1);
        if (a < v || b < v || mesh_.is_absent(a) || mesh_.is_absent(b)) continue;
        visit(std::array<Point, 3>{voxel(v), voxel(a), voxel(b)});
      }
    }
  }
  // visit(first voxel behind the crossing, in the room) for each row that the face crosses there.
  template <typename Visit>
  void cross(const std::array<Point, 3>& p, const Visit& visit) const {
    const auto [y0, y1] = range(p, 1, kBesideY);
    const auto [z0, z1] = range(p, 2, kBesideZ);
    for (int64_t k = z0; k <= z1; ++k) {
      for (int64_t j = y0; j <= y1; ++j) {
        const auto x = crossing(p, 0, row_y(j), row_z(k));
        if (!x || (mesh_.is_patch() && *x < plane())) continue;
        const auto first =
            static_cast<int64_t>(std::ceil(std::max(*x, static_cast<double>(room_.low[0]))));
        if (first > room_.high[0]) continue;
        visit(Voxel{static_cast<int32_t>(first), static_cast<int32_t>(j), static_cast<int32_t>(k)});
      }
    }
  }
  // In the plane where rows begin: visit(y, z) of the first row behind each crossing between two of
  // the same z; and of the first z behind those between the first rows of two.
  template <typename VisitRow, typename VisitColumn>
  void cross_plane(const std::array<Point, 3>& p, const VisitRow& between_rows,
                   const VisitColumn& between_columns) const {
    const auto [low, high] = std::minmax({p[0][0], p[1][0], p[2][0]});
    if (low > plane() || high < plane()) return;
    const auto [z0, z1] = range(p, 2, kBesideZ);
    for (int64_t k = z0; k <= z1; ++k) {
      if (const auto y = crossing(p, 1, plane(), row_z(k))) {
        const auto first = static_cast<int64_t>(std::ceil(*y - kBesideY));
        if (first > room_.low[1] && first <= room_.high[1]) between_rows(first, k);
      }
    }
    if (const auto z = crossing(p, 2, plane(), row_y(room_.low[1]))) {
      const auto first = static_cast<int64_t>(std::ceil(*z - kBesideZ));
      if (first > room_.low[2] && first <= room_.high[2]) between_columns(first);
    }
  }

 private:
  double plane() const { return room_.low[0] - kBefore; }
  static double row_y(int64_t j) { return static_cast<double>(j) + kBesideY; }
  static double row_z(int64_t k) { return static_cast<double>(k) + kBesideZ; }
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

  // Rows of the room within the face's extent on an axis.
  std::pair<int64_t, int64_t> range(const std::array<Point, 3>& p, size_t axis,
                                    double beside) const {
    const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
    return {std::max<int64_t>(room_.low[axis], static_cast<int64_t>(std::ceil(low - beside))),
            std::min<int64_t>(room_.high[axis], static_cast<int64_t>(std::floor(high - beside)))};
  }

  const Mesh& mesh_;
  const ImageView& image_;
  const VoxelRoom& room_;
};

VoxelSides::VoxelSides(const Mesh& mesh, const ImageView& image, const VoxelRoom& room)
    : room_(room), flips_(image.dims) {
  const Rows rows(mesh, image, room_);
  rows.visit_faces([&](const std::array<Point, 3>& p) {
    rows.cross(p, [this](const Voxel& first) { flips_.flip(first); });
  });
  if (!mesh.is_patch()) return;
  if (mesh.vertex_count() > 0) {
    begin_rows(mesh, image);
  } else {
    first_.assign(index_of(room_.high[1], room_.high[2]) + 1, room_.inside ? 1 : 0);
  }
}

void VoxelSides::begin_rows(const Mesh& mesh, const ImageView& image) {
  const Rows rows(mesh, image, room_);
  const size_t height = room_.width(1);
  const size_t depth = room_.width(2);
  first_.assign(height * depth, 0);
  Vector<uint8_t> turns(depth, 0);  // between the first rows of successive z
  struct Crossing {
    Voxel first;
    uint8_t inside;  // behind it
  };
  Vector<Crossing> crossings;
  rows.visit_faces([&](const std::array<Point, 3>& p) {
    rows.cross_plane(
        p, [&](int64_t y, int64_t z) { first_[index_of(y, z)] ^= 1; },
        [&](int64_t z) { turns[static_cast<size_t>(z - room_.low[2])] ^= 1; });
    const uint8_t inside = leads_out(p) ? 0 : 1;
    rows.cross(p, [&](const Voxel& first) { crossings.push_back({first, inside}); });
  });
  uint8_t side = 0;
  for (size_t k = 0; k < depth; ++k) {
    side ^= turns[k];
    first_[k * height] = side;
    for (size_t j = 1; j < height; ++j) first_[k * height + j] ^= first_[k * height + j - 1];
  }
  // All that is known so far is known but for which side is which: what most crossings say. Two
  // between the same voxels say either.
  const auto by_row = [](const Crossing& l, const Crossing& r) {
    return std::tie(l.first[2], l.first[1]) < std::tie(r.first[2], r.first[1]);
  };
  std::stable_sort(crossings.begin(), crossings.end(), by_row);
  Vector<uint8_t> inside(room_.width(0));
  int64_t agree = 0, differ = 0;
  for (size_t i = 0; i < crossings.size(); ++i) {
    const Crossing& c = crossings[i];
    if (i == 0 || by_row(crossings[i - 1], c)) row(c.first[1], c.first[2], inside.data());
    const uint8_t found = inside[static_cast<size_t>(c.first[0] - room_.low[0])];
    ++(found == c.inside ? agree : differ);
  }
  known_ = agree != differ;
  if (differ > agree) {
    for (uint8_t& s : first_) s ^= 1;
  }
}

bool VoxelSides::row(int32_t y, int32_t z, uint8_t* inside) const {
  const int32_t low = room_.low[0], end = room_.high[0] + 1;
  int32_t from = low;
  uint8_t side = first_.empty() ? uint8_t{0} : first_[index_of(y, z)];
  bool any = side != 0;
  flips_.visit_row(y, z, low, end, [&](int32_t x) {
    std::fill(inside + (from - low), inside + (x - low), side);
    from = x;
    side ^= 1;
    any = true;
  });
  std::fill(inside + (from - low), inside + (end - low), side);
  return any;
}

}  // namespace plc

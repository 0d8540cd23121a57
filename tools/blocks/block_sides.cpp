#include "tools/blocks/block_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace plc::tools {

namespace {

using Place = std::array<double, 3>;

// The rows of middles lie this far beside them, in voxels: those of blocks may be on vertices.
constexpr double kBesideY = 0.000913, kBesideZ = 0.000617;

// Twice the signed area of (a, b, row) in the plane yz; the same but for its sign for (b, a, row).
double side_of(const Place& a, const Place& b, double y, double z) {
  if (b < a) return -side_of(b, a, y, z);
  return (b[1] - a[1]) * (z - a[2]) - (b[2] - a[2]) * (y - a[1]);
}

}  // namespace

std::vector<int64_t> blocks_inside(const BlockGrid& grid, const std::vector<double>& xyz,
                                   const std::vector<uint32_t>& abc) {
  const auto middle = [&](int64_t block) {
    return (static_cast<double>(block) + 0.5) * static_cast<double>(grid.side());
  };
  const auto rows_from = [&](double low, double beside) {
    return static_cast<int64_t>(std::ceil((low - beside) / static_cast<double>(grid.side()) - 0.5));
  };
  std::map<std::pair<int64_t, int64_t>, std::vector<double>> crossings;  // by row: z, y
  for (size_t f = 0; f < abc.size(); f += 3) {
    std::array<Place, 3> p;
    for (size_t k = 0; k < 3; ++k) std::copy_n(&xyz[3 * size_t{abc[f + k]}], 3, p[k].begin());
    const auto [y0, y1] = std::minmax({p[0][1], p[1][1], p[2][1]});
    const auto [z0, z1] = std::minmax({p[0][2], p[1][2], p[2][2]});
    for (int64_t k = rows_from(z0, kBesideZ); middle(k) + kBesideZ <= z1; ++k) {
      for (int64_t j = rows_from(y0, kBesideY); middle(j) + kBesideY <= y1; ++j) {
        const double y = middle(j) + kBesideY, z = middle(k) + kBesideZ;
        const double a = side_of(p[1], p[2], y, z), b = side_of(p[2], p[0], y, z),
                     c = side_of(p[0], p[1], y, z);
        const bool within = (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
        if (within)
          crossings[{k, j}].push_back((a * p[0][0] + b * p[1][0] + c * p[2][0]) / (a + b + c));
      }
    }
  }
  std::vector<int64_t> inside;
  for (int64_t block = 0; block < grid.block_count(); ++block) {
    const Int3 at = grid.block_at(block);
    const auto row = crossings.find({at[2], at[1]});
    if (row == crossings.end()) continue;
    const double x = middle(at[0]);
    const auto before =
        std::count_if(row->second.begin(), row->second.end(), [x](double c) { return c < x; });
    if (before % 2 == 1) inside.push_back(block);
  }
  return inside;
}

}  // namespace plc::tools

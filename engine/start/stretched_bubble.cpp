#include "engine/start/stretched_bubble.h"

#include <algorithm>
#include <cmath>

#include "engine/resolve/conform.h"
#include "engine/start/iso_surface.h"

namespace plc {

namespace {

// Lattice cells from the middle to the end of the shortest axis, at most: what is longer is divided
// by conform(). Cells are cubes: with cells stretched like a rod of 3 x 3 x 270 voxels of 1 : 20 :
// 2,400 its faces were slivers, and conform() took minutes.
constexpr double kMostCells = 16;
// What conform() leaves is near its shortest edges; a bubble is to have longer ones, none as long
// as the guards cannot see (kFaceReach).
constexpr double kCoarser = 1.3;

double even_power(double x, int power) {
  double result = 1;
  for (int i = 0; i < power; i += 2) result *= x * x;
  return result;
}

}  // namespace

bool is_stretched(const std::array<double, 3>& half) {
  const auto [shortest, longest] = std::minmax_element(half.begin(), half.end());
  return *longest > kStretched * *shortest;
}

Status make_stretched_bubble(Mesh& mesh, const std::array<double, 3>& middle,
                             const std::array<double, 3>& half, int power, double delta,
                             const Schedule& schedule) {
  ImageView lattice;
  std::array<double, 3> step{};    // of the lattice, in halves
  std::array<double, 3> centre{};  // of the bubble, in voxels of the lattice
  const double pitch = std::max(delta, *std::min_element(half.begin(), half.end()) / kMostCells);
  for (size_t a = 0; a < 3; ++a) {
    const double reach = std::ceil(half[a] / pitch) + 1;
    lattice.dims[a] = static_cast<int32_t>(2 * reach + 1);
    lattice.scale[a] = static_cast<float>(1 / pitch);
    lattice.offset[a] = static_cast<float>(reach - middle[a] / pitch);
    step[a] = pitch / half[a];
    centre[a] = reach;
  }
  const auto term = [&](size_t axis, int32_t voxel) {
    return even_power((voxel - centre[axis]) * step[axis], power);
  };
  const auto value = [&](int32_t x, int32_t y, int32_t z) {
    return static_cast<float>(1 - term(0, x) - term(1, y) - term(2, z));
  };
  const LatticeValues values{[&](int32_t y, int32_t z, uint8_t* inside) {
                               for (int32_t x = 0; x < lattice.dims[0]; ++x)
                                 inside[x] = value(x, y, z) >= 0;
                             },
                             value};
  if (Status s = iso_surface({lattice, 0, true}, values, schedule, mesh); !s.ok()) return s;
  OperationCounts counts;  // what the making of a start takes is none of a level's
  Status s = conform(mesh, kCoarser * delta, schedule, counts);
  mesh.delta = delta;
  return s;
}

}  // namespace plc

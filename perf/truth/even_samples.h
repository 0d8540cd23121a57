// Places spread evenly over the area of a mesh.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tools/file/failure.h"

namespace truth {

using Corners = std::array<std::array<double, 3>, 3>;  // of a face

inline double face_area(const Corners& p) {
  double cross = 0;
  for (size_t a = 0; a < 3; ++a) {
    const size_t b = (a + 1) % 3, c = (a + 2) % 3;
    const double x =
        (p[1][b] - p[0][b]) * (p[2][c] - p[0][c]) - (p[1][c] - p[0][c]) * (p[2][b] - p[0][b]);
    cross += x * x;
  }
  return std::sqrt(cross) / 2;
}

// `count` places, each for as much of the area as any other: one in the middle of each equal part
// of the faces laid end to end, and within its face by the sequence R2 of Roberts. corners(face)
// for face below face_count. Throws Failure where there is no area.
template <typename CornersOf>
std::vector<std::array<double, 3>> even_samples(size_t face_count, const CornersOf& corners,
                                                size_t count) {
  std::vector<double> ends;  // area of the faces up to and with this one
  double area = 0;
  for (size_t f = 0; f < face_count; ++f) {
    area += face_area(corners(f));
    ends.push_back(area);
  }
  if (!(area > 0)) throw plc::tools::Failure{"a surface has no area"};
  constexpr double kPlastic = 1.32471795724474602596;
  std::vector<std::array<double, 3>> samples(count);
  size_t face = 0;
  for (size_t i = 0; i < count; ++i) {
    const auto n = static_cast<double>(i) + 0.5;
    const double at = n / static_cast<double>(count) * area;
    while (face + 1 < face_count && ends[face] < at) ++face;
    double u = std::fmod(n / kPlastic, 1.0), v = std::fmod(n / (kPlastic * kPlastic), 1.0);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Corners p = corners(face);
    for (size_t a = 0; a < 3; ++a) {
      samples[i][a] = p[0][a] + u * (p[1][a] - p[0][a]) + v * (p[2][a] - p[0][a]);
    }
  }
  return samples;
}

}  // namespace truth

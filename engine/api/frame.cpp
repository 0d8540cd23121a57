#include "engine/api/frame.h"

#include <cmath>

namespace plc {

namespace {

double determinant(const std::array<double, 9>& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

}  // namespace

std::array<double, 3> Affine::vector(const std::array<double, 3>& v) const {
  std::array<double, 3> r{};
  for (size_t i = 0; i < 3; ++i) r[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
  return r;
}

std::array<double, 3> Affine::point(const std::array<double, 3>& p) const {
  std::array<double, 3> r = vector(p);
  for (size_t i = 0; i < 3; ++i) r[i] += t[i];
  return r;
}

double Affine::volume() const {
  return std::abs(determinant(m));
}

bool Affine::mirrors() const {
  return determinant(m) < 0;
}

Affine Affine::inverse() const {
  Affine r;
  const double d = determinant(m);
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      const size_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, e = (i + 2) % 3;
      r.m[3 * i + j] = (m[3 * a + c] * m[3 * b + e] - m[3 * a + e] * m[3 * b + c]) / d;
    }
  }
  const std::array<double, 3> moved = r.vector(t);
  for (size_t i = 0; i < 3; ++i) r.t[i] = -moved[i];
  return r;
}

Affine Frame::to(plc_space space) const {
  Affine a;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (space == PLC_SPACE_VOXEL) {
      a.m[4 * axis] = 1;
      continue;
    }
    for (size_t i = 0; i < 3; ++i) {
      // RAS is LPS with x and y turned round.
      const double sign = space == PLC_SPACE_RAS && i < 2 ? -1 : 1;
      a.m[3 * i + axis] = sign * direction[3 * i + axis] * spacing[axis];
      a.t[i] = sign * origin[i];
    }
  }
  return a;
}

}  // namespace plc

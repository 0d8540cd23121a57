#include "engine/api/frame.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace {

using plc::Affine;
using plc::Frame;
using Point = std::array<double, 3>;

void check_near(const Point& a, const Point& b) {
  for (size_t i = 0; i < 3; ++i) CHECK(a[i] == Approx(b[i]).margin(1e-12));
}

// Turned by 30 degrees about z, then 20 about x.
std::array<double, 9> oblique() {
  const double c = std::cos(0.5235987755982988), s = std::sin(0.5235987755982988);
  const double d = std::cos(0.3490658503988659), t = std::sin(0.3490658503988659);
  return {c, -s, 0, d * s, d * c, -t, t * s, t * c, d};
}

Frame oblique_frame() {
  return {{0.5, 0.75, 2}, {10, -20, 30}, oblique()};
}

}  // namespace

TEST_CASE("voxel space is where it is, whatever the frame", "[frame]") {
  const Affine a = oblique_frame().to(PLC_SPACE_VOXEL);
  check_near(a.point({3, -4, 5.5}), {3, -4, 5.5});
  check_near(a.vector({3, -4, 5.5}), {3, -4, 5.5});
  CHECK_FALSE(a.mirrors());
}

TEST_CASE("LPS is origin plus voxel steps along the columns of the direction", "[frame]") {
  const Frame frame = oblique_frame();
  const Affine a = frame.to(PLC_SPACE_LPS);
  check_near(a.point({0, 0, 0}), frame.origin);
  for (size_t axis = 0; axis < 3; ++axis) {
    Point unit{};
    unit[axis] = 1;
    Point expected{};
    for (size_t i = 0; i < 3; ++i) {
      expected[i] = frame.direction[3 * i + axis] * frame.spacing[axis];
    }
    check_near(a.vector(unit), expected);
    const Point moved = a.point(unit);
    for (size_t i = 0; i < 3; ++i) CHECK(moved[i] - frame.origin[i] == Approx(expected[i]));
  }
}

TEST_CASE("RAS is LPS with x and y turned round", "[frame]") {
  const Frame frame = oblique_frame();
  for (const Point& p : {Point{0, 0, 0}, Point{1, 2, 3}, Point{-7, 0.5, 11}}) {
    const Point lps = frame.to(PLC_SPACE_LPS).point(p);
    check_near(frame.to(PLC_SPACE_RAS).point(p), {-lps[0], -lps[1], lps[2]});
  }
}

TEST_CASE("the inverse of a map takes points and vectors back", "[frame]") {
  Frame skewed = oblique_frame();
  skewed.direction[1] += 0.2;  // not orthogonal
  skewed.direction[5] -= 0.1;
  for (const Frame& frame : {Frame{}, oblique_frame(), skewed}) {
    for (const plc_space space : {PLC_SPACE_LPS, PLC_SPACE_RAS, PLC_SPACE_VOXEL}) {
      const Affine there = frame.to(space);
      const Affine back = there.inverse();
      for (const Point& p : {Point{0, 0, 0}, Point{12, 5, -3}, Point{0.1, 200, 77}}) {
        check_near(back.point(there.point(p)), p);
        check_near(there.point(back.point(p)), p);
        check_near(back.vector(there.vector(p)), p);
      }
    }
  }
}

TEST_CASE("a map mirrors where the image's axes are left-handed, in LPS and RAS alike", "[frame]") {
  Frame frame = oblique_frame();
  for (const bool left_handed : {false, true}) {
    if (left_handed) {
      for (size_t i = 0; i < 3; ++i) frame.direction[3 * i + 2] *= -1;
    }
    CHECK(frame.to(PLC_SPACE_LPS).mirrors() == left_handed);
    CHECK(frame.to(PLC_SPACE_RAS).mirrors() == left_handed);
    CHECK(frame.to(PLC_SPACE_LPS).inverse().mirrors() == left_handed);
    CHECK_FALSE(frame.to(PLC_SPACE_VOXEL).mirrors());
  }
}

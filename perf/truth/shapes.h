// Objects whose surfaces are known: what perf/accuracy measures meshes against.
#pragma once
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/double3.h"

namespace truth {

inline constexpr double kPi = 3.14159265358979323846;

// About the origin; lengths in mm, which are voxels of a cubic volume.
struct Shape {
  // Signed distance to the surface, negative inside. Exact but for rounding: of the saddle, which
  // solves for the nearest point, within its thickness and a few mm around.
  std::function<double(const plc::Double3&)> distance;
  double half[3] = {0, 0, 0};  // of a box around it
  int components = 1, genus = 0;
  // Of the exact surface; NaN where there is no closed form here.
  double area = std::numeric_limits<double>::quiet_NaN(), volume = area;
};

// By NAME[:SIZE,...], the sizes in the order given, each with the default given:
//
//   ball:RADIUS               20
//   torus:RING,TUBE           14,5     radii
//   cylinder:RADIUS,LENGTH    8,28     flat ends, sharp rims
//   plate:THICKNESS,SIDE      2,30     a square box, sharp edges
//   rod:DIAMETER,LENGTH       2,30     round ends, which the length does not count
//   links:RING,TUBE           10,3     two linked tori
//   saddle:THICKNESS,RIM,A    6,15,16  within half the thickness of the part of z = (x^2 - y^2) /
//                                      (2 A) where x^2 + y^2 <= rim^2
//   balls:GAP,RADIUS          1,9      two, with GAP between them along x
//
// Throws Failure.
Shape make_shape(const std::string& text);

}  // namespace truth

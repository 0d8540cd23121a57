// Extractions of a ball with what a host adds: callbacks, and where the results lie.
#pragma once
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/samples/sample_api.h"

namespace samples {

// A ball of 8 mm about the middle of the image; its potential falls by 1 over 16 mm.
inline constexpr double kRadius = 8;
inline constexpr double kPerMillimetre = 1 / (2 * kRadius);

inline Volume ball(std::array<int64_t, 3> dims = {30, 30, 30},
                   std::array<double, 3> spacing = {1, 1, 1}) {
  return sampled(empty_volume(dims, spacing), [](const Point& p) {
    return std::max(0.0, 1 - norm(p[0], p[1], p[2]) * kPerMillimetre);
  });
}

inline double ball_volume(double r) {
  return 4.0 / 3 * 3.14159265358979 * r * r * r;
}

// What the callbacks get as `user`.
struct Host {
  std::function<int(const plc_force_points&, float*)> force;
  std::function<plc_verdict(const plc_level_report&, const plc_surface*)> level;
};

inline int call_force(const plc_force_points* points, float* forces, void* user) {
  return static_cast<Host*>(user)->force(*points, forces);
}

inline plc_verdict call_level(const plc_level_report* level, const plc_surface* surface,
                              void* user) {
  return static_cast<Host*>(user)->level(*level, surface);
}

inline plc_extras extras_of(Host& host) {
  plc_extras extras = no_extras();
  if (host.force) extras.force = call_force;
  if (host.level) extras.level = call_level;
  extras.force_user = extras.level_user = &host;
  return extras;
}

// size * normal on every vertex.
inline Host pushing(float size) {
  Host host;
  host.force = [size](const plc_force_points& points, float* forces) {
    for (int64_t i = 0; i < 3 * points.count; ++i) forces[i] = size * points.normals[i];
    return 0;
  };
  return host;
}

inline plc_parameters gentle(int levels = 0) {
  plc_parameters p = parameters(0.5, levels);
  p.curvature = 0.02;
  p.window_low = 0;
  p.window_high = 1;
  return p;
}

// Positions in LPS, relative to the middle of an image of identity direction.
inline std::vector<Point> about_middle(const plc_surface* surface, const plc_image& image) {
  std::vector<Point> points;
  const std::vector<float> xyz = positions(surface, PLC_SPACE_LPS);
  for (size_t i = 0; i < xyz.size(); i += 3) {
    Point p{};
    for (size_t a = 0; a < 3; ++a) {
      p[a] = static_cast<double>(xyz[i + a]) -
             image.spacing[a] * static_cast<double>(image.dims[a] - 1) / 2;
    }
    points.push_back(p);
  }
  return points;
}

inline double distance_to(const std::vector<Point>& points, const Point& to) {
  double least = 1e30;
  for (const Point& p : points) {
    least = std::min(least, norm(p[0] - to[0], p[1] - to[1], p[2] - to[2]));
  }
  return least;
}

// In LPS of an image of spacing 1.
inline Point in_image(const plc_image& image, const Point& from_middle) {
  Point p = from_middle;
  for (size_t a = 0; a < 3; ++a) {
    p[a] += image.spacing[a] * static_cast<double>(image.dims[a] - 1) / 2;
  }
  return p;
}

}  // namespace samples

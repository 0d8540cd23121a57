#include "perf/truth/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "perf/truth/numbers.h"
#include "tools/file/failure.h"

namespace truth {
namespace {

using plc::Double3;
using plc::tools::Failure;

Shape ball(const std::vector<double>& sizes) {
  const double r = sizes[0];
  return {[=](const Double3& p) { return length(p) - r; },
          {r, r, r},
          1,
          0,
          4 * kPi * r * r,
          4 * kPi * r * r * r / 3};
}

double torus_distance(const Double3& p, double ring, double tube) {
  return std::hypot(std::hypot(p.x, p.y) - ring, p.z) - tube;
}

Shape torus(const std::vector<double>& sizes) {
  const double ring = sizes[0], tube = sizes[1];
  if (tube >= ring) throw Failure{"torus: its tube must be thinner than its ring"};
  return {[=](const Double3& p) { return torus_distance(p, ring, tube); },
          {ring + tube, ring + tube, tube},
          1,
          1,
          4 * kPi * kPi * ring * tube,
          2 * kPi * kPi * ring * tube * tube};
}

// Of a body whose parts are `a` and `b` outside of two slabs that are at right angles.
double corner_distance(double a, double b) {
  return std::min(std::max(a, b), 0.0) + std::hypot(std::max(a, 0.0), std::max(b, 0.0));
}

Shape cylinder(const std::vector<double>& sizes) {
  const double r = sizes[0], half = sizes[1] / 2;
  return {[=](const Double3& p) {
            return corner_distance(std::hypot(p.x, p.y) - r, std::abs(p.z) - half);
          },
          {r, r, half},
          1,
          0,
          2 * kPi * r * (r + 2 * half),
          2 * kPi * r * r * half};
}

Shape plate(const std::vector<double>& sizes) {
  const double half = sizes[0] / 2, side = sizes[1] / 2;
  return {[=](const Double3& p) {
            const Double3 q{std::abs(p.x) - side, std::abs(p.y) - side, std::abs(p.z) - half};
            const Double3 out{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
            return std::min(std::max({q.x, q.y, q.z}), 0.0) + length(out);
          },
          {side, side, half},
          1,
          0,
          8 * side * (side + 2 * half),
          8 * side * side * half};
}

Shape rod(const std::vector<double>& sizes) {
  const double r = sizes[0] / 2, half = sizes[1] / 2;
  return {[=](const Double3& p) {
            return length(Double3{p.x, p.y, std::max(std::abs(p.z) - half, 0.0)}) - r;
          },
          {r, r, half + r},
          1,
          0,
          4 * kPi * r * (r + half),
          kPi * r * r * (2 * half + 4 * r / 3)};
}

Shape links(const std::vector<double>& sizes) {
  const double ring = sizes[0], tube = sizes[1];
  if (2 * tube >= ring) throw Failure{"links: a tube must be thinner than half of the ring"};
  return {[=](const Double3& p) {
            const double a = torus_distance({p.x + ring / 2, p.y, p.z}, ring, tube);
            const double b = torus_distance({p.x - ring / 2, p.z, p.y}, ring, tube);
            return std::min(a, b);
          },
          {1.5 * ring + tube, ring + tube, ring + tube},
          2,
          2,
          8 * kPi * kPi * ring * tube,
          4 * kPi * kPi * ring * tube * tube};
}

Shape balls(const std::vector<double>& sizes) {
  const double r = sizes[1], centre = r + sizes[0] / 2;
  return {[=](const Double3& p) {
            return length(Double3{std::abs(p.x) - centre, p.y, p.z}) - r;
          },
          {centre + r, r, r},
          2,
          0,
          8 * kPi * r * r,
          8 * kPi * r * r * r / 3};
}

// The sheet z = (x^2 - y^2) / (2 a) within a rim.
struct SaddleSheet {
  double rim, a;

  Double3 edge(double angle) const {
    return {rim * std::cos(angle), rim * std::sin(angle),
            rim * rim * std::cos(2 * angle) / (2 * a)};
  }

  // The nearest point of the unbounded sheet is q = (x / (1 - m / a), y / (1 + m / a), z - m):
  // where it lies on the sheet for a multiplier |m| < a, the Lagrangian is convex and the point the
  // nearest of all. What must vanish falls from m = -a to m = a.
  double distance(const Double3& p) const {
    double low = -a * (1 - 1e-12), high = a * (1 - 1e-12), m = 0;
    Double3 q;
    for (int i = 0; i < 200; ++i) {
      q = {p.x / (1 - m / a), p.y / (1 + m / a), p.z - m};
      const double off = q.z - (q.x * q.x - q.y * q.y) / (2 * a);
      (off > 0 ? low : high) = m;
      const double slope = 1 + (q.x * q.x / (1 - m / a) + q.y * q.y / (1 + m / a)) / (a * a);
      const double step = off / slope;
      if (std::abs(step) < 1e-13 * a || high - low < 1e-13 * a) break;
      m += step;
      if (!(m > low && m < high)) m = (low + high) / 2;
    }
    if (q.x * q.x + q.y * q.y <= rim * rim) return length(p - q);
    return edge_distance(p);
  }

  // By Newton from the best of some angles about that of p.
  double edge_distance(const Double3& p) const {
    const double about = std::atan2(p.y, p.x);
    double best = about, least = std::numeric_limits<double>::infinity();
    for (int i = -4; i <= 4; ++i) {
      const double far = length(p - edge(about + 0.15 * i));
      if (far < least) least = far, best = about + 0.15 * i;
    }
    for (int i = 0; i < 8; ++i) {
      const double h = rim * rim / a, c = std::cos(best), s = std::sin(best);
      const Double3 off = p - edge(best);
      const Double3 first{-rim * s, rim * c, -h * std::sin(2 * best)};
      const Double3 second{-rim * c, -rim * s, -2 * h * std::cos(2 * best)};
      const double curved = dot(first, first) - dot(off, second);
      if (!(curved > 0)) break;
      best += std::clamp(dot(off, first) / curved, -0.1, 0.1);
      least = std::min(least, length(p - edge(best)));
    }
    return least;
  }
};

Shape saddle(const std::vector<double>& sizes) {
  const double half = sizes[0] / 2;
  const SaddleSheet sheet{sizes[1], sizes[2]};
  const double out = sheet.rim + half;
  return {[=](const Double3& p) { return sheet.distance(p) - half; },
          {out, out, sheet.rim * sheet.rim / (2 * sheet.a) + half},
          1,
          0};
}

struct Kind {
  std::vector<double> sizes;
  Shape (*make)(const std::vector<double>& sizes);
};

const std::map<std::string, Kind>& kinds() {
  static const std::map<std::string, Kind> all{{"ball", {{20}, ball}},
                                               {"torus", {{14, 5}, torus}},
                                               {"cylinder", {{8, 28}, cylinder}},
                                               {"plate", {{2, 30}, plate}},
                                               {"rod", {{2, 30}, rod}},
                                               {"links", {{10, 3}, links}},
                                               {"saddle", {{6, 15, 16}, saddle}},
                                               {"balls", {{1, 9}, balls}}};
  return all;
}

}  // namespace

Shape make_shape(const std::string& text) {
  const size_t colon = text.find(':');
  const auto kind = kinds().find(text.substr(0, colon));
  if (kind == kinds().end()) {
    std::string names;
    for (const auto& entry : kinds()) names += (names.empty() ? "" : ", ") + entry.first;
    throw Failure{text + ": not a shape: one of " + names + " is expected"};
  }
  std::vector<double> sizes = kind->second.sizes;
  if (colon != std::string::npos) {
    const std::vector<double> given = to_numbers(text, text.substr(colon + 1), 1, sizes.size());
    std::copy(given.begin(), given.end(), sizes.begin());
  }
  for (const double size : sizes) {
    if (!(size > 0 && size <= 200))
      throw Failure{text + ": sizes above 0, at most 200 are expected"};
  }
  return kind->second.make(sizes);
}

}  // namespace truth

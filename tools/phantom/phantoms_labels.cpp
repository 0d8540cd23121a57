// A label image: the cells of a ball, and one more label inside a cell.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/phantom/phantoms_canvas.h"
#include "tools/phantom/phantoms_random.h"

namespace plc::tools {
namespace {

constexpr double kBall = 0.45;   // radius, of the smallest extent
constexpr double kInner = 0.55;  // radius of the inner label, of the room that its cell has

double squared_distance(const Point& a, const Point& b) {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  const double z = a.z - b.z;
  return x * x + y * y + z * z;
}

std::vector<Point> random_sites(int count, const Point& centre, double radius, Random& random) {
  std::vector<Point> sites;
  while (sites.size() < static_cast<size_t>(count)) {
    const double x = centre.x + random.uniform(-radius, radius);
    const double y = centre.y + random.uniform(-radius, radius);
    const double z = centre.z + random.uniform(-radius, radius);
    if (squared_distance({x, y, z}, centre) < radius * radius) sites.push_back({x, y, z});
  }
  return sites;
}

// From the site to its cell's nearest wall.
double room(const std::vector<Point>& sites, size_t cell, const Point& centre, double radius) {
  double least = radius - std::sqrt(squared_distance(sites[cell], centre));
  for (size_t other = 0; other < sites.size(); ++other) {
    if (other == cell) continue;
    least = std::min(least, std::sqrt(squared_distance(sites[cell], sites[other])) / 2);
  }
  return least;
}

size_t nearest(const std::vector<Point>& sites, const Point& p) {
  const auto at = std::min_element(sites.begin(), sites.end(), [&](const Point& a, const Point& b) {
    return squared_distance(a, p) < squared_distance(b, p);
  });
  return static_cast<size_t>(at - sites.begin());
}

}  // namespace

LoadedVolume labels_phantom(const PhantomOptions& options) {
  const Canvas canvas("labels", options, {{64, 64, 64}, PLC_U8, 0});
  const int limit = canvas.type == PLC_U8 ? std::numeric_limits<uint8_t>::max() - 1 : 10000;
  const int count = checked_count("labels", "number of cells", options.count, 8, limit);
  Random random(options.seed);
  const Point centre = canvas.centre();
  const double radius = kBall * canvas.smallest_extent();
  const std::vector<Point> sites = random_sites(count, centre, radius, random);
  size_t roomy = 0;
  double most = 0;
  for (size_t cell = 0; cell < sites.size(); ++cell) {
    const double own = room(sites, cell, centre, radius);
    if (own > most) {
      most = own;
      roomy = cell;
    }
  }
  const double inner = kInner * most;
  const double unit = 1 / full_scale(canvas.type);
  return canvas.volume([&](const Point& p) {
    if (squared_distance(p, centre) >= radius * radius) return 0.0;
    if (squared_distance(p, sites[roomy]) < inner * inner) return (count + 1) * unit;
    return static_cast<double>(nearest(sites, p) + 1) * unit;
  });
}

}  // namespace plc::tools

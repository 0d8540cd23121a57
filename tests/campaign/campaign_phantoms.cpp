#include "tests/campaign/campaign_phantoms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace campaign {

namespace {

using samples::Volume;

constexpr double kNowhere = -1e30;

Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Point& a) {
  return std::sqrt(dot(a, a));
}

double voxel(const Volume& shape) {
  return std::min({shape.spacing[0], shape.spacing[1], shape.spacing[2]});
}

// In the middle part of the image, `part` of it.
Point somewhere(Random& random, const Volume& shape, double part) {
  const auto mm = shape.extent();
  Point p{};
  for (size_t a = 0; a < 3; ++a) p[a] = random.uniform(-0.5, 0.5) * part * mm[a];
  return p;
}

Point direction(Random& random) {
  for (;;) {
    Point d{};
    for (double& x : d) x = random.uniform(-1, 1);
    const double l = length(d);
    if (l < 0.1 || l > 1) continue;
    for (double& x : d) x /= l;
    return d;
  }
}

// The z axis of a shape: as often as not that of the image, where faces of voxels line up.
Point axis(Random& random) {
  if (random.integer(0, 1) == 0) return direction(random);
  Point d{};
  d[static_cast<size_t>(random.integer(0, 2))] = 1;
  return d;
}

// Of a point from a place: along an axis, and across it.
struct Cylindric {
  double along, across;
};
Cylindric about(const Point& p, const Point& centre, const Point& z) {
  const Point way = minus(p, centre);
  const double along = dot(way, z);
  return {along, std::sqrt(std::max(0.0, dot(way, way) - along * along))};
}

Field ball(const Point& centre, double radius) {
  return [=](const Point& p) { return radius - length(minus(p, centre)); };
}

Field capsule(const Point& from, const Point& to, double radius) {
  return [=](const Point& p) {
    const Point way = minus(to, from), at = minus(p, from);
    const double whole = dot(way, way);
    const double t = whole > 0 ? std::clamp(dot(at, way) / whole, 0.0, 1.0) : 0;
    return radius - length({at[0] - t * way[0], at[1] - t * way[1], at[2] - t * way[2]});
  };
}

Field box(const Point& centre, const Point& half) {
  return [=](const Point& p) {
    double inside = 1e30;
    for (size_t a = 0; a < 3; ++a) inside = std::min(inside, half[a] - std::abs(p[a] - centre[a]));
    return inside;
  };
}

Field any_of(std::vector<Field> fields) {
  return [fields = std::move(fields)](const Point& p) {
    double most = kNowhere;
    for (const Field& f : fields) most = std::max(most, f(p));
    return most;
  };
}

Field without(const Field& whole, const Field& hole) {
  return [=](const Point& p) { return std::min(whole(p), -hole(p)); };
}

Field balls(Random& random, const Volume& shape) {
  std::vector<Field> all;
  for (int64_t i = random.integer(1, 6); i > 0; --i) {
    const Point centre = somewhere(random, shape, 0.7);
    all.push_back(ball(centre, random.uniform(0.08, 0.4) * shape.smallest()));
  }
  return any_of(std::move(all));
}

Field tori(Random& random, const Volume& shape) {
  std::vector<Field> all;
  for (int64_t i = random.integer(1, 3); i > 0; --i) {
    const Point centre = somewhere(random, shape, 0.4);
    const Point z = axis(random);
    const double major = random.uniform(0.18, 0.35) * shape.smallest();
    const double minor = random.uniform(0.2, 0.7) * major;
    all.emplace_back([=](const Point& p) {
      const Cylindric c = about(p, centre, z);
      const double radial = c.across - major;
      return minor - std::sqrt(radial * radial + c.along * c.along);
    });
  }
  return any_of(std::move(all));
}

// A ball with cavities, some of which reach its surface.
Field shells(Random& random, const Volume& shape) {
  const Point centre = somewhere(random, shape, 0.15);
  const double radius = random.uniform(0.3, 0.48) * shape.smallest();
  std::vector<Field> holes;
  if (random.integer(0, 1) == 0) {
    holes.push_back(ball(centre, radius * random.uniform(0.4, 0.9)));
  }
  for (int64_t i = random.integer(1, 5); i > 0; --i) {
    const Point way = direction(random);
    const double off = radius * random.uniform(0, 1);
    holes.push_back(
        ball({centre[0] + off * way[0], centre[1] + off * way[1], centre[2] + off * way[2]},
             radius * random.uniform(0.15, 0.45)));
  }
  return without(ball(centre, radius), any_of(std::move(holes)));
}

// Plates and wires about as thick as a voxel, and thinner.
Field thin(Random& random, const Volume& shape) {
  const double unit = voxel(shape);
  std::vector<Field> all;
  for (int64_t i = random.integer(1, 4); i > 0; --i) {
    const Point centre = somewhere(random, shape, 0.5);
    const Point z = axis(random);
    const double half = random.uniform(0.2, 1.8) * unit;
    const double reach = random.uniform(0.2, 0.5) * shape.smallest();
    if (random.integer(0, 1) == 0) {
      all.emplace_back([=](const Point& p) {
        const Cylindric c = about(p, centre, z);
        return std::min(half - std::abs(c.along), reach - c.across);
      });
    } else {
      const Point end = {centre[0] + reach * z[0], centre[1] + reach * z[1],
                         centre[2] + reach * z[2]};
      all.push_back(capsule(centre, end, half));
    }
  }
  return any_of(std::move(all));
}

Field nested(Random& random, const Volume& shape) {
  const Point centre = somewhere(random, shape, 0.1);
  const double outer = random.uniform(0.35, 0.5) * shape.smallest();
  const double period = outer / random.uniform(1.2, 4);
  const double filled = random.uniform(0.3, 0.7);
  return [=](const Point& p) {
    const double r = length(minus(p, centre));
    const double part = r / period - std::floor(r / period);
    const double inside = std::min(part, filled - part) * period;
    return std::min(outer - r, inside);
  };
}

// Balls, boxes and rods that nearly touch, touch, or overlap by a little.
Field touching(Random& random, const Volume& shape) {
  const double unit = voxel(shape);
  std::vector<Field> all;
  Point at = somewhere(random, shape, 0.5);
  double radius = random.uniform(0.1, 0.25) * shape.smallest();
  const bool boxes = random.integer(0, 2) == 0;
  for (int64_t i = random.integer(2, 4); i > 0; --i) {
    if (boxes) {
      all.push_back(box(at, {radius, radius, radius}));
    } else {
      all.push_back(ball(at, radius));
    }
    const double next = random.uniform(0.08, 0.25) * shape.smallest();
    const double gap = random.uniform(-1, 2) * unit;
    const Point way = axis(random);
    for (size_t a = 0; a < 3; ++a) at[a] += (radius + next + gap) * way[a];
    radius = next;
  }
  return any_of(std::move(all));
}

// Trees of tapering tubes.
Field tubes(Random& random, const Volume& shape) {
  struct Branch {
    Point at, way;
    double radius;
    int depth;
  };
  std::vector<Field> all;
  std::vector<Branch> open;
  for (int64_t i = random.integer(1, 2); i > 0; --i) {
    Branch root;
    root.at = somewhere(random, shape, 0.9);
    root.way = direction(random);
    root.radius = random.uniform(0.03, 0.1) * shape.smallest();
    root.depth = 4;
    open.push_back(root);
  }
  while (!open.empty()) {
    const Branch b = open.back();
    open.pop_back();
    const double step = random.uniform(0.12, 0.3) * shape.smallest();
    Point end = b.at;
    for (size_t a = 0; a < 3; ++a) end[a] += step * b.way[a];
    all.push_back(capsule(b.at, end, b.radius));
    if (b.depth == 0) continue;
    for (int64_t i = random.integer(1, 2); i > 0; --i) {
      const Point turn = direction(random);
      Branch next = b;
      next.at = end;
      for (size_t a = 0; a < 3; ++a) next.way[a] = b.way[a] + 0.9 * turn[a];
      const double l = std::max(0.1, length(next.way));
      for (double& x : next.way) x /= l;
      next.radius = b.radius * random.uniform(0.6, 1);
      next.depth = b.depth - 1;
      open.push_back(next);
    }
  }
  return any_of(std::move(all));
}

// A Menger sponge, or what is left of the cube without it.
Field menger(Random& random, const Volume& shape) {
  const double unit = voxel(shape);
  const auto depth = random.integer(1, 3);
  const double half = random.uniform(0.35, 0.6) * shape.smallest();
  const Point centre = somewhere(random, shape, 0.15);
  const bool holes = random.integer(0, 3) == 0;
  return [=](const Point& p) {
    std::array<double, 3> part{};
    for (size_t a = 0; a < 3; ++a) part[a] = (p[a] - centre[a]) / (2 * half) + 0.5;
    bool solid = true;
    for (const double x : part) {
      if (x < 0 || x >= 1) return -unit;
    }
    for (int64_t i = 0; i < depth; ++i) {
      int middles = 0;
      for (double& x : part) {
        const double third = std::floor(x * 3);
        middles += third == 1 ? 1 : 0;
        x = x * 3 - third;
      }
      solid = solid && middles < 2;
    }
    return solid != holes ? unit : -unit;
  };
}

// Cells of alternating sides, which touch at edges and corners.
Field checker(Random& random, const Volume& shape) {
  std::array<double, 3> cell{};
  for (size_t a = 0; a < 3; ++a) {
    cell[a] = shape.spacing[a] * static_cast<double>(random.integer(1, 6));
  }
  const Point corner = somewhere(random, shape, 0.2);
  const double reach = random.uniform(0.2, 0.8) * shape.smallest();
  const double unit = voxel(shape);
  return [=](const Point& p) {
    double sum = 0, wall = unit;
    for (size_t a = 0; a < 3; ++a) {
      const double at = (p[a] - corner[a]) / cell[a];
      sum += std::floor(at);
      const double part = at - std::floor(at);
      wall = std::min(wall, std::min(part, 1 - part) * cell[a]);
    }
    const bool odd = std::floor(sum / 2) * 2 != sum;
    return std::min(odd ? wall : -wall, reach - length(minus(p, corner)));
  };
}

// Random values on a lattice, trilinear in between: caverns, bridges and islands.
Field noise(Random& random, const Volume& shape) {
  const double period = random.uniform(0.12, 0.4) * shape.smallest();
  const double threshold = random.uniform(0.35, 0.65);
  const uint64_t key = random.bits();
  const auto mm = shape.extent();
  const bool within = random.integer(0, 1) == 0;
  const Field edge = box({0, 0, 0}, {0.4 * mm[0], 0.4 * mm[1], 0.4 * mm[2]});
  return [=](const Point& p) {
    std::array<double, 3> cell{}, f{};
    for (size_t a = 0; a < 3; ++a) {
      cell[a] = std::floor(p[a] / period);
      f[a] = p[a] / period - cell[a];
    }
    double sum = 0;
    for (size_t corner = 0; corner < 8; ++corner) {
      double weight = 1;
      uint64_t place = key;
      for (size_t a = 0; a < 3; ++a) {
        const bool far = (corner >> a & 1) != 0;
        weight *= far ? f[a] : 1 - f[a];
        place = place * 1021 + static_cast<uint64_t>(static_cast<int64_t>(cell[a]) + (far ? 1 : 0));
      }
      Random value(place);
      sum += weight * value.uniform(0, 1);
    }
    const double inside = (sum - threshold) * period;
    return within ? std::min(inside, edge(p)) : inside;
  };
}

// One or some of the Voronoi cells of random sites in a ball, as in an image of labels.
Field labels(Random& random, const Volume& shape) {
  std::vector<Point> sites;
  for (int64_t i = random.integer(2, 9); i > 0; --i) {
    sites.push_back(somewhere(random, shape, 0.8));
  }
  const uint64_t chosen = random.bits() | 1;
  const double radius = random.uniform(0.35, 0.7) * shape.smallest();
  const double unit = voxel(shape);
  return [=](const Point& p) {
    double nearest = std::numeric_limits<double>::max();
    size_t label = 0;
    for (size_t i = 0; i < sites.size(); ++i) {
      const double d = length(minus(p, sites[i]));
      if (d >= nearest) continue;
      nearest = d;
      label = i;
    }
    const double side = (chosen >> label & 1) != 0 ? unit : -unit;
    return std::min(side, radius - length(p));
  };
}

// Blocks with edges along the axes, some of them cut out of others.
Field blocks(Random& random, const Volume& shape) {
  const auto mm = shape.extent();
  Field all = [](const Point&) { return kNowhere; };
  for (int64_t i = random.integer(1, 6); i > 0; --i) {
    const Point centre = somewhere(random, shape, 0.8);
    Point half{};
    for (size_t a = 0; a < 3; ++a) half[a] = random.uniform(0.03, 0.35) * mm[a];
    const Field block = box(centre, half);
    const bool hole = i != 1 && random.integer(0, 3) == 0;
    all = hole ? without(all, block) : any_of({all, block});
  }
  return all;
}

// Single voxels and clumps of a few.
Field specks(Random& random, const Volume& shape) {
  const double unit = voxel(shape);
  std::vector<Field> all;
  for (int64_t i = random.integer(1, 12); i > 0; --i) {
    const Point centre = somewhere(random, shape, 0.9);
    all.push_back(ball(centre, random.uniform(0.5, 2.5) * unit));
  }
  return any_of(std::move(all));
}

}  // namespace

const std::vector<Phantom>& phantoms() {
  static const std::vector<Phantom> all = {
      {"balls", balls},   {"tori", tori},         {"shells", shells}, {"thin", thin},
      {"nested", nested}, {"touching", touching}, {"tubes", tubes},   {"menger", menger},
      {"noise", noise},   {"checker", checker},   {"labels", labels}, {"blocks", blocks},
      {"specks", specks}};
  return all;
}

Volume drawn(const Volume& shape, const Field& field, double softness) {
  return samples::sampled(shape, [&](const Point& p) {
    const double inside = field(p);
    if (softness <= 0) return inside >= 0 ? 1.0 : 0.0;
    return std::clamp(0.5 + inside / (2 * softness), 0.0, 1.0);
  });
}

}  // namespace campaign

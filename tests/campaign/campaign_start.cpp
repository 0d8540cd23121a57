#include "tests/campaign/campaign_start.h"

#include <algorithm>
#include <cmath>

#include "engine/base/constants.h"
#include "tests/campaign/campaign_image.h"
#include "tests/campaign/campaign_phantoms.h"

namespace campaign {

namespace {

using samples::Soup;

double finest(const Case& c) {
  return std::min({c.image.spacing[0], c.image.spacing[1], c.image.spacing[2]});
}
double coarsest(const Case& c) {
  return std::max({c.image.spacing[0], c.image.spacing[1], c.image.spacing[2]});
}

// The levels above I_0 that there are at most, and by how much the coarsest is reduced.
int levels_of(const Case& c) {
  return c.parameters.levels < 0 ? 3 : c.parameters.levels;
}
double reduction_of(const Case& c) {
  double factor = 1;
  for (int h = 0; h < levels_of(c); ++h) factor *= c.parameters.reduction;
  return factor;
}

// Voxel indices, in the middle `part` of the image.
Point place(const Case& c, Random& random, double part) {
  Point p{};
  for (size_t a = 0; a < 3; ++a) {
    const auto n = static_cast<double>(c.image.dims[a]);
    p[a] = (n - 1) / 2 + random.uniform(-0.5, 0.5) * part * n;
  }
  return p;
}

Point to_space(const Case& c, const Point& voxel) {
  return c.frame().to(c.space).point(voxel);
}

// As many bubbles as surely have room on the coarsest level; in one of ten cases perhaps too many.
void choose_bubbles(Case& c, Random& random) {
  plc_parameters& p = c.parameters;
  const bool crowded = once_in(random, 10);
  // In millimetres delta grows with voxels that are long.
  if (crowded || p.anisotropy == PLC_ANISOTROPY_PHYSICAL) {
    c.refusals.push_back({PLC_INVALID_ARGUMENT, "bubbles "});
  }
  const double delta = reduction_of(c) / plc::kUnitPerDelta;
  for (size_t a = 0; a < 3; ++a) {
    const double step =
        p.anisotropy == PLC_ANISOTROPY_PHYSICAL ? c.image.spacing[a] / finest(c) : 1;
    const double room = static_cast<double>(c.image.dims[a]) * step / (5 * delta);
    if (room < 1 && !crowded) {
      p.init = PLC_INIT_BUBBLE;
      return;
    }
    const auto most = std::max(int64_t{1}, static_cast<int64_t>(crowded ? 2 * room : room));
    p.bubbles[a] = static_cast<int>(random.integer(1, std::min(most, int64_t{5})));
  }
}

// Spheres that surely are large enough and apart on the coarsest level; in one of ten cases perhaps
// not.
void choose_seeds(Case& c, Random& random) {
  const bool crowded = once_in(random, 10);
  if (crowded) {
    c.refusals.push_back({PLC_INVALID_ARGUMENT, "too small for level"});
    c.refusals.push_back({PLC_INVALID_ARGUMENT, ": touches seed"});
  }
  // A half more: sizes of levels are rounded down, so that their voxels are longer.
  const double delta = 1.5 * reduction_of(c) / plc::kUnitPerDelta * coarsest(c);
  const double smallest = static_cast<double>(plc::kSmallestBubble) * delta;
  std::vector<Point> centres;
  for (int64_t i = random.integer(1, 4); i > 0; --i) {
    const Point at = place(c, random, 0.9);
    const double radius =
        crowded ? random.uniform(0.3, 1.5) * smallest : random.uniform(1.05, 2) * smallest;
    bool apart = true;
    for (size_t k = 0; k < centres.size() && !crowded; ++k) {
      // On one axis at least: that is enough for ellipsoids in any space.
      bool on_an_axis = false;
      for (size_t a = 0; a < 3; ++a) {
        const double gap = std::abs(at[a] - centres[k][a]) * c.image.spacing[a] - radius -
                           c.seeds[k].radius - static_cast<double>(plc::kBubbleGap) * delta;
        on_an_axis = on_an_axis || gap > 0;
      }
      apart = apart && on_an_axis;
    }
    if (!apart) continue;
    centres.push_back(at);
    const Point p = to_space(c, at);
    c.seeds.push_back({{p[0], p[1], p[2]}, radius});
  }
}

void choose_mask(Case& c, Random& random) {
  samples::Volume shape;
  for (size_t a = 0; a < 3; ++a) {
    shape.dims[a] = c.image.dims[a];
    shape.spacing[a] = c.image.spacing[a];
  }
  const auto& all = phantoms();
  const Field field = all[static_cast<size_t>(random.bits() % all.size())].make(random, shape);
  const samples::Volume mask = drawn(shape, field, 0);
  const auto type = static_cast<plc_voxel_type>(random.integer(PLC_U8, PLC_F32));
  constexpr double kValues[] = {1, 1, 7, 100};
  double value = random.one_of(kValues);
  if (type != PLC_U8 && type != PLC_U16 && random.integer(0, 1) == 0) value = -value;
  if (type == PLC_F32 && random.integer(0, 1) == 0) value *= 1e-3;
  plc_image_defaults(&c.mask);
  c.mask.type = type;
  std::copy_n(c.image.dims, 3, c.mask.dims);
  c.mask_voxels = stored(mask.values, type, value, 0);
  c.mask.voxels = c.mask_voxels.data();
  if (std::all_of(mask.values.begin(), mask.values.end(), [](float v) { return v == 0; })) {
    c.refusals.push_back({PLC_INVALID_DATA, "mask: every voxel is 0"});
  }
}

// A point of the unit circle, i of n, without a sine: on a square, drawn onto the circle.
std::array<double, 2> on_circle(uint32_t i, uint32_t n) {
  const double t = 4.0 * i / n;
  const double side = std::floor(t), along = 2 * (t - side) - 1;
  double x = 1, y = along;
  for (int k = 0; k < static_cast<int>(side); ++k) {
    const double turned = -y;
    y = x;
    x = turned;
  }
  const double l = std::sqrt(x * x + y * y);
  return {x / l, y / l};
}

Soup torus(const Point& centre, double major, double minor, uint32_t nu, uint32_t nv) {
  Soup m;
  for (uint32_t i = 0; i < nu; ++i) {
    const auto u = on_circle(i, nu);
    for (uint32_t j = 0; j < nv; ++j) {
      const auto v = on_circle(j, nv);
      const double distance = major + minor * v[0];
      m.vertex(centre[0] + distance * u[0], centre[1] + distance * u[1], centre[2] + minor * v[1]);
    }
  }
  const auto id = [&](uint32_t i, uint32_t j) { return i % nu * nv + j % nv; };
  for (uint32_t i = 0; i < nu; ++i) {
    for (uint32_t j = 0; j < nv; ++j) {
      m.face(id(i, j), id(i + 1, j), id(i + 1, j + 1));
      m.face(id(i, j), id(i + 1, j + 1), id(i, j + 1));
    }
  }
  return m;
}

Point scaled(const Point& p, double factor) {
  return {p[0] * factor, p[1] * factor, p[2] * factor};
}

// Valid surfaces: an ellipsoid, one with a cavity, two side by side, a torus, a box of few faces.
Soup some_mesh(const Case& c, Random& random) {
  const auto shortest =
      static_cast<double>(std::min({c.image.dims[0], c.image.dims[1], c.image.dims[2]}));
  const Point centre = place(c, random, 0.3);
  const int fineness = static_cast<int>(random.integer(0, 4));
  Point radii{};
  for (double& r : radii) r = random.uniform(0.12, 0.5) * shortest;
  const int64_t kind = random.integer(0, 4);
  if (kind == 1) {
    Soup m = ellipsoid(centre, radii, std::max(fineness, 2));
    m.append(samples::flipped(ellipsoid(centre, scaled(radii, random.uniform(0.2, 0.8)), 2)));
    return m;
  }
  if (kind == 2) {
    Soup m = ellipsoid(centre, radii, fineness);
    Point beside = centre;
    beside[1] += 2 * radii[1] + random.uniform(0.01, 4);
    m.append(ellipsoid(beside, radii, fineness));
    return m;
  }
  if (kind == 3) {
    const double major = random.uniform(0.2, 0.35) * shortest;
    const double minor = random.uniform(0.1, 0.7) * major;
    const auto nu = static_cast<uint32_t>(random.integer(3, 16) * 4);
    const auto nv = static_cast<uint32_t>(random.integer(1, 6) * 4);
    return torus(centre, major, minor, nu, nv);
  }
  if (kind == 4) {
    Soup m = samples::moved(samples::cube(), -0.5, -0.5, -0.5);
    for (size_t i = 0; i < m.xyz.size(); ++i) {
      m.xyz[i] = m.xyz[i] * 2 * radii[i % 3] + centre[i % 3];
    }
    return m;
  }
  return ellipsoid(centre, radii, fineness);
}

void choose_mesh(Case& c, Random& random) {
  c.mesh = in_space(c, some_mesh(c, random));
  // What a level cannot hold is refused, as the mesh is what was asked for.
  c.refusals.push_back({PLC_INVALID_DATA, "nothing is left of the surface at this resolution"});
  c.refusals.push_back({PLC_INVALID_DATA, "the surface has faces too thin to be divided"});
}

}  // namespace

Soup in_space(const Case& c, Soup mesh) {
  const plc::Affine affine = c.frame().to(c.space);
  for (size_t i = 0; i < mesh.xyz.size(); i += 3) {
    const auto p = affine.point({mesh.xyz[i], mesh.xyz[i + 1], mesh.xyz[i + 2]});
    std::copy(p.begin(), p.end(), mesh.xyz.begin() + static_cast<ptrdiff_t>(i));
  }
  return affine.mirrors() ? samples::flipped(std::move(mesh)) : mesh;
}

Soup ellipsoid(const Point& centre, const Point& radii, int fineness) {
  Soup m = samples::sphere(fineness);
  for (size_t i = 0; i < m.xyz.size(); ++i) m.xyz[i] = m.xyz[i] * radii[i % 3] + centre[i % 3];
  return m;
}

void choose_start(Case& c) {
  Random random = draws(c.seed, Part::kStart);
  plc_parameters& p = c.parameters;
  c.space = static_cast<plc_space>(random.integer(PLC_SPACE_LPS, PLC_SPACE_VOXEL));
  constexpr plc_init kInits[] = {PLC_INIT_AUTO, PLC_INIT_BUBBLE, PLC_INIT_BUBBLES, PLC_INIT_SEEDS,
                                 PLC_INIT_ISO,  PLC_INIT_ISO,    PLC_INIT_MASK,    PLC_INIT_MESH};
  p.init = random.one_of(kInits);
  if (p.init == PLC_INIT_ISO && std::isnan(p.iso)) p.init = PLC_INIT_BUBBLE;
  if (p.init == PLC_INIT_BUBBLES) choose_bubbles(c, random);
  if (p.init == PLC_INIT_SEEDS) choose_seeds(c, random);
  if (p.init == PLC_INIT_MASK) choose_mask(c, random);
  if (p.init == PLC_INIT_MESH) choose_mesh(c, random);
}

void choose_extras(Case& c) {
  Random random = draws(c.seed, Part::kExtras);
  if (once_in(random, 8)) {
    constexpr double kStrengths[] = {0, 0.5, 4, 20, 100};
    for (int64_t i = random.integer(1, 4); i > 0; --i) {
      const Point at = to_space(c, place(c, random, 0.9));
      const double radius = random.uniform(1, 8) * finest(c);
      c.attachments.push_back({{at[0], at[1], at[2]}, radius, random.one_of(kStrengths)});
    }
  }
  if (once_in(random, 8)) {
    for (int64_t i = random.integer(1, 3); i > 0; --i) {
      const Point at = to_space(c, place(c, random, 0.9));
      c.pins.push_back({{at[0], at[1], at[2]}, random.uniform(0.5, 6) * finest(c)});
    }
  }
  if (once_in(random, 20)) {
    c.force = random.integer(0, 1) == 0 ? UserForce::kPressure : UserForce::kCentre;
    c.force_centre = to_space(c, place(c, random, 0.5));
    c.force_strength = random.uniform(-0.5, 0.5);
  }
  const int coarsest_level = levels_of(c);
  if (once_in(random, 20)) c.more_level = static_cast<int>(random.integer(0, coarsest_level));
  if (once_in(random, 30)) c.stop_level = static_cast<int>(random.integer(0, coarsest_level));
  if (once_in(random, 40)) c.cancel_at = static_cast<int>(random.integer(1, 40));
}

}  // namespace campaign

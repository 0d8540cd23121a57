#include "tests/campaign/campaign_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "pyramid/feature.h"
#include "tests/campaign/campaign_phantoms.h"

namespace campaign {

namespace {

using samples::Volume;

template <typename T>
void append(std::vector<std::byte>& bytes, double value) {
  T stored{};
  if constexpr (std::numeric_limits<T>::is_integer) {
    stored = static_cast<T>(
        std::floor(std::clamp(value + 0.5, static_cast<double>(std::numeric_limits<T>::lowest()),
                              static_cast<double>(std::numeric_limits<T>::max()))));
  } else {
    stored = static_cast<T>(value);
  }
  const size_t at = bytes.size();
  bytes.resize(at + sizeof stored);
  std::memcpy(bytes.data() + at, &stored, sizeof stored);
}

// Small images mostly: a case is to take a tenth of a second.
void choose_grid(Random& random, Volume& shape) {
  const int64_t most = once_in(random, 20) ? 40 : once_in(random, 5) ? 24 : 18;
  constexpr double kSpacings[] = {1, 1, 1, 1, 0.7, 1.3, 2, 3};
  constexpr double kScales[] = {1, 1, 1, 0.5, 1e-3, 300};
  const double scale = random.one_of(kScales);
  const bool cubes = random.integer(0, 1) == 0;
  for (size_t a = 0; a < 3; ++a) {
    shape.dims[a] = random.integer(12, most);
    const double step = random.one_of(kSpacings);
    shape.spacing[a] = scale * (cubes ? 1 : step);
  }
}

// A phantom, moved over the border in one of four cases.
Volume shapes(Case& c, const Volume& shape, Random& random) {
  const Phantom& phantom = phantoms()[static_cast<size_t>(random.bits() % phantoms().size())];
  c.phantom = phantom.name;
  const double finest = std::min({shape.spacing[0], shape.spacing[1], shape.spacing[2]});
  constexpr double kSoftnesses[] = {0, 0, 0.5, 1, 2, 4};
  const double softness = random.one_of(kSoftnesses) * finest;
  Point shift{};
  if (once_in(random, 4)) {
    const auto mm = shape.extent();
    for (size_t a = 0; a < 3; ++a) shift[a] = random.uniform(-0.45, 0.45) * mm[a];
  }
  const Field field = phantom.make(random, shape);
  return drawn(
      shape,
      [&](const Point& p) {
        return field({p[0] - shift[0], p[1] - shift[1], p[2] - shift[2]});
      },
      softness);
}

void spoil(Volume& volume, Random& random) {
  constexpr double kNoises[] = {0, 0, 0, 0.05, 0.15, 0.4};
  const double noise = random.one_of(kNoises);
  const uint64_t noise_seed = random.bits();
  if (noise > 0) samples::add_noise(volume, noise, noise_seed);
  if (once_in(random, 12)) {  // salt and pepper
    const double part = random.uniform(0.001, 0.05);
    for (float& value : volume.values) {
      if (random.uniform(0, 1) < part) value = random.integer(0, 1) == 0 ? 0.0F : 1.0F;
    }
  }
  if (once_in(random, 10)) {  // brighter to one side
    const double slope = random.uniform(-0.6, 0.6);
    const auto row = static_cast<size_t>(volume.dims[0]);
    for (size_t i = 0; i < volume.values.size(); ++i) {
      const double part = static_cast<double>(i % row) / static_cast<double>(row);
      volume.values[i] += static_cast<float>(slope * part);
    }
  }
}

struct Units {
  plc_voxel_type type;
  double scale, offset;
};

Units choose_units(Random& random) {
  constexpr Units kUnits[] = {{PLC_U8, 255, 0},       {PLC_U8, 100, 50},     {PLC_I16, 1000, 0},
                              {PLC_I16, 3000, -1000}, {PLC_U16, 4000, 100},  {PLC_U16, 65535, 0},
                              {PLC_I32, 1e6, -5e5},   {PLC_I32, 1e9, 0},     {PLC_F32, 1, 0},
                              {PLC_F32, 1, 0},        {PLC_F32, 1e-3, -0.5}, {PLC_F32, 1e6, 1e5}};
  return random.one_of(kUnits);
}

struct Range {
  double low = 0, high = 0;
};

template <typename T>
Range range_of(const std::vector<std::byte>& bytes) {
  Range range{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (size_t at = 0; at < bytes.size(); at += sizeof(T)) {
    T value{};
    std::memcpy(&value, bytes.data() + at, sizeof value);
    range.low = std::min(range.low, static_cast<double>(value));
    range.high = std::max(range.high, static_cast<double>(value));
  }
  return range;
}

Range range_of(plc_voxel_type type, const std::vector<std::byte>& bytes) {
  switch (type) {
    case PLC_U8:
      return range_of<uint8_t>(bytes);
    case PLC_I16:
      return range_of<int16_t>(bytes);
    case PLC_U16:
      return range_of<uint16_t>(bytes);
    case PLC_I32:
      return range_of<int32_t>(bytes);
    case PLC_F32:
      break;
  }
  return range_of<float>(bytes);
}

// Of the image that the evolution sees.
Range range_seen(const Case& c) {
  if (c.parameters.feature == PLC_FEATURE_NONE) return range_of(c.image.type, c.voxels);
  plc::Buffer<float> norm;
  const plc::Status status =
      plc::gradient_norm(view_of(c.image), c.parameters.feature_sigma,
                         plc::SerialExecutor(plc::SimdTarget::kScalar), norm);
  if (!status.ok()) return {};
  const auto [low, high] = std::minmax_element(norm.data(), norm.data() + norm.size());
  return {static_cast<double>(*low), static_cast<double>(*high)};
}

void choose_force(Case& c, Random& random) {
  plc_parameters& p = c.parameters;
  constexpr plc_force kForces[] = {PLC_FORCE_ISO, PLC_FORCE_ISO,  PLC_FORCE_ISO,
                                   PLC_FORCE_ISO, PLC_FORCE_BOTH, PLC_FORCE_GRADIENT};
  p.force = random.one_of(kForces);
  constexpr double kGradients[] = {0, 0.2, 1, 1, -0.5};
  p.gradient = random.one_of(kGradients);
  p.gradient_tangent = random.one_of(kGradients);
  p.gradient_bound = random.uniform(0.1, 2);
  if (once_in(random, 12)) {
    p.feature = PLC_FEATURE_GRADIENT_NORM;
    const double finest = std::min({c.image.spacing[0], c.image.spacing[1], c.image.spacing[2]});
    p.feature_sigma = static_cast<double>(random.integer(0, 2)) * 0.6 * finest;
  }
}

// Values of the image: iso by its part of the range, and what must fit to it.
void choose_iso(Case& c, Random& random) {
  plc_parameters& p = c.parameters;
  const Range range = range_seen(c);
  const double width = range.high - range.low;
  if (!(width > 0)) {
    p.iso = range.low;
    c.refusals.push_back({PLC_INVALID_DATA, "constant image"});
    return;
  }
  const double part = random.integer(0, 2) == 0 ? 0.5 : random.uniform(0.15, 0.85);
  p.iso = range.low + part * width;
  const bool on_voxel = once_in(random, 8) && c.image.type != PLC_F32;
  if (on_voxel) p.iso = std::floor(p.iso);  // just the value of voxels
  p.iso = std::clamp(p.iso, range.low + 1e-9 * width, range.high - 1e-9 * width);
  const double below = random.uniform(0.05, 1) * (p.iso - range.low) + 1e-3 * width;
  const double above = random.uniform(0.05, 1) * (range.high - p.iso) + 1e-3 * width;
  const int64_t window = random.integer(0, 5);
  if (window >= 3) p.window_low = p.iso - below;
  if (window >= 4) p.window_high = p.iso + above;
  // Beyond iso, or the iso-value of a level, nothing outside the image would hold the surface: that
  // is refused.
  if (once_in(random, 20)) {
    p.pad_value = p.inside_below != 0 ? p.iso + random.uniform(0.01, 1.5) * (range.high - p.iso)
                                      : p.iso - random.uniform(0.01, 1.5) * (p.iso - range.low);
    c.refusals.push_back({PLC_INVALID_ARGUMENT, "on the object's side of level iso-value"});
  }
  if (p.force == PLC_FORCE_GRADIENT && random.integer(0, 1) == 0) {
    p.iso = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  // An explicit value for every level only where the window is known.
  if (window < 4 || p.levels < 0 || random.integer(0, 2) != 0) return;
  p.level_iso_count = p.levels + 1;
  p.level_iso[p.levels] = p.iso;
  for (int h = 1; h <= p.levels; ++h) {
    // Outwards more often than inwards.
    const double inwards = random.uniform(-0.6, 0.3);
    const double up = p.inside_below != 0 ? -inwards : inwards;
    p.level_iso[p.levels - h] = p.iso + up * (up < 0 ? below : above);
  }
}

// Unit axes, turned, swapped or mirrored, and an origin not so far away that floats of mm become
// coarse.
void choose_frame(Case& c, Random& random) {
  plc_image& image = c.image;
  const int64_t kind = random.integer(0, 3);
  Point axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (kind >= 2) {
    for (;;) {
      for (double& x : axes[0]) x = random.uniform(-1, 1);
      for (double& x : axes[1]) x = random.uniform(-1, 1);
      const auto dot = [](const Point& a, const Point& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
      };
      const auto normalise = [&](Point& a) {
        const double l = std::sqrt(dot(a, a));
        for (double& x : a) x /= l;
        return l > 0.2;
      };
      if (!normalise(axes[0])) continue;
      const double along = dot(axes[0], axes[1]);
      for (size_t a = 0; a < 3; ++a) axes[1][a] -= along * axes[0][a];
      if (!normalise(axes[1])) continue;
      for (size_t a = 0; a < 3; ++a) {
        const size_t b = (a + 1) % 3, d = (a + 2) % 3;
        axes[2][a] = axes[0][b] * axes[1][d] - axes[0][d] * axes[1][b];
      }
      break;
    }
  }
  if (kind == 1 || kind == 3) {
    const auto axis = static_cast<size_t>(random.integer(0, 2));
    for (double& x : axes[axis]) x = -x;
    std::swap(axes[axis], axes[(axis + 1) % 3]);
  }
  for (size_t a = 0; a < 3; ++a) {
    for (size_t i = 0; i < 3; ++i) image.direction[3 * i + a] = axes[a][i];
    const double extent = static_cast<double>(image.dims[a]) * image.spacing[a];
    image.origin[a] = kind == 0 ? 0 : random.uniform(-4, 4) * extent;
  }
}

}  // namespace

plc::VolumeView view_of(const plc_image& image) {
  plc::VolumeView view;
  view.type = static_cast<plc::VoxelType>(image.type);
  view.voxels = image.voxels;
  for (size_t a = 0; a < 3; ++a) {
    view.dims[a] = image.dims[a];
    view.spacing[a] = image.spacing[a];
  }
  return view;
}

std::vector<std::byte> stored(const std::vector<float>& values, plc_voxel_type type, double scale,
                              double offset) {
  std::vector<std::byte> bytes;
  for (const float v : values) {
    const double value = static_cast<double>(v) * scale + offset;
    switch (type) {
      case PLC_U8:
        append<uint8_t>(bytes, value);
        break;
      case PLC_I16:
        append<int16_t>(bytes, value);
        break;
      case PLC_U16:
        append<uint16_t>(bytes, value);
        break;
      case PLC_I32:
        append<int32_t>(bytes, value);
        break;
      case PLC_F32:
        append<float>(bytes, value);
        break;
    }
  }
  return bytes;
}

void choose_image(Case& c) {
  Random random = draws(c.seed, Part::kImage);
  Volume shape;
  choose_grid(random, shape);
  Volume volume = shapes(c, shape, random);
  spoil(volume, random);
  c.parameters.inside_below = once_in(random, 4) ? 1 : 0;
  if (c.parameters.inside_below != 0) {
    for (float& value : volume.values) value = 1 - value;
  }
  const Units units = choose_units(random);
  plc_image_defaults(&c.image);
  c.image.type = units.type;
  c.voxels = stored(volume.values, units.type, units.scale, units.offset);
  c.image.voxels = c.voxels.data();
  for (size_t a = 0; a < 3; ++a) {
    c.image.dims[a] = volume.dims[a];
    c.image.spacing[a] = volume.spacing[a];
  }
  Random frame = draws(c.seed, Part::kFrame);
  choose_frame(c, frame);
}

void choose_values(Case& c) {
  Random random = draws(c.seed, Part::kValues);
  choose_force(c, random);
  choose_iso(c, random);
}

}  // namespace campaign

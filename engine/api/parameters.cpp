#include "engine/api/parameters.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/api/parameter_list.h"
#include "engine/base/constants.h"

namespace plc {

namespace {

std::string text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.9g", value);
  return buffer;
}

Status bad(const std::string& name, double value, const std::string& expected) {
  return {ErrorCode::kInvalidArgument, name + " " + text(value) + ": must be " + expected};
}

// Every value of every field within its range.
Status check_ranges(const plc_parameters& p) {
  for (const plc_parameter_info& info : parameter_list()) {
    for (int i = 0; i < given_values(p, info); ++i) {
      const double value = parameter_value(p, info, i);
      if (value >= info.lowest && value <= info.highest) continue;
      if (std::isnan(value) && std::isnan(info.value)) continue;
      std::string name = info.name;
      std::replace(name.begin(), name.end(), '_', ' ');
      return bad(name, value, info.range);
    }
  }
  return {};
}

// On a head CT the soft tissue around the bone fills the coarse levels below 1/8.
constexpr double kLevelIsoMargin = 0.25;

// An object that the surroundings of the image belong to has no end: its surface would grow for
// ever.
Status check_surroundings(const plc_parameters& p) {
  if (std::isnan(p.iso) || p.force == PLC_FORCE_GRADIENT) return {};
  const auto outside = [&](double iso) {
    return p.inside_below == 0 ? p.pad_value < iso : p.pad_value > iso;
  };
  const std::string pad = "pad value " + text(p.pad_value) + ": ";
  if (!outside(p.iso)) {
    return {ErrorCode::kInvalidArgument, pad + "on the object's side of iso " + text(p.iso)};
  }
  for (int h = 0; h < p.level_iso_count; ++h) {
    if (outside(p.level_iso[h])) continue;
    return {ErrorCode::kInvalidArgument,
            pad + "on the object's side of level iso-value " + text(p.level_iso[h])};
  }
  return {};
}

// Of an adaptive mesh.
constexpr double kLeastSize = 0.125, kMostSize = 7.9;  // in delta
// Of the edges of a uniform mesh, in voxels and in the image's shortest side.
constexpr double kLeastEdge = 0.25, kMostEdge = 0.1;

// Mean edges of a uniform mesh whose delta is that of the voxels, mm.
double usual_edge(double unit) {
  return kMeanEdge * unit / kUnitPerDelta;
}

// Whether the surface starts from the image's iso-surface, near where it ends, and not from a
// bubble around a coarse image. That takes about kBytes for each of the voxels at_surface, which
// must be half of a limit at most. Of noise there is no end of them, and what it joins is taken
// apart one by one. They are 1 to 4 % of most images, 7 % of soft tissue in a head CT, 18 % of a CT
// of an aorta, which from there are done in half the time of coarse to fine, and nearer. In small
// images they are many, too, but cost little.
bool starts_at_iso(const VolumeView& volume, uint64_t at_surface, int64_t memory_limit,
                   const plc_parameters& p) {
  constexpr double kPart = 0.2, kFew = 1 << 14, kMany = 1 << 21, kBytes = 1200;
  const double voxels = static_cast<double>(volume.dims[0]) * static_cast<double>(volume.dims[1]) *
                        static_cast<double>(volume.dims[2]);
  const double count = static_cast<double>(at_surface);
  const bool fits = memory_limit == 0 || kBytes * count <= static_cast<double>(memory_limit) / 2;
  return p.init == PLC_INIT_AUTO && is_adaptive(p) && p.late_bubbles != 0 && fits &&
         count <= std::clamp(kPart * voxels, kFew, kMany);
}

Status check_mesh(const plc_parameters& p) {
  if (p.mesh != PLC_MESH_ADAPTIVE) return {};
  const auto refused = [](const std::string& why) {
    return Status{ErrorCode::kInvalidArgument, "mesh adaptive: " + why};
  };
  if (std::isnan(p.iso)) return refused("needs an iso-value, from which its sizes are derived");
  if (p.spring > 0) return refused("has no springs, which draw edges to one length");
  return {};
}

}  // namespace

bool is_adaptive(const plc_parameters& p) {
  if (p.mesh != PLC_MESH_AUTO) return p.mesh == PLC_MESH_ADAPTIVE;
  return p.force == PLC_FORCE_ISO && p.spring == 0 && p.edge == 0;
}

int usual_levels(const VolumeView& volume, const plc_parameters& p) {
  return std::min(PyramidSpec{}.levels,
                  max_levels(padded_dims(volume.dims, kPadVoxels), p.reduction));
}

Status check_parameters(const plc_parameters& p) {
  if (Status s = check_ranges(p); !s.ok()) return s;
  if (std::isnan(p.iso)) {
    if (p.force != PLC_FORCE_GRADIENT) return {ErrorCode::kInvalidArgument, "iso: not set"};
    if (p.init == PLC_INIT_ISO) {
      return {ErrorCode::kInvalidArgument, "iso: not set, but the start is an iso-surface"};
    }
    if (p.level_iso_count != 0) {
      return {ErrorCode::kInvalidArgument, "level iso-values: given, but iso is not set"};
    }
  }
  if (Status s = check_mesh(p); !s.ok()) return s;
  if (p.level_iso_count > 0 && p.levels >= 0 && p.level_iso_count != p.levels + 1) {
    return {ErrorCode::kInvalidArgument, "level iso-values: " + std::to_string(p.level_iso_count) +
                                             " given, " + std::to_string(p.levels + 1) +
                                             " expected (one per level)"};
  }
  return {};
}

Status derive_parameters(const VolumeView& volume, const VoxelRange& range,
                         const Executor& executor, int64_t memory_limit, plc_parameters& p,
                         DerivedWindow& window) {
  const bool above = p.inside_below == 0;
  if (range.low == range.high) {
    return {ErrorCode::kInvalidData,
            "constant image: every voxel is " + text(range.low) + ", there is no surface in it"};
  }
  const bool within = std::isnan(p.iso) || (above ? p.iso > range.low && p.iso <= range.high
                                                  : p.iso >= range.low && p.iso < range.high);
  if (!within) {
    return {ErrorCode::kInvalidArgument, "iso " + text(p.iso) + ": outside the image's range " +
                                             text(range.low) + " .. " + text(range.high)};
  }
  // What is given need not be looked for; of the background only derived iso-values depend.
  const bool given =
      !std::isnan(p.window_low) && !std::isnan(p.window_high) && p.level_iso_count > 0;
  window = std::isnan(p.iso) || given ? DerivedWindow{{range.low, range.high}, range.low, 0}
                                      : derive_window(volume, range, p.iso, above, executor);
  if (std::isnan(p.window_low)) p.window_low = window.low;
  if (std::isnan(p.window_high)) p.window_high = window.high;
  const std::string window_text =
      "window " + text(p.window_low) + ", " + text(p.window_high) + ": ";
  if (std::isnan(p.iso)) {
    if (!(p.window_low < p.window_high)) {
      return {ErrorCode::kInvalidArgument, window_text + "must be a low value and a higher one"};
    }
  } else if (!(p.window_low < p.iso && p.iso < p.window_high)) {
    return {ErrorCode::kInvalidArgument,
            window_text + "iso " + text(p.iso) + " must lie inside it"};
  }
  for (int h = 0; h < p.level_iso_count; ++h) {
    if (p.level_iso[h] <= p.window_low || p.level_iso[h] >= p.window_high) {
      return {ErrorCode::kInvalidArgument, "level iso-value " + text(p.level_iso[h]) +
                                               ": outside the window " + text(p.window_low) + ", " +
                                               text(p.window_high)};
    }
  }
  if (std::isnan(p.pad_value)) p.pad_value = above ? p.window_low : p.window_high;
  if (Status s = check_surroundings(p); !s.ok()) return s;
  if (p.levels < 0 && p.level_iso_count > 0) p.levels = p.level_iso_count - 1;
  if (p.levels < 0 && !std::isnan(p.iso) &&
      starts_at_iso(volume, window.at_surface, memory_limit, p)) {
    p.levels = 0;
  }
  if (p.levels < 0) p.levels = usual_levels(volume, p);
  return {};
}

Status derive_edge(double unit, double side, plc_parameters& p) {
  if (p.edge == 0) p.edge = usual_edge(unit);
  const double least = kLeastEdge * unit, most = std::max(kMostEdge * side, usual_edge(unit));
  if (p.edge >= least && p.edge <= most) return {};
  return {ErrorCode::kInvalidArgument, "edges of " + text(p.edge) + " mm: must be within " +
                                           text(least) + " .. " + text(most) +
                                           " mm for this image"};
}

Status derive_mesh(double unit, double side, plc_parameters& p) {
  p.mesh = is_adaptive(p) ? PLC_MESH_ADAPTIVE : PLC_MESH_UNIFORM;
  if (p.mesh != PLC_MESH_ADAPTIVE) return derive_edge(unit, side, p);
  const double delta = unit / kUnitPerDelta;
  const SizeSpec sizes;
  if (p.tolerance == 0) p.tolerance = sizes.tolerance * delta;
  if (p.edge_min == 0) p.edge_min = sizes.finest * kMeanEdge * delta;
  if (p.edge_max == 0) p.edge_max = std::max(p.edge_min, sizes.coarsest * kMeanEdge * delta);
  const double least = kLeastSize * kMeanEdge * delta, most = kMostSize * kMeanEdge * delta;
  if (p.edge_min >= least && p.edge_min <= p.edge_max && p.edge_max <= most) return {};
  return {ErrorCode::kInvalidArgument, "edges of " + text(p.edge_min) + " .. " + text(p.edge_max) +
                                           " mm: must be a range within " + text(least) + " .. " +
                                           text(most) + " mm for voxels of " + text(unit) + " mm"};
}

void derive_init(const plc_extras& extras, plc_parameters& p) {
  if (p.init != PLC_INIT_AUTO) return;
  const bool at_iso = p.mesh == PLC_MESH_ADAPTIVE && p.levels == 0 && p.late_bubbles != 0;
  const bool draws = extras.attachment_count > 0 || extras.pin_count > 0;
  p.init = at_iso && !draws ? PLC_INIT_ISO : PLC_INIT_BUBBLE;
}

double level_iso_bound(const plc_parameters& p, double background) {
  const double surroundings =
      p.inside_below == 0 ? std::max(background, p.pad_value) : std::min(background, p.pad_value);
  return normalised(p, surroundings + kLevelIsoMargin * (p.iso - surroundings));
}

PyramidSpec pyramid_spec(const plc_parameters& p) {
  PyramidSpec spec;
  spec.reduction = p.reduction;
  spec.levels = p.levels;
  spec.window_low = p.window_low;
  spec.window_high = p.window_high;
  spec.pad_value = p.pad_value;
  spec.pad_voxels = kPadVoxels;
  return spec;
}

RecoverySpec recovery_spec(const plc_parameters& p, double unit) {
  RecoverySpec spec;
  if (p.mesh != PLC_MESH_ADAPTIVE) {
    spec.scale.edges = p.edge == 0 ? 1 : p.edge / usual_edge(unit);
  } else {
    const double delta = unit / kUnitPerDelta;
    spec.sizes.emplace();
    spec.sizes->finest = p.edge_min / (kMeanEdge * delta);
    spec.sizes->coarsest = p.edge_max / (kMeanEdge * delta);
    spec.sizes->tolerance = p.tolerance / delta;
  }
  spec.inside_above = p.inside_below == 0;
  Model& m = spec.model;
  m.curvature = static_cast<float>(p.curvature);
  m.spring = static_cast<float>(p.spring);
  m.rest_length = static_cast<RestLength>(p.rest_length);
  m.rest_length_value = static_cast<float>(p.rest_length_value);
  // alpha_I is negative when the object is bright: (7).
  if (p.force == PLC_FORCE_GRADIENT) {
    m.attraction = 0;
  } else {
    m.attraction = static_cast<float>(spec.inside_above ? -p.attraction : p.attraction);
  }
  if (p.force != PLC_FORCE_ISO) {
    m.gradient_normal = static_cast<float>(p.gradient);
    m.gradient_tangent = static_cast<float>(p.gradient_tangent);
  }
  spec.gradient_bound = p.gradient_bound;
  m.mass = static_cast<float>(p.mass);
  m.damping = static_cast<float>(p.damping);
  m.time_step = static_cast<float>(p.time_step);
  m.max_move = static_cast<float>(p.max_move);
  m.bound = static_cast<Bound>(p.bound);
  spec.pad_voxels = kPadVoxels;
  spec.scale.anisotropy = static_cast<Anisotropy>(p.anisotropy);
  spec.start.init = static_cast<Init>(p.init);
  spec.start.bubbles = {p.bubbles[0], p.bubbles[1], p.bubbles[2]};
  // Without the force towards iso nothing holds a bubble to what it tells.
  spec.late_bubbles = p.late_bubbles != 0 && p.force != PLC_FORCE_GRADIENT;
  spec.sleeping = p.sleeping != 0;
  spec.calm_speed = p.calm_speed;
  spec.epsilon = p.epsilon;
  spec.max_iterations = p.max_iterations;
  return spec;
}

}  // namespace plc

#include "engine/api/parameter_list.h"

#include <algorithm>
#include <cfloat>
#include <climits>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "engine/base/defaults.h"
#include "pyramid/pyramid.h"

namespace plc {

namespace {

// Far beyond any use; keeps every product of coefficients within floats.
constexpr double kMost = 1e6;
constexpr double kLeast = 1e-6;
constexpr double kAboveZero = DBL_TRUE_MIN;
constexpr double kAboveOne = 1 + DBL_EPSILON;

struct Field {
  const char* name;
  size_t offset;
  int count = 1;
};

constexpr plc_parameter_info real(Field f, double value, double lowest, double highest,
                                  const char* range) {
  return {f.name, PLC_PARAMETER_REAL, f.offset, f.count, value, lowest, highest, range, nullptr};
}
constexpr plc_parameter_info coefficient(Field f, double value) {
  return real(f, value, 0, kMost, "0 .. 1e6");
}
constexpr plc_parameter_info positive(Field f, double value) {
  return real(f, value, kLeast, kMost, "1e-6 .. 1e6");
}
constexpr plc_parameter_info either_sign(Field f, double value) {
  return real(f, value, -kMost, kMost, "-1e6 .. 1e6");
}
constexpr plc_parameter_info finite(Field f, double value) {
  return real(f, value, -DBL_MAX, DBL_MAX, "finite");
}
constexpr plc_parameter_info count(Field f, int value, int lowest, int highest, const char* range) {
  return {f.name,         PLC_PARAMETER_COUNT, f.offset, f.count, double(value),
          double(lowest), double(highest),     range,    nullptr};
}
constexpr plc_parameter_info flag(Field f, int value) {
  return {f.name, PLC_PARAMETER_FLAG, f.offset, f.count, double(value), 0, 1, "0 or 1", nullptr};
}
template <size_t kWords>
constexpr plc_parameter_info choice(Field f, int value, int first, const char* range,
                                    const char* const (&words)[kWords]) {
  return {f.name,
          PLC_PARAMETER_CHOICE,
          f.offset,
          f.count,
          double(value),
          double(first),
          double(first) + double(kWords) - 1,
          range,
          words};
}

constexpr const char* kFeatures[] = {"none", "gradient_norm"};
constexpr const char* kInits[] = {"bubble", "bubbles", "seeds", "iso", "mask", "mesh", "auto"};
constexpr const char* kRestLengths[] = {"zero", "mean", "value"};
constexpr const char* kForces[] = {"iso", "gradient", "both"};
constexpr const char* kBounds[] = {"clamp", "scale"};
constexpr const char* kAnisotropies[] = {"physical", "voxel", "metric"};

constexpr const char* kMeshes[] = {"uniform", "adaptive", "auto"};

#define FIELD(name)                       \
  Field {                                 \
#name, offsetof(plc_parameters, name) \
  }

constexpr plc_parameter_info kList[] = {
    finite(FIELD(iso), NAN),
    flag(FIELD(inside_below), 0),
    finite({"level_iso", offsetof(plc_parameters, level_iso), PLC_MAX_LEVELS}, 0),
    count(FIELD(level_iso_count), 0, 0, PLC_MAX_LEVELS, "0 .. 32"),
    finite(FIELD(window_low), NAN),
    finite(FIELD(window_high), NAN),
    finite(FIELD(pad_value), NAN),
    choice(FIELD(feature), PLC_FEATURE_NONE, PLC_FEATURE_NONE, "a plc_feature", kFeatures),
    real(FIELD(feature_sigma), 0, 0, kMost, "0 .. 1e6 mm"),
    count(FIELD(levels), -1, -1, PLC_MAX_LEVELS - 1, "0 .. 31"),
    real(FIELD(reduction), PyramidSpec{}.reduction, kAboveOne, 2, "above 1 and at most 2"),
    choice(FIELD(init), PLC_INIT_AUTO, PLC_INIT_BUBBLE, "a plc_init", kInits),
    count({"bubbles", offsetof(plc_parameters, bubbles), 3}, 1, 1, 256, "1 .. 256 per axis"),
    choice(FIELD(mesh), PLC_MESH_AUTO, PLC_MESH_UNIFORM, "a plc_mesh_kind", kMeshes),
    real(FIELD(edge), 0, 0, kMost, "0 .. 1e6 mm"),
    real(FIELD(tolerance), 0, 0, kMost, "0 .. 1e6 mm"),
    real(FIELD(edge_min), 0, 0, kMost, "0 .. 1e6 mm"),
    real(FIELD(edge_max), 0, 0, kMost, "0 .. 1e6 mm"),
    coefficient(FIELD(curvature), defaults::kCurvature),
    coefficient(FIELD(spring), defaults::kSpring),
    choice(FIELD(rest_length), PLC_REST_MEAN, PLC_REST_ZERO, "a plc_rest_length", kRestLengths),
    coefficient(FIELD(rest_length_value), defaults::kRestLength),
    choice(FIELD(force), PLC_FORCE_ISO, PLC_FORCE_ISO, "a plc_force", kForces),
    positive(FIELD(attraction), defaults::kAttraction),
    either_sign(FIELD(gradient), 0.5),
    either_sign(FIELD(gradient_tangent), 0),
    positive(FIELD(gradient_bound), defaults::kGradientBound),
    positive(FIELD(mass), defaults::kMass),
    coefficient(FIELD(damping), defaults::kDamping),
    positive(FIELD(time_step), defaults::kTimeStep),
    real(FIELD(max_move), defaults::kMaxMove, kAboveZero, 1, "above 0 and at most 1 delta"),
    choice(FIELD(bound), PLC_BOUND_CLAMP, PLC_BOUND_CLAMP, "a plc_bound", kBounds),
    choice(FIELD(anisotropy), PLC_ANISOTROPY_VOXEL, PLC_ANISOTROPY_PHYSICAL, "a plc_anisotropy",
           kAnisotropies),
    real(FIELD(epsilon), defaults::kEpsilon, kAboveZero, 1, "above 0 and at most 1"),
    coefficient(FIELD(calm_speed), defaults::kCalmSpeed),
    count(FIELD(max_iterations), defaults::kMaxIterations, 1, INT_MAX, "at least 1"),
    flag(FIELD(late_bubbles), 1),
    flag(FIELD(sleeping), 1),
};

#undef FIELD

constexpr size_t size_of(const plc_parameter_info& info) {
  return info.kind == PLC_PARAMETER_REAL ? sizeof(double) : sizeof(int);
}

// Every field is listed: what is between two of them is no more than padding.
constexpr bool complete() {
  size_t end = sizeof(size_t);
  for (const plc_parameter_info& info : kList) {
    if (info.offset < end || info.offset - end >= size_of(info)) return false;
    end = info.offset + size_of(info) * static_cast<size_t>(info.count);
  }
  return sizeof(plc_parameters) - end < sizeof(double);
}
static_assert(complete());

}  // namespace

std::span<const plc_parameter_info> parameter_list() {
  return kList;
}

double parameter_value(const plc_parameters& parameters, const plc_parameter_info& info, int i) {
  const auto* at = reinterpret_cast<const char*>(&parameters) + info.offset +
                   size_of(info) * static_cast<size_t>(i);
  if (info.kind == PLC_PARAMETER_REAL) {
    double value;
    std::memcpy(&value, at, sizeof value);
    return value;
  }
  int value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

void set_parameter(plc_parameters& parameters, const plc_parameter_info& info, int i,
                   double value) {
  auto* at =
      reinterpret_cast<char*>(&parameters) + info.offset + size_of(info) * static_cast<size_t>(i);
  if (info.kind == PLC_PARAMETER_REAL) {
    std::memcpy(at, &value, sizeof value);
    return;
  }
  const int whole = static_cast<int>(value);
  std::memcpy(at, &whole, sizeof whole);
}

int given_values(const plc_parameters& parameters, const plc_parameter_info& info) {
  if (info.offset != offsetof(plc_parameters, level_iso)) return info.count;
  return std::clamp(parameters.level_iso_count, 0, PLC_MAX_LEVELS);
}

}  // namespace plc

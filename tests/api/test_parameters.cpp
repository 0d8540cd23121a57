#include <utility>
#include "engine/api/parameters.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "engine/base/constants.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::ErrorCode;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

plc_parameters defaults() {
  plc_parameters p;
  plc_parameters_defaults(&p);
  p.iso = 0.5;
  return p;
}

using Change = std::function<void(plc_parameters&)>;

// The message, "" when accepted; a refusal is always kInvalidArgument.
std::string refusal(const Change& change) {
  plc_parameters p = defaults();
  change(p);
  const plc::Status status = plc::check_parameters(p);
  if (!status.ok()) CHECK(status.code() == ErrorCode::kInvalidArgument);
  return status.message();
}

// A value of one field that is refused, in these words.
struct Refused {
  double plc_parameters::*field;
  double value;
  const char* message;
};

struct RefusedInt {
  int plc_parameters::*field;
  int value;
  const char* message;
};

const samples::Volume& ball() {
  static const samples::Volume volume =
      samples::sphere_potential(samples::empty_volume({20, 20, 20}), 0.3);
  return volume;
}

plc::Status derive(plc_parameters& p, const samples::Volume& volume = ball(),
                   int64_t memory_limit = 0) {
  const plc::VolumeView view = volume.view();
  const plc::VoxelRange range = plc::voxel_range(view, samples::kSerial);
  plc::DerivedWindow window;
  return plc::derive_parameters(view, range, samples::kSerial, memory_limit, p, window);
}

std::string not_derived(const Change& change, ErrorCode code = ErrorCode::kInvalidArgument) {
  plc_parameters p = defaults();
  change(p);
  const plc::Status status = derive(p);
  CHECK(status.code() == code);
  return status.message();
}

}  // namespace

TEST_CASE("the defaults with an iso-value are accepted", "[parameters]") {
  CHECK(refusal([](plc_parameters&) {}) == "");
  CHECK(refusal([](plc_parameters& p) { p.iso = kNan; }) == "iso: not set");
  CHECK(refusal([](plc_parameters& p) { p.iso = kInf; }) == "iso inf: must be finite");
}

TEST_CASE("each number outside its range is refused by name, value and range", "[parameters]") {
  using P = plc_parameters;
  const Refused kRefused[] = {
      {&P::reduction, 1, "reduction 1: must be above 1 and at most 2"},
      {&P::reduction, 2.0001, "reduction 2.0001: must be above 1 and at most 2"},
      {&P::reduction, kNan, "reduction nan: must be above 1 and at most 2"},
      {&P::window_low, -kInf, "window low -inf: must be finite"},
      {&P::window_high, kInf, "window high inf: must be finite"},
      {&P::pad_value, kInf, "pad value inf: must be finite"},
      {&P::curvature, -0.1, "curvature -0.1: must be 0 .. 1e6"},
      {&P::curvature, 1e7, "curvature 10000000: must be 0 .. 1e6"},
      {&P::curvature, kNan, "curvature nan: must be 0 .. 1e6"},
      {&P::spring, -1, "spring -1: must be 0 .. 1e6"},
      {&P::spring, kInf, "spring inf: must be 0 .. 1e6"},
      {&P::rest_length_value, -2, "rest length value -2: must be 0 .. 1e6"},
      {&P::attraction, 0, "attraction 0: must be 1e-6 .. 1e6"},
      {&P::attraction, -1, "attraction -1: must be 1e-6 .. 1e6"},
      {&P::attraction, kNan, "attraction nan: must be 1e-6 .. 1e6"},
      {&P::mass, 0, "mass 0: must be 1e-6 .. 1e6"},
      {&P::mass, -3, "mass -3: must be 1e-6 .. 1e6"},
      {&P::damping, -0.5, "damping -0.5: must be 0 .. 1e6"},
      {&P::time_step, 0, "time step 0: must be 1e-6 .. 1e6"},
      {&P::time_step, kInf, "time step inf: must be 1e-6 .. 1e6"},
      {&P::max_move, 0, "max move 0: must be above 0 and at most 1 delta"},
      {&P::max_move, 1.5, "max move 1.5: must be above 0 and at most 1 delta"},
      {&P::epsilon, 0, "epsilon 0: must be above 0 and at most 1"},
      {&P::epsilon, 1.1, "epsilon 1.1: must be above 0 and at most 1"},
      {&P::epsilon, kNan, "epsilon nan: must be above 0 and at most 1"},
  };
  for (const Refused& r : kRefused) {
    CHECK(refusal([&](plc_parameters& p) { p.*r.field = r.value; }) == r.message);
  }
  const RefusedInt kRefusedInts[] = {
      {&P::levels, -2, "levels -2: must be 0 .. 31"},
      {&P::levels, 32, "levels 32: must be 0 .. 31"},
      {&P::max_iterations, 0, "max iterations 0: must be at least 1"},
      {&P::sleeping, 2, "sleeping 2: must be 0 or 1"},
      {&P::late_bubbles, -1, "late bubbles -1: must be 0 or 1"},
      {&P::level_iso_count, -1, "level iso count -1: must be 0 .. 32"},
      {&P::level_iso_count, 33, "level iso count 33: must be 0 .. 32"},
  };
  for (const RefusedInt& r : kRefusedInts) {
    CHECK(refusal([&](plc_parameters& p) { p.*r.field = r.value; }) == r.message);
  }
}

TEST_CASE("the ends of the ranges are accepted", "[parameters]") {
  using P = plc_parameters;
  const std::pair<double P::*, double> kAccepted[] = {
      {&P::reduction, 2},     {&P::reduction, 1.0001}, {&P::curvature, 0},
      {&P::curvature, 1e6},   {&P::spring, 0},         {&P::attraction, 1e-6},
      {&P::mass, 1e6},        {&P::damping, 0},        {&P::time_step, 1e-6},
      {&P::max_move, 1},      {&P::max_move, 1e-9},    {&P::epsilon, 1},
      {&P::window_low, -1e9}, {&P::pad_value, 1e300},  {&P::rest_length_value, 0}};
  for (const auto& [field, value] : kAccepted) {
    CHECK(refusal([&, f = field, v = value](plc_parameters& p) { p.*f = v; }) == "");
  }
  CHECK(refusal([](plc_parameters& p) { p.levels = 31; }) == "");
  CHECK(refusal([](plc_parameters& p) { p.max_iterations = 1; }) == "");
}

TEST_CASE("choices that are none are refused", "[parameters]") {
  // As C callers pass them: any integer.
  const auto set = [](auto& choice, int value) {
    static_assert(sizeof choice == sizeof value);
    std::memcpy(&choice, &value, sizeof value);
  };
  CHECK(refusal([&](plc_parameters& p) { set(p.init, 7); }) == "init 7: must be a plc_init");
  CHECK(refusal([&](plc_parameters& p) { set(p.rest_length, 3); }) ==
        "rest length 3: must be a plc_rest_length");
  CHECK(refusal([&](plc_parameters& p) { set(p.bound, 2); }) == "bound 2: must be a plc_bound");
  CHECK(refusal([&](plc_parameters& p) { set(p.anisotropy, 0); }) ==
        "anisotropy 0: must be a plc_anisotropy");
}

TEST_CASE("bubbles are 1 to 256 on each axis", "[parameters]") {
  CHECK(refusal([](plc_parameters& p) { p.bubbles[1] = 0; }) ==
        "bubbles 0: must be 1 .. 256 per axis");
  CHECK(refusal([](plc_parameters& p) { p.bubbles[2] = 257; }) ==
        "bubbles 257: must be 1 .. 256 per axis");
  CHECK(refusal([](plc_parameters& p) { p.bubbles[0] = 256; }) == "");
}

TEST_CASE("there is an iso-value for every level, or for none", "[parameters]") {
  const auto given = [](int levels, int count) {
    return refusal([&](plc_parameters& p) {
      p.levels = levels;
      p.level_iso_count = count;
    });
  };
  CHECK(given(2, 3) == "");
  CHECK(given(2, 0) == "");
  CHECK(given(-1, 4) == "");
  CHECK(given(2, 2) == "level iso-values: 2 given, 3 expected (one per level)");
  CHECK(given(0, 2) == "level iso-values: 2 given, 1 expected (one per level)");
  CHECK(refusal([](plc_parameters& p) {
          p.level_iso_count = 2;
          p.level_iso[1] = kNan;
        }) == "level iso nan: must be finite");
}

TEST_CASE("what is not set is derived from the image", "[parameters]") {
  plc_parameters p = defaults();
  REQUIRE(derive(p).ok());
  CHECK(p.window_low < 0.5);
  CHECK(p.window_high > 0.5);
  CHECK(p.pad_value == p.window_low);
  CHECK(p.levels == 0);
  p = defaults();
  p.inside_below = 1;
  REQUIRE(derive(p).ok());
  CHECK(p.pad_value == p.window_high);
}

TEST_CASE("what is set is kept", "[parameters]") {
  plc_parameters p = defaults();
  p.window_low = 0.25;
  p.window_high = 0.75;
  p.pad_value = 0.1;
  p.levels = 1;
  REQUIRE(derive(p).ok());
  CHECK(p.window_low == 0.25);
  CHECK(p.window_high == 0.75);
  CHECK(p.pad_value == 0.1);
  CHECK(p.levels == 1);
  CHECK(plc::normalised(p, 0.5) == Approx(0.5));
  CHECK(plc::normalised(p, 0.25) == 0);
  CHECK(plc::denormalised(p, 1) == Approx(0.75));
}

TEST_CASE("the number of levels comes from the iso-values of levels or from the size",
          "[parameters]") {
  plc_parameters p = defaults();
  p.window_low = 0;
  p.window_high = 1;
  p.level_iso_count = 2;
  p.level_iso[0] = p.level_iso[1] = 0.5;
  REQUIRE(derive(p).ok());
  CHECK(p.levels == 1);
  // 3 voxels and the padding: 15, 8, 5 - no fourth level.
  samples::Volume small = samples::sphere_potential(samples::empty_volume({3, 20, 20}), 0.3);
  p = defaults();
  p.iso = 0.3;
  p.init = PLC_INIT_BUBBLE;
  REQUIRE(derive(p, small).ok());
  CHECK(p.levels == 2);
}

TEST_CASE("an iso-value outside the image's range is refused with the range", "[parameters]") {
  using Catch::Matchers::Contains;
  CHECK_THAT(not_derived([](plc_parameters& p) { p.iso = 5; }),
             Contains("iso 5: outside the image's range 0 .. "));
  CHECK_THAT(not_derived([](plc_parameters& p) { p.iso = 0; }), Contains("outside"));
  CHECK_THAT(not_derived([](plc_parameters& p) {
               p.iso = 1;
               p.inside_below = 1;
             }),
             Contains("outside"));
  plc_parameters p = defaults();
  p.iso = 0;
  p.inside_below = 1;
  CHECK(derive(p).ok());
}

TEST_CASE("a constant image is refused", "[parameters]") {
  samples::Volume flat = samples::empty_volume({8, 8, 8});
  flat.values.assign(512, 7);
  plc_parameters p = defaults();
  const plc::Status status = derive(p, flat);
  CHECK(status.code() == ErrorCode::kInvalidData);
  CHECK(status.message() == "constant image: every voxel is 7, there is no surface in it");
}

TEST_CASE("a window that does not hold the iso-values is refused", "[parameters]") {
  CHECK(not_derived([](plc_parameters& p) {
          p.window_low = 0.6;
          p.window_high = 0.9;
        }) == "window 0.6, 0.9: iso 0.5 must lie inside it");
  CHECK(not_derived([](plc_parameters& p) {
          p.window_low = 0.9;
          p.window_high = 0.1;
        }) == "window 0.9, 0.1: iso 0.5 must lie inside it");
  CHECK(not_derived([](plc_parameters& p) {
          p.window_low = 0;
          p.window_high = 0.9;
          p.level_iso_count = 2;
          p.level_iso[0] = 0.5;
          p.level_iso[1] = 0.9;
        }) == "level iso-value 0.9: outside the window 0, 0.9");
}

TEST_CASE("surroundings on the object's side of an iso-value are refused: it would have no end",
          "[parameters]") {
  CHECK(not_derived([](plc_parameters& p) { p.pad_value = 0.5; }) ==
        "pad value 0.5: on the object's side of iso 0.5");
  CHECK(not_derived([](plc_parameters& p) {
          p.pad_value = 0.4;
          p.inside_below = 1;
        }) == "pad value 0.4: on the object's side of iso 0.5");
  CHECK(not_derived([](plc_parameters& p) {
          p.window_low = 0;
          p.window_high = 1;
          p.pad_value = 0.3;
          p.level_iso_count = 2;
          p.level_iso[0] = 0.5;
          p.level_iso[1] = 0.2;
        }) == "pad value 0.3: on the object's side of level iso-value 0.2");
  // The gradient's force knows no sides.
  plc_parameters p = defaults();
  p.pad_value = 0.9;
  p.force = PLC_FORCE_GRADIENT;
  CHECK(derive(p).ok());
}

TEST_CASE("no level's iso-value is derived beyond what surrounds the image", "[parameters]") {
  plc_parameters p = defaults();
  p.window_low = p.pad_value = 0;
  REQUIRE(derive(p).ok());
  CHECK(plc::level_iso_bound(p, 0.25) == Approx(plc::normalised(p, 0.3125)));
  p.pad_value = 0.4;
  CHECK(plc::level_iso_bound(p, 0.25) == Approx(plc::normalised(p, 0.425)));
}

TEST_CASE("the model is what was asked for, with the sign of the object's side", "[parameters]") {
  plc_parameters p = defaults();
  p.curvature = 0.25;
  p.spring = 0.125;
  p.rest_length = PLC_REST_VALUE;
  p.rest_length_value = 1.75;
  p.attraction = 2;
  p.mass = 3;
  p.damping = 0.75;
  p.time_step = 0.5;
  p.max_move = 0.375;
  p.bound = PLC_BOUND_SCALE;
  p.init = PLC_INIT_BUBBLES;
  p.bubbles[2] = 7;
  p.epsilon = 1e-4;
  p.max_iterations = 77;
  const plc::RecoverySpec spec = plc::recovery_spec(p, 1);
  CHECK(spec.model.curvature == 0.25F);
  CHECK(spec.model.spring == 0.125F);
  CHECK(spec.model.rest_length == plc::RestLength::kValue);
  CHECK(spec.model.rest_length_value == 1.75F);
  CHECK(spec.model.attraction == -2);
  CHECK(spec.model.mass == 3);
  CHECK(spec.model.damping == 0.75F);
  CHECK(spec.model.time_step == 0.5F);
  CHECK(spec.model.max_move == 0.375F);
  CHECK(spec.model.bound == plc::Bound::kScale);
  CHECK(spec.start.init == plc::Init::kBubbles);
  CHECK(spec.start.bubbles == std::array{1, 1, 7});
  CHECK(spec.epsilon == 1e-4);
  CHECK(spec.max_iterations == 77);
  CHECK(spec.pad_voxels == plc::kPadVoxels);
  CHECK(spec.inside_above);
  p.inside_below = 1;
  CHECK(plc::recovery_spec(p, 1).model.attraction == 2);
  CHECK_FALSE(plc::recovery_spec(p, 1).inside_above);
}

TEST_CASE("an adaptive mesh starts from the iso-surface where the image is not mostly that",
          "[parameters]") {
  plc_extras extras;
  plc_extras_defaults(&extras);
  const auto start_of = [&extras](const std::function<void(plc_parameters&)>& change,
                                  const samples::Volume& volume, int64_t memory_limit) {
    plc_parameters p = defaults();
    change(p);
    REQUIRE(derive(p, volume, memory_limit).ok());
    REQUIRE(plc::derive_mesh(1, 40, p).ok());
    plc::derive_init(extras, p);
    return std::pair(static_cast<int>(p.init), p.levels);
  };
  const auto as_is = [](plc_parameters&) {};
  const std::pair iso(static_cast<int>(PLC_INIT_ISO), 0);
  const std::pair bubble(static_cast<int>(PLC_INIT_BUBBLE), 3);
  const samples::Volume ball = samples::sphere_potential(samples::empty_volume({40, 40, 40}), 0.3);
  CHECK(start_of(as_is, ball, 0) == iso);
  CHECK(start_of([](plc_parameters& p) { p.mesh = PLC_MESH_UNIFORM; }, ball, 0) == bubble);
  CHECK(start_of([](plc_parameters& p) { p.edge = 2; }, ball, 0) == bubble);
  CHECK(start_of([](plc_parameters& p) { p.late_bubbles = 0; }, ball, 0) == bubble);
  CHECK(start_of([](plc_parameters& p) { p.init = PLC_INIT_BUBBLE; }, ball, 0) == bubble);
  CHECK(start_of([](plc_parameters& p) { p.levels = 0; }, ball, 0) == iso);
  CHECK(start_of([](plc_parameters& p) { p.levels = 3; }, ball, 0) == bubble);
  // About 1,200 voxels at its surface.
  CHECK(start_of(as_is, ball, 16 << 20) == iso);
  CHECK(start_of(as_is, ball, 1 << 20) == bubble);
  extras.pin_count = 1;
  CHECK(start_of(as_is, ball, 0) == std::pair(static_cast<int>(PLC_INIT_BUBBLE), 0));
  extras.pin_count = 0;
  samples::Volume noise = samples::empty_volume({60, 60, 60});
  noise.values.resize(size_t{60} * 60 * 60);
  for (size_t i = 0; i < noise.values.size(); ++i) {
    noise.values[i] = static_cast<float>(i * 2654435761U % 1000) / 1000;
  }
  CHECK(start_of(as_is, noise, 0) == bubble);
  // Noise in a fifth of it: about 12 % of all voxels.
  std::fill(noise.values.begin() + 12 * 60 * 60, noise.values.end(), 0.0F);
  CHECK(start_of(as_is, noise, 0) == iso);
}

TEST_CASE("the engine's own defaults are those that are shipped", "[parameters]") {
  plc_parameters p = defaults();
  plc_extras extras;
  plc_extras_defaults(&extras);
  plc::derive_init(extras, p);
  const plc::RecoverySpec shipped = plc::recovery_spec(p, 1), own;
  CHECK(own.model.curvature == shipped.model.curvature);
  CHECK(own.model.spring == shipped.model.spring);
  CHECK(own.model.rest_length == shipped.model.rest_length);
  CHECK(own.model.rest_length_value == shipped.model.rest_length_value);
  CHECK(own.model.attraction == shipped.model.attraction);
  CHECK(own.model.gradient_normal == shipped.model.gradient_normal);
  CHECK(own.model.gradient_tangent == shipped.model.gradient_tangent);
  CHECK(own.model.mass == shipped.model.mass);
  CHECK(own.model.damping == shipped.model.damping);
  CHECK(own.model.time_step == shipped.model.time_step);
  CHECK(own.model.max_move == shipped.model.max_move);
  CHECK(own.model.bound == shipped.model.bound);
  CHECK(own.sizes.has_value() == shipped.sizes.has_value());
  CHECK(own.inside_above == shipped.inside_above);
  CHECK(own.gradient_bound == shipped.gradient_bound);
  CHECK(own.pad_voxels == shipped.pad_voxels);
  CHECK(own.scale.anisotropy == shipped.scale.anisotropy);
  CHECK(own.start.init == shipped.start.init);
  CHECK(own.start.bubbles == shipped.start.bubbles);
  CHECK(own.late_bubbles == shipped.late_bubbles);
  CHECK(own.sleeping == shipped.sleeping);
  CHECK(own.epsilon == shipped.epsilon);
  CHECK(own.calm_speed == shipped.calm_speed);
  CHECK(own.max_iterations == shipped.max_iterations);
}

TEST_CASE("the pyramid's own defaults are those that are shipped, of an image from 0 to 1",
          "[parameters]") {
  plc_parameters p = defaults();
  p.window_low = 0;
  p.window_high = 1;
  p.init = PLC_INIT_BUBBLE;
  REQUIRE(derive(p).ok());
  const plc::PyramidSpec shipped = plc::pyramid_spec(p), own;
  CHECK(own.reduction == shipped.reduction);
  CHECK(own.reduction == plc::kRefinement);
  CHECK(own.levels == shipped.levels);
  CHECK(own.window_low == shipped.window_low);
  CHECK(own.window_high == shipped.window_high);
  CHECK(own.pad_value == shipped.pad_value);
  CHECK(own.pad_voxels == shipped.pad_voxels);
}

TEST_CASE("the sizes of an adaptive mesh are the engine's own where nothing is said of them",
          "[parameters]") {
  plc_parameters p = defaults();
  p.mesh = PLC_MESH_ADAPTIVE;
  REQUIRE(plc::derive_mesh(1, 100, p).ok());
  const auto shipped = plc::recovery_spec(p, 1).sizes;
  const plc::SizeSpec own;
  REQUIRE(shipped.has_value());
  CHECK(own.finest == Approx(shipped->finest));
  CHECK(own.coarsest == Approx(shipped->coarsest));
  CHECK(own.tolerance == Approx(shipped->tolerance));
  CHECK(own.slope == shipped->slope);
}

TEST_CASE("the pyramid is built with the parameters' window, padding and reduction",
          "[parameters]") {
  plc_parameters p = defaults();
  p.reduction = 1.5;
  p.levels = 2;
  p.window_low = -3;
  p.window_high = 9;
  p.pad_value = -5;
  const plc::PyramidSpec spec = plc::pyramid_spec(p);
  CHECK(spec.reduction == 1.5);
  CHECK(spec.levels == 2);
  CHECK(spec.window_low == -3);
  CHECK(spec.window_high == 9);
  CHECK(spec.pad_value == -5);
  CHECK(spec.pad_voxels == plc::kPadVoxels);
}

TEST_CASE("lengths of an adaptive mesh are derived from the voxels, and checked against them",
          "[parameters]") {
  plc_parameters p = defaults();
  p.mesh = PLC_MESH_UNIFORM;
  CHECK(plc::derive_mesh(2, 100, p).ok());
  CHECK(p.edge_max == 0);  // a uniform mesh has none
  CHECK(p.edge == Approx(2.5));
  CHECK(plc::recovery_spec(p, 2).scale.edges == 1);
  p.edge = 5;
  CHECK(plc::derive_mesh(2, 100, p).ok());
  CHECK(plc::recovery_spec(p, 2).scale.edges == Approx(2));
  p.edge = 0.4;
  CHECK(plc::derive_mesh(2, 100, p).message() ==
        "edges of 0.4 mm: must be within 0.5 .. 10 mm for this image");
  CHECK_FALSE(plc::recovery_spec(p, 2).sizes.has_value());
  p.mesh = PLC_MESH_ADAPTIVE;
  REQUIRE(plc::derive_mesh(2, 100, p).ok());
  CHECK(p.tolerance == Approx(2.0 / 24));
  CHECK(p.edge_min == Approx(1.25));
  CHECK(p.edge_max == Approx(10));
  const auto sizes = plc::recovery_spec(p, 2).sizes;
  REQUIRE(sizes.has_value());
  CHECK(sizes->finest == Approx(0.5));
  CHECK(sizes->coarsest == Approx(4));
  CHECK(sizes->tolerance == Approx(0.05));
  p.edge_max = 1;
  CHECK(plc::derive_mesh(2, 100, p).message() ==
        "edges of 1.25 .. 1 mm: must be a range within 0.3125 .. 19.75 mm for voxels of 2 mm");
}

TEST_CASE("a mesh is adaptive where it can be, unless the caller says which", "[parameters]") {
  const auto kind = [](const auto& change) {
    plc_parameters p = defaults();
    p.iso = 0.5;
    change(p);
    REQUIRE(plc::derive_mesh(2, 100, p).ok());
    CHECK(plc::recovery_spec(p, 2).sizes.has_value() == (p.mesh == PLC_MESH_ADAPTIVE));
    return p.mesh;
  };
  CHECK(kind([](plc_parameters&) {}) == PLC_MESH_ADAPTIVE);
  CHECK(kind([](plc_parameters& p) { p.mesh = PLC_MESH_UNIFORM; }) == PLC_MESH_UNIFORM);
  CHECK(kind([](plc_parameters& p) { p.edge = 3; }) == PLC_MESH_UNIFORM);
  CHECK(kind([](plc_parameters& p) { p.spring = 0.1; }) == PLC_MESH_UNIFORM);
  CHECK(kind([](plc_parameters& p) { p.force = PLC_FORCE_BOTH; }) == PLC_MESH_UNIFORM);
  CHECK(kind([](plc_parameters& p) {
          p.force = PLC_FORCE_BOTH;
          p.mesh = PLC_MESH_ADAPTIVE;
        }) == PLC_MESH_ADAPTIVE);
}

TEST_CASE("an adaptive mesh needs an iso-value and has no springs", "[parameters]") {
  CHECK(refusal([](plc_parameters& p) {
          p.mesh = PLC_MESH_ADAPTIVE;
          p.spring = 0.1;
        }) == "mesh adaptive: has no springs, which draw edges to one length");
  CHECK(refusal([](plc_parameters& p) {
          p.mesh = PLC_MESH_ADAPTIVE;
          p.iso = NAN;
          p.force = PLC_FORCE_GRADIENT;
        }) == "mesh adaptive: needs an iso-value, from which its sizes are derived");
}

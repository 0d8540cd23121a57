// The C API: the force callback.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "tests/samples/sample_hosts.h"

using namespace samples;

namespace {

// How far the surface reaches from the middle of the image on each of its axes, mm.
Point extents(const plc_surface* surface, const plc_image& image) {
  const auto xyz = positions(surface, PLC_SPACE_VOXEL);
  Point most{};
  for (size_t i = 0; i < xyz.size(); ++i) {
    const size_t a = i % 3;
    const double middle = static_cast<double>(image.dims[a] - 1) / 2;
    most[a] = std::max(most[a], std::abs(static_cast<double>(xyz[i]) - middle) * image.spacing[a]);
  }
  return most;
}

}  // namespace

TEST_CASE("a force of 1 is that of attraction 1 on a value a window away from iso", "[pellicle]") {
  // The surface rests where both cancel: 0.1 outward at the value 0.4, 20 % further out.
  const Context context = make_context();
  struct Method {
    plc_anisotropy anisotropy;
    plc_space space;
    bool mirrored;
  };
  for (const Method& m : {Method{PLC_ANISOTROPY_PHYSICAL, PLC_SPACE_LPS, false},
                          Method{PLC_ANISOTROPY_PHYSICAL, PLC_SPACE_RAS, true},
                          Method{PLC_ANISOTROPY_METRIC, PLC_SPACE_LPS, true},
                          Method{PLC_ANISOTROPY_METRIC, PLC_SPACE_RAS, false},
                          Method{PLC_ANISOTROPY_VOXEL, PLC_SPACE_VOXEL, false}}) {
    const Volume volume = ball({28, 28, 14}, {1, 1, 2});
    plc_image image = image_of(volume);
    if (m.mirrored) image.direction[0] = -1;
    Host host = pushing(0.1F);
    plc_extras extras = extras_of(host);
    extras.space = m.space;
    plc_parameters p = gentle();
    p.anisotropy = m.anisotropy;
    const Surface plain = extract(context.get(), image, p);
    const Surface pushed = extract(context.get(), image, p, &extras);
    const double before = measured(context.get(), plain.get(), PLC_SPACE_LPS).volume;
    const double after = measured(context.get(), pushed.get(), PLC_SPACE_LPS).volume;
    CAPTURE(static_cast<int>(m.anisotropy), static_cast<int>(m.space));
    CHECK(std::cbrt(after / before) == Approx(1.2).epsilon(0.015));
    // On all axes alike.
    const Point most = extents(pushed.get(), image);
    for (const double extent : most) CHECK(extent == Approx(1.2 * kRadius).epsilon(0.05));
  }
}

TEST_CASE("a force in mm on a mesh in voxels is less along the longer voxels", "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball({28, 28, 14}, {1, 1, 2});
  const plc_image image = image_of(volume);
  Host host = pushing(0.1F);
  const plc_extras extras = extras_of(host);  // LPS
  plc_parameters p = gentle();
  p.anisotropy = PLC_ANISOTROPY_VOXEL;
  const Surface pushed = extract(context.get(), image, p, &extras);
  const Point most = extents(pushed.get(), image);
  CHECK(most[0] == Approx(1.2 * kRadius).epsilon(0.05));
  CHECK(most[1] == Approx(1.2 * kRadius).epsilon(0.05));
  CHECK(most[2] == Approx(1.1 * kRadius).epsilon(0.05));
}

TEST_CASE(
    "the force callback sees every vertex of a stage with its normal, four times an iteration",
    "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball();
  const plc_image image = image_of(volume);
  int64_t calls = 0, levels_seen = 0, wrong = 0;
  int level = 99;
  Host host;
  host.force = [&](const plc_force_points& points, float* forces) {
    ++calls;
    CHECK(points.struct_size == sizeof points);
    levels_seen += points.level != level ? 1 : 0;
    level = points.level;
    CHECK(points.count > 30);
    for (int64_t i = 0; i < points.count; ++i) {
      const float* n = points.normals + 3 * i;
      const float* x = points.xyz + 3 * i;
      double outward = 0, squared = 0;
      for (size_t a = 0; a < 3; ++a) {
        const auto component = static_cast<double>(n[a]);
        outward += component * (static_cast<double>(x[a]) - 14.5);
        squared += component * component;
        wrong += forces[3 * i + static_cast<int64_t>(a)] != 0 ? 1 : 0;
      }
      wrong += outward <= 0 || std::abs(squared - 1) > 1e-4 ? 1 : 0;
    }
    return 0;
  };
  const plc_extras extras = extras_of(host);
  const Surface surface = extract(context.get(), image, gentle(1), &extras);
  CHECK(wrong == 0);
  CHECK(levels_seen == 2);
  CHECK(calls ==
        4 * (level_of(surface.get(), 0).iterations + level_of(surface.get(), 1).iterations));
  // A force of 0 changes no bit.
  // Nothing sleeps with a force.
  plc_parameters awake = gentle(1);
  awake.sleeping = 0;
  const Surface plain = extract(context.get(), image, awake);
  CHECK(plc_surface_hash(surface.get()) == plc_surface_hash(plain.get()));
}

TEST_CASE("a force that is not finite, too large, or says no ends the call", "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball();
  const plc_image image = image_of(volume);
  const plc_parameters p = gentle();
  const auto failed = [&](plc_status expected,
                          const std::function<int(const plc_force_points&, float*)>& force) {
    Host host;
    host.force = force;
    const plc_extras extras = extras_of(host);
    auto* surface = reinterpret_cast<plc_surface*>(&host);
    CHECK(plc_extract(context.get(), &image, &p, &extras, &surface) == expected);
    CHECK(surface == nullptr);
    return std::string(plc_context_message(context.get()));
  };
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(), 2e6F}) {
    CHECK(failed(PLC_INVALID_ARGUMENT, [&](const plc_force_points&, float* forces) {
            forces[7] = bad;
            return 0;
          }) == "force callback: the force on vertex 2 of level 0 is not finite, or above 1e6");
  }
  int calls = 0;
  CHECK(failed(PLC_CANCELLED, [&](const plc_force_points&, float*) {
          return ++calls < 11 ? 0 : 1;
        }) == "cancelled by the force callback");
  CHECK(calls == 11);
  // The context is as good as new.
  CHECK(extract(context.get(), image, p) != nullptr);
}

TEST_CASE("the scaled time step asks the force callback again", "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball();
  int64_t calls = 0;
  Host host;
  host.force = [&](const plc_force_points&, float*) {
    ++calls;
    return 0;
  };
  const plc_extras extras = extras_of(host);
  plc_parameters p = gentle();
  p.bound = PLC_BOUND_SCALE;
  p.max_iterations = 10;
  p.late_bubbles = 0;
  const plc_image image = image_of(volume);
  const Surface surface = extract(context.get(), image, p, &extras);
  CHECK(calls > 4 * level_of(surface.get(), 0).iterations);
  CHECK(calls % 4 == 0);
}

// What the C API tells of failures, of a surface's rest, and of structs that are only written.
#include <algorithm>
#include <catch2/catch.hpp>
#include <climits>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <type_traits>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"
#include "tests/samples/sample_hosts.h"
#include "tests/samples/sample_steps.h"

using namespace samples;

namespace {

template <typename Struct>
void require_cleared(void (*defaults)(Struct*)) {
  Struct s;
  std::memset(static_cast<void*>(&s), 0x5a, sizeof s);
  defaults(&s);
  CHECK(s.struct_size == sizeof s);
  s.struct_size = 0;
  if constexpr (std::is_same_v<Struct, plc_check>) {
    CHECK(s.measures.struct_size == sizeof s.measures);
    s.measures.struct_size = 0;
  }
  if constexpr (std::is_same_v<Struct, plc_run_state>) {
    CHECK(s.progress.struct_size == sizeof s.progress);
    s.progress.struct_size = 0;
  }
  Struct zero{};
  CHECK(std::memcmp(static_cast<const void*>(&s), static_cast<const void*>(&zero), sizeof s) == 0);
  defaults(nullptr);
}

// 0.5 on a sphere of the radius, a ramp of six voxels across it.
Volume edged_ball(int64_t n, double radius) {
  Volume volume = empty_volume({n, n, n}, {1, 1, 1});
  const double middle = static_cast<double>(n - 1) / 2;
  volume.values.clear();
  for (int64_t z = 0; z < n; ++z) {
    for (int64_t y = 0; y < n; ++y) {
      for (int64_t x = 0; x < n; ++x) {
        const double distance =
            std::hypot(static_cast<double>(x) - middle, static_cast<double>(y) - middle,
                       static_cast<double>(z) - middle);
        volume.values.push_back(
            static_cast<float>(std::clamp(0.5 + (radius - distance) / 6, 0.0, 1.0)));
      }
    }
  }
  return volume;
}

// A tilted plate of twice `half` voxels, with a hole of that radius in its middle.
Volume edged_plate(double hole, double half = 0.8) {
  return sampled(empty_volume({56, 56, 56}, {1, 1, 1}), [&](const Point& p) {
    const double off = (p[0] + 0.4 * p[1] + 0.2 * p[2]) / std::sqrt(1.2);
    const double squared = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - off * off;
    const double within = std::sqrt(std::max(squared, 0.0));
    double depth = std::min(half - std::abs(off), 20 - within);
    if (hole > 0) depth = std::min(depth, within - hole);
    return std::clamp(0.5 + 0.5 * depth, 0.0, 1.0);
  });
}

}  // namespace

TEST_CASE("every status has a text of its own, and what is no status has one, too",
          "[pellicle_outputs]") {
  std::set<std::string> texts;
  for (int status = PLC_OK; status <= PLC_INTERNAL; ++status) {
    texts.insert(plc_status_string(static_cast<plc_status>(status)));
  }
  CHECK(texts.size() == 6);
  CHECK(texts.count("out of memory") == 1);
  CHECK(texts.count("") == 0);
  for (const int status : {-1, PLC_INTERNAL + 1, INT_MIN, INT_MAX}) {
    CHECK(std::string(plc_status_string(static_cast<plc_status>(status))) ==
          "not a status of this version of the library");
  }
}

TEST_CASE("structs that are only written start with their size and nothing else",
          "[pellicle_outputs]") {
  require_cleared(plc_pyramid_level_defaults);
  require_cleared(plc_run_state_defaults);
  require_cleared(plc_measures_defaults);
  require_cleared(plc_level_report_defaults);
  require_cleared(plc_seconds_defaults);
  require_cleared(plc_check_defaults);
  require_cleared(plc_component_measures_defaults);
  require_cleared(plc_distances_defaults);
}

TEST_CASE("a surface tells whether it came to rest", "[pellicle_outputs]") {
  const Context context = make_context();
  const Volume volume = ball({24, 24, 24});
  const plc_image image = image_of(volume);
  plc_parameters p = parameters(0.5, 1);
  CHECK(plc_surface_converged(extract(context.get(), image, p).get()) == 1);
  p.max_iterations = 3;
  CHECK(plc_surface_converged(extract(context.get(), image, p).get()) == 0);
  CHECK(plc_surface_converged(nullptr) == 0);
}

TEST_CASE("the surface of a run has not converged before its level ends", "[pellicle_outputs]") {
  const Scene s;
  const Context context = make_context();
  const PyramidHandle pyramid = pyramid_of(context.get(), s.image, s.parameters);
  const RunHandle run = run_of(context.get(), pyramid.get(), s.parameters);
  const auto converged = [&] {
    return plc_surface_converged(surface_of(context.get(), run.get()).get());
  };
  CHECK(converged() == 0);
  advance(context.get(), run.get(), PLC_ONE_ITERATION);
  CHECK(converged() == 0);
  advance(context.get(), run.get(), PLC_ONE_LEVEL);
  CHECK(converged() == 1);
  advance(context.get(), run.get(), PLC_ONE_ITERATION);
  CHECK(converged() == 0);
  advance(context.get(), run.get(), PLC_ALL_LEVELS);
  CHECK(converged() == 1);
}

TEST_CASE("all edges of a uniform mesh are as long as the caller wants them",
          "[pellicle_outputs]") {
  const Context context = make_context();
  const Volume volume = edged_ball(60, 22);
  const plc_image image = image_of(volume);
  plc_parameters p = parameters(0.5, 2);
  const auto made = [&](double edge) {
    p.edge = edge;
    return extract(context.get(), image, p);
  };
  p.mesh = PLC_MESH_UNIFORM;
  const Surface usual = made(0);
  CHECK(parameters_of(usual.get()).edge == 1.25);
  CHECK(plc_surface_hash(made(1.25).get()) == plc_surface_hash(usual.get()));
  const double volume_of_ball = measured(context.get(), usual.get(), PLC_SPACE_LPS).volume;
  for (const double edge : {0.4, 0.8, 2.5, 5.0}) {
    CAPTURE(edge);
    const Surface surface = made(edge);
    CHECK(plc_surface_converged(surface.get()) == 1);
    plc_check check;
    plc_check_defaults(&check);
    REQUIRE(plc_surface_check(context.get(), surface.get(), &check) == PLC_OK);
    CHECK(check.valid == 1);
    CHECK(check.edge_mean == Approx(edge).epsilon(0.2));
    CHECK(measured(context.get(), surface.get(), PLC_SPACE_LPS).volume ==
          Approx(volume_of_ball).epsilon(0.02));
  }
  p.edge = 0.2;
  plc_surface* none = nullptr;
  CHECK(plc_extract(context.get(), &image, &p, nullptr, &none) == PLC_INVALID_ARGUMENT);
  CHECK(std::string(plc_context_message(context.get())) ==
        "edges of 0.2 mm: must be within 0.25 .. 6 mm for this image");
}

TEST_CASE("edges are as long as the header says", "[pellicle_outputs]") {
  const Context context = make_context();
  const auto check_of = [&](double radius, double voxel, plc_mesh_kind mesh, double& tolerance) {
    const auto n = static_cast<int64_t>(2 * radius) + 12;
    const Volume volume = edged_ball(n, radius);
    plc_image image = image_of(volume);
    for (double& side : image.spacing) side = voxel;
    plc_parameters p = parameters(0.5, 2);
    p.mesh = mesh;
    const Surface surface = extract(context.get(), image, p);
    tolerance = parameters_of(surface.get()).tolerance;
    plc_check check;
    plc_check_defaults(&check);
    REQUIRE(plc_surface_check(context.get(), surface.get(), &check) == PLC_OK);
    return check;
  };
  double tolerance = 0;
  for (const double voxel : {1.0, 0.3}) {
    const plc_check uniform = check_of(10, voxel, PLC_MESH_UNIFORM, tolerance);
    CHECK(uniform.edge_min > 0.83 * voxel);
    CHECK(uniform.edge_max < 2.09 * voxel);
    CHECK(uniform.edge_mean > 1.1 * voxel);
    CHECK(uniform.edge_mean < 1.5 * voxel);
    for (const double radius : {10.0, 20.0}) {
      const plc_check adaptive = check_of(radius, voxel, PLC_MESH_ADAPTIVE, tolerance);
      CHECK(tolerance == Approx(voxel / 24));
      CHECK(adaptive.edge_mean == Approx(3 * std::sqrt(tolerance * radius * voxel)).epsilon(0.15));
    }
  }
}

// Most of it is rims of what voxels show of it; where the image bends alone edges were short, and
// 1,201 of these 2,513 square voxels were left.
TEST_CASE("what voxels show of a plate thinner than they are is not cut to pieces by its start",
          "[pellicle_outputs]") {
  const Context context = make_context();
  const Volume thin = edged_plate(0, 0.35);
  const Surface surface = extract(context.get(), image_of(thin), parameters(0.5, 0));
  CHECK(measured(context.get(), surface.get(), PLC_SPACE_LPS).area > 1500);
}

// The border of such a hole, as a coarse level may tear it, is nothing of the image's.
TEST_CASE("a hole that only the surface has in a thin plate is closed but for pores",
          "[pellicle_outputs]") {
  const Context context = make_context();
  const Volume with = edged_plate(7), without = edged_plate(0);
  plc_parameters p = parameters(0.5, 0);
  const Surface torn = extract(context.get(), image_of(with), p);
  const Surface whole = extract(context.get(), image_of(without), p);
  CHECK(parameters_of(torn.get()).mesh == PLC_MESH_ADAPTIVE);
  CHECK(measured(context.get(), torn.get(), PLC_SPACE_LPS).genus == 1);
  const auto arrays = [](const Surface& surface) {
    return std::pair(positions_f64(surface.get(), PLC_SPACE_VOXEL),
                     faces(surface.get(), PLC_SPACE_VOXEL));
  };
  const auto [xyz, abc] = arrays(torn);
  plc_extras extras = no_extras();
  extras.space = PLC_SPACE_VOXEL;
  extras.mesh_xyz = xyz.data();
  extras.mesh_vertex_count = static_cast<int64_t>(xyz.size() / 3);
  extras.mesh_abc = abc.data();
  extras.mesh_face_count = static_cast<int64_t>(abc.size() / 3);
  p.init = PLC_INIT_MESH;
  const Surface closed = extract(context.get(), image_of(without), p, &extras);
  const auto [from_xyz, from_abc] = arrays(whole);
  const auto [to_xyz, to_abc] = arrays(closed);
  plc_distances distances{};
  distances.struct_size = sizeof distances;
  REQUIRE(
      plc_mesh_distance(context.get(), from_xyz.data(), static_cast<int64_t>(from_xyz.size() / 3),
                        from_abc.data(), static_cast<int64_t>(from_abc.size() / 3), to_xyz.data(),
                        static_cast<int64_t>(to_xyz.size() / 3), to_abc.data(),
                        static_cast<int64_t>(to_abc.size() / 3), nullptr, &distances) == PLC_OK);
  CHECK(distances.max < 3.5);
  CHECK(measured(context.get(), closed.get(), PLC_SPACE_LPS).genus <= 4);
}

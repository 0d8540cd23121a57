// The C API: a part of a larger surface evolves, what is held stays as it is.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/samples/sample_api.h"
#include "tests/samples/sample_meshes.h"

namespace {

using Catch::Matchers::Contains;
using samples::Context;
using samples::Surface;

constexpr double kIso = 0.5;

// A ball of radius 15 about the middle, a wave on it, and a small ball beside it.
struct Scene {
  samples::Volume volume =
      samples::sampled(samples::empty_volume({48, 44, 46}, {1, 1, 1}), [](const auto& p) {
        const double wave = std::sin(p[0] * 0.7) * std::sin(p[1] * 0.6);
        const double large = 15 + wave - samples::norm(p[0] + 2, p[1], p[2]);
        const double small = 3.4 - samples::norm(p[0] - 18.5, p[1], p[2]);
        return std::clamp(0.5 + std::max(large, small), 0.0, 1.0);
      });
  plc_image image = samples::image_of(volume);
  plc_parameters parameters = samples::parameters(kIso, 0);

  Scene() {
    parameters.mesh = PLC_MESH_UNIFORM;
    parameters.late_bubbles = 0;
  }
};

struct Part {
  std::vector<double> xyz;
  std::vector<uint32_t> abc;
  std::vector<uint8_t> held;
  std::array<double, 3> low{-100, -100, -100}, high{100, 100, 100};

  plc_extras extras() const {
    plc_extras e = samples::no_extras();
    e.space = PLC_SPACE_VOXEL;
    e.mesh_xyz = xyz.data();
    e.mesh_vertex_count = static_cast<int64_t>(xyz.size() / 3);
    e.mesh_abc = abc.data();
    e.mesh_face_count = static_cast<int64_t>(abc.size() / 3);
    e.mesh_held = held.data();
    std::copy(low.begin(), low.end(), e.room_low);
    std::copy(high.begin(), high.end(), e.room_high);
    return e;
  }
};

// A coarser surface of the large ball, as blocks start from.
Part coarse(const Scene& scene) {
  plc_parameters p = scene.parameters;
  p.edge = 2;
  p.init = PLC_INIT_SEEDS;
  const plc_seed seed{{21.5, 21.5, 22.5}, 10};
  plc_extras extras = samples::no_extras();
  extras.seeds = &seed;
  extras.seed_count = 1;
  const Context context = samples::make_context();
  const Surface surface = samples::extract(context.get(), scene.image, p, &extras);
  Part part;
  part.xyz = samples::positions_f64(surface.get(), PLC_SPACE_VOXEL);
  part.abc = samples::faces(surface.get(), PLC_SPACE_VOXEL);
  part.held.assign(part.xyz.size() / 3, 0);
  return part;
}

void hold_below(Part& part, double x) {
  for (size_t v = 0; v < part.held.size(); ++v) part.held[v] = part.xyz[3 * v] < x ? 1 : 0;
  part.low[0] = x;
}

// Takes out the faces of which a corner lies below x.
std::vector<uint32_t> cut_below(Part& part, double x) {
  std::vector<uint32_t> gone, left;
  for (size_t f = 0; f < part.abc.size(); f += 3) {
    bool below = false;
    for (size_t k = 0; k < 3; ++k) below = below || part.xyz[3 * size_t{part.abc[f + k]}] < x;
    auto& to = below ? gone : left;
    to.insert(to.end(), &part.abc[f], &part.abc[f] + 3);
  }
  part.abc = left;
  return gone;
}

struct Result {
  std::vector<double> xyz;
  std::vector<uint32_t> abc;
  std::vector<int64_t> source;
  uint64_t hash = 0;
  int converged = 0;
};

Result evolved(plc_context* context, const Scene& scene, const Part& part) {
  plc_parameters p = scene.parameters;
  p.init = PLC_INIT_MESH;
  const plc_extras extras = part.extras();
  const Surface surface = samples::extract(context, scene.image, p, &extras);
  Result result;
  result.xyz = samples::positions_f64(surface.get(), PLC_SPACE_VOXEL);
  result.source.resize(result.xyz.size() / 3);
  REQUIRE(plc_surface_patch(context, surface.get(), result.source.data(),
                            static_cast<int64_t>(result.source.size())) == PLC_OK);
  result.abc = samples::faces(surface.get(), PLC_SPACE_VOXEL);
  for (const uint32_t v : result.abc) REQUIRE(result.source[v] != PLC_PATCH_ABSENT);
  result.hash = plc_surface_hash(surface.get());
  result.converged = plc_surface_converged(surface.get());
  return result;
}

using Face = std::array<int64_t, 3>;

Face turned(Face f) {
  std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
  return f;
}

// The faces of held vertices alone, by the ids given.
std::set<Face> held_faces(const Part& part) {
  std::set<Face> faces;
  for (size_t f = 0; f < part.abc.size(); f += 3) {
    const uint32_t* v = &part.abc[f];
    if (part.held[v[0]] != 1 || part.held[v[1]] != 1 || part.held[v[2]] != 1) continue;
    faces.insert(turned({v[0], v[1], v[2]}));
  }
  return faces;
}

// Each held vertex is there once, where it was, and so are the faces between them.
void check_held(const Part& part, const Result& result) {
  std::vector<int> seen(part.held.size(), 0);
  for (size_t v = 0; v < result.source.size(); ++v) {
    const int64_t from = result.source[v];
    if (from < 0) continue;
    const auto i = static_cast<size_t>(from);
    ++seen[i];
    CHECK(part.held[i] == 1);
    for (size_t a = 0; a < 3; ++a) CHECK(result.xyz[3 * v + a] == part.xyz[3 * i + a]);
  }
  std::vector<uint8_t> used(part.held.size(), 0);
  for (const uint32_t v : part.abc) used[v] = 1;
  for (size_t v = 0; v < seen.size(); ++v) CHECK(seen[v] == (used[v] != 0 && part.held[v] == 1));
  std::set<Face> faces;
  for (size_t f = 0; f < result.abc.size(); f += 3) {
    const Face ids{result.source[result.abc[f]], result.source[result.abc[f + 1]],
                   result.source[result.abc[f + 2]]};
    if (*std::min_element(ids.begin(), ids.end()) >= 0) faces.insert(turned(ids));
  }
  CHECK(faces == held_faces(part));
}

plc_check checked(plc_context* context, const std::vector<double>& xyz,
                  const std::vector<uint32_t>& abc) {
  plc_check check;
  plc_check_defaults(&check);
  REQUIRE(plc_check_mesh(context, xyz.data(), static_cast<int64_t>(xyz.size() / 3), abc.data(),
                         static_cast<int64_t>(abc.size() / 3), &check) == PLC_OK);
  return check;
}

// How far vertices lie from the iso-surface of the large ball, beyond x.
double mean_distance(const Result& result, double beyond) {
  double sum = 0;
  size_t count = 0;
  for (size_t v = 0; v < result.source.size(); ++v) {
    if (result.source[v] != PLC_PATCH_FREE || result.xyz[3 * v] < beyond) continue;
    const double x = result.xyz[3 * v] - 23.5, y = result.xyz[3 * v + 1] - 21.5,
                 z = result.xyz[3 * v + 2] - 22.5;
    const double wave = std::sin(x * 0.7) * std::sin(y * 0.6);
    sum += std::abs(15 + wave - samples::norm(x + 2, y, z));
    ++count;
  }
  REQUIRE(count > 100);
  return sum / static_cast<double>(count);
}

std::string refusal(const Scene& scene, const plc_parameters& p, const plc_extras& extras,
                    plc_status expected) {
  const Context context = samples::make_context();
  plc_surface* surface = nullptr;
  CHECK(plc_extract(context.get(), &scene.image, &p, &extras, &surface) == expected);
  CHECK(surface == nullptr);
  return plc_context_message(context.get());
}

}  // namespace

TEST_CASE("half of a surface is held, the other half gets as fine as its level",
          "[pellicle_patch]") {
  const Scene scene;
  Part part = coarse(scene);
  hold_below(part, 22);
  const Context context = samples::make_context();
  const Result result = evolved(context.get(), scene, part);
  CHECK(result.converged == 1);
  check_held(part, result);
  CHECK(checked(context.get(), result.xyz, result.abc).valid == 1);
  // To the area of one coarse vertex there are 2.5 fine ones.
  const auto held = std::count(part.held.begin(), part.held.end(), uint8_t{1});
  CHECK(static_cast<double>(result.source.size()) > 2.2 * static_cast<double>(held));
  CHECK(mean_distance(result, 26) < 0.1);
}

TEST_CASE("a part that is of the level above is refined, what is held is not", "[pellicle_patch]") {
  const Scene scene;
  Part part = coarse(scene);
  hold_below(part, 22);
  for (uint8_t& held : part.held) held = held != 0 ? 1 : 2;
  const Context context = samples::make_context();
  const Result result = evolved(context.get(), scene, part);
  CHECK(result.converged == 1);
  check_held(part, result);
  CHECK(checked(context.get(), result.xyz, result.abc).valid == 1);
  CHECK(mean_distance(result, 26) < 0.1);
  part.held[3] = 3;
  plc_parameters p = scene.parameters;
  p.init = PLC_INIT_MESH;
  CHECK_THAT(refusal(scene, p, part.extras(), PLC_INVALID_ARGUMENT),
             Contains("mesh_held: is 3 of vertex 3"));
}

TEST_CASE("an open patch evolves as if the rest of the surface were there", "[pellicle_patch]") {
  const Scene scene;
  Part part = coarse(scene);
  hold_below(part, 24);
  const Part whole = part;
  const std::vector<uint32_t> gone = cut_below(part, 18);
  const Context context = samples::make_context();
  CHECK(checked(context.get(), part.xyz, part.abc).border_edges > 10);
  const Result result = evolved(context.get(), scene, part);
  check_held(part, result);
  CHECK(std::count(result.source.begin(), result.source.end(), PLC_PATCH_ABSENT) == 1);
  // With what was cut off it is a valid surface again.
  std::map<int64_t, uint32_t> id;
  std::vector<double> xyz = result.xyz;
  std::vector<uint32_t> abc = result.abc;
  for (size_t v = 0; v < result.source.size(); ++v) {
    if (result.source[v] >= 0) id[result.source[v]] = static_cast<uint32_t>(v);
  }
  for (const uint32_t v : gone) {
    if (id.count(v) == 0) {
      id[v] = static_cast<uint32_t>(xyz.size() / 3);
      xyz.insert(xyz.end(), &whole.xyz[3 * size_t{v}], &whole.xyz[3 * size_t{v}] + 3);
    }
    abc.push_back(id[v]);
  }
  const plc_check check = checked(context.get(), xyz, abc);
  CHECK(check.valid == 1);
  CHECK(check.measures.genus == 0);
  // The same places as those of the whole surface with the same held: nothing that is cut off is
  // near what moves.
  const Result beside = evolved(context.get(), scene, whole);
  std::set<std::array<double, 3>> free[2];
  for (size_t i = 0; i < 2; ++i) {
    const Result& r = i == 0 ? result : beside;
    for (size_t v = 0; v < r.source.size(); ++v) {
      if (r.source[v] == PLC_PATCH_FREE) {
        free[i].insert({r.xyz[3 * v], r.xyz[3 * v + 1], r.xyz[3 * v + 2]});
      }
    }
  }
  const double ratio = static_cast<double>(free[0].size()) / static_cast<double>(free[1].size());
  CHECK(ratio > 0.98);
  CHECK(ratio < 1.02);
}

TEST_CASE("vertices stay in their room", "[pellicle_patch]") {
  const Scene scene;
  Part part = coarse(scene);
  // Blown up: without a room all of it would come back.
  for (size_t i = 0; i < part.xyz.size(); ++i) {
    const double middle[3] = {21.5, 21.5, 22.5};
    part.xyz[i] = static_cast<float>(middle[i % 3] + 1.2 * (part.xyz[i] - middle[i % 3]));
  }
  hold_below(part, 10);
  part.low = {10, -100, -100};
  part.high = {100, 100, 100};
  const Context context = samples::make_context();
  const Result result = evolved(context.get(), scene, part);
  check_held(part, result);
  // What is made on an edge of a held vertex may begin outside.
  for (size_t v = 0; v < result.source.size(); ++v) {
    if (result.source[v] == PLC_PATCH_FREE) CHECK(result.xyz[3 * v] >= 8.3);
  }
  CHECK(checked(context.get(), result.xyz, result.abc).valid == 1);
}

TEST_CASE("late bubbles of a patch start in its room alone", "[pellicle_patch]") {
  Scene scene;
  Part part = coarse(scene);
  scene.parameters.late_bubbles = 1;
  const Context context = samples::make_context();
  hold_below(part, 24);
  const auto components = [&](const Result& r) {
    return checked(context.get(), r.xyz, r.abc).measures.components;
  };
  CHECK(components(evolved(context.get(), scene, part)) == 2);
  Part open = part;
  cut_below(open, 18);
  CHECK(components(evolved(context.get(), scene, open)) == 2);
  // The small ball lies about (42, 21.5, 22.5).
  open.high[0] = 37;
  for (size_t v = 0; v < open.held.size(); ++v) {
    if (open.xyz[3 * v] > 37) open.held[v] = 1;
  }
  CHECK(components(evolved(context.get(), scene, open)) == 1);
}

TEST_CASE("a room without a face gets what is in it, on either side", "[pellicle_patch]") {
  Scene scene;
  scene.parameters.late_bubbles = 1;
  const Context context = samples::make_context();
  Part nothing;
  nothing.held.assign(1, 0);
  const auto volume = [&](std::array<double, 3> low, std::array<double, 3> high, int inside) {
    nothing.low = low;
    nothing.high = high;
    plc_parameters p = scene.parameters;
    p.init = PLC_INIT_MESH;
    plc_extras extras = nothing.extras();
    extras.mesh_vertex_count = 0;
    extras.room_inside = inside;
    const Surface surface = samples::extract(context.get(), scene.image, p, &extras);
    if (plc_surface_face_count(surface.get()) == 0) return 0.0;
    const plc_check check =
        checked(context.get(), samples::positions_f64(surface.get(), PLC_SPACE_VOXEL),
                samples::faces(surface.get(), PLC_SPACE_VOXEL));
    CHECK(check.self_intersections == 0);
    CHECK(check.closed == 1);
    return check.measures.volume;
  };
  // The small ball, outside; a corner without anything.
  const double small = volume({36.5, 14, 15}, {47, 29, 30}, 0);
  CHECK(small == Approx(4.0 / 3 * 3.14159 * 3.4 * 3.4 * 3.4).epsilon(0.1));
  CHECK(volume({0, 0, 0}, {6, 6, 6}, 0) == 0);
  // Within the large ball nothing is missed; where all was taken for inside the corner is a cavity.
  CHECK(volume({16, 16, 16}, {26, 26, 26}, 1) == 0);
  CHECK(volume({0, 0, 0}, {8, 8, 8}, 1) < -200);
}

TEST_CASE("a patch is the same bits for any threads and SIMD target", "[pellicle_patch]") {
  Scene scene;
  Part part = coarse(scene);
  scene.parameters.late_bubbles = 1;
  hold_below(part, 22);
  cut_below(part, 17);
  const uint64_t hash = evolved(samples::make_context().get(), scene, part).hash;
  CHECK(evolved(samples::make_context(4).get(), scene, part).hash == hash);
  CHECK(evolved(samples::make_context(1, PLC_SIMD_SCALAR).get(), scene, part).hash == hash);
}

TEST_CASE("patches that cannot be are refused by name", "[pellicle_patch]") {
  const Scene scene;
  Part part = coarse(scene);
  plc_parameters p = scene.parameters;
  p.init = PLC_INIT_MESH;
  cut_below(part, 18);
  part.held.assign(part.held.size(), 1);
  hold_below(part, 18.5);
  CHECK_THAT(refusal(scene, p, part.extras(), PLC_INVALID_DATA),
             Contains("is not held, but next to the border"));
  hold_below(part, 24);
  plc_extras extras = part.extras();
  p.init = PLC_INIT_BUBBLE;
  CHECK_THAT(refusal(scene, p, extras, PLC_INVALID_ARGUMENT), Contains("mesh_held"));
  p.init = PLC_INIT_MESH;
  extras.room_low[1] = 50;
  extras.room_high[1] = 40;
  CHECK_THAT(refusal(scene, p, extras, PLC_INVALID_ARGUMENT), Contains("room: from 50 to 40"));
  extras = part.extras();
  extras.mesh_held = nullptr;
  CHECK_THAT(refusal(scene, p, extras, PLC_INVALID_DATA), Contains("open"));
  // A border that touches itself.
  Part pinched;
  pinched.xyz = {20, 20, 20, 22, 20, 20, 20, 22, 20, 18, 20, 22, 20, 18, 22};
  pinched.abc = {0, 1, 2, 0, 3, 4};
  pinched.held.assign(5, 1);
  CHECK_THAT(refusal(scene, p, pinched.extras(), PLC_INVALID_DATA), Contains("sheets touch"));
}

TEST_CASE("a run of a patch is neither saved nor restored", "[pellicle_patch]") {
  const Scene scene;
  Part part = coarse(scene);
  hold_below(part, 22);
  plc_parameters p = scene.parameters;
  p.init = PLC_INIT_MESH;
  const Context context = samples::make_context();
  plc_volume* volume = nullptr;
  REQUIRE(plc_volume_create(context.get(), &scene.image, PLC_BORROW, &volume) == PLC_OK);
  plc_pyramid* pyramid = nullptr;
  REQUIRE(plc_pyramid_create(context.get(), volume, &p, &pyramid) == PLC_OK);
  const plc_extras extras = part.extras();
  plc_run* run = nullptr;
  REQUIRE(plc_run_create(context.get(), pyramid, &p, &extras, &run) == PLC_OK);
  size_t size = 0;
  CHECK(plc_run_save(context.get(), run, nullptr, 0, &size) == PLC_INVALID_ARGUMENT);
  CHECK_THAT(plc_context_message(context.get()), Contains("patch"));
  const std::array<char, 64> bytes{};
  plc_run* restored = nullptr;
  CHECK(plc_run_restore(context.get(), pyramid, &p, &extras, bytes.data(), bytes.size(),
                        &restored) == PLC_INVALID_ARGUMENT);
  CHECK(restored == nullptr);
  plc_run_destroy(run);
  plc_pyramid_destroy(pyramid);
  plc_volume_destroy(volume);
}

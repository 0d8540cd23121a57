// Adaptive meshes: finer than the voxels where the image asks for it, coarser where it does not.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "engine/base/mesh_arrays.h"
#include "engine/base/state_io.h"
#include "engine/guard/self_meeting.h"
#include "engine/measure/measures.h"
#include "engine/mesh/mesh_invariants.h"
#include "engine/mesh/state_hash.h"
#include "tests/samples/sample_runs.h"
#include "tests/samples/sample_woken.h"

namespace {

using plc::Mesh;
using samples::Run;

struct Result {
  Mesh mesh;
  std::vector<plc::LevelRecord> records;
  plc::SurfaceMeasures measures;
};

Result recovered(Run run, const plc::SizeSpec& sizes = {}, const plc::RecoveryHooks& hooks = {}) {
  run.recovery.sizes = sizes;
  Result r;
  const plc::Schedule schedule(2);
  REQUIRE(plc::pyramidal_recover_shape(samples::pyramid_of(run), run.recovery, schedule, hooks,
                                       r.mesh, r.records)
              .message() == "");
  CHECK(plc::broken_invariant(r.mesh) == "");
  CHECK(plc::meeting_faces(r.mesh, schedule).empty());
  for (const auto& record : r.records) CHECK((record.converged || record.vertices == 0));
  plc::Vector<float> xyz;
  for (uint32_t v = 0; v < r.mesh.slots(); ++v) {
    const plc::Vec3 p = r.mesh.at(v);
    xyz.insert(xyz.end(), {p.x, p.y, p.z});
  }
  r.measures = plc::surface_measures(plc::arrays_of(xyz, r.mesh.faces()), schedule);
  return r;
}

template <typename Distance>
Run run_of(const char* name, const std::array<int64_t, 3>& dims, const Distance& distance) {
  samples::Volume volume = samples::empty_volume(dims);
  volume.values.clear();
  for (int64_t z = 0; z < dims[2]; ++z) {
    for (int64_t y = 0; y < dims[1]; ++y) {
      for (int64_t x = 0; x < dims[0]; ++x) {
        const double d =
            distance(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
        volume.values.push_back(static_cast<float>(std::clamp(0.5 + 0.5 * d, 0.0, 1.0)));
      }
    }
  }
  Run run = samples::make_run(name, std::move(volume), 0.5, 2);
  // Thin parts fade on coarse levels.
  run.recovery.isos = {0.5, 0.3, 0.3};
  run.recovery.model.time_step = 1.5F;
  return run;
}

// An edge of length 28 voxels, edges rounded.
Run cube() {
  return run_of("cube", {44, 44, 44}, [](double x, double y, double z) {
    const auto out = [](double c) { return std::max(std::abs(c - 21.5) - 12, 0.0); };
    return 2 - std::sqrt(out(x) * out(x) + out(y) * out(y) + out(z) * out(z));
  });
}

Run rod(double radius) {
  return run_of("rod", {24, 24, 64}, [radius](double x, double y, double z) {
    const double along = std::max(std::abs(z - 31.5) - 24, 0.0);
    const double across = std::hypot(x - 11.3, y - 11.6);
    return radius - std::hypot(across, along);
  });
}

// Tilted.
Run plate(double half) {
  return run_of("plate", {48, 48, 48}, [half](double x, double y, double z) {
    const double a = x - 23.5, b = y - 23.5, c = z - 23.5;
    const double off = (a + 0.4 * b + 0.2 * c) / std::sqrt(1.2);
    const double within = std::sqrt(std::max(a * a + b * b + c * c - off * off, 0.0));
    return std::min(half - std::abs(off), 16 - within);
  });
}

// Sheets thinner than a voxel, most of them too thin to be held.
Run sheets() {
  return run_of("sheets", {48, 48, 48}, [](double x, double y, double z) {
    const double waves = std::cos(0.31 * x + 0.17 * y + 0.5) + std::cos(0.29 * y - 0.21 * z + 1.3) +
                         std::cos(0.33 * z + 0.13 * x - 0.7);
    return std::min(0.35 - 1.5 * std::abs(waves), 18 - std::hypot(x - 23.5, y - 23.5, z - 23.5));
  });
}

// A cube of 7 voxels, a voxel with hardly anything around its centre that touches it by an edge,
// and by another edge a box of 3 x 3 x `height`.
Run crumb(int height) {
  return run_of("crumb", {20, 20, 20}, [height](double x, double y, double z) {
    const auto within = [](double c, int low, int high) { return low <= c && c <= high; };
    const bool cube = within(x, 4, 10) && within(y, 4, 10) && within(z, 4, 10);
    const bool box = within(x, 12, 14) && within(y, 12, 14) && within(z, 10, 9 + height);
    const bool neck = x == 11 && y == 11 && z == 10;
    return cube || box ? 1.0 : neck ? 0.55 : -1.0;
  });
}

Run direct(Run run) {
  run.pyramid.levels = 0;
  run.recovery.isos = {0.5};
  run.recovery.start.init = plc::Init::kIso;
  return run;
}

}  // namespace

TEST_CASE("flat parts take a quarter of the vertices that the finest size takes everywhere",
          "[adaptive]") {
  plc::SizeSpec everywhere;
  everywhere.coarsest = everywhere.finest;
  const Result finest = recovered(cube(), everywhere), adaptive = recovered(cube());
  CAPTURE(finest.mesh.vertex_count(), adaptive.mesh.vertex_count());
  CHECK(4 * adaptive.mesh.vertex_count() < finest.mesh.vertex_count());
  CHECK(adaptive.measures.volume == Approx(finest.measures.volume).epsilon(0.01));
}

TEST_CASE("a steep image is met where it crosses iso, not where it does once clipped",
          "[adaptive]") {
  constexpr double kRadius = 12.3;
  const auto radius_at = [](double x, double y, double z) {
    return std::sqrt((x - 21.4) * (x - 21.4) + (y - 21.6) * (y - 21.6) + (z - 21.3) * (z - 21.3));
  };
  Run run = run_of("ball", {44, 44, 44}, [](double, double, double) { return 0.0; });
  float* value = run.volume.values.data();
  for (int z = 0; z < 44; ++z) {
    for (int y = 0; y < 44; ++y) {
      for (int x = 0; x < 44; ++x) {
        *value++ = static_cast<float>(0.5 + 2 * (kRadius - radius_at(x, y, z)));
      }
    }
  }
  const Result r = recovered(std::move(run));
  double squared = 0;
  for (uint32_t v = 0; v < r.mesh.slots(); ++v) {
    const plc::Vec3 p = r.mesh.at(v);
    const double off =
        radius_at(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)) -
        kRadius;
    squared += off * off / r.mesh.vertex_count();
  }
  CHECK(squared < 0.05 * 0.05);
}

TEST_CASE("a rod of two voxels, which a uniform mesh loses, is there whole", "[adaptive]") {
  const Result r = recovered(rod(1.1));
  CHECK(r.measures.components == 1);
  CHECK(r.measures.genus == 0);
  // A cylinder of radius 1.1 and 48 voxels, two half balls.
  constexpr double kPi = 3.14159265358979;
  CHECK(r.measures.volume == Approx(kPi * 1.21 * 48 + 4.0 / 3 * kPi * 1.331).epsilon(0.2));
}

TEST_CASE("a plate of a voxel and a half stays whole", "[adaptive]") {
  const Result r = recovered(plate(0.75));
  CHECK(r.measures.components == 1);
  CHECK(r.measures.genus == 0);
  CHECK(r.measures.volume == Approx(3.14159 * 256 * 1.5).epsilon(0.15));
}

TEST_CASE("a start from the iso-surface has the sizes of its level", "[adaptive]") {
  int iterations = 0;
  std::vector<int> searched;  // after so many iterations
  plc::RecoveryHooks hooks;
  hooks.pass = [&](const std::string& pass, uint32_t, const plc::Evolution&) {
    iterations += pass == "resolution" ? 1 : 0;
    if (pass == "late bubbles") searched.push_back(iterations);
  };
  const Result r = recovered(direct(plate(0.65)), {}, hooks);
  // For the first time when it is near rest, and again when it has come to it.
  REQUIRE(searched.size() > 1);
  CHECK(searched[0] >= plc::kEarlySearch);
  CHECK(searched[0] < 10);
  CHECK(searched[1] > searched[0] + 3);
  CHECK(r.measures.components == 1);
  CHECK(r.measures.genus == 0);
  CHECK(r.measures.volume == Approx(3.14159 * 256 * 1.3).epsilon(0.1));
}

TEST_CASE("a search wakes what it has changed, and of a surface at rest nothing else moves",
          "[adaptive]") {
  Run run = direct(plate(0.65));
  run.recovery.sizes.emplace();
  Mesh mesh;
  std::vector<plc::LevelRecord> records;
  std::optional<samples::Woken> woken;
  std::vector<double> changed, awake;  // after each search, in vertices
  plc::RecoveryHooks hooks;
  hooks.pass = [&](const std::string& pass, uint32_t, const plc::Evolution& evolution) {
    if (pass == "late bubbles") woken.emplace(mesh);
    if (pass == "ids" && woken) {
      uint32_t count = 0;
      for (uint32_t v = 0; v < mesh.slots(); ++v) count += (*woken)[v] ? 1 : 0;
      changed.push_back(static_cast<double>(count) / mesh.slots());
      woken.reset();
    }
    if (pass == "resolution" && awake.size() < changed.size()) {
      awake.push_back(static_cast<double>(evolution.awake()) / mesh.padded());
    }
  };
  const plc::Schedule schedule(2);
  REQUIRE(plc::pyramidal_recover_shape(samples::pyramid_of(run), run.recovery, schedule, hooks,
                                       mesh, records)
              .ok());
  REQUIRE(changed.size() == 2);
  CAPTURE(changed, awake);
  for (const double share : changed) {
    CHECK(share > 0);
    CHECK(share < 0.5);
  }
  CHECK(awake[0] > 0.8);
  CHECK(awake[1] < 0.5);
}

TEST_CASE("where nothing of the iso-surface conforms bubbles start in what it is of",
          "[adaptive]") {
  plc::SizeSpec sizes;
  sizes.finest = 0.7;  // with finer ones much of it does
  const Result r = recovered(direct(plate(0.25)), sizes);
  CHECK(r.records[0].late.bubbles > 0);
  CHECK(r.measures.volume > 10);
}

TEST_CASE(
    "a surface from the iso-surface is at rest when only what draws back from thin parts moves",
    "[adaptive]") {
  const Result r = recovered(direct(sheets()));
  CHECK(r.records[0].iterations < 400);  // 141; 1175 where a vertex counts all its energy
}

TEST_CASE("a crumb that the image joins to the object by edges is not left behind", "[adaptive]") {
  for (const auto init : {plc::Init::kBubble, plc::Init::kIso}) {
    for (const int height : {2, 3}) {
      Run run = direct(crumb(height));
      run.recovery.start.init = init;
      CAPTURE(height);
      CHECK(recovered(run).measures.components == height - 1);  // 3: 27 voxels
    }
  }
}

TEST_CASE("an adaptive run that is saved and restored goes on with the same bits", "[adaptive]") {
  Run run = cube();
  run.recovery.sizes.emplace();
  const plc::Schedule schedule(2);
  std::vector<plc::LevelRecord> records, records_again;
  Mesh mesh, again;
  plc::Recovery whole(samples::pyramid_of(run), run.recovery, schedule, {}, mesh, records);
  REQUIRE(whole.start().message() == "");
  for (int i = 0; i < 45; ++i) REQUIRE(whole.advance(plc::Amount::kIteration).message() == "");
  plc::StateWriter size;
  whole.save(size);
  std::vector<uint8_t> bytes(size.size());
  plc::StateWriter writer(bytes.data());
  whole.save(writer);
  plc::Recovery restored(samples::pyramid_of(run), run.recovery, schedule, {}, again,
                         records_again);
  plc::StateReader reader(bytes.data(), bytes.size());
  REQUIRE(restored.restore(reader).ok());
  REQUIRE(whole.advance(plc::Amount::kAll).message() == "");
  REQUIRE(restored.advance(plc::Amount::kAll).message() == "");
  CHECK(plc::state_hash(mesh) == plc::state_hash(again));
}

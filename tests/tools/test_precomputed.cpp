#include "tools/blocks/precomputed.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "tests/tools/block_samples.h"
#include "tests/tools/precomputed_reader.h"
#include "tests/tools/tool_fixtures.h"

namespace {

using namespace samples;
using plc::tools::PrecomputedRecord;

}  // namespace

TEST_CASE("Meshes for neuroglancer are the surface, cut into chunks that fit together",
          "[precomputed]") {
  // Boxes of 64 voxels with one more level of detail, some of which end where cells do; of 130,
  // with two, and chunks of 32.5 voxels.
  const auto [side, margin] = GENERATE(table<int64_t, int64_t>({{64, 4}, {130, 30}}));
  constexpr size_t lods = 4;
  const fixtures::Folder folder;
  const BlockMesh mesh = surface();
  const BlockPlan plan = plan_with(side, margin);
  write_blocks(folder / "d", plan, mesh);
  const PrecomputedRecord record =
      plc::tools::write_precomputed(folder / "d", plan, {folder / "n", 0, 7, {}});
  const Meshes meshes = read_meshes(folder / "n", "7");
  check_tree(meshes);
  REQUIRE(meshes.lods.size() == lods);
  REQUIRE(record.lods.size() == lods);
  CHECK(meshes.chunk == Place{record.lods[0].chunk, record.lods[0].chunk, record.lods[0].chunk});

  const std::vector<Triangle> before = triangles_of(mesh), after = meshes.triangles(0);
  const double step = meshes.chunk[0] / kLargest;
  CHECK(after.size() > before.size());
  CHECK(after.size() < 3 * before.size() / 2);
  CHECK(std::abs(volume_of(after) - volume_of(before)) < step * area_of(before));
  CHECK(std::abs(area_of(after) - area_of(before)) < 1e-4 * area_of(before));

  for (size_t l = 0; l < lods; ++l) {
    INFO("level of detail " << l);
    CHECK(meshes.lods[l].face_count() == static_cast<size_t>(record.lods[l].faces));
    CHECK(open_edges(meshes.lods[l]) == 0);
    if (l == 0) continue;
    CHECK(3 * meshes.lods[l].face_count() < 2 * meshes.lods[l - 1].face_count());
    CHECK(meshes.lods[l].scale == record.lods[l].cluster);
    double farthest = 0;
    for (const Triangle& t : meshes.triangles(l)) {
      for (const Place& corner : t) farthest = std::max(farthest, distance_of(corner));
    }
    CHECK(farthest < std::sqrt(3.0) * record.lods[l].cluster + 0.5);
    CHECK(std::abs(volume_of(meshes.triangles(l)) - volume_of(before)) <
          record.lods[l].cluster * area_of(before));
    CHECK(uncovered(meshes.lods[l], meshes.lods[l - 1]) == 0);
  }
}

TEST_CASE("What vanishes with distance, or comes to be beside what is there, leaves no hole",
          "[precomputed]") {
  const fixtures::Folder folder;
  std::mt19937 random(5);
  BlockMesh mesh;
  add_crumbs(mesh, {100, {60, 60, 60}, {128, 128, 128}}, false, random);
  // Around an edge of a chunk that has none. Most are where they draw clusters beside the edge
  // away from it, so that faces between these go through the chunk.
  add_crumbs(mesh, {2000, {22, 22, 28}, {30, 30, 56}}, true, random);
  add_crumbs(mesh, {4000, {25.5, 27, 28}, {25.8, 27.8, 56}, 0.2}, true, random);
  add_crumbs(mesh, {4000, {27, 25.5, 28}, {27.8, 25.8, 56}, 0.2}, true, random);
  const BlockPlan plan = plan_with(64, 6);
  write_blocks(folder / "d", plan, mesh);
  plc::tools::write_precomputed(folder / "d", plan, {folder / "n", 0, 1, {}});
  const Meshes meshes = read_meshes(folder / "n", "1");
  check_tree(meshes);
  size_t empty = 0;
  for (size_t l = 0; l < meshes.lods.size(); ++l) {
    CHECK(open_edges(meshes.lods[l]) == 0);
    if (l > 0) CHECK(uncovered(meshes.lods[l], meshes.lods[l - 1]) == 0);
    for (const Fragment& f : meshes.lods[l].fragments) empty += f.size == 0 ? 1 : 0;
  }
  CHECK(empty > 0);
}

TEST_CASE("Faces that are cut share the points of their edges to the bit", "[precomputed]") {
  std::mt19937 random(3);
  BlockMesh mesh;
  add_crumbs(mesh, {2000, {0, 0, 0}, {128, 128, 128}}, false, random);
  plc::tools::FaceCutter cutter(-6, 0.75);
  std::map<std::pair<Place, Place>, int> net;
  size_t count = 0, outside = 0;
  double area = 0;
  for (const Triangle& face : triangles_of(mesh)) {
    for (const auto& [corners, cube] : cutter.cut(face)) {
      ++count;
      area += area_of({corners});
      for (size_t k = 0; k < 3; ++k) {
        const Place &from = corners[k], &to = corners[(k + 1) % 3];
        for (size_t a = 0; a < 3; ++a) {
          const bool within =
              from[a] >= cutter.plane(cube[a]) && from[a] <= cutter.plane(cube[a] + 1);
          outside += within ? 0 : 1;
        }
        if (from != to) net[std::minmax(from, to)] += from < to ? 1 : -1;
      }
    }
  }
  CHECK(count > 10 * mesh.face_count());
  CHECK(outside == 0);
  CHECK(std::all_of(net.begin(), net.end(), [](const auto& e) { return e.second == 0; }));
  CHECK(area == Approx(area_of(triangles_of(mesh))).epsilon(1e-9));
}

TEST_CASE("Meshes for neuroglancer have the same bytes each time", "[precomputed]") {
  const fixtures::Folder folder;
  const BlockPlan plan = plan_with(64, 6);
  write_blocks(folder / "d", plan, surface());
  size_t boxes = 0, told = 0;
  const auto count = [&](size_t done, size_t all) {
    boxes = all, told += done == told + 1 ? 1 : 0;
  };
  plc::tools::write_precomputed(folder / "d", plan, {folder / "a", 0, 1, count});
  CHECK(boxes == 27);
  CHECK(told == boxes);
  plc::tools::write_precomputed(folder / "d", plan, {folder / "b", 0, 1, {}});
  plc::tools::write_precomputed(folder / "d", plan, {folder / "b", 0, 18446744073709551615U, {}});
  plc::tools::write_precomputed(folder / "d", plan, {folder / "b", 0, 1, {}});
  for (const std::string name : {"/1", "/1.index", "/info"}) {
    CHECK(fixtures::contents(folder / "a" + name) == fixtures::contents(folder / "b" + name));
  }
  CHECK(fixtures::contents(folder / "a/1") ==
        fixtures::contents(folder / "b/18446744073709551615"));
  size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder / "b")) {
    ++files;
  }
  CHECK(files == 5);  // nothing else is left
}

TEST_CASE("Fewer levels of detail are the first of all", "[precomputed]") {
  const fixtures::Folder folder;
  const BlockPlan plan = plan_with(64, 6);
  write_blocks(folder / "d", plan, surface());
  plc::tools::write_precomputed(folder / "d", plan, {folder / "all", 0, 1, {}});
  const Meshes all = read_meshes(folder / "all", "1");
  const std::string bytes = fixtures::contents(folder / "all/1");
  for (const int lods : {1, 2, 3}) {
    plc::tools::write_precomputed(folder / "d", plan, {folder / "some", lods, 1, {}});
    const Meshes some = read_meshes(folder / "some", "1");
    check_tree(some);
    CHECK(some.lods.size() == static_cast<size_t>(lods));
    const std::string fewer = fixtures::contents(folder / "some/1");
    CHECK(fewer.size() < bytes.size());
    CHECK(bytes.compare(0, fewer.size(), fewer) == 0);
  }
  CHECK(fixtures::failure_of([&] {
          plc::tools::write_precomputed(folder / "d", plan, {folder / "x", 5, 1, {}});
        }) == "--lods 5: at most 4, which end with a single chunk");
}

TEST_CASE("The transform goes to nanometres of LPS, and faces stay outward in mirrored images",
          "[precomputed]") {
  const fixtures::Folder folder;
  BlockPlan plan = plan_with(64, 6);
  plan.image.spacing[0] = 0.5;
  plan.image.direction[0] = -1;
  plan.image.origin[0] = 100;
  plan.image.origin[2] = -0.25;
  const BlockMesh mesh = surface();
  write_blocks(folder / "d", plan, mesh);
  plc::tools::write_precomputed(folder / "d", plan, {folder / "n", 0, 1, {}});
  const auto info = nlohmann::json::parse(fixtures::contents(folder / "n/info"));
  CHECK(info["@type"] == "neuroglancer_multilod_draco");
  CHECK(info["vertex_quantization_bits"] == 16);
  CHECK(info["lod_scale_multiplier"] == 1);
  CHECK(info["transform"] ==
        nlohmann::json::array({-5e5, 0, 0, 1e8, 0, 1e6, 0, 0, 0, 0, 1e6, -2.5e5}));
  const Meshes meshes = read_meshes(folder / "n", "1");
  for (size_t l = 0; l < meshes.lods.size(); ++l) {
    CHECK(open_edges(meshes.lods[l]) == 0);
    // In voxels they are inward.
    CHECK(volume_of(meshes.triangles(l)) < -0.5 * volume_of(triangles_of(mesh)));
  }
}

TEST_CASE("Meshes for neuroglancer that cannot be written are told in a line", "[precomputed]") {
  const fixtures::Folder folder;
  const BlockPlan plan = plan_with(64, 6);
  const auto failure = [&](const std::string& from) {
    return fixtures::failure_of([&] {
      plc::tools::write_precomputed(folder / from, plan, {folder / "n", 0, 1, {}});
    });
  };
  CHECK(failure("none").find("is not there yet") != std::string::npos);
  write_blocks(folder / "empty", plan, {});
  CHECK(failure("empty") == folder / "empty: holds no surface");
  BlockMesh wide = surface();
  wide.xyz[0] += 4;
  write_blocks(folder / "wide", plan, wide);
  CHECK(failure("wide").find("a face leaves its cell by more than") != std::string::npos);
  CHECK(std::filesystem::is_empty(folder / "n"));  // nothing is left
  write_blocks(folder / "d", plan, surface());
  CHECK(failure("d").empty());
  std::ofstream(folder / "n/info") << "{}";
  CHECK(failure("d") ==
        folder / "n/info: is that of another image's meshes; choose another folder");
}

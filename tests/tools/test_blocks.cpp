// What a large surface is kept in: a grid of blocks and cells, and their files.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/samples/sample_meshes.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/blocks/block_file.h"
#include "tools/blocks/block_grid.h"
#include "tools/blocks/block_patch.h"
#include "tools/blocks/block_sides.h"

namespace {

using fixtures::failure_of;
using plc::tools::BlockCell;
using plc::tools::BlockGrid;
using plc::tools::BlockMesh;
using plc::tools::Int3;
using plc::tools::Star;

std::vector<Int3> all_cells(const BlockGrid& grid) {
  const Int3& n = grid.blocks();
  return grid.cells_of({{0, 0, 0}, {3 * n[0] - 1, 3 * n[1] - 1, 3 * n[2] - 1}});
}

BlockMesh mesh_of(const samples::Soup& soup) {
  BlockMesh mesh;
  for (size_t v = 0; v < soup.vertex_count(); ++v) mesh.ids.push_back(10 * v + 7);
  mesh.xyz = soup.xyz;
  mesh.abc.assign(soup.abc.begin(), soup.abc.end());
  return mesh;
}

}  // namespace

TEST_CASE("every place is in one cell, and every cell in the windows around it", "[blocks]") {
  const BlockGrid grid({100, 70, 31}, 30, 8);
  CHECK(grid.blocks() == Int3{3, 2, 1});
  for (double z = -3; z < 35; z += 1.5) {
    for (double y = -3; y < 75; y += 1.5) {
      for (double x = -3; x < 105; x += 1.5) {
        const Int3 cell = grid.cell_of({x, y, z});
        const Int3 block = BlockGrid::block_of_cell(cell);
        REQUIRE(grid.block_at(grid.index_of(block)) == block);
        for (int64_t i = 0; i < grid.block_count(); ++i) {
          const BlockGrid::Window window = grid.window_of(grid.block_at(i));
          std::array<double, 3> low{}, high{};
          grid.bounds_of(window, low, high);
          bool within = true;
          const std::array<double, 3> at{x, y, z};
          for (size_t a = 0; a < 3; ++a) within = within && at[a] >= low[a] && at[a] < high[a];
          REQUIRE(within == window.contains(cell));
        }
        std::array<double, 3> low{}, high{};
        grid.bounds_of({cell, cell}, low, high);
        REQUIRE((x >= low[0] && x < high[0] && y >= low[1] && y < high[1] && z >= low[2] &&
                 z < high[2]));
      }
    }
  }
}

TEST_CASE("windows of a colour have no cell in common, and it is known who wrote one last",
          "[blocks]") {
  const BlockGrid grid({400, 230, 170}, 60, 15);
  std::map<Int3, BlockGrid::Writer> last;
  for (const Int3& cell : all_cells(grid)) last[cell] = {-1, BlockGrid::block_of_cell(cell)};
  for (int step = 0; step < 3 * BlockGrid::kColours; ++step) {
    for (const auto& [cell, writer] : last) {
      const BlockGrid::Writer found = grid.writer_of(cell, step);
      REQUIRE(found.step == writer.step);
      REQUIRE(found.block == writer.block);
    }
    std::set<Int3> written;
    for (const int64_t block : grid.blocks_of_colour(step % BlockGrid::kColours)) {
      const Int3 at = grid.block_at(block);
      for (const Int3& cell : grid.cells_of(grid.window_of(at))) {
        REQUIRE(written.insert(cell).second);
        last[cell] = {step, at};
      }
    }
  }
}

TEST_CASE("a surface is divided into cells and put together again", "[blocks]") {
  const BlockGrid grid({64, 64, 64}, 32, 8);
  samples::Soup soup = samples::sphere(4);
  for (double& x : soup.xyz) x = 32 + 25 * x;
  const BlockMesh mesh = mesh_of(soup);
  const std::map<Int3, BlockCell> cells = divided(mesh, grid, {{0, 0, 0}, {5, 5, 5}});
  CHECK(cells.size() > 50);
  const fixtures::Folder folder;
  const std::string path = folder / "cells.blk";
  write_block_file(path, cells);
  const plc::tools::BlockFile file(path);
  std::map<Int3, BlockCell> read;
  for (const Int3& at : all_cells(grid)) {
    BlockCell cell = file.read(at);
    REQUIRE(cell.abc.empty() == (cells.count(at) == 0));
    if (!cell.abc.empty()) read[at] = std::move(cell);
  }
  const BlockMesh again = joined(read, "test");
  CHECK(again.ids == mesh.ids);
  CHECK(again.xyz == mesh.xyz);
  CHECK(again.face_count() == mesh.face_count());
  const plc::tools::Stars stars = stars_of(again);
  CHECK(std::count(stars.star.begin(), stars.star.end(), Star::kWhole) ==
        static_cast<std::ptrdiff_t>(again.vertex_count()));
  // A vertex at two places.
  read.begin()->second.xyz[0] += 1;
  CHECK_THAT(failure_of([&] { joined(read, "test"); }), Catch::Contains("different places"));
}

TEST_CASE("blocks know on which side of the coarse surface they lie", "[blocks]") {
  const BlockGrid grid({100, 100, 100}, 10, 2);
  samples::Soup soup = samples::sphere(3);
  for (double& x : soup.xyz) x = 50 + 42 * x;
  samples::Soup cavity = samples::sphere(3);
  for (double& x : cavity.xyz) x = 50 + 17 * x;
  for (size_t f = 0; f < cavity.abc.size(); f += 3) std::swap(cavity.abc[f], cavity.abc[f + 1]);
  soup.append(cavity);
  const std::vector<uint32_t> abc(soup.abc.begin(), soup.abc.end());
  const std::vector<int64_t> inside = plc::tools::blocks_inside(grid, soup.xyz, abc);
  size_t sure = 0;
  for (int64_t block = 0; block < grid.block_count(); ++block) {
    const Int3 at = grid.block_at(block);
    double r = 0;
    for (size_t a = 0; a < 3; ++a) {
      const double x = 10 * static_cast<double>(at[a]) + 5 - 50;
      r += x * x;
    }
    r = std::sqrt(r);
    if (std::abs(r - 42) < 2 || std::abs(r - 17) < 2) continue;
    ++sure;
    const bool expected = r < 42 && r > 17;
    REQUIRE(std::binary_search(inside.begin(), inside.end(), block) == expected);
  }
  CHECK(sure > 700);
}

TEST_CASE("block files that are damaged are refused in a line", "[blocks]") {
  const BlockGrid grid({64, 64, 64}, 32, 8);
  samples::Soup soup = samples::sphere(2);
  for (double& x : soup.xyz) x = 32 + 25 * x;
  const fixtures::Folder folder;
  const std::string path = folder / "cells.blk";
  write_block_file(path, divided(mesh_of(soup), grid, {{0, 0, 0}, {5, 5, 5}}));
  const std::string bytes = fixtures::contents(path);
  const auto whole_reading = [&] {
    const plc::tools::BlockFile file(path);
    for (const Int3& at : all_cells(grid)) file.read(at);
  };
  CHECK(failure_of(whole_reading) == "");
  for (size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 40) {
    folder.put("cells.blk", bytes.substr(0, size));
    REQUIRE_THAT(failure_of(whole_reading), Catch::Contains("not whole"));
  }
  for (size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 300) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 4);
    folder.put("cells.blk", changed);
    REQUIRE_THAT(failure_of(whole_reading), Catch::Contains("not whole"));
  }
  std::filesystem::remove(path);
  CHECK_THAT(failure_of(whole_reading), Catch::Contains("cannot be read"));
}

TEST_CASE("what a task holds is two edges wide, and no border touches itself", "[blocks]") {
  samples::Soup soup = samples::sphere(4);
  BlockMesh mesh = mesh_of(soup);
  // Half of the sphere, and a face more that touches the rest in one vertex.
  std::vector<uint32_t> left;
  const auto z = [&](uint32_t v) { return mesh.xyz[3 * size_t{v} + 2]; };
  for (size_t f = 0; f < mesh.abc.size(); f += 3) {
    const uint32_t* v = &mesh.abc[f];
    if (std::min({z(v[0]), z(v[1]), z(v[2])}) > 0) left.insert(left.end(), v, v + 3);
  }
  std::set<uint32_t> used(left.begin(), left.end());
  size_t added = 0;
  for (size_t f = 0; f < mesh.abc.size() && added == 0; f += 3) {
    const uint32_t* v = &mesh.abc[f];
    if (used.count(v[0]) + used.count(v[1]) + used.count(v[2]) == 1) {
      left.insert(left.end(), v, v + 3);
      ++added;
    }
  }
  REQUIRE(added == 1);
  mesh.abc = left;
  const std::map<Int3, BlockCell> cells =
      divided(mesh, BlockGrid({64, 64, 64}, 32, 8), {{0, 0, 0}, {5, 5, 5}});
  const plc::tools::Patch patch =
      patch_of(joined(cells, "test"), {-2, -2, -2}, {0.5, 2, 2}, 100, "test");
  CHECK(patch.aside.size() > 1);
  CHECK(patch.free > 50);
  const plc::tools::Stars stars = stars_of(patch.mesh);
  for (size_t v = 0; v < patch.mesh.vertex_count(); ++v) {
    CHECK(stars.fans[v] == 1);
    if (stars.star[v] == Star::kBorder) CHECK(patch.held[v] == 1);
    if (patch.mesh.xyz[3 * v] > 0.5) CHECK(patch.held[v] == 1);
    if (patch.held[v] != 1) CHECK(patch.held[v] == (patch.mesh.ids[v] < 100 ? 2 : 0));
  }
  for (size_t f = 0; f < patch.mesh.face_count(); ++f) {
    const uint32_t* v = &patch.mesh.abc[3 * f];
    const bool border =
        std::any_of(v, v + 3, [&](uint32_t w) { return stars.star[w] == Star::kBorder; });
    for (size_t k = 0; k < 3 && border; ++k) CHECK(patch.held[v[k]] == 1);
  }
  // Three faces at an edge.
  BlockMesh broken = patch.mesh;
  broken.abc.insert(broken.abc.end(), {broken.abc[0], broken.abc[1], broken.abc[5]});
  CHECK_THAT(failure_of([&] {
               patch_of(broken, {-2, -2, -2}, {2, 2, 2}, 0, "here");
             }),
             Catch::Contains("here: its faces are of no closed surface"));
}

// Closed surfaces, and the folder of a run by blocks that holds one.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tools/blocks/block_task.h"
#include "tools/blocks/chunk_grid.h"
#include "tools/blocks/face_cutter.h"

namespace samples {

using plc::tools::BlockGrid;
using plc::tools::BlockMesh;
using plc::tools::BlockPlan;
using plc::tools::Int3;
using plc::tools::Place;
using plc::tools::Triangle;

// A torus, and a cuboid with sides in planes between chunks.
inline constexpr Place kMiddle{75, 70, 65};
inline constexpr double kRing = 40, kTube = 15;
inline constexpr Place kLow{26, 26, 90}, kHigh{58, 58, 122};
inline constexpr int kSteps = 16;  // of each edge of the cuboid

inline uint32_t add_vertex(BlockMesh& mesh, const Place& place) {
  mesh.ids.push_back(mesh.ids.size());
  mesh.xyz.insert(mesh.xyz.end(), place.begin(), place.end());
  return static_cast<uint32_t>(mesh.ids.size() - 1);
}

inline void add_torus(BlockMesh& mesh) {
  constexpr uint32_t kAround = 170, kAcross = 64;
  const auto start = static_cast<uint32_t>(mesh.vertex_count());
  for (uint32_t i = 0; i < kAround; ++i) {
    for (uint32_t j = 0; j < kAcross; ++j) {
      const double u = 2 * std::numbers::pi * i / kAround, v = 2 * std::numbers::pi * j / kAcross;
      const double radius = kRing + kTube * std::cos(v);
      Place place{kMiddle[0] + radius * std::cos(u), kMiddle[1] + radius * std::sin(u),
                  kMiddle[2] + kTube * std::sin(v)};
      // Some lie in planes between chunks.
      if ((i + 3 * j) % 5 == 0) {
        for (double& x : place) x = std::round(2 * x) / 2;
      }
      add_vertex(mesh, place);
    }
  }
  const auto at = [&](uint32_t i, uint32_t j) {
    return start + i % kAround * kAcross + j % kAcross;
  };
  for (uint32_t i = 0; i < kAround; ++i) {
    for (uint32_t j = 0; j < kAcross; ++j) {
      const uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      mesh.abc.insert(mesh.abc.end(), {a, b, c, a, c, d});
    }
  }
}

inline void add_cuboid(BlockMesh& mesh) {
  std::map<Int3, uint32_t> made;
  const auto vertex = [&](const Int3& at) {
    const auto [found, fresh] = made.try_emplace(at, 0);
    if (fresh) {
      Place place{};
      for (size_t a = 0; a < 3; ++a) {
        place[a] = kLow[a] + (kHigh[a] - kLow[a]) * static_cast<double>(at[a]) / kSteps;
      }
      found->second = add_vertex(mesh, place);
    }
    return found->second;
  };
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const int64_t side : {0, kSteps}) {
      for (int64_t i = 0; i < kSteps; ++i) {
        for (int64_t j = 0; j < kSteps; ++j) {
          const auto corner = [&](int64_t di, int64_t dj) {
            Int3 at{};
            at[axis] = side;
            at[(axis + 1) % 3] = i + di;
            at[(axis + 2) % 3] = j + dj;
            return vertex(at);
          };
          uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == 0) std::swap(b, d);
          mesh.abc.insert(mesh.abc.end(), {a, b, c, a, c, d});
        }
      }
    }
  }
}

inline BlockMesh surface() {
  BlockMesh mesh;
  add_torus(mesh);
  add_cuboid(mesh);
  return mesh;
}

// Tetrahedra of random corners, each closed, with their middles in a box.
struct Crumbs {
  int count;
  Place low, high;
  double size = 1.7;  // how far corners are from the middle
};

// None has some of cube 1, 1, 1 of those of 32 voxels from -6, where `free`.
inline void add_crumbs(BlockMesh& mesh, const Crumbs& crumbs, bool free, std::mt19937& random) {
  plc::tools::FaceCutter cutter(-6, 32);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < crumbs.count; ++i) {
    Place at{};
    for (size_t a = 0; a < 3; ++a) {
      at[a] = crumbs.low[a] + (crumbs.high[a] - crumbs.low[a]) * unit(random);
    }
    std::array<Place, 4> places{};
    for (Place& place : places) {
      for (size_t a = 0; a < 3; ++a) place[a] = at[a] + crumbs.size * (2 * unit(random) - 1);
    }
    constexpr std::array<std::array<uint32_t, 3>, 4> kFaces{
        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    bool out = false;
    for (const auto& [a, b, c] : kFaces) {
      for (const auto& piece : cutter.cut({places[a], places[b], places[c]})) {
        out = out || piece.cube == Int3{1, 1, 1};
      }
    }
    if (out && free) continue;
    const auto first = static_cast<uint32_t>(mesh.vertex_count());
    for (const Place& place : places) add_vertex(mesh, place);
    for (const auto& face : kFaces) {
      for (const uint32_t v : face) mesh.abc.push_back(first + v);
    }
  }
}

inline BlockPlan plan_with(int64_t side, int64_t margin) {
  BlockPlan plan;
  plan.version = plc_version_string();
  plc_parameters_defaults(&plan.parameters);
  plan.parameters.reduction = 1.7;
  plan.parameters.levels = 1;
  plc_image_defaults(&plan.image);
  constexpr std::array<int64_t, 3> kDims{150, 140, 130};
  std::copy(kDims.begin(), kDims.end(), plan.image.dims);
  plan.grid = BlockGrid(kDims, side, margin);
  return plan;
}

// The folder of a plan whose tasks are done: each has written all cells of its window.
inline void write_blocks(const std::string& folder, const BlockPlan& plan, const BlockMesh& mesh) {
  std::filesystem::create_directories(folder + "/level0");
  const Int3& n = plan.grid.blocks();
  const auto cells =
      plc::tools::divided(mesh, plan.grid, {{0, 0, 0}, {3 * n[0] - 1, 3 * n[1] - 1, 3 * n[2] - 1}});
  for (int64_t block = 0; block < plan.grid.block_count(); ++block) {
    const Int3 at = plan.grid.block_at(block);
    const BlockGrid::Window window = plan.grid.window_of(at);
    std::map<Int3, plc::tools::BlockCell> own;
    for (const auto& [cell, faces] : cells) {
      if (window.contains(cell)) own[cell] = faces;
    }
    plc::tools::write_block_file(plc::tools::block_path(folder, plan, BlockGrid::colour_of(at), at),
                                 own);
  }
}

inline Place minus(const Place& l, const Place& r) {
  return {l[0] - r[0], l[1] - r[1], l[2] - r[2]};
}

inline Place cross(const Place& l, const Place& r) {
  return {l[1] * r[2] - l[2] * r[1], l[2] * r[0] - l[0] * r[2], l[0] * r[1] - l[1] * r[0]};
}

inline double dot(const Place& l, const Place& r) {
  return l[0] * r[0] + l[1] * r[1] + l[2] * r[2];
}

inline double area_of(const std::vector<Triangle>& faces) {
  double sum = 0;
  for (const Triangle& t : faces) {
    const Place n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    sum += std::sqrt(dot(n, n)) / 2;
  }
  return sum;
}

inline double volume_of(const std::vector<Triangle>& faces) {
  double sum = 0;
  for (const Triangle& t : faces) sum += dot(t[0], cross(t[1], t[2])) / 6;
  return sum;
}

inline std::vector<Triangle> triangles_of(const BlockMesh& mesh) {
  std::vector<Triangle> all;
  for (size_t f = 0; f < mesh.abc.size(); f += 3) {
    Triangle t{};
    for (size_t k = 0; k < 3; ++k) std::copy_n(&mesh.xyz[3 * size_t{mesh.abc[f + k]}], 3, &t[k][0]);
    all.push_back(t);
  }
  return all;
}

// To the shapes that the surface was made of; its faces are within half a voxel of them.
inline double distance_of(const Place& at) {
  const Place t = minus(at, kMiddle);
  const double torus = std::abs(std::hypot(std::hypot(t[0], t[1]) - kRing, t[2]) - kTube);
  double outside = 0, depth = -1e9;
  for (size_t a = 0; a < 3; ++a) {
    const double x = std::max(kLow[a] - at[a], at[a] - kHigh[a]);
    outside += x > 0 ? x * x : 0;
    depth = std::max(depth, x);
  }
  return std::min(torus, depth > 0 ? std::sqrt(outside) : -depth);
}

}  // namespace samples

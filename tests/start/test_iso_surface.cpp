#include "engine/start/iso_surface.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/mesh_arrays.h"
#include "engine/base/schedule.h"
#include "engine/measure/measures.h"
#include "engine/measure/mesh_check.h"
#include "engine/mesh/state_hash.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Mesh;
using samples::Volume;

constexpr double kPi = 3.14159265358979323846;

// Mesh space: voxel indices.
plc::ImageView view_of(const Volume& v) {
  plc::ImageView view;
  view.data = v.values.data();
  for (size_t a = 0; a < 3; ++a) view.dims[a] = static_cast<int32_t>(v.dims[a]);
  return view;
}

void extract(Mesh& mesh, const Volume& v, float iso, bool inside_above = true) {
  REQUIRE(plc::iso_surface({view_of(v), iso, inside_above}, samples::kSerial, mesh).message() ==
          "");
}

// Everything that a surface must be, and its measures.
plc::MeshCheck checked(const Mesh& mesh) {
  CHECK(plc::broken_invariant(mesh) == "");
  std::vector<double> xyz;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const plc::Vec3 p = mesh.at(v);
    xyz.insert(xyz.end(), {p.x, p.y, p.z});
  }
  const plc::Vector<uint32_t> abc = mesh.faces();
  plc::MeshCheck check;
  REQUIRE(plc::check_mesh(plc::arrays_of(xyz, abc), samples::kSerial, check).ok());
  CHECK(check.valid == 1);
  CHECK(check.isolated_vertices == 0);
  return check;
}

plc::Crossings crossings_of(const Volume& v, float iso, bool inside_above = true, int64_t least = 0,
                            int threads = 1) {
  const plc::ImageView view = view_of(v);
  const plc::ImageObject object{view, iso, inside_above};
  plc::Crossings crossings;
  REQUIRE(
      plc::iso_crossings(object, plc::values_of(object), least, plc::Schedule(threads), crossings)
          .ok());
  return crossings;
}

plc::MeshCheck checked(const plc::Crossings& crossings) {
  const std::vector<double> xyz(crossings.xyz.begin(), crossings.xyz.end());
  plc::MeshCheck check;
  REQUIRE(plc::check_mesh(plc::arrays_of(xyz, crossings.abc), samples::kSerial, check).ok());
  CHECK(check.valid == 1);
  CHECK(check.isolated_vertices == 0);
  return check;
}

Volume constant(std::array<int64_t, 3> dims, float value) {
  Volume v = samples::empty_volume(dims);
  v.values.assign(static_cast<size_t>(dims[0] * dims[1] * dims[2]), value);
  return v;
}

}  // namespace

TEST_CASE("the iso-surface of a ball is a sphere of its volume", "[iso_surface]") {
  const Volume v = samples::sphere_potential(samples::empty_volume({40, 40, 40}), 0.3);
  Mesh mesh;
  extract(mesh, v, 0.5F);
  const plc::MeshCheck check = checked(mesh);
  CHECK(check.measures.components == 1);
  CHECK(check.measures.genus == 0);
  CHECK(check.measures.volume == Approx(4 * kPi / 3 * 12 * 12 * 12).epsilon(0.01));
  CHECK(check.measures.area == Approx(4 * kPi * 12 * 12).epsilon(0.02));
}

TEST_CASE("the iso-surface of a chain is its two tori", "[iso_surface]") {
  const Volume v = samples::chain_potential(samples::empty_volume({64, 64, 64}));
  Mesh mesh;
  extract(mesh, v, 0.5F);
  const plc::MeshCheck check = checked(mesh);
  CHECK(check.measures.components == 2);
  CHECK(check.measures.genus == 2);
  CHECK(check.measures.volume == Approx(2 * 2 * kPi * 14 * kPi * 3.57 * 3.57).epsilon(0.02));
}

TEST_CASE("cavities get walls that face inward, and dark objects are found as well",
          "[iso_surface]") {
  const Volume v = samples::shell(samples::empty_volume({40, 40, 40}));
  Mesh mesh;
  extract(mesh, v, 0.5F);
  const plc::MeshCheck bright = checked(mesh);
  CHECK(bright.measures.components == 2);
  CHECK(bright.measures.genus == 0);
  // Outside of the shell is dark: one box with a shell-shaped cavity, and the core.
  extract(mesh, v, 0.5F, false);
  const plc::MeshCheck dark = checked(mesh);
  CHECK(dark.measures.components == 3);
  CHECK(dark.measures.volume == Approx(40 * 40 * 40 - bright.measures.volume).epsilon(0.01));
}

TEST_CASE("noise of every density has a valid iso-surface", "[iso_surface]") {
  for (const uint64_t seed : {1U, 2U, 3U}) {
    Volume v = constant({14, 11, 9}, 0.5F);
    samples::add_noise(v, 0.5, seed);
    for (const float iso : {0.05F, 0.3F, 0.5F, 0.7F, 0.95F}) {
      for (const bool above : {false, true}) {
        Mesh mesh;
        extract(mesh, v, iso, above);
        const plc::MeshCheck check = checked(mesh);
        CHECK(check.edge_min > 0.05);
        CHECK(check.edge_max < 2);
        CHECK(checked(crossings_of(v, iso, above)).edge_min > 0.05);
      }
    }
  }
}

TEST_CASE("a checkerboard, and every cell of eight voxels, has a valid iso-surface",
          "[iso_surface]") {
  Volume v = constant({9, 8, 7}, 0);
  for (size_t i = 0; i < v.values.size(); ++i) {
    const size_t x = i % 9, y = i / 9 % 8, z = i / 72;
    v.values[i] = (x + y + z) % 2 == 0 ? 1.0F : 0.0F;
  }
  Mesh mesh;
  extract(mesh, v, 0.5F);
  checked(mesh);
  checked(crossings_of(v, 0.5F));
  for (uint32_t inside = 1; inside < 256; ++inside) {
    Volume cell = constant({2, 2, 2}, 0);
    for (uint32_t c = 0; c < 8; ++c) cell.values[c] = (inside >> c & 1) != 0 ? 1.0F : 0.0F;
    extract(mesh, cell, 0.5F);
    checked(mesh);
    checked(crossings_of(cell, 0.5F));
  }
}

TEST_CASE("values equal to iso are inside and do not make faces degenerate", "[iso_surface]") {
  Volume v = constant({7, 7, 7}, 0);
  for (const size_t i : {171U, 172U, 178U, 185U}) v.values[i] = 0.5F;
  for (const bool above : {true, false}) {
    Mesh mesh;
    extract(mesh, v, above ? 0.5F : 0.0F, above);
    const plc::MeshCheck check = checked(mesh);
    CHECK(check.edge_min > 0.05);
    CHECK(check.measures.volume > 0);
  }
}

TEST_CASE("what the border cuts is closed half a voxel beyond it", "[iso_surface]") {
  Mesh mesh;
  extract(mesh, constant({5, 6, 7}, 1), 0.5F);
  const plc::MeshCheck check = checked(mesh);
  CHECK(check.measures.components == 1);
  CHECK(check.measures.genus == 0);
  CHECK(check.measures.volume == Approx(5 * 6 * 7).epsilon(0.12));
  float low = 0, high = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    low = std::min(low, mesh.at(v).x);
    high = std::max(high, mesh.at(v).x);
  }
  CHECK(low == -0.5F);
  CHECK(high == 4.5F);
  extract(mesh, constant({1, 1, 1}, 1), 0.5F);
  CHECK(checked(mesh).measures.vertices == 14);
}

TEST_CASE("positions are of mesh space", "[iso_surface]") {
  const Volume v = samples::sphere_potential(samples::empty_volume({20, 20, 20}), 0.3);
  Mesh plain, scaled;
  extract(plain, v, 0.5F);
  plc::ImageView view = view_of(v);
  const float scale[3] = {0.5F, 2, 4}, offset[3] = {1, 2, -3};
  for (size_t a = 0; a < 3; ++a) {
    view.scale[a] = scale[a];
    view.offset[a] = offset[a];
  }
  scaled.delta = 0.4;
  REQUIRE(plc::iso_surface({view, 0.5F, true}, samples::kSerial, scaled).ok());
  REQUIRE(plain.slots() == scaled.slots());
  CHECK(scaled.delta == 0.4);
  for (uint32_t u = 0; u < plain.slots(); ++u) {
    CHECK(scaled.at(u).x == Approx((plain.at(u).x - 1) / 0.5F).epsilon(1e-5));
    CHECK(scaled.at(u).y == Approx((plain.at(u).y - 2) / 2).epsilon(1e-5));
    CHECK(scaled.at(u).z == Approx((plain.at(u).z + 3) / 4).epsilon(1e-5));
  }
}

TEST_CASE("no voxel inside is an error, and what is not a number is outside", "[iso_surface]") {
  Mesh mesh;
  extract(mesh, constant({3, 3, 3}, 1), 0.5F);
  const uint32_t before = mesh.slots();
  const plc::Status status =
      plc::iso_surface({view_of(constant({3, 3, 3}, 0)), 0.5F, true}, samples::kSerial, mesh);
  CHECK(status.code() == plc::ErrorCode::kInvalidData);
  CHECK(status.message() == "no iso-surface: no voxel of the image is inside; check the iso-value");
  CHECK(mesh.slots() == before);
  Volume v = constant({3, 3, 3}, 1);
  v.values[13] = std::numeric_limits<float>::quiet_NaN();
  extract(mesh, v, 0.5F);
  CHECK(checked(mesh).measures.components == 2);
}

TEST_CASE("iso-surfaces are the same bits for any number of threads", "[iso_surface]") {
  Volume v = samples::noise(samples::empty_volume({30, 31, 41}), 5, 7);
  std::vector<uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    const plc::Schedule schedule(threads);
    Mesh mesh;
    REQUIRE(plc::iso_surface({view_of(v), 0.5F, true}, schedule, mesh).ok());
    hashes.push_back(plc::state_hash(mesh));
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

TEST_CASE("parts and cavities of too few voxels are left out, but for the largest",
          "[iso_surface]") {
  // A shell of 5 x 5 x 5 voxels around a cavity of 3 x 3 x 3, that with a voxel in its middle; a
  // row of 26 voxels, a row of 27, one of 27 at the border.
  Volume v = constant({40, 16, 16}, 0);
  const auto fill = [&](std::array<size_t, 3> low, std::array<size_t, 3> size, float value) {
    for (size_t z = low[2]; z < low[2] + size[2]; ++z) {
      for (size_t y = low[1]; y < low[1] + size[1]; ++y) {
        std::fill_n(v.values.begin() + static_cast<int64_t>((z * 16 + y) * 40 + low[0]), size[0],
                    value);
      }
    }
  };
  fill({2, 2, 2}, {5, 5, 5}, 1);
  fill({3, 3, 3}, {3, 3, 3}, 0);
  fill({4, 4, 4}, {1, 1, 1}, 1);
  fill({2, 10, 10}, {26, 1, 1}, 1);
  fill({2, 13, 13}, {27, 1, 1}, 1);
  fill({13, 0, 0}, {27, 1, 1}, 1);
  const auto components = [&](int64_t least) {
    return checked(crossings_of(v, 0.5F, true, least)).measures.components;
  };
  CHECK(components(0) == 6);
  CHECK(components(2) == 5);   // without the voxel in the cavity
  CHECK(components(27) == 4);  // and the row of 26
  CHECK(components(28) == 1);  // the shell, filled
  CHECK(components(125) == 1);
  CHECK(components(1000) == 1);
}

TEST_CASE("voxels that touch by edges alone are parts of their own", "[iso_surface]") {
  Volume v = constant({40, 40, 40}, 0);
  const auto fill = [&](std::array<size_t, 3> low, std::array<size_t, 3> high) {
    for (size_t z = low[2]; z < high[2]; ++z) {
      for (size_t y = low[1]; y < high[1]; ++y) {
        for (size_t x = low[0]; x < high[0]; ++x) v.values[(z * 40 + y) * 40 + x] = 1;
      }
    }
  };
  const auto components = [&](int64_t least) {
    return checked(crossings_of(v, 0.5F, true, least)).measures.components;
  };
  // A slab, the largest; pairs of voxels along a diagonal.
  fill({0, 0, 28}, {40, 40, 40});
  for (size_t i = 0; i < 18; ++i) fill({2 + i, 2 + i, 2}, {3 + i, 3 + i, 4});
  CHECK(components(0) == 19);
  CHECK(components(27) == 1);
  // With 27 voxels at its end it is a part.
  fill({20, 19, 3}, {37, 20, 4});
  CHECK(components(20) == 1);
  CHECK(components(19) == 2);
  fill({20, 19, 2}, {37, 20, 4});
  CHECK(components(27) == 2);
}

TEST_CASE("of many parts in a row each is left out for itself, by any number of threads",
          "[iso_surface]") {
  // In each cube of 12 voxels a shell of 8, around a cavity of 27 voxels or one of 8, and a speck.
  constexpr size_t kSide = 60, kCube = 12;
  Volume v = constant({kSide, kSide, kSide}, 0);
  for (size_t i = 0; i < v.values.size(); ++i) {
    const std::array<size_t, 3> at{i % kSide, i / kSide % kSide, i / kSide / kSide};
    const size_t cavity = (at[0] / kCube + at[1] / kCube + at[2] / kCube) % 2 == 0 ? 7 : 6;
    const auto all_within = [&](size_t low, size_t high) {
      return std::all_of(at.begin(), at.end(),
                         [&](size_t x) { return x % kCube >= low && x % kCube < high; });
    };
    const bool inside = all_within(0, 1) || (all_within(2, 10) && !all_within(4, cavity));
    v.values[i] = inside ? 1.0F : 0.0F;
  }
  std::vector<std::vector<uint32_t>> faces;
  for (const int threads : {1, 3}) {
    const plc::Crossings crossings = crossings_of(v, 0.5F, true, 27, threads);
    CHECK(checked(crossings).measures.components == 125 + 63);
    faces.emplace_back(crossings.abc.begin(), crossings.abc.end());
  }
  CHECK(faces[0] == faces[1]);
}

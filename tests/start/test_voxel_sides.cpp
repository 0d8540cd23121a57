#include "engine/start/voxel_sides.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "engine/base/schedule.h"
#include "engine/start/iso_surface.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_sides.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::ImageView;
using plc::Mesh;
using samples::Soup;

// Only the place of the voxels is looked at.
ImageView view(std::array<int32_t, 3> dims, std::array<float, 3> scale = {1, 1, 1},
               std::array<float, 3> offset = {0, 0, 0}) {
  ImageView v;
  for (size_t a = 0; a < 3; ++a) {
    v.dims[a] = dims[a];
    v.scale[a] = scale[a];
    v.offset[a] = offset[a];
  }
  return v;
}

plc::Vector<uint8_t> sides(const Mesh& mesh, const ImageView& image) {
  return samples::sides_of(mesh, image);
}

// depth(p) > 0 inside, about the distance from the surface in mesh units: voxels nearer to it than
// `room` are not judged. Returns the voxels inside.
size_t check_sides(const Soup& soup, const ImageView& image, double room,
                   const std::function<double(double, double, double)>& depth) {
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  const plc::Vector<uint8_t> inside = sides(mesh, image);
  REQUIRE(inside.size() == static_cast<size_t>(image.dims[0]) * static_cast<size_t>(image.dims[1]) *
                               static_cast<size_t>(image.dims[2]));
  size_t i = 0, wrong = 0, in = 0;
  const auto at = [&](int32_t voxel, size_t a) {
    return (static_cast<double>(voxel) - static_cast<double>(image.offset[a])) /
           static_cast<double>(image.scale[a]);
  };
  for (int32_t z = 0; z < image.dims[2]; ++z) {
    for (int32_t y = 0; y < image.dims[1]; ++y) {
      for (int32_t x = 0; x < image.dims[0]; ++x, ++i) {
        const double d = depth(at(x, 0), at(y, 1), at(z, 2));
        in += inside[i];
        if (std::abs(d) > room) wrong += (inside[i] != 0) != (d > 0) ? 1 : 0;
      }
    }
  }
  CHECK(wrong == 0);
  return in;
}

double sphere_depth(double x, double y, double z, double centre, double radius) {
  return radius - samples::norm(x - centre, y - centre, z - centre);
}

}  // namespace

TEST_CASE("voxels inside a sphere are told, at every size", "[voxel_sides]") {
  for (const double radius : {1.7, 4.3, 9.1}) {
    const size_t in = check_sides(
        samples::moved(samples::sphere(4), 12.3, 12.3, 12.3, radius), view({25, 25, 25}),
        0.03 * radius,
        [&](double x, double y, double z) { return sphere_depth(x, y, z, 12.3, radius); });
    CHECK(static_cast<double>(in) ==
          Approx(4.0 / 3 * 3.14159265 * radius * radius * radius).epsilon(0.15));
  }
}

TEST_CASE("the hole of a torus is outside", "[voxel_sides]") {
  check_sides(samples::moved(samples::torus(60, 40, 8, 3), 14, 14, 6), view({29, 29, 13}), 0.1,
              [](double x, double y, double z) {
                const double radial = std::hypot(x - 14, y - 14) - 8;
                return 3 - std::hypot(radial, z - 6);
              });
}

TEST_CASE("a cavity is outside and what lies in it inside again", "[voxel_sides]") {
  Soup soup = samples::moved(samples::sphere(4), 12, 12, 12, 11);
  soup.append(samples::flipped(samples::moved(samples::sphere(4), 12, 12, 12, 8)));
  soup.append(samples::moved(samples::sphere(4), 12, 12, 12, 4));
  check_sides(soup, view({25, 25, 25}), 0.2, [](double x, double y, double z) {
    const double r = samples::norm(x - 12, y - 12, z - 12);
    if (r > 9.5) return 11 - r;
    return r > 6 ? r - 8 : 4 - r;
  });
}

TEST_CASE("vertices, edges and faces on voxel centres lose no parity", "[voxel_sides]") {
  // Boxes and octahedra with corners on the centres, and all their edges through centres.
  const auto box_depth = [](double x, double y, double z) {
    return std::min({x - 3, 9 - x, y - 3, 9 - y, z - 3, 9 - z});
  };
  CHECK(check_sides(samples::moved(samples::cube(), 3, 3, 3, 6), view({13, 13, 13}), 1e-3,
                    box_depth) >= 125);
  const auto octahedron_depth = [](double x, double y, double z) {
    return 5 - std::abs(x - 6) - std::abs(y - 6) - std::abs(z - 6);
  };
  check_sides(samples::moved(samples::octahedron(), 6, 6, 6, 5), view({13, 13, 13}), 1e-2,
              octahedron_depth);
}

TEST_CASE("an iso-surface encloses the voxels that it was made around", "[voxel_sides]") {
  const samples::Volume volume = samples::blobs(samples::empty_volume({24, 20, 22}), 9, 5);
  ImageView image = view({24, 20, 22});
  image.data = volume.values.data();
  Mesh mesh;
  REQUIRE(plc::iso_surface({image, 0.4F, true}, samples::kSerial, mesh).ok());
  const plc::Vector<uint8_t> inside = sides(mesh, image);
  size_t wrong = 0, in = 0;
  for (size_t i = 0; i < inside.size(); ++i) {
    wrong += (inside[i] != 0) != (volume.values[i] >= 0.4F) ? 1 : 0;
    in += inside[i];
  }
  CHECK(wrong == 0);
  CHECK(in > 300);
}

TEST_CASE("voxels of any shape and place are asked at their centres", "[voxel_sides]") {
  const Soup ball = samples::moved(samples::sphere(4), 10, 10, 10, 6);
  const auto depth = [](double x, double y, double z) { return sphere_depth(x, y, z, 10, 6); };
  CHECK(check_sides(ball, view({40, 10, 5}, {2, 0.5F, 0.25F}, {0.5F, -0.25F, -0.375F}), 0.15,
                    depth) > 100);
  CHECK(check_sides(ball, view({21, 21, 60}, {1, 1, 3}, {0, 0, 0.7F}), 0.15, depth) > 2000);
}

TEST_CASE("what the border of the image cuts is judged by what lies beyond it", "[voxel_sides]") {
  const auto depth = [](double x, double y, double z) { return sphere_depth(x, y, z, 4, 7); };
  // On every side the sphere sticks out; also where it begins left of the rows.
  CHECK(check_sides(samples::moved(samples::sphere(4), 4, 4, 4, 7), view({9, 9, 9}), 0.1, depth) >
        600);
  // An image within the surface, and one far away.
  Mesh mesh;
  samples::fill_mesh(mesh, samples::moved(samples::sphere(3), 0, 0, 0, 50), 1);
  for (const uint8_t side : sides(mesh, view({5, 6, 7}))) CHECK(side == 1);
  samples::fill_mesh(mesh, samples::moved(samples::sphere(3), 80, 3, 3, 20), 1);
  for (const uint8_t side : sides(mesh, view({5, 6, 7}))) CHECK(side == 0);
  samples::fill_mesh(mesh, samples::moved(samples::sphere(3), -80, 3, 3, 20), 1);
  for (const uint8_t side : sides(mesh, view({5, 6, 7}))) CHECK(side == 0);
}

TEST_CASE("an empty mesh encloses nothing, and deleted vertices count for nothing",
          "[voxel_sides]") {
  Mesh mesh;
  for (const uint8_t side : sides(mesh, view({4, 4, 4}))) CHECK(side == 0);
  Soup soup = samples::moved(samples::sphere(2), 4, 4, 4, 3);
  soup.append(samples::moved(samples::sphere(2), 12, 4, 4, 3));
  samples::fill_mesh(mesh, soup, 1);
  for (uint32_t v = 0; v < 66; ++v) mesh.destroy(v);
  Mesh alone;
  samples::fill_mesh(alone, samples::moved(samples::sphere(2), 12, 4, 4, 3), 1);
  CHECK(sides(mesh, view({17, 9, 9})) == sides(alone, view({17, 9, 9})));
}

TEST_CASE("a row says whether a voxel of it may be inside, from any thread", "[voxel_sides]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::moved(samples::torus(60, 40, 8, 3), 14, 14, 6), 1);
  const ImageView image = view({29, 29, 13});
  const plc::Vector<uint8_t> one = sides(mesh, image);
  const plc::VoxelSides voxel_sides(mesh, image);
  const plc::Schedule schedule(3);
  plc::Vector<uint8_t> got(one.size(), 9), wrong(29 * 13, 0);
  schedule.run(wrong.size(), [&](size_t row) {
    uint8_t* to = got.data() + row * 29;
    const bool any =
        voxel_sides.row(static_cast<int32_t>(row % 29), static_cast<int32_t>(row / 29), to);
    if (!any && std::count(to, to + 29, 0) != 29) wrong[row] = 1;
  });
  CHECK(got == one);
  CHECK(std::count(wrong.begin(), wrong.end(), 1) == 0);
}

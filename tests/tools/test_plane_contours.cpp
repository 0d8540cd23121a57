#include "tests/tools/plane_contours.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numbers>

#include "tests/samples/sample_meshes.h"

namespace {

plc::tools::TriangleMesh mesh_of(const samples::Soup& soup) {
  plc::tools::TriangleMesh mesh;
  mesh.xyz.assign(soup.xyz.begin(), soup.xyz.end());
  mesh.abc.assign(soup.abc.begin(), soup.abc.end());
  return mesh;
}

plc_image turned_image() {
  plc_image image;
  plc_image_defaults(&image);
  const double direction[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  const double spacing[3] = {3, 2, 0.5};
  const double origin[3] = {5, -1, 2};
  std::copy(direction, direction + 9, image.direction);
  std::copy(spacing, spacing + 3, image.spacing);
  std::copy(origin, origin + 3, image.origin);
  return image;
}

}  // namespace

TEST_CASE("a slice of a sphere is a circle in the plane of the slice", "[view]") {
  const double radius = 10;
  const auto mesh = mesh_of(samples::moved(samples::sphere(6), 5, -1, 2, radius));
  const plc_image image = turned_image();
  for (size_t axis = 0; axis < 3; ++axis) {
    const double k = 0.37;  // through no vertex
    const double spacing = std::array<double, 3>{3, 2, 0.5}[axis];
    const auto segments = samples::plane_contours(mesh, image, axis, k);
    REQUIRE(segments.size() > 50);
    for (const auto& segment : segments) {
      for (const auto& end : segment) CHECK(plc::tools::voxel_of(image, end)[axis] == Approx(k));
    }
    const double circle =
        2 * std::numbers::pi * std::sqrt(radius * radius - k * k * spacing * spacing);
    CHECK(samples::length_of(segments) == Approx(circle).epsilon(1e-3));
  }
}

TEST_CASE("contours are closed, and there are none beside the mesh", "[view]") {
  const auto mesh = mesh_of(samples::torus(40, 20, 8, 3));
  plc_image image;
  plc_image_defaults(&image);
  const auto segments = samples::plane_contours(mesh, image, 2, 0.5);
  REQUIRE(segments.size() > 50);
  for (const auto& segment : segments) {
    const auto& a = segment[0];
    size_t shared = 0;  // every end is that of two segments
    for (const auto& [c, d] : segments) {
      for (const auto& end : {c, d}) {
        shared += std::hypot(a[0] - end[0], a[1] - end[1], a[2] - end[2]) < 1e-9 ? 1U : 0U;
      }
    }
    CHECK(shared == 2);
  }
  CHECK(samples::plane_contours(mesh, image, 2, 3.5).empty());
}

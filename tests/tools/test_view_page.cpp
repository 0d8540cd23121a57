#include "tools/view/view_page.h"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/samples/sample_meshes.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/view/packed.h"

namespace {

using fixtures::failure_of;
using namespace plc::tools;

TriangleMesh ball_at(double x, double y, double z, double radius) {
  const samples::Soup soup = samples::moved(samples::sphere(2), x, y, z, radius);
  TriangleMesh mesh;
  mesh.xyz.assign(soup.xyz.begin(), soup.xyz.end());
  mesh.abc.assign(soup.abc.begin(), soup.abc.end());
  return mesh;
}

// 10 x 20 x 30 voxels whose axes are permuted and one turned round.
plc_image turned_image() {
  plc_image image;
  plc_image_defaults(&image);
  image.type = PLC_U8;
  const int64_t dims[3] = {10, 20, 30};
  const double spacing[3] = {1, 2, 0.5};
  const double origin[3] = {100, 50, -7};
  const double direction[9] = {0, 1, 0, 0, 0, -1, 1, 0, 0};
  std::copy(dims, dims + 3, image.dims);
  std::copy(spacing, spacing + 3, image.spacing);
  std::copy(origin, origin + 3, image.origin);
  std::copy(direction, direction + 9, image.direction);
  return image;
}

}  // namespace

TEST_CASE("a surface beside the image is told from one that reaches into it", "[view]") {
  const plc_image image = turned_image();
  CHECK_FALSE(is_outside(image, ball_at(119, 42, -2, 3)));
  CHECK_FALSE(is_outside(image, ball_at(119, 42, -9, 3)));
  CHECK(is_outside(image, ball_at(119, 42, -12, 3)));
  CHECK(is_outside(image, ball_at(-119, -42, -2, 3)));
}

TEST_CASE("a surface that cannot be shown is refused by its name", "[view]") {
  TriangleMesh empty;
  CHECK(failure_of([&] { check_surface("a.ply", empty); }) ==
        "a.ply: has no face: there is nothing to show");
  TriangleMesh broken = ball_at(0, 0, 0, 1);
  broken.xyz[7] = std::numeric_limits<double>::quiet_NaN();
  CHECK(failure_of([&] { check_surface("a.ply", broken); }).find("a.ply: its point 2") == 0);
}

TEST_CASE("no name ends the script element that it stands in, and the page is there whole",
          "[view]") {
  const fixtures::Folder folder;
  ViewedScene scene;
  scene.name = "</script><script>alert(1)</script>\xff";
  scene.image = turned_image();
  scene.grey = {{2, 2, 2}, {5, 10, 15}, {}, true, 0, 255, std::vector<uint8_t>(8, 1)};
  scene.surfaces.push_back({"<!--", ball_at(119, 42, -2, 3)});
  const PageSource source = {"<before>\n", "<after>\n", {}};
  const uint64_t size = write_page(folder / "a.html", source, scene);
  const std::string page = fixtures::contents(folder / "a.html");
  CHECK(size == page.size());
  CHECK(page.find("<before>\n") == 0);
  CHECK(page.find("<after>\n") == page.size() - 8);
  CHECK(page.find("alert(1)</") == std::string::npos);
  CHECK(page.find("<!--") == std::string::npos);
  size_t scripts = 0;
  for (size_t at = 0; (at = page.find("</script", at)) != std::string::npos; ++at) ++scripts;
  CHECK(scripts == 4);  // greys, points, corners, the scene
  CHECK(folder.file_count() == 1);
}

TEST_CASE("what is packed is smaller than base64 of it, and an empty array is one", "[view]") {
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < 30000; ++i) indices.push_back(i / 3 + i % 3 * 100);
  CHECK(packed_indices(indices).size() < 4000);
  std::vector<float> values(10000, 0.25F);
  CHECK(packed_floats(values).size() < 200);
  CHECK(packed_greys({}) == "eJwDAAAAAAE=");  // as zlib's compress() has it
}

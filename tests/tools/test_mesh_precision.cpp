#include "tools/command/mesh_precision.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <limits>

#include "tests/samples/sample_meshes.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/command/engine_handles.h"

namespace {

using plc::tools::settle_precision;
using plc::tools::TriangleMesh;

plc::tools::ContextHandle make_context() {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = 1;
  return plc::tools::make_context(options);
}

// Of edges about half of `scale` long, at `origin` on every axis.
TriangleMesh torus(double scale, double origin) {
  const samples::Soup soup = samples::torus(13, 7, 2, 0.7);
  TriangleMesh mesh;
  for (const double x : soup.xyz) mesh.xyz.push_back(origin + scale * x);
  mesh.abc.assign(soup.abc.begin(), soup.abc.end());
  return mesh;
}

}  // namespace

TEST_CASE("Coordinates are rounded to floats where they hold the mesh", "[mesh_precision]") {
  const auto context = make_context();
  TriangleMesh mesh = torus(1, 1000.0 / 3);
  REQUIRE(settle_precision(context.get(), mesh));
  CHECK_FALSE(mesh.doubles);
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    REQUIRE(mesh.xyz[i] == static_cast<double>(static_cast<float>(mesh.xyz[i])));
  }
}

TEST_CASE("Where floats would make faces meet, coordinates stay doubles", "[mesh_precision]") {
  const auto context = make_context();
  for (const auto& [scale, origin] :
       {std::pair(1e-6, 1e3), std::pair(1.0, 1e8), std::pair(1e-30, 1e-15), std::pair(1e39, 0.0)}) {
    CAPTURE(scale, origin);
    TriangleMesh mesh = torus(scale, origin);
    const std::vector<double> before = mesh.xyz;
    REQUIRE(settle_precision(context.get(), mesh));
    CHECK(mesh.doubles);
    CHECK(mesh.xyz == before);
  }
}

TEST_CASE("What not even doubles hold is told, with what helps", "[mesh_precision]") {
  const auto context = make_context();
  TriangleMesh mesh = torus(1e-12, 1e6);
  CHECK_FALSE(settle_precision(context.get(), mesh));
  const std::string message = fixtures::failure_of(
      [&] { plc::tools::settle_surface(context.get(), mesh, PLC_SPACE_LPS, "out.ply"); });
  CHECK_THAT(message, Catch::Contains("out.ply: not written") && Catch::Contains("--space voxel"));
}

TEST_CASE("A mesh that is not valid is written in floats unless they make it worse",
          "[mesh_precision]") {
  const auto context = make_context();
  TriangleMesh open = torus(1, 1000.0 / 3);
  open.abc.resize(open.abc.size() - 3);
  CHECK_FALSE(settle_precision(context.get(), open));
  CHECK_FALSE(open.doubles);
  CHECK(open.xyz[0] == static_cast<double>(static_cast<float>(open.xyz[0])));
  TriangleMesh far = torus(1e-6, 1e3);
  far.abc.resize(far.abc.size() - 3);
  CHECK_FALSE(settle_precision(context.get(), far));
  CHECK(far.doubles);
}

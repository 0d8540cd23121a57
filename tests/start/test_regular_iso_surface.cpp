#include "engine/start/regular_iso_surface.h"

#include <catch2/catch.hpp>
#include <utility>

#include "engine/mesh/face_rings.h"
#include "kernels/image_value.h"
#include "tests/samples/sample_runs.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Mesh;

plc::ImageView view_of(const samples::Volume& volume) {
  plc::ImageView view;
  for (size_t a = 0; a < 3; ++a) {
    view.dims[a] = static_cast<int32_t>(volume.dims[a]);
    view.scale[a] = 1;
    view.offset[a] = 0;
  }
  view.data = volume.values.data();
  return view;
}

// By tetrahedra, and what starts from that; by cubes, and what an adaptive mesh starts from.
struct Both {
  Mesh plain, regular, cubes, adaptive;
  int asked = 0;  // of the adaptive one: whether to go on
};

Both surfaces_of(const samples::Volume& volume, float iso, int threads = 1) {
  const plc::ImageView view = view_of(volume);
  const plc::LatticeValues values{
      [&](int32_t y, int32_t z, uint8_t* inside) {
        for (int32_t x = 0; x < view.dims[0]; ++x)
          inside[x] = plc::image_value(view, x, y, z) >= iso;
      },
      [&](int32_t x, int32_t y, int32_t z) { return plc::image_value(view, x, y, z); }};
  const plc::Schedule schedule(threads);
  Both both;
  REQUIRE(plc::iso_surface({view, iso, true}, values, schedule, both.plain).ok());
  REQUIRE(plc::regular_iso_surface({view, iso, true}, values, schedule, both.regular).ok());
  plc::Crossings crossings;
  REQUIRE(plc::iso_crossings({view, iso, true}, values, 0, schedule, crossings).ok());
  const size_t count = crossings.xyz.size() / 3;
  const plc::FaceRings rings(crossings.abc.data(), crossings.abc.size() / 3, count, schedule);
  plc::fill_from_rings(both.cubes, crossings.xyz.data(), count, rings);
  plc::Sizing sizing;
  REQUIRE(sizing.field.build(view, iso, 1, {}, schedule).ok());
  both.adaptive.sizing = &sizing;
  const auto go_on = [&both] { return ++both.asked > 0; };
  REQUIRE(
      plc::regular_iso_surface({view, iso, true}, values, schedule, both.adaptive, 0, {go_on, {}})
          .ok());
  both.adaptive.sizing = nullptr;
  return both;
}

}  // namespace

TEST_CASE("a ball has a quarter of the vertices, and its place and volume",
          "[regular_iso_surface]") {
  const samples::Volume ball = samples::sphere_potential(samples::empty_volume({40, 40, 40}), 0.35);
  const Both both = surfaces_of(ball, 0.5F);
  CHECK(plc::broken_invariant(both.regular) == "");
  CHECK(both.regular.in_order());
  CHECK(samples::meeting_count(both.regular) == 0);
  CHECK(samples::euler(both.regular) == 2);
  CHECK(both.regular.vertex_count() * 3.5 < both.plain.vertex_count());
  CHECK(samples::volume(both.regular) == Approx(samples::volume(both.plain)).epsilon(0.02));
}

TEST_CASE("an adaptive mesh starts with edges of its sizes, with vertices of the iso-surface",
          "[regular_iso_surface]") {
  const samples::Volume ball = samples::sphere_potential(samples::empty_volume({40, 40, 40}), 0.35);
  const plc::ImageView view = view_of(ball);
  const plc::ImageObject object{view, 0.5F, true};
  plc::Sizing sizing;
  const plc::Schedule schedule(1);
  REQUIRE(sizing.field.build(view, 0.5F, 1, {}, schedule).ok());
  Mesh mesh;
  mesh.sizing = &sizing;
  REQUIRE(plc::regular_iso_surface(object, plc::values_of(object), schedule, mesh).ok());
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(mesh.slots() == mesh.vertex_count());
  CHECK(samples::meeting_count(mesh) == 0);
  CHECK(samples::euler(mesh) == 2);
  double edges = 0, sizes = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    for (uint32_t k = 0; k < mesh.valence(v); ++k) {
      const uint32_t w = mesh.neighbor(v, k);
      const float edge = length(mesh.at(w) - mesh.at(v)), size = mesh.size_between(v, w);
      CHECK(edge < plc::kMaxEdge * size);
      edges += static_cast<double>(edge), sizes += static_cast<double>(size);
    }
    CHECK(length(mesh.at(v) - plc::Vec3{19.5F, 19.5F, 19.5F}) == Approx(14).margin(0.15));
  }
  CHECK(edges / sizes == Approx(plc::kMeanEdge).epsilon(0.1));
}

TEST_CASE("whatever the voxels are, the topology stays and nothing meets",
          "[regular_iso_surface]") {
  for (const uint64_t seed : {1U, 2U, 3U, 4U}) {
    samples::Volume volume = samples::noise(samples::empty_volume({24, 20, 22}), 2.5, seed);
    samples::add_noise(volume, seed % 2 == 0 ? 0.5 : 0.05, seed + 10);
    const Both both = surfaces_of(volume, 0.5F), again = surfaces_of(volume, 0.5F, 3);
    CAPTURE(seed);
    for (const auto& [mesh, of] :
         {std::pair{&both.regular, &both.plain}, std::pair{&both.adaptive, &both.cubes}}) {
      CHECK(plc::broken_invariant(*mesh) == "");
      CHECK(samples::meeting_count(*mesh) == 0);
      CHECK(samples::euler(*mesh) == samples::euler(*of));
      CHECK(samples::component_count(*mesh) == samples::component_count(*of));
    }
    CHECK(samples::meeting_count(both.cubes) == 0);
    CHECK(both.cubes.vertex_count() * 2 < both.plain.vertex_count());
    CHECK(both.regular.vertex_count() * 2 < both.plain.vertex_count());
    CHECK(plc::state_hash(both.regular) == plc::state_hash(again.regular));
    CHECK(both.adaptive.vertex_count() < 0.9 * both.cubes.vertex_count());
    CHECK(plc::state_hash(both.adaptive) == plc::state_hash(again.adaptive));
  }
}

TEST_CASE("blocks that are thinned out at once leave one surface of their sizes",
          "[regular_iso_surface]") {
  // Larger than a few blocks, with noise whose faces meet when they are thinned out.
  samples::Volume volume = samples::noise(samples::empty_volume({70, 60, 50}), 4, 3);
  samples::add_noise(volume, 0.1, 5);
  const Both both = surfaces_of(volume, 0.5F), again = surfaces_of(volume, 0.5F, 3);
  CHECK(plc::broken_invariant(both.adaptive) == "");
  CHECK(samples::meeting_count(both.adaptive) == 0);
  CHECK(samples::euler(both.adaptive) == samples::euler(both.cubes));
  CHECK(samples::component_count(both.adaptive) == samples::component_count(both.cubes));
  CHECK(both.adaptive.vertex_count() < 0.6 * both.cubes.vertex_count());
  // Once after the crossings and after each of three grids: nothing had to be done anew as a whole.
  CHECK(both.asked == 4);
  CHECK(plc::state_hash(both.adaptive) == plc::state_hash(again.adaptive));
}

TEST_CASE("a plate of one voxel, and a single one, keep two sides", "[regular_iso_surface]") {
  samples::Volume volume = samples::empty_volume({12, 12, 12});
  volume.values.assign(12 * 12 * 12, 0.0F);
  for (size_t y = 2; y < 10; ++y) {
    for (size_t x = 2; x < 10; ++x) volume.values[(5 * 12 + y) * 12 + x] = 1;
  }
  volume.values[(10 * 12 + 1) * 12 + 1] = 1;
  const Both both = surfaces_of(volume, 0.5F);
  CHECK(plc::broken_invariant(both.regular) == "");
  CHECK(samples::meeting_count(both.regular) == 0);
  CHECK(samples::component_count(both.regular) == 2);
  CHECK(samples::euler(both.regular) == 4);
  CHECK(samples::volume(both.regular) > 0.3 * samples::volume(both.plain));
  CHECK(samples::euler(both.adaptive) == 4);
  CHECK(samples::volume(both.adaptive) > 0.7 * samples::volume(both.cubes));
}

// The layer for C++: the same bits and the same failures as through the functions of C.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "engine/pellicle.hpp"
#include "tests/samples/sample_api.h"
#include "tests/samples/sample_hosts.h"

namespace {

struct Scene {
  samples::Volume volume = samples::ball({24, 24, 24});
  plc_image image = samples::image_of(volume);
  plc_parameters parameters = samples::parameters(0.5, 1);
};

plc_context_options one_thread() {
  auto options = pellicle::defaults<plc_context_options>();
  options.threads = 1;
  return options;
}

pellicle::Mesh mesh_of(const pellicle::Surface& surface) {
  return {surface.positions_f64(PLC_SPACE_LPS), surface.faces(PLC_SPACE_LPS)};
}

template <typename Call>
plc_status status_of(const Call& call) {
  try {
    call();
  } catch (const pellicle::Error& error) {
    CHECK(std::string(error.what()) != "");
    return error.status();
  }
  return PLC_OK;
}

static_assert(!std::is_copy_constructible_v<pellicle::Surface>);
static_assert(std::is_nothrow_move_constructible_v<pellicle::Surface>);
static_assert(std::is_nothrow_move_constructible_v<pellicle::Run>);

}  // namespace

TEST_CASE("a surface by the layer for C++ is that of C, and tells the same", "[pellicle_cpp]") {
  const Scene s;
  const pellicle::Context context(one_thread());
  CHECK(context.threads() == 1);
  CHECK(context.simd() == plc_context_simd(context.get()));
  const pellicle::Surface surface = pellicle::extract(context, s.image, s.parameters);
  const samples::Surface plain =
      samples::extract(samples::make_context().get(), s.image, s.parameters);
  CHECK(surface.hash() == plc_surface_hash(plain.get()));
  CHECK(surface.positions(PLC_SPACE_RAS) == samples::positions(plain.get(), PLC_SPACE_RAS));
  CHECK(surface.positions_f64(PLC_SPACE_LPS) == samples::positions_f64(plain.get(), PLC_SPACE_LPS));
  CHECK(surface.faces(PLC_SPACE_RAS) == samples::faces(plain.get(), PLC_SPACE_RAS));
  CHECK(surface.normals(PLC_SPACE_LPS) == samples::normals(plain.get(), PLC_SPACE_LPS));
  CHECK(surface.scalars(PLC_SPACE_LPS, PLC_SCALAR_VALENCE).size() ==
        static_cast<size_t>(surface.vertex_count()));
  CHECK(surface.frozen_sites(PLC_SPACE_LPS).empty());
  CHECK(surface.patch() == std::vector<int64_t>(surface.patch().size(), PLC_PATCH_FREE));
  CHECK(surface.converged());
  CHECK(surface.check().valid == 1);
  CHECK(surface.measure(PLC_SPACE_LPS).faces == surface.face_count());
  REQUIRE(surface.levels().size() == 2);
  CHECK(surface.levels()[1].level == 0);
  CHECK(surface.seconds().evolution > 0);
  CHECK(surface.parameters().iso == 0.5);
  CHECK(surface.input_range().low < surface.input_range().high);
  CHECK(context.memory().peak > context.memory().now);
}

TEST_CASE("handles of the layer free themselves, in any order, and what they need stays",
          "[pellicle_cpp]") {
  const Scene s;
  std::optional<pellicle::Context> context(one_thread());
  std::optional<pellicle::Surface> surface(pellicle::extract(*context, s.image, s.parameters));
  const plc_surface* handle = surface->get();
  pellicle::Surface moved = std::move(*surface);
  CHECK(moved.get() == handle);
  surface.reset();
  context.reset();
  CHECK(moved.check().valid == 1);
}

TEST_CASE("volumes, pyramids and runs of the layer, saved on the way, come to the same surface",
          "[pellicle_cpp]") {
  const Scene s;
  const pellicle::Context context(one_thread());
  const uint64_t whole = pellicle::extract(context, s.image, s.parameters).hash();
  const pellicle::Volume volume(context, s.image, PLC_BORROW);
  CHECK(volume.image().voxels == s.image.voxels);
  CHECK(volume.range().low < volume.range().high);
  const pellicle::Pyramid pyramid(context, volume, s.parameters);
  CHECK(pyramid.levels() == 1);
  const plc_pyramid_level level = pyramid.level(1);
  CHECK(pyramid.values(1).size() ==
        static_cast<size_t>(level.dims[0] * level.dims[1] * level.dims[2]));
  CHECK(!std::isnan(pyramid.parameters().window_low));
  pellicle::Run run(context, pyramid, s.parameters);
  const plc_run_state after = run.advance(PLC_ONE_LEVEL);
  CHECK(after.between_levels == 1);
  CHECK(run.state().progress.iteration == after.progress.iteration);
  pellicle::Run restored(context, pyramid, s.parameters, run.save());
  for (pellicle::Run* each : {&run, &restored}) {
    CHECK(each->advance(PLC_ALL_LEVELS).done == 1);
    CHECK(each->surface().hash() == whole);
  }
}

TEST_CASE("failures are exceptions with the status and the engine's line", "[pellicle_cpp]") {
  Scene s;
  const pellicle::Context context(one_thread());
  s.parameters.iso = 1e9;
  CHECK(status_of([&] { pellicle::extract(context, s.image, s.parameters); }) ==
        PLC_INVALID_ARGUMENT);
  s.image.dims[0] = 1;
  CHECK(status_of([&] { const pellicle::Volume volume(context, s.image); }) == PLC_INVALID_DATA);
  auto options = one_thread();
  options.threads = -1;
  CHECK(status_of([&] { const pellicle::Context bad(options); }) == PLC_INVALID_ARGUMENT);
  CHECK(std::string(pellicle::Error(PLC_CANCELLED, "").what()) == plc_status_string(PLC_CANCELLED));
  CHECK_THROWS_AS(context.demand(PLC_INTERNAL), pellicle::Error);
}

TEST_CASE("a run of the layer that was cancelled can go on", "[pellicle_cpp]") {
  const Scene s;
  const pellicle::Context context(one_thread());
  const pellicle::Pyramid pyramid(context, pellicle::Volume(context, s.image), s.parameters);
  auto extras = pellicle::defaults<plc_extras>();
  int calls = 0;
  extras.progress_user = &calls;
  extras.progress = [](const plc_progress*, void* user) {
    return ++*static_cast<int*>(user) == 5 ? 1 : 0;
  };
  pellicle::Run run(context, pyramid, s.parameters, &extras);
  CHECK(status_of([&] { run.advance(PLC_ALL_LEVELS); }) == PLC_CANCELLED);
  CHECK(run.advance(PLC_ALL_LEVELS).done == 1);
  CHECK(run.surface().hash() == pellicle::extract(context, s.image, s.parameters).hash());
}

TEST_CASE("meshes are checked and measured by the layer as by C", "[pellicle_cpp]") {
  const Scene s;
  const pellicle::Context context(one_thread());
  const pellicle::Mesh mesh = mesh_of(pellicle::extract(context, s.image, s.parameters));
  const plc_check check = pellicle::check(context, mesh);
  CHECK(check.valid == 1);
  const pellicle::ComponentMeasures measures = pellicle::component_measures(context, mesh);
  REQUIRE(measures.components.size() == 1);
  CHECK(measures.whole.volume == Approx(check.measures.volume));
  CHECK(measures.components[0].faces == check.measures.faces);
  const pellicle::Curvature curvature = pellicle::curvature(context, mesh);
  double total = 0, area = 0;
  for (size_t v = 0; v < curvature.area.size(); ++v) {
    total += curvature.gaussian[v] * curvature.area[v];
    area += curvature.area[v];
  }
  CHECK(total == Approx(4 * std::acos(-1.0)));
  CHECK(area == Approx(check.measures.area));
  CHECK(std::count_if(curvature.mean.begin(), curvature.mean.end(),
                      [](double mean) { return mean > 0; }) > mesh.vertices() / 2);
  const int64_t nearest =
      pellicle::nearest_vertex(context, mesh, {mesh.xyz[3], mesh.xyz[4], mesh.xyz[5]});
  CHECK(nearest == 1);
  const std::vector<double> path = pellicle::geodesic(context, mesh, 1);
  CHECK(path[1] == 0);
  CHECK(*std::max_element(path.begin(), path.end()) > 10);
  const pellicle::Distances distances = pellicle::distances(context, mesh, mesh);
  CHECK(distances.summary.max == Approx(0).margin(1e-9));
  CHECK(distances.of_vertex.size() == path.size());
  // And back into a surface.
  const pellicle::Surface again(context, PLC_SPACE_LPS, &s.image, mesh.xyz, mesh.abc);
  CHECK(again.converged());
  CHECK(again.vertex_count() == mesh.vertices());
  const pellicle::Mesh nothing;
  CHECK(pellicle::component_measures(context, nothing).components.empty());
  CHECK(status_of([&] { pellicle::distances(context, mesh, nothing); }) == PLC_INVALID_DATA);
}

TEST_CASE("a volume of bricks by the layer for C++ gives the surface of the image",
          "[pellicle_cpp]") {
  Scene s;
  const pellicle::Context context(one_thread());
  auto bricks = pellicle::defaults<plc_bricks>();
  bricks.type = PLC_F32;
  std::copy_n(s.image.dims, 3, bricks.dims);
  std::copy_n(s.image.spacing, 3, bricks.spacing);
  bricks.brick[2] = 16;
  bricks.user = &s.image;
  bricks.fetch = [](const int64_t at[3], void* voxels, char*, size_t, void* user) {
    const auto& image = *static_cast<const plc_image*>(user);
    const auto* from = static_cast<const float*>(image.voxels);
    for (int64_t z = 16 * at[2]; z < std::min(image.dims[2], 16 * (at[2] + 1)); ++z) {
      for (int64_t y = 0; y < image.dims[1]; ++y) {
        std::copy_n(from + (z * image.dims[1] + y) * image.dims[0], image.dims[0],
                    static_cast<float*>(voxels) + ((z - 16 * at[2]) * 64 + y) * 64);
      }
    }
    return 0;
  };
  const pellicle::Volume volume(context, bricks);
  CHECK(pellicle::extract(context, volume, s.parameters).hash() ==
        pellicle::extract(context, s.image, s.parameters).hash());
  CHECK(volume.brick_counts().bricks == 2);
  CHECK(status_of([&] {
          const pellicle::Volume plain(context, s.image);
          (void)plain.brick_counts();
        }) == PLC_INVALID_ARGUMENT);
  bricks.fetch = nullptr;
  CHECK(status_of([&] { const pellicle::Volume none(context, bricks); }) == PLC_INVALID_ARGUMENT);
}

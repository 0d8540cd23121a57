// The same bits for any number of threads and any SIMD target, and on any machine.
#include <catch2/catch.hpp>
#include <tuple>
#include <vector>

#include "engine/mesh/state_hash.h"
#include "engine/pellicle.h"
#include "tests/samples/sample_traces.h"

namespace {

using plc::Mesh;
using plc::SimdTarget;
using samples::Run;
using samples::Trace;

#if defined(__SANITIZE_THREAD__)
// Hundreds of times slower; whether threads race does not depend on the target.
constexpr int kThreads[] = {8};
std::vector<SimdTarget> targets() {
  return {plc::best_simd_target()};
}
#else
constexpr int kThreads[] = {1, 2, 3, 8};
std::vector<SimdTarget> targets() {
  return plc::available_simd_targets();
}
#endif

plc_simd api_target(SimdTarget target) {
  switch (target) {
    case SimdTarget::kScalar:
      return PLC_SIMD_SCALAR;
    case SimdTarget::kSse4:
      return PLC_SIMD_SSE4;
    case SimdTarget::kAvx2:
      return PLC_SIMD_AVX2;
    case SimdTarget::kAvx512:
      return PLC_SIMD_AVX512;
    case SimdTarget::kNeon:
      return PLC_SIMD_NEON;
    case SimdTarget::kWasm:
      return PLC_SIMD_WASM;
  }
  return PLC_SIMD_AUTO;
}

struct Result {
  uint64_t hash = 0;
  plc_measures measures{};
};

Result extract(const samples::Volume& volume, const plc_parameters& parameters, int threads,
               SimdTarget target) {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = threads;
  options.simd = api_target(target);
  plc_context* context = nullptr;
  REQUIRE(plc_context_create(&options, &context, nullptr, 0) == PLC_OK);
  plc_image image;
  plc_image_defaults(&image);
  image.type = PLC_F32;
  image.voxels = volume.values.data();
  for (size_t a = 0; a < 3; ++a) {
    image.dims[a] = volume.dims[a];
    image.spacing[a] = volume.spacing[a];
  }
  plc_surface* surface = nullptr;
  const plc_status status = plc_extract(context, &image, &parameters, nullptr, &surface);
  INFO(plc_context_message(context));
  REQUIRE(status == PLC_OK);
  Result result;
  result.hash = plc_surface_hash(surface);
  result.measures.struct_size = sizeof result.measures;
  REQUIRE(plc_surface_measure(context, surface, PLC_SPACE_VOXEL, &result.measures) == PLC_OK);
  plc_surface_destroy(surface);
  plc_context_destroy(context);
  return result;
}

// The chain of 3.9 with its parameters; nothing that is derived from the image.
plc_parameters chain_parameters() {
  plc_parameters p;
  plc_parameters_defaults(&p);
  p.iso = 0.5;
  p.window_low = 0;
  p.window_high = 1;
  p.levels = 1;
  p.level_iso_count = 2;
  p.level_iso[0] = 0.4;
  p.level_iso[1] = 0.5;
  p.curvature = 0.1;
  p.spring = 0.01;
  return p;
}

// Blobs that are hollow where they are densest: what shrink-wrapping leaves to late bubbles.
samples::Volume hollow_blobs(std::array<int64_t, 3> dims) {
  samples::Volume all = samples::blobs(samples::empty_volume(dims), 24, 3);
  for (float& value : all.values) {
    if (value > 0.75F) value = std::max(0.0F, value - (value - 0.75F) * 5);
  }
  samples::add_noise(all, 0.05, 9);
  return all;
}

// Large enough for the parallel path, through two levels: sleepers beside moving vertices, cuts and
// joins, late bubbles.
Run large_run() {
  Run run = samples::make_run("hollow blobs", hollow_blobs({64, 64, 64}), 0.4, 1);
  run.recovery.max_iterations = 110;
  run.recovery.epsilon = 1e-4;
  return run;
}

// Longer edges: delta, by which late bubbles are brought to the mesh's, is far from 1.
Run long_edges_run() {
  Run run = large_run();
  run.name = "long edges";
  run.recovery.scale.edges = 1.8;
  return run;
}

// With every other force, attachments and pins, which go by other kernels and passes.
Run forces_run() {
  Run run = samples::make_run("forces", samples::blobs(samples::empty_volume({64, 64, 64}), 24, 3),
                              0.4, 0);
  run.recovery.max_iterations = 12;
  run.recovery.model.spring = 0.01F;
  run.recovery.model.gradient_normal = 0.1F;
  run.recovery.model.gradient_tangent = 0.05F;
  run.recovery.user.attachments = {{{20, 32, 32}, 12, 0.5F}};
  run.recovery.user.pins = {{{44, 32, 32}, 10}};
  run.recovery.model.bound = plc::Bound::kScale;
  run.recovery.scale.anisotropy = plc::Anisotropy::kMetric;
  run.volume.spacing = {1, 1.2, 1.5};
  return run;
}

// Sizes from a half to four times delta.
Run adaptive_run() {
  Run run = large_run();
  run.name = "adaptive";
  run.recovery.sizes.emplace();
  return run;
}

uint64_t hash_of(const Run& run, int threads, SimdTarget target) {
  const plc::Schedule schedule(threads, target);
  Mesh mesh;
  std::vector<plc::LevelRecord> records;
  REQUIRE(plc::pyramidal_recover_shape(samples::pyramid_of(run, schedule), run.recovery, schedule,
                                       {}, mesh, records)
              .message() == "");
  return plc::state_hash(mesh);
}

}  // namespace

TEST_CASE("the chain has the recorded hash for any threads and SIMD target", "[determinism]") {
  const samples::Volume chain = samples::chain_potential(samples::empty_volume({40, 40, 40}));
  const plc_parameters parameters = chain_parameters();
  // Recorded: tells machines and compilers apart that round differently. A change of the engine
  // that changes results on purpose records it anew.
  constexpr uint64_t kGolden = 0x80B31EE57EF71E74;
  for (const SimdTarget target : targets()) {
    for (const int threads : kThreads) {
      for (int repeat = 0; repeat < (threads == 1 ? 1 : 2); ++repeat) {
        const Result result = extract(chain, parameters, threads, target);
        CAPTURE(plc::simd_target_name(target), threads, repeat);
        CHECK(result.hash == kGolden);
        CHECK(result.measures.components == 2);
        CHECK(result.measures.genus == 2);
      }
    }
  }
}

TEST_CASE("large runs, uniform and adaptive, have the recorded hashes, run after run",
          "[determinism]") {
  const auto [run, golden] = GENERATE(table<Run, uint64_t>({{large_run(), 0x18B5AD5336899FDC},
                                                            {long_edges_run(), 0x1045A07EFAD9A68C},
                                                            {adaptive_run(), 0x3A720D8604AE5FB3}}));
  for (const SimdTarget target : targets()) {
    for (const int threads : kThreads) {
      for (int repeat = 0; repeat < (threads == 3 ? 2 : 1); ++repeat) {
        CAPTURE(run.name, plc::simd_target_name(target), threads, repeat);
        CHECK(hash_of(run, threads, target) == golden);
      }
    }
  }
}

TEST_CASE("a run with every force has the recorded hash for any threads and SIMD target",
          "[determinism]") {
  const Run run = forces_run();
  constexpr uint64_t kGolden = 0x5AE46337ACB45C4E;
  for (const SimdTarget target : targets()) {
    for (const int threads : kThreads) {
      CAPTURE(plc::simd_target_name(target), threads);
      CHECK(hash_of(run, threads, target) == kGolden);
    }
  }
}

TEST_CASE("no pass of a large run tells one scalar thread from three of the best target",
          "[determinism]") {
  const Run run = large_run();
  const Trace one = samples::traced(run, 1, SimdTarget::kScalar);
  // What this run is for.
  CHECK(one.most_beside_asleep > 4 * plc::kGrain);
  plc::OperationCounts operations;
  int64_t late = 0;
  for (const plc::LevelRecord& record : one.records) {
    operations.annular += record.operations.annular;
    operations.axial += record.operations.axial;
    operations.inversion += record.operations.inversion;
    late += record.late.bubbles + record.late.cavities;
  }
  CHECK(operations.annular > 0);
  CHECK(operations.axial > 0);
  CHECK(operations.inversion > 0);
  CHECK(late > 0);
  CHECK(samples::first_difference(one, samples::traced(run, 3, plc::best_simd_target())) == "");
}

TEST_CASE("no pass of a run with every force tells one scalar thread from three of the best target",
          "[determinism]") {
  const Run run = forces_run();
  const Trace one = samples::traced(run, 1, SimdTarget::kScalar);
  CHECK(one.most_awake > 4 * plc::kGrain);
  CHECK(samples::first_difference(one, samples::traced(run, 3, plc::best_simd_target())) == "");
}

TEST_CASE("no pass of random runs tells one scalar thread from three of the best target",
          "[determinism]") {
  int compared = 0;
  int64_t reverted = 0;
  for (uint64_t seed = 1000; compared < 6; ++seed) {
    Run run = samples::random_run(seed);
    run.recovery.max_iterations = 30;
    const plc::Pyramid pyramid = samples::pyramid_of(run);
    Mesh mesh;
    std::vector<plc::LevelRecord> records;
    const plc::Schedule schedule(1, SimdTarget::kScalar);
    if (!plc::pyramidal_recover_shape(pyramid, run.recovery, schedule, {}, mesh, records).ok()) {
      continue;  // the object is lost
    }
    ++compared;
    for (const plc::LevelRecord& record : records) reverted += record.operations.reverted;
    INFO(run.name);
    CHECK(samples::first_difference(samples::traced(run, 1, SimdTarget::kScalar),
                                    samples::traced(run, 3, plc::best_simd_target())) == "");
  }
  CHECK(reverted > 0);
}

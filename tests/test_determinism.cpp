// The same bits for any number of threads and any SIMD target, and on any machine.
#include <catch2/catch.hpp>

#include "engine/pellicle.h"
#include "engine/state_hash.h"
#include "tests/sample_runs.h"

namespace {

using plc::Mesh;
using plc::SimdTarget;
using samples::Run;

constexpr int kThreads[] = {1, 2, 3, 8};

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
  p.level_iso[0] = 0.5;
  p.level_iso[1] = 0.4;
  p.curvature = 0.1;
  p.spring = 0.01;
  return p;
}

// A run's state after every iteration.
struct Trace {
  std::vector<uint64_t> hashes;
  uint32_t most_vertices = 0;
};

Trace traced(const Run& run, int threads, SimdTarget target) {
  const plc::Schedule schedule(threads);
  const plc::Pyramid pyramid = samples::pyramid_of(run, schedule);
  Mesh mesh;
  Trace trace;
  const auto record = [&](const plc::RecoveryProgress&) {
    trace.hashes.push_back(plc::state_hash(mesh));
    trace.most_vertices = std::max(trace.most_vertices, mesh.vertex_count());
    return true;
  };
  std::vector<plc::LevelRecord> records;
  REQUIRE(plc::pyramidal_recover_shape(pyramid, run.recovery, schedule, target, {record, {}}, mesh,
                                       records)
              .ok());
  trace.hashes.push_back(plc::state_hash(mesh));
  return trace;
}

// The first iteration after which they differ, from 1; 0: none.
size_t first_difference(const Trace& a, const Trace& b) {
  for (size_t i = 0; i < std::max(a.hashes.size(), b.hashes.size()); ++i) {
    if (i >= a.hashes.size() || i >= b.hashes.size() || a.hashes[i] != b.hashes[i]) return i + 1;
  }
  return 0;
}

Run blobs_run() {
  Run run = samples::make_run("blobs", samples::blobs(samples::empty_volume({64, 64, 64}), 24, 3),
                              0.4, 0);
  run.recovery.max_iterations = 20;
  return run;
}

}  // namespace

TEST_CASE("the chain has the recorded hash for any threads and SIMD target", "[determinism]") {
  const samples::Volume chain = samples::chain_potential(samples::empty_volume({40, 40, 40}));
  const plc_parameters parameters = chain_parameters();
  // Recorded: tells machines and compilers apart that round differently. A change of the engine
  // that changes results on purpose records it anew.
  constexpr uint64_t kGolden = 0x585C2157E9BC1234;
  for (const SimdTarget target : plc::available_simd_targets()) {
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

TEST_CASE("a mesh that is evolved in parallel has one hash for any threads and SIMD target",
          "[determinism]") {
  const samples::Volume blobs = samples::blobs(samples::empty_volume({64, 64, 64}), 24, 3);
  plc_parameters parameters;
  plc_parameters_defaults(&parameters);
  parameters.iso = 0.4;
  parameters.levels = 1;
  parameters.max_iterations = 10;
  const Result first = extract(blobs, parameters, 1, SimdTarget::kScalar);
  REQUIRE(first.measures.vertices > plc::kSerialBelow);
  for (const SimdTarget target : plc::available_simd_targets()) {
    for (const int threads : kThreads) {
      const Result result = extract(blobs, parameters, threads, target);
      CAPTURE(plc::simd_target_name(target), threads);
      CHECK(result.hash == first.hash);
    }
  }
}

TEST_CASE("runs of one and of three threads agree after every iteration", "[determinism]") {
  const Run run = blobs_run();
  const Trace one = traced(run, 1, plc::best_simd_target());
  REQUIRE(one.most_vertices > plc::kSerialBelow);
  for (int repeat = 0; repeat < 2; ++repeat) {
    const Trace three = traced(run, 3, plc::best_simd_target());
    INFO("first difference after iteration " << first_difference(one, three));
    CHECK(first_difference(one, three) == 0);
  }
}

TEST_CASE("runs on every SIMD target agree with the scalar one after every iteration",
          "[determinism]") {
  const Run run = blobs_run();
  const Trace scalar = traced(run, 2, SimdTarget::kScalar);
  for (const SimdTarget target : plc::available_simd_targets()) {
    const Trace other = traced(run, 2, target);
    INFO(plc::simd_target_name(target)
         << ": first difference after iteration " << first_difference(scalar, other));
    CHECK(first_difference(scalar, other) == 0);
  }
}

TEST_CASE("random runs agree after every iteration for any threads", "[determinism]") {
  int compared = 0;
  for (uint64_t seed = 1000; compared < 6; ++seed) {
    Run run = samples::random_run(seed);
    run.recovery.max_iterations = 30;
    const plc::Pyramid pyramid = samples::pyramid_of(run);
    Mesh mesh;
    std::vector<plc::LevelRecord> records;
    const plc::Schedule schedule(1);
    if (!plc::pyramidal_recover_shape(pyramid, run.recovery, schedule, SimdTarget::kScalar, {},
                                      mesh, records)
             .ok()) {
      continue;  // the object is lost
    }
    ++compared;
    INFO(run.name);
    CHECK(first_difference(traced(run, 1, SimdTarget::kScalar),
                           traced(run, 3, plc::best_simd_target())) == 0);
  }
}

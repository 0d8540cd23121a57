// The movement part of a step: each kernel, and Dynamics::step, per SIMD target. Times are per
// vertex. Before a kernel is timed its output is compared with that of its scalar twin; where they
// differ the program ends with an error.
//   build/perf/bench_kernels --benchmark_filter=laplacian --benchmark_repetitions=9
#include <benchmark/benchmark.h>

#include <ctime>
#include <string>

#include "engine/motion/dynamics.h"
#include "perf/bench_table.h"

namespace {

using bench::Bench;
using bench::Kernel;
using plc::SimdTarget;

Bench& shared_bench() {
  static Bench bench;
  return bench;
}

uint64_t hash_of(Bench& b, const Kernel& kernel, SimdTarget simd) {
  b.reset();
  kernel(b, simd);
  return b.hash();
}

void time_kernel(benchmark::State& state, const std::string& name, const Kernel& kernel,
                 SimdTarget simd) {
  Bench& b = shared_bench();
  const uint64_t hash = hash_of(b, kernel, simd);
  if (const uint64_t twin = hash_of(b, kernel, SimdTarget::kScalar); hash != twin) {
    std::cerr << "bench_kernels: " << name << ": " << plc::simd_target_name(simd)
              << " has other bits than the scalar twin: " << std::hex << hash << ", " << twin
              << '\n';
    std::exit(1);
  }
  for (auto _ : state) kernel(b, simd);
  const auto vertices = static_cast<double>(b.mesh.vertex_count());
  state.counters["vertex"] = benchmark::Counter(
      vertices, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.SetLabel(std::to_string(hash));
}

constexpr int kSteps = 10;

// Of this thread: what other programs take of the machine does not count. With several threads
// there is only the clock on the wall.
double seconds_of(int threads) {
  timespec t{};
  clock_gettime(threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Hash after kSteps steps; `took` is their time in seconds.
uint64_t run_steps(Bench& b, plc::Dynamics& dynamics, int threads, double& took) {
  b.reset();
  const plc::Guide guide = bench::guide_of(b.image);
  plc::Seconds seconds;
  const double begin = seconds_of(threads);
  for (int i = 0; i < kSteps; ++i) {
    if (!dynamics.step(guide, seconds).ok()) std::exit(1);
  }
  took = seconds_of(threads) - begin;
  b.sum = dynamics.energy() + dynamics.speed();
  return b.hash();
}

void time_step(benchmark::State& state, Bench& b, SimdTarget simd, int threads,
               const plc::Model& model) {
  double took = 0;
  const plc::Schedule one(1, SimdTarget::kScalar), many(threads, simd);
  plc::Dynamics scalar(b.mesh, one, model);
  plc::Dynamics dynamics(b.mesh, many, model);
  const uint64_t twin = run_steps(b, scalar, 1, took);
  uint64_t hash = 0;
  for (auto _ : state) {
    hash = run_steps(b, dynamics, threads, took);
    state.SetIterationTime(took);
  }
  if (hash != twin) {
    std::cerr << "bench_kernels: step: " << plc::simd_target_name(simd) << " on " << threads
              << " threads has other bits than scalar on one: " << std::hex << hash << ", " << twin
              << '\n';
    std::exit(1);
  }
  const auto vertices = static_cast<double>(b.mesh.vertex_count());
  state.counters["vertex"] =
      benchmark::Counter(vertices * kSteps, benchmark::Counter::kIsIterationInvariantRate |
                                                benchmark::Counter::kInvert);
  state.counters["vertices"] = vertices;
  state.SetLabel(std::to_string(hash));
}

void add_step(const std::string& name, Bench& (*bench)(), SimdTarget simd, int threads,
              const plc::Model& model) {
  const std::string full =
      name + "/" + std::string(plc::simd_target_name(simd)) + "/threads:" + std::to_string(threads);
  benchmark::RegisterBenchmark(
      full.c_str(),
      [=](benchmark::State& state) { time_step(state, bench(), simd, threads, model); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

// Meshes of about 100,000 / Divisor vertices.
template <int kDivisor>
Bench& small_bench() {
  static Bench bench(std::sqrt(static_cast<double>(kDivisor)));
  return bench;
}

// Of curvature and image alone, with the time step that the published results are of.
constexpr plc::Model kModel{.time_step = 1};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  static const bench::Table table = bench::kernel_table();
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const auto& entry : table) {
      const std::string full = entry.first + "/" + std::string(plc::simd_target_name(simd));
      benchmark::RegisterBenchmark(full.c_str(), [&entry, simd](benchmark::State& state) {
        time_kernel(state, entry.first, entry.second, simd);
      })->Unit(benchmark::kMillisecond);
    }
    plc::Model springs = kModel;
    springs.spring = 0.01F;
    add_step("step", shared_bench, simd, 1, kModel);
    add_step("step_springs", shared_bench, simd, 1, springs);
  }
  const SimdTarget best = plc::best_simd_target();
  for (const int threads : {1, 2}) {
    add_step("step_all", shared_bench, best, threads, kModel);
    add_step("step_8th", small_bench<8>, best, threads, kModel);
    add_step("step_20th", small_bench<20>, best, threads, kModel);
    add_step("step_40th", small_bench<40>, best, threads, kModel);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

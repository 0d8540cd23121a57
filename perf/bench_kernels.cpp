// The movement part of a step: each kernel, and Dynamics::step, per SIMD target. Times are per
// vertex. Before a kernel is timed its output is compared with that of its scalar twin; where they
// differ the program ends with an error.
//   build/perf/bench_kernels --benchmark_filter=laplacian --benchmark_repetitions=9
#include <benchmark/benchmark.h>

#include <bit>
#include <ctime>
#include <functional>
#include <string>
#include <utility>

#include "engine/motion/dynamics.h"
#include "kernels/guided_stage.h"
#include "kernels/image_force.h"
#include "kernels/integrate.h"
#include "kernels/ring_forces.h"
#include "perf/bench_mesh.h"
#include "pyramid/memory.h"

namespace {

using plc::Buffer;
using plc::Float4;
using plc::Mesh;
using plc::SimdTarget;
using plc::Streams3;
namespace kernels = plc::kernels;

// FNV-1a over 4-byte words.
class Hash {
 public:
  void add(uint32_t word) { hash_ = (hash_ ^ word) * 0x100000001B3U; }
  void add(float value) { add(std::bit_cast<uint32_t>(value)); }
  void add(double value) {
    const auto bits = std::bit_cast<uint64_t>(value);
    add(static_cast<uint32_t>(bits));
    add(static_cast<uint32_t>(bits >> 32U));
  }
  void add(const Buffer<float>& values) {
    for (const float v : values) add(v);
  }
  void add(const Streams3& s) { add(s.x), add(s.y), add(s.z); }
  void add(const Buffer<Float4>& records) {
    for (const Float4& r : records) add(r.x), add(r.y), add(r.z), add(r.w);
  }
  uint64_t value() const { return hash_; }

 private:
  uint64_t hash_ = 0xCBF29CE484222325U;
};

kernels::Float3s raw(Streams3& s) {
  return {s.x.data(), s.y.data(), s.z.data()};
}
kernels::ConstFloat3s raw(const Streams3& s) {
  return {s.x.data(), s.y.data(), s.z.data()};
}

// The mesh, and one of every stream that kernels write.
struct Bench {
  bench::Image image;
  Mesh mesh;
  Streams3 force, speed, rate, moved;
  Buffer<Float4> laplacian, stage;
  Streams3 start_velocity;
  Buffer<Float4> start;
  plc::Vector<uint32_t> list;
  double sum = 0;

  explicit Bench(double shrink = 1) : mesh(bench::evolved_mesh(image, shrink)) {
    for (Streams3* s : {&force, &speed, &rate, &moved}) s->resize(n());
    for (Buffer<Float4>* b : {&laplacian, &stage}) b->resize(n());
    start = mesh.position;
    start_velocity = mesh.velocity;
    for (uint32_t i = 0; i < n() / plc::kRingLanes; ++i) list.push_back(i);
  }
  uint32_t n() const { return mesh.padded(); }
  plc::Blocks all() const { return plc::Blocks::range(0, n()); }
  plc::Blocks listed() const { return {list.data(), list.size()}; }
  // As at the start.
  void reset() {
    std::fill(stage.begin(), stage.end(), Float4{});
    for (Streams3* s : {&force, &speed, &rate, &moved}) {
      for (Buffer<float>* b : {&s->x, &s->y, &s->z}) std::fill(b->begin(), b->end(), 0.25F);
    }
    for (uint32_t v = 0; v < n(); ++v) {
      mesh.place(v, {start[v].x, start[v].y, start[v].z});
      mesh.velocity.set(v, start_velocity.at(v));
      mesh.path[v] = 0;
    }
    kernels::normals_and_laplacian(SimdTarget::kScalar, mesh.rings(), start.data(), all(),
                                   raw(mesh.normal), laplacian.data());
    sum = 0;
  }
  uint64_t hash() const {
    Hash h;
    for (const Streams3* s : {&force, &speed, &rate, &moved, &mesh.normal, &mesh.velocity}) {
      h.add(*s);
    }
    for (const Buffer<Float4>* b : {&laplacian, &stage, &mesh.position}) h.add(*b);
    h.add(mesh.path);
    h.add(sum);
    return h.value();
  }
};

Bench& shared_bench() {
  static Bench bench;
  return bench;
}

using Kernel = std::function<void(Bench&, SimdTarget)>;

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

kernels::Rk4Streams rk4(Bench& b) {
  return {b.start.data(), raw(std::as_const(b.start_velocity)),
          raw(b.speed),   raw(b.moved),
          raw(b.rate),    b.stage.data()};
}
kernels::SurfaceForces forces(Bench& b) {
  return {b.mesh.rings(), b.laplacian.data(), 0.4F,
          b.image.view(), b.start.data(),     raw(std::as_const(b.mesh.normal)),
          -0.8F,          bench::Image::kIso};
}
kernels::MoveStreams ends(Bench& b) {
  return {b.start.data(),       b.mesh.position.data(),
          raw(b.mesh.velocity), raw(std::as_const(b.mesh.normal)),
          b.mesh.path.data(),   b.mesh.turns.data()};
}
constexpr kernels::Rk4Coefficients kNewton{1, 0.5F, 1};
constexpr kernels::MoveBound kBound{0.3F, 0.3F, 20, 10};

using Table = std::vector<std::pair<std::string, Kernel>>;

void add_ring_kernels(Table& table) {
  table.emplace_back("laplacian", [](Bench& b, SimdTarget simd) {
    kernels::laplacian(simd, b.mesh.rings(), b.start.data(), b.all(), b.laplacian.data());
  });
  // The same through a list of all blocks.
  table.emplace_back("laplacian_listed", [](Bench& b, SimdTarget simd) {
    kernels::laplacian(simd, b.mesh.rings(), b.start.data(), b.listed(), b.laplacian.data());
  });
  table.emplace_back("normals", [](Bench& b, SimdTarget simd) {
    Streams3& n = b.mesh.normal;
    kernels::normals(simd, b.mesh.rings(), b.start.data(), b.all(), raw(n));
  });
  table.emplace_back("normals_and_laplacian", [](Bench& b, SimdTarget simd) {
    Streams3& n = b.mesh.normal;
    kernels::normals_and_laplacian(simd, b.mesh.rings(), b.start.data(), b.all(), raw(n),
                                   b.laplacian.data());
  });
  table.emplace_back("curvature_force", [](Bench& b, SimdTarget simd) {
    kernels::curvature_force(simd, b.mesh.rings(), b.laplacian.data(), 0.4F, 0, b.n(),
                             raw(b.force));
  });
  table.emplace_back("spring_force", [](Bench& b, SimdTarget simd) {
    kernels::spring_force(simd, b.mesh.rings(), b.start.data(), {0.01F, 1.2F}, 0, b.n(),
                          raw(b.force));
  });
}

void add_motion_kernels(Table& table) {
  table.emplace_back("iso_force", [](Bench& b, SimdTarget simd) {
    Streams3& n = b.mesh.normal;
    kernels::iso_force(simd, b.image.view(), b.start.data(), raw(n), {-0.8F, bench::Image::kIso}, 0,
                       b.n(), raw(b.force));
  });
  for (const int stage : {0, 1, 3}) {
    table.emplace_back("rk4_stage_" + std::to_string(stage), [stage](Bench& b, SimdTarget simd) {
      kernels::rk4_stage(simd, stage, kNewton, rk4(b), raw(std::as_const(b.force)), b.all());
    });
    table.emplace_back("guided_stage_" + std::to_string(stage), [stage](Bench& b, SimdTarget simd) {
      kernels::guided_stage(simd, stage, kNewton, forces(b), rk4(b), b.all());
    });
  }
  table.emplace_back("guided_stage_listed", [](Bench& b, SimdTarget simd) {
    kernels::guided_stage(simd, 1, kNewton, forces(b), rk4(b), b.listed());
  });
  table.emplace_back("guided_move", [](Bench& b, SimdTarget simd) {
    b.sum = kernels::guided_move(simd, kNewton, forces(b), rk4(b), kBound, ends(b), b.all()).energy;
  });
  table.emplace_back("move", [](Bench& b, SimdTarget simd) {
    b.sum = kernels::move(simd, kBound, raw(b.moved), raw(std::as_const(b.rate)), ends(b), b.all())
                .energy;
  });
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
  static Table table;
  add_ring_kernels(table);
  add_motion_kernels(table);
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

// The passes of an iteration, and what is around it, one by one, on bone of the head CT (or the
// volume that is given, at 226):
//   bench_passes [VOLUME] [options of Google Benchmark]
// Every repetition starts from the same state. Each benchmark is labelled with the hash of what it
// computed, which must be the same over repetitions and numbers of threads: if not, the program
// fails. "calm" is a converged surface on which next to nothing is to be done, "moving" the same
// one ten iterations into its level.
#include <benchmark/benchmark.h>

#include <cinttypes>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <numeric>
#include <thread>

#include "engine/base/blocks.h"
#include "engine/recover/evolution.h"
#include "engine/resolve/refinement.h"
#include "engine/start/missed_places.h"
#include "kernels/ring_forces.h"
#include "perf/bench_head.h"
#include "pyramid/memory.h"
#include "tools/file/failure.h"

namespace {

using bench::copy_mesh;
using bench::hash_of;
using bench::Head;
using plc::Mesh;
using plc::Schedule;

// The hash of each benchmark, whatever the threads.
class Results {
 public:
  void check(benchmark::State& state, const std::string& name, uint64_t hash) {
    const auto [known, first] = hashes_.emplace(name, hash);
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, hash);
    state.SetLabel(text);
    if (first || known->second == hash) return;
    failed_ = true;
    state.SkipWithError("the result differs from that of another repetition or thread count");
  }
  bool failed() const { return failed_; }

 private:
  std::map<std::string, uint64_t> hashes_;
  bool failed_ = false;
};

// A mesh that goes back to a state before every repetition, and what passes need beside it.
struct Bench {
  Bench(const Mesh& start, int threads) : schedule(threads), from(start) { restore(); }
  void restore() { copy_mesh(from, mesh); }
  void wake() {
    for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.wake(v);
  }

  Schedule schedule;
  const Mesh& from;
  Mesh mesh;
};

// Adds benchmarks of `measured`, which returns seconds, for 1 thread and all: prepare() is not
// timed, neither is hash().
class Suite {
 public:
  Suite(Head& head, Results& results) : head_(head), results_(results) {}

  struct Case {
    std::function<void()> prepare;
    std::function<double()> measured;
    std::function<uint64_t()> hash;
  };

  void add(const std::string& name, const Mesh& start, std::function<Case(Bench&)> make) {
    const auto run = [this, name, &start, make = std::move(make)](benchmark::State& state) {
      Bench bench(start, static_cast<int>(state.range(0)));
      Case c = make(bench);
      // Buffers have their size after the first.
      c.prepare();
      c.measured();
      for ([[maybe_unused]] auto _ : state) {
        c.prepare();
        const double seconds = c.measured();
        state.SetIterationTime(seconds);
        results_.check(state, name, c.hash());
      }
      state.counters["vertices"] = start.vertex_count();
    };
    auto* registered = benchmark::RegisterBenchmark(name.c_str(), run);
    registered->ArgName("threads")->Arg(1)->UseManualTime()->Unit(benchmark::kMillisecond);
    registered->Iterations(3);
    if (const auto cores = std::thread::hardware_concurrency(); cores > 1) registered->Arg(cores);
  }

  Head& head() { return head_; }

 private:
  Head& head_;
  Results& results_;
};

// Seconds of body().
template <typename Body>
double timed(Body&& body) {
  const double start = plc::now();
  body();
  return plc::now() - start;
}

float cell_of(const Mesh& mesh) {
  return plc::kMinApart * static_cast<float>(mesh.delta);
}

uint64_t entries_hash(const Mesh& mesh, const plc::SpatialHash& hash) {
  uint64_t sum = bench::hash_bytes(nullptr, 0);
  const float r = cell_of(mesh);
  for (uint32_t v = 0; v < mesh.slots(); v += 61) {
    const plc::Vec3 p = mesh.at(v);
    uint64_t near = 0;  // a vertex may be seen twice
    uint32_t last = v;
    hash.visit_box(mesh, {p.x - r, p.y - r, p.z - r}, {p.x + r, p.y + r, p.z + r},
                   [&](uint32_t w, plc::Vec3) { near |= uint64_t{1} << (w % 64), last = w; });
    sum = bench::hash_bytes(&near, sizeof near, sum) + last;
  }
  return sum;
}

void add_hash_build(Suite& suite, const Mesh& start) {
  suite.add("hash_build", start, [](Bench& b) {
    auto hash = std::make_shared<plc::SpatialHash>();
    return Suite::Case{
        [] {},
        [&b, hash] { return timed([&] { hash->build(b.mesh, cell_of(b.mesh), b.schedule); }); },
        [&b, hash] { return entries_hash(b.mesh, *hash); }};
  });
}

void add_edges(Suite& suite, const Mesh& start) {
  suite.add("edge_violations", start, [](Bench& b) {
    auto flags = std::make_shared<plc::Buffer<uint8_t>>(b.mesh.padded());
    const auto measured = [&b, flags] {
      const auto delta = static_cast<float>(b.mesh.delta);
      const float least = delta * delta, most = plc::kMaxEdge * plc::kMaxEdge * least;
      const size_t count = b.mesh.padded() / plc::kRingLanes;
      const auto look = [&](size_t, size_t begin, size_t end) {
        const plc::Blocks part{nullptr, end - begin, static_cast<uint32_t>(begin), count - end};
        plc::kernels::edge_violations(b.schedule.simd(), b.mesh.rings(), b.mesh.position.data(),
                                      least, most, part, flags->data());
      };
      return timed([&] { plc::run_blocks(b.schedule, count, plc::kTaskBlocks, look); });
    };
    return Suite::Case{[] {}, measured,
                       [flags] { return bench::hash_bytes(flags->data(), flags->size()); }};
  });
}

// The whole movement, or only what is not normals: F of the paper's tables.
void add_dynamics(Suite& suite, const Mesh& start) {
  for (const bool whole : {false, true}) {
    suite.add(whole ? "movement" : "dynamics", start, [&suite, whole](Bench& b) {
      auto dynamics =
          std::make_shared<plc::Dynamics>(b.mesh, b.schedule, suite.head().recovery.model);
      const auto measured = [&suite, dynamics, whole] {
        plc::Seconds seconds;
        const double all = timed([&] { (void)dynamics->step(suite.head().guide, seconds).ok(); });
        return whole ? all : seconds.dynamics;
      };
      return Suite::Case{[&b] { b.restore(); }, measured, [&b] { return hash_of(b.mesh); }};
    });
  }
}

void search_all(plc::Detection& detection) {
  detection.list_all();
  detection.update_hash();
  detection.search();
}

// Constraints (1) to (3) of every vertex. What the motion guard looks for, too, after a movement is
// the pass `look`.
void add_resolution(Suite& suite, const std::string& name, const Mesh& start) {
  suite.add(name, start, [](Bench& b) {
    struct Parts {
      explicit Parts(Bench& bench)
          : detection(bench.mesh, bench.schedule),
            resolution(bench.mesh, bench.schedule, detection) {}
      plc::Detection detection;
      plc::Resolution resolution;
    };
    auto parts = std::make_shared<Parts>(b);
    const auto prepare = [&b, parts] {
      b.restore();
      parts->detection.restart();
      parts->resolution.restart();
    };
    const auto measured = [parts] {
      plc::OperationCounts counts;
      return timed([&] {
        parts->detection.search_near_all();
        parts->resolution.run(1, {}, counts);
      });
    };
    return Suite::Case{prepare, measured, [&b] { return hash_of(b.mesh); }};
  });
}

// Around every vertex, for constraint (3) and for the motion guard.
void add_look(Suite& suite, const Mesh& start) {
  suite.add("look", start, [](Bench& b) {
    auto detection = std::make_shared<plc::Detection>(b.mesh, b.schedule);
    const auto prepare = [&b, detection] {
      b.restore();
      detection->restart();
    };
    const auto measured = [detection] { return timed([&] { search_all(*detection); }); };
    const auto hash = [detection] {
      const auto& risk = detection->surroundings().at_risk();
      return bench::hash_bytes(risk.data(), risk.size() * sizeof(uint32_t));
    };
    return Suite::Case{prepare, measured, hash};
  });
}

// Without the look around the moved vertices.
void add_guard(Suite& suite, const Mesh& start) {
  suite.add("motion_guard", start, [&suite](Bench& b) {
    struct Parts {
      Parts(Bench& bench, const plc::Model& model)
          : dynamics(bench.mesh, bench.schedule, model),
            detection(bench.mesh, bench.schedule),
            guard(bench.mesh, bench.schedule) {}
      plc::Dynamics dynamics;
      plc::Detection detection;
      plc::MotionGuard guard;
      plc::Vector<uint32_t> blocks, back;
    };
    auto parts = std::make_shared<Parts>(b, suite.head().recovery.model);
    const auto prepare = [&b, &suite, parts] {
      b.restore();
      parts->detection.restart();
      plc::Seconds seconds;
      (void)parts->dynamics.step(suite.head().guide, seconds).ok();
      search_all(parts->detection);
      parts->back.clear();
      parts->blocks.resize(b.mesh.padded() / plc::kRingLanes);
      std::iota(parts->blocks.begin(), parts->blocks.end(), 0U);
    };
    const auto measured = [parts] {
      return timed([&] {
        parts->guard.find_folds(parts->blocks);
        parts->guard.assess(parts->detection.due(), parts->detection.surroundings().at_risk());
        parts->guard.take_back(parts->dynamics.before(), parts->detection.hash(), parts->back);
      });
    };
    return Suite::Case{prepare, measured, [&b] { return hash_of(b.mesh); }};
  });
}

// Every face against all others.
void add_meeting(Suite& suite, const Mesh& start) {
  suite.add("meeting_search", start, [](Bench& b) {
    auto search = std::make_shared<plc::MeetingSearch>();
    const auto measured = [&b, search] {
      return timed([&] {
        search->find(b.mesh.rings(), b.mesh.slots(), b.mesh.position.data(), nullptr, b.schedule);
      });
    };
    const auto hash = [search] {
      return bench::hash_bytes(search->face(0), search->face_count() * 3 * sizeof(uint32_t));
    };
    return Suite::Case{[] {}, measured, hash};
  });
}

void add_topology(Suite& suite, const Mesh& start) {
  suite.add("renumber", start, [](Bench& b) {
    return Suite::Case{[&b] { b.restore(); },
                       [&b] { return timed([&] { b.mesh.renumber(plc::morton_order(b.mesh)); }); },
                       [&b] { return hash_of(b.mesh); }};
  });
  suite.add("refinement", start, [](Bench& b) {
    return Suite::Case{[&b] { b.restore(); },
                       [&b] { return timed([&] { plc::refine(b.mesh, b.schedule); }); },
                       [&b] { return hash_of(b.mesh); }};
  });
}

// One whole iteration, every vertex awake.
void add_iteration(Suite& suite, const std::string& name, const Mesh& start) {
  suite.add(name, start, [&suite](Bench& b) {
    auto evolution =
        std::make_shared<plc::Evolution>(b.mesh, b.schedule, suite.head().recovery.model);
    const auto prepare = [&b, evolution] {
      b.restore();
      b.wake();
      evolution->restart();
    };
    const auto measured = [&suite, evolution] {
      plc::Seconds seconds;
      plc::OperationCounts counts;
      return timed([&] { (void)evolution->iterate(suite.head().guide, seconds, counts).ok(); });
    };
    return Suite::Case{prepare, measured, [&b] { return hash_of(b.mesh); }};
  });
}

void add_missed_places(Suite& suite, const Mesh& start) {
  suite.add("missed_places", start, [&suite](Bench& b) {
    auto count = std::make_shared<std::array<int64_t, 2>>();
    const auto measured = [&suite, &b, count] {
      const plc::Guide& guide = suite.head().guide;
      const auto delta = static_cast<float>(b.mesh.delta);
      plc::VoxelSet tried;
      return timed([&] {
        *count = plc::find_missed_places(
                     b.mesh, {guide.image, guide.iso, true},
                     {3 * delta, plc::kSmallestBubble * delta, plc::kThinSheet * delta}, b.schedule,
                     tried, plc::whole_room(guide.image))
                     .count;
      });
    };
    return Suite::Case{[] {}, measured,
                       [count] { return bench::hash_bytes(count->data(), sizeof *count); }};
  });
}

// rho = sqrt 3, 3 levels.
void add_pyramid(Suite& suite, const Mesh& start) {
  suite.add("pyramid", start, [&suite](Bench& b) {
    auto pyramid = std::make_shared<plc::Pyramid>();
    const auto measured = [&suite, &b, pyramid] {
      const Head& head = suite.head();
      return timed([&] {
        (void)plc::build_pyramid(head.ct.volume, head.pyramid_spec, b.schedule, *pyramid).ok();
      });
    };
    const auto hash = [pyramid] {
      uint64_t sum = bench::hash_bytes(nullptr, 0);
      for (const auto& level : pyramid->levels) {
        sum = bench::hash_bytes(level.values.data(), level.values.size() * sizeof(float), sum);
      }
      return sum;
    };
    return Suite::Case{[pyramid] { *pyramid = {}; }, measured, hash};
  });
}

void add_all(Suite& suite) {
  Head& head = suite.head();
  add_resolution(suite, "resolution_calm", head.calm);
  add_resolution(suite, "resolution_moving", head.moving);
  add_dynamics(suite, head.calm);
  add_iteration(suite, "iteration_calm", head.calm);
  add_iteration(suite, "iteration_moving", head.moving);
  add_hash_build(suite, head.calm);
  add_edges(suite, head.calm);
  add_look(suite, head.moving);
  add_guard(suite, head.moving);
  add_meeting(suite, head.calm);
  add_topology(suite, head.moving);
  add_missed_places(suite, head.calm);
  add_pyramid(suite, head.calm);
}

}  // namespace

int main(int argc, char** argv) {
  std::string path = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3";
  if (argc > 1 && argv[1][0] != '-') {
    path = argv[1];
    for (int i = 2; i < argc; ++i) argv[i - 1] = argv[i];
    --argc;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    Head head(path, Schedule(static_cast<int>(std::thread::hardware_concurrency())));
    Results results;
    Suite suite(head, results);
    add_all(suite);
    benchmark::RunSpecifiedBenchmarks();
    return results.failed() ? 1 : 0;
  } catch (const plc::tools::Failure& failure) {
    std::cerr << "bench_passes: " << failure.message << '\n';
    return 1;
  }
}

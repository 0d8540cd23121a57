// What a host lends to a context: threads, memory, an ear for what the engine has to say.
#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cfenv>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"
#include "tests/samples/sample_hosts.h"
#include "tests/samples/sample_pools.h"

namespace {

using samples::Context;
using samples::Pool;
using samples::Surface;

Context context_of(const std::function<void(plc_context_options&)>& change) {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = 1;
  change(options);
  plc_context* context = nullptr;
  char error[200] = "";
  const plc_status status = plc_context_create(&options, &context, error, sizeof error);
  INFO(error);
  REQUIRE(status == PLC_OK);
  return Context(context);
}

// Large enough to take the parallel path, short enough for a test.
struct Job {
  samples::Volume volume = samples::ball({60, 60, 60});
  plc_image image = samples::image_of(volume);
  plc_parameters parameters = samples::parameters(0.1, 1);
  Job() { parameters.max_iterations = 12; }
  uint64_t hash(plc_context* context) const {
    return plc_surface_hash(samples::extract(context, image, parameters).get());
  }
};

// The host's allocator: counts, and gives no more after so many.
struct Heap {
  std::atomic<int64_t> given{0}, bytes{0}, most{0};
  std::atomic<int64_t> left{-1};  // allocations that still succeed; -1: all

  static void* allocate(size_t size, size_t alignment, void* user) {
    auto& heap = *static_cast<Heap*>(user);
    if (heap.left == 0) return nullptr;
    if (heap.left > 0) --heap.left;
    void* data = nullptr;
    if (posix_memalign(&data, alignment, size) != 0) return nullptr;
    ++heap.given;
    const int64_t now = heap.bytes += static_cast<int64_t>(size);
    if (now > heap.most) heap.most = now;
    return data;
  }
  static void release(void* data, size_t size, size_t, void* user) {
    static_cast<Heap*>(user)->bytes -= static_cast<int64_t>(size);
    std::free(data);
  }
  void lend(plc_context_options& options) {
    options.allocate = allocate;
    options.release = release;
    options.allocator_user = this;
  }
};

}  // namespace

TEST_CASE("a host's threads run every loop, and the bits are the same", "[pellicle_hosts]") {
  const Job job;
  const uint64_t expected = job.hash(samples::make_context(1).get());
  for (const auto hook : {samples::run_serially, samples::run_backwards, samples::run_on_threads}) {
    Pool pool;
    const Context context = context_of([&](plc_context_options& options) {
      options.threads = 0;
      options.parallel_for = hook;
      options.parallel_for_user = &pool;
    });
    CHECK(plc_context_threads(context.get()) == 0);
    CHECK(job.hash(context.get()) == expected);
    CHECK(pool.loops > 100);
    CHECK(pool.tasks > 2 * pool.loops);
  }
}

TEST_CASE("a host's memory is all given back, and is what the context counts", "[pellicle_hosts]") {
  const Job job;
  Heap heap;
  uint64_t hash = 0;
  {
    const Context context = context_of([&](plc_context_options& options) { heap.lend(options); });
    const Surface surface = samples::extract(context.get(), job.image, job.parameters);
    hash = plc_surface_hash(surface.get());
    int64_t now = 0, peak = 0;
    REQUIRE(plc_context_memory(context.get(), &now, &peak) == PLC_OK);
    CHECK(now == heap.bytes);
    CHECK(peak == heap.most);
    // The surface is there, the pyramid and the streams of the evolution are not.
    CHECK(now > 100 * plc_surface_vertex_count(surface.get()));
    CHECK(now < peak / 2);
  }
  CHECK(heap.given > 100);
  CHECK(heap.bytes == 0);
  CHECK(hash == job.hash(samples::make_context(1).get()));
}

TEST_CASE("a surface outlives its context, and its memory goes with it", "[pellicle_hosts]") {
  const Job job;
  Heap heap;
  Surface surface;
  {
    const Context context = context_of([&](plc_context_options& options) { heap.lend(options); });
    surface = samples::extract(context.get(), job.image, job.parameters);
  }
  CHECK(heap.bytes > 0);
  CHECK(samples::faces(surface.get(), PLC_SPACE_LPS).size() > 0);
  surface.reset();
  CHECK(heap.bytes == 0);
}

TEST_CASE("within its limit a context works, beyond it says that memory is out",
          "[pellicle_hosts]") {
  const Job job;
  int64_t peak = 0;
  {
    const Context context = samples::make_context(1);
    job.hash(context.get());
    REQUIRE(plc_context_memory(context.get(), nullptr, &peak) == PLC_OK);
  }
  const auto status_within = [&](int64_t limit) {
    const Context context =
        context_of([&](plc_context_options& options) { options.memory_limit = limit; });
    plc_surface* surface = nullptr;
    const plc_status status =
        plc_extract(context.get(), &job.image, &job.parameters, nullptr, &surface);
    plc_surface_destroy(surface);
    int64_t now = -1, most = 0;
    CHECK(plc_context_memory(context.get(), &now, &most) == PLC_OK);
    CHECK(now == 0);
    CHECK(most <= limit);
    return status;
  };
  CHECK(status_within(peak) == PLC_OK);
  CHECK(status_within(peak - peak / 10) == PLC_OUT_OF_MEMORY);
  CHECK(status_within(peak / 2) == PLC_OUT_OF_MEMORY);
  CHECK(status_within(1) == PLC_OUT_OF_MEMORY);
}

TEST_CASE("what memory has no room for is told with how much was asked for", "[pellicle_hosts]") {
  const Job job;
  const Context context =
      context_of([](plc_context_options& options) { options.memory_limit = 100000; });
  const auto message_of = [&](plc_ownership ownership) {
    plc_volume* volume = nullptr;
    const plc_status status = plc_volume_create(context.get(), &job.image, ownership, &volume);
    plc_volume_destroy(volume);
    CHECK((status == PLC_OUT_OF_MEMORY) == (ownership == PLC_COPY));
    return std::string(plc_context_message(context.get()));
  };
  CHECK_THAT(message_of(PLC_COPY),
             Catch::Matchers::StartsWith("out of memory: ") &&
                 Catch::Matchers::EndsWith(
                     " KiB were asked for, 0 bytes are in use, the limit is 98 KiB"));
  // The next call knows nothing of it.
  CHECK(message_of(PLC_BORROW) == "");
  // A step of the engine that says what it was about to do.
  std::string message;
  for (int64_t limit = 20000; !message.starts_with("pyramid of "); limit += limit / 8) {
    const Context context_with_limit =
        context_of([&](plc_context_options& options) { options.memory_limit = limit; });
    plc_surface* surface = nullptr;
    REQUIRE(plc_extract(context_with_limit.get(), &job.image, &job.parameters, nullptr, &surface) ==
            PLC_OUT_OF_MEMORY);
    message = plc_context_message(context_with_limit.get());
    CHECK_THAT(message, Catch::Matchers::Contains("out of memory: ") &&
                            Catch::Matchers::Contains("were asked for"));
  }
}

TEST_CASE("a context tells what it derives and how levels end", "[pellicle_hosts]") {
  struct Told {
    std::vector<std::string> lines;
    int warnings = 0;
    std::thread::id thread;
  } told;
  const auto listen = [](plc_log_level level, const char* line, void* user) {
    auto& t = *static_cast<Told*>(user);
    t.lines.emplace_back(line);
    t.warnings += level == PLC_LOG_WARNING ? 1 : 0;
    t.thread = std::this_thread::get_id();
  };
  const Context context = context_of([&](plc_context_options& options) {
    options.threads = 3;
    options.log = listen;
    options.log_user = &told;
  });
  const samples::Volume volume = samples::ball({24, 24, 24});
  plc_parameters p = samples::parameters(0.5, 2);
  samples::extract(context.get(), samples::image_of(volume), p);
  REQUIRE(told.lines.size() == 5);
  CHECK_THAT(told.lines[0], Catch::Matchers::Contains("window"));
  CHECK_THAT(told.lines[1], Catch::Matchers::StartsWith("expected: about "));
  CHECK_THAT(told.lines[2], Catch::Matchers::StartsWith("level 2: converged"));
  CHECK_THAT(told.lines[4], Catch::Matchers::StartsWith("level 0: converged"));
  CHECK(told.warnings == 0);
  CHECK(told.thread == std::this_thread::get_id());
  told = {};
  p.max_iterations = 3;
  samples::extract(context.get(), samples::image_of(volume), p);
  CHECK(told.warnings == 3);
  CHECK_THAT(told.lines[2], Catch::Matchers::Contains("not converged"));
}

TEST_CASE(
    "a surface out of proportion to the image is told before it is made, one that cannot be "
    "held is refused",
    "[pellicle_hosts]") {
  std::vector<std::string> warnings;
  const auto listen = [](plc_log_level level, const char* line, void* user) {
    if (level == PLC_LOG_WARNING) static_cast<std::vector<std::string>*>(user)->emplace_back(line);
  };
  // In millimetres of voxels of 1 x 1 x 8 every voxel of a surface has many vertices.
  samples::Volume volume = samples::empty_volume({12, 12, 12}, {1, 1, 8});
  volume.values.assign(12 * 12 * 12, 0);
  for (size_t i = 0; i < volume.values.size(); i += 2) volume.values[i] = 1;
  plc_parameters p = samples::parameters(0.5, 0);
  p.anisotropy = PLC_ANISOTROPY_PHYSICAL;
  p.max_iterations = 1;
  plc_image image = samples::image_of(volume);
  const auto status_within = [&](int64_t limit, std::string& message) {
    const Context context = context_of([&](plc_context_options& options) {
      options.log = listen;
      options.log_user = &warnings;
      options.memory_limit = limit;
    });
    plc_extras extras = samples::no_extras();
    extras.progress = [](const plc_progress*, void*) { return 1; };
    plc_surface* surface = nullptr;
    const plc_status status = plc_extract(context.get(), &image, &p, &extras, &surface);
    message = plc_context_message(context.get());
    return status;
  };
  std::string message;
  CHECK(status_within(0, message) == PLC_CANCELLED);
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Catch::Matchers::StartsWith("expected: about ") &&
                              Catch::Matchers::EndsWith("more than the image has voxels"));
  CHECK(status_within(300 << 10, message) == PLC_OUT_OF_MEMORY);
  CHECK_THAT(message, Catch::Matchers::StartsWith("the surface would have about ") &&
                          Catch::Matchers::EndsWith("MiB, more than there is"));
}

TEST_CASE("a level on which the surface vanishes is told as that, not as one that did not converge",
          "[pellicle_hosts]") {
  std::vector<std::string> lines;
  int warnings = 0;
  const auto listen = [](plc_log_level level, const char* line, void* user) {
    auto& [all, count] = *static_cast<std::pair<std::vector<std::string>*, int*>*>(user);
    all->emplace_back(line);
    *count += level == PLC_LOG_WARNING ? 1 : 0;
  };
  std::pair<std::vector<std::string>*, int*> told{&lines, &warnings};
  const Context context = context_of([&](plc_context_options& options) {
    options.log = listen;
    options.log_user = &told;
  });
  const samples::Volume volume = samples::ball({24, 24, 24});
  const plc_image image = samples::image_of(volume);
  plc_parameters p = samples::parameters(0.5, 0);
  p.spring = 20;  // pulls every bubble to a point
  p.rest_length = PLC_REST_ZERO;
  p.late_bubbles = 0;
  plc_surface* made = nullptr;
  plc_extract(context.get(), &image, &p, nullptr, &made);
  const Surface surface(made);
  REQUIRE(!lines.empty());
  CHECK_THAT(lines.back(), Catch::Matchers::Contains("level 0: nothing is left of the surface"));
  CHECK(warnings == 0);
}

TEST_CASE("hooks that make no sense are refused", "[pellicle_hosts]") {
  plc_context_options options;
  plc_context_options_defaults(&options);
  char error[200] = "";
  plc_context* context = nullptr;
  options.allocate = Heap::allocate;
  CHECK(plc_context_create(&options, &context, error, sizeof error) == PLC_INVALID_ARGUMENT);
  CHECK(std::string(error) == "allocate, release: both or neither must be NULL");
  options.allocate = nullptr;
  options.memory_limit = -1;
  CHECK(plc_context_create(&options, &context, error, sizeof error) == PLC_INVALID_ARGUMENT);
  CHECK(std::string(error) == "memory limit -1: must not be negative");
}

TEST_CASE("a host that was built with an older header gets the rest at its default",
          "[pellicle_hosts]") {
  const samples::Volume volume = samples::ball({24, 24, 24});
  const plc_image image = samples::image_of(volume);
  const Context context = samples::make_context();
  plc_parameters p = samples::parameters(0.5, 1);
  const uint64_t expected = plc_surface_hash(samples::extract(context.get(), image, p).get());
  // As if sleeping had not been there yet.
  p.struct_size = offsetof(plc_parameters, sleeping);
  p.sleeping = 77;
  const Surface surface = samples::extract(context.get(), image, p);
  CHECK(plc_surface_hash(surface.get()) == expected);
  // And is told no more than it has room for.
  plc_parameters used{};
  used.struct_size = offsetof(plc_parameters, sleeping);
  used.sleeping = 77;
  REQUIRE(plc_surface_parameters(context.get(), surface.get(), &used) == PLC_OK);
  CHECK(used.struct_size == offsetof(plc_parameters, sleeping));
  CHECK(used.curvature == p.curvature);
  CHECK(used.sleeping == 77);
}

TEST_CASE("loops run whole where the host has cancelled the task that called", "[pellicle_hosts]") {
  const Job job;
  const Context context = context_of([](plc_context_options& options) { options.threads = 0; });
  const uint64_t expected = job.hash(samples::make_context(1).get());
  uint64_t hash = 0;
  oneapi::tbb::task_group_context group;
  oneapi::tbb::parallel_for(
      0, 1,
      [&](int) {
        group.cancel_group_execution();
        hash = job.hash(context.get());
      },
      group);
  CHECK(hash == expected);
}

TEST_CASE("results do not depend on how the host's threads compute, which is left as it was",
          "[pellicle_hosts]") {
  const Job job;
  const uint64_t expected = job.hash(samples::make_context(1).get());
  Pool pool;
  const Context lent = context_of([&](plc_context_options& options) {
    options.parallel_for = [](size_t tasks, plc_task_fn task, void* data, void* user) {
      // Those of a host differ from each other.
      std::pair<plc_task_fn, void*> whole(task, data);
      const auto rounded = [](size_t i, void* its) {
        const auto& [run, of_run] = *static_cast<std::pair<plc_task_fn, void*>*>(its);
        const int before = std::fegetround();
        std::fesetround(i % 2 == 0 ? FE_TOWARDZERO : FE_UPWARD);
        run(i, of_run);
        std::fesetround(before);
      };
      samples::run_on_threads(tasks, rounded, &whole, user);
    };
    options.parallel_for_user = &pool;
  });
  const Context own = samples::make_context(2);
  for (plc_context* context : {own.get(), lent.get()}) {
    std::fesetround(FE_DOWNWARD);
    const uint64_t hash = job.hash(context);
    const int rounding = std::fegetround();
    std::fesetround(FE_TONEAREST);
    CHECK(rounding == FE_DOWNWARD);
    CHECK(hash == expected);
  }
}

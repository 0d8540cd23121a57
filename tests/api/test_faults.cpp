// Every allocation failing in turn, and calls cancelled at every moment: a clear status, nothing
// leaked, and every handle still good for use.
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"
#include "tests/samples/sample_hosts.h"

namespace {

// All memory of a test: of operator new, and what the host lends to the context.
struct Faults {
  std::atomic<int64_t> live{0};   // allocations
  std::atomic<int64_t> count{0};  // since it was armed
  std::atomic<int64_t> fail{-1};  // the one that fails, from 0; -1: none
  std::atomic<bool> armed{false};

  // Not inlined: GCC would take what operator new gives for what free() must not have.
  [[gnu::noinline]] void* allocate(size_t size, size_t alignment) {
    if (armed && count++ == fail) return nullptr;
    void* data = nullptr;
    if (posix_memalign(&data, std::max(alignment, sizeof(void*)), std::max<size_t>(size, 1)) != 0) {
      return nullptr;
    }
    ++live;
    return data;
  }
  [[gnu::noinline]] void release(void* data) {
    if (data == nullptr) return;
    --live;
    std::free(data);
  }
};
Faults faults;

void* allocate_or_throw(size_t size, size_t alignment) {
  void* data = faults.allocate(size, alignment);
  if (data == nullptr) throw std::bad_alloc();
  return data;
}

void* lend(size_t size, size_t alignment, void*) {
  return faults.allocate(size, alignment);
}
void take_back(void* data, size_t, size_t, void*) {
  faults.release(data);
}

}  // namespace

// clang-format off
void* operator new(size_t size) { return allocate_or_throw(size, 16); }
void* operator new[](size_t size) { return allocate_or_throw(size, 16); }
void* operator new(size_t size, std::align_val_t a) { return allocate_or_throw(size, static_cast<size_t>(a)); }
void* operator new[](size_t size, std::align_val_t a) { return allocate_or_throw(size, static_cast<size_t>(a)); }
void* operator new(size_t size, const std::nothrow_t&) noexcept { return faults.allocate(size, 16); }
void* operator new[](size_t size, const std::nothrow_t&) noexcept { return faults.allocate(size, 16); }
void operator delete(void* data) noexcept { faults.release(data); }
void operator delete[](void* data) noexcept { faults.release(data); }
void operator delete(void* data, size_t) noexcept { faults.release(data); }
void operator delete[](void* data, size_t) noexcept { faults.release(data); }
void operator delete(void* data, std::align_val_t) noexcept { faults.release(data); }
void operator delete[](void* data, std::align_val_t) noexcept { faults.release(data); }
void operator delete(void* data, size_t, std::align_val_t) noexcept { faults.release(data); }
void operator delete[](void* data, size_t, std::align_val_t) noexcept { faults.release(data); }
// clang-format on

namespace {

using samples::Context;

Context lent_context() {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = 1;
  options.allocate = lend;
  options.release = take_back;
  plc_context* context = nullptr;
  REQUIRE(plc_context_create(&options, &context, nullptr, 0) == PLC_OK);
  return Context(context);
}

// Short, with an annular cut, a late bubble and every level.
struct Job {
  samples::Volume volume =
      samples::sampled(samples::empty_volume({22, 14, 14}), [](const samples::Point& p) {
        const auto ball = [&](double x, double r) {
          return 1 - samples::norm(p[0] - x, p[1], p[2]) / (2 * r);
        };
        return std::max({0.0, ball(-5, 4), ball(6, 3)});
      });
  plc_image image = samples::image_of(volume);
  plc_parameters parameters = samples::parameters(0.5, 1);
  explicit Job(plc_mesh_kind mesh = PLC_MESH_UNIFORM) {
    parameters.mesh = mesh;
    parameters.max_iterations = 8;
  }
};

// call() until it needs no allocation that fails. Each failure must say that memory was out - or do
// without, as std::stable_sort can - and leave as much allocated as there was.
struct Tried {
  int64_t allocations = 0, failures = 0;
};
template <typename Call>
Tried fail_in_turn(const Call& call) {
  Tried tried;
  for (int64_t n = 0;; ++n) {
    const int64_t before = faults.live;
    faults.count = 0;
    faults.fail = n;
    faults.armed = true;
    const plc_status status = call();
    faults.armed = false;
    if (faults.count <= n) {
      tried.allocations = n;
      CHECK(status == PLC_OK);
      return tried;
    }
    tried.failures += status == PLC_OUT_OF_MEMORY ? 1 : 0;
    if ((status != PLC_OK && status != PLC_OUT_OF_MEMORY) || faults.live != before) {
      CAPTURE(n);
      REQUIRE(status == PLC_OUT_OF_MEMORY);
      REQUIRE(faults.live == before);
    }
  }
}

void tell(const char* what, const Tried& tried) {
  std::cout << what << ": " << tried.allocations << " allocations failed in turn, "
            << tried.failures << " of them told as PLC_OUT_OF_MEMORY" << std::endl;
}

// Room for any message, so that what a failure says is no allocation that stays.
void make_room_for_messages(plc_context* context, const Job& job) {
  plc_parameters p = job.parameters;
  p.window_low = p.window_high = 0.123456789;
  plc_surface* none = nullptr;
  for (int i = 0; i < 2; ++i) {
    REQUIRE(plc_extract(context, &job.image, &p, nullptr, &none) == PLC_INVALID_ARGUMENT);
  }
}

}  // namespace

TEST_CASE("an extraction survives every allocation that fails", "[faults]") {
  const Job job;
  const Context context = lent_context();
  make_room_for_messages(context.get(), job);
  const Tried tried = fail_in_turn([&] {
    plc_surface* surface = nullptr;
    const plc_status status =
        plc_extract(context.get(), &job.image, &job.parameters, nullptr, &surface);
    if ((status == PLC_OK) != (surface != nullptr)) return PLC_INTERNAL;
    plc_surface_destroy(surface);
    return status;
  });
  tell("an extraction", tried);
  CHECK(tried.failures > tried.allocations * 9 / 10);
  CHECK(tried.allocations > 1000);
  // The context is as good as new.
  CHECK(plc_surface_hash(samples::extract(context.get(), job.image, job.parameters).get()) ==
        plc_surface_hash(
            samples::extract(samples::make_context().get(), job.image, job.parameters).get()));
}

TEST_CASE("an extraction by bricks survives every allocation that fails", "[faults]") {
  Job job;
  job.parameters.max_iterations = 2;
  const Context context = lent_context();
  make_room_for_messages(context.get(), job);
  plc_bricks bricks;
  plc_bricks_defaults(&bricks);
  bricks.type = PLC_F32;
  std::copy_n(job.image.dims, 3, bricks.dims);
  std::fill_n(bricks.brick, 3, 16);
  std::copy_n(job.image.spacing, 3, bricks.spacing);
  bricks.cache = 1;  // so that level 1 comes by bricks, too
  bricks.fetch = [](const int64_t at[3], void* voxels, char*, size_t, void* user) {
    const auto& image = *static_cast<const plc_image*>(user);
    const auto* from = static_cast<const float*>(image.voxels);
    for (int64_t i = 0; i < 16 * 16 * 16; ++i) {
      const int64_t x = at[0] * 16 + i % 16, y = at[1] * 16 + i / 16 % 16, z = at[2] * 16 + i / 256;
      if (x >= image.dims[0] || y >= image.dims[1] || z >= image.dims[2]) continue;
      static_cast<float*>(voxels)[i] = from[(z * image.dims[1] + y) * image.dims[0] + x];
    }
    return 0;
  };
  plc_image image = job.image;
  bricks.user = &image;
  uint64_t hash = 0;
  plc_volume* first = nullptr;  // the context keeps room to know of caches
  REQUIRE(plc_volume_create_bricks(context.get(), &bricks, &first) == PLC_OK);
  plc_volume_destroy(first);
  const Tried tried = fail_in_turn([&] {
    plc_volume* volume = nullptr;
    plc_surface* surface = nullptr;
    plc_status status = plc_volume_create_bricks(context.get(), &bricks, &volume);
    if (status == PLC_OK) {
      status = plc_extract_volume(context.get(), volume, &job.parameters, nullptr, &surface);
    }
    if (status == PLC_OK && hash != 0 && hash != plc_surface_hash(surface)) return PLC_INTERNAL;
    if (status == PLC_OK) hash = plc_surface_hash(surface);
    plc_surface_destroy(surface);
    plc_volume_destroy(volume);
    return status;
  });
  tell("an extraction by bricks", tried);
  CHECK(tried.failures > tried.allocations / 3);  // bricks make room for the others
  CHECK(hash == plc_surface_hash(samples::extract(context.get(), job.image, job.parameters).get()));
}

TEST_CASE("making, stepping, saving and restoring a run survives every allocation that fails",
          "[faults]") {
  const Job job(PLC_MESH_ADAPTIVE);
  const Context context = lent_context();
  make_room_for_messages(context.get(), job);
  const plc_parameters& p = job.parameters;
  std::vector<uint8_t> state(1U << 22U);
  const Tried tried = fail_in_turn([&] {
    plc_volume* volume = nullptr;
    plc_pyramid* pyramid = nullptr;
    plc_run *run = nullptr, *restored = nullptr;
    plc_surface* surface = nullptr;
    plc_check check{};
    check.struct_size = sizeof check;
    size_t size = 0;
    plc_context* c = context.get();
    plc_status status = plc_volume_create(c, &job.image, PLC_COPY, &volume);
    const auto then = [&](const auto& call) {
      if (status == PLC_OK) status = call();
    };
    const auto advance = [&](plc_run* of) {
      return plc_run_advance(c, of, PLC_ONE_ITERATION, nullptr);
    };
    then([&] { return plc_pyramid_create(c, volume, &p, &pyramid); });
    then([&] { return plc_run_create(c, pyramid, &p, nullptr, &run); });
    then([&] { return advance(run); });
    then([&] { return plc_run_save(c, run, state.data(), state.size(), &size); });
    then([&] { return plc_run_restore(c, pyramid, &p, nullptr, state.data(), size, &restored); });
    then([&] { return advance(restored); });
    then([&] { return plc_run_surface(c, restored, &surface); });
    then([&] { return plc_surface_check(c, surface, &check); });
    plc_surface_destroy(surface);
    plc_run_destroy(restored);
    plc_run_destroy(run);
    plc_pyramid_destroy(pyramid);
    plc_volume_destroy(volume);
    return status;
  });
  tell("a run, saved and restored", tried);
  CHECK(tried.failures > 300);
}

TEST_CASE("measures and checks of a mesh survive every allocation that fails", "[faults]") {
  const Job job;
  const Context context = lent_context();
  make_room_for_messages(context.get(), job);
  const samples::Surface surface = samples::extract(context.get(), job.image, job.parameters);
  const std::vector<float> floats = samples::positions(surface.get(), PLC_SPACE_LPS);
  const std::vector<double> xyz(floats.begin(), floats.end());
  const std::vector<uint32_t> abc = samples::faces(surface.get(), PLC_SPACE_LPS);
  const auto vertices = static_cast<int64_t>(xyz.size() / 3);
  const auto faces = static_cast<int64_t>(abc.size() / 3);
  constexpr double kUntouched = -7;
  std::vector<double> values(xyz.size(), kUntouched);
  std::vector<double> new_xyz(xyz.size());
  std::vector<uint32_t> new_abc(abc.size());
  std::vector<float> rounded(xyz.size());
  plc_context* c = context.get();
  using Call = std::function<plc_status()>;
  const std::vector<Call> calls = {
      [&] {
        plc_check check{};
        check.struct_size = sizeof check;
        return plc_check_mesh(c, xyz.data(), vertices, abc.data(), faces, &check);
      },
      [&] {
        int64_t count = 0;
        plc_component_measures whole{};
        whole.struct_size = sizeof whole;
        return plc_mesh_component_measures(c, xyz.data(), vertices, abc.data(), faces, &whole,
                                           nullptr, 0, &count);
      },
      [&] {
        return plc_mesh_curvature(c, xyz.data(), vertices, abc.data(), faces, values.data(),
                                  nullptr, nullptr);
      },
      [&] {
        return plc_mesh_geodesic(c, xyz.data(), vertices, abc.data(), faces, 0, values.data());
      },
      [&] {
        return plc_mesh_distance(c, xyz.data(), vertices, abc.data(), faces, xyz.data(), vertices,
                                 abc.data(), faces, values.data(), nullptr);
      },
      [&] {
        plc_simplify_options options;
        plc_simplify_options_defaults(&options);
        options.tolerance = 0.5;
        plc_simplified simplified;
        plc_simplified_defaults(&simplified);
        simplified.struct_size = sizeof simplified;
        return plc_mesh_simplify(c, xyz.data(), vertices, abc.data(), faces, &options,
                                 new_xyz.data(), new_abc.data(), &simplified);
      },
      [&] {
        return plc_mesh_round(c, xyz.data(), vertices, abc.data(), faces, rounded.data(), nullptr);
      },
      [&] {
        plc_surface* made = nullptr;
        const plc_status status = plc_surface_create(c, PLC_SPACE_LPS, &job.image, xyz.data(),
                                                     vertices, abc.data(), faces, &made);
        plc_surface_destroy(made);
        return status;
      },
      [&] {
        return plc_surface_scalars(c, surface.get(), PLC_SPACE_LPS, PLC_SCALAR_MEAN_CURVATURE,
                                   reinterpret_cast<float*>(values.data()), vertices);
      },
  };
  Tried all;
  for (const Call& call : calls) {
    int64_t touched = 0;  // by calls that failed
    const Tried tried = fail_in_turn([&] {
      const plc_status status = call();
      if (status != PLC_OK) {
        touched += std::count_if(values.begin(), values.end(),
                                 [](double value) { return value != kUntouched; });
      }
      std::fill(values.begin(), values.end(), kUntouched);
      return status;
    });
    CHECK(tried.failures > 0);
    CHECK(touched == 0);
    all.allocations += tried.allocations;
    all.failures += tried.failures;
  }
  tell("measures and checks", all);
}

TEST_CASE("a context that cannot be made for want of memory says so", "[faults]") {
  const Tried tried = fail_in_turn([] {
    plc_context* context = nullptr;
    char error[100] = "";
    const plc_status status = plc_context_create(nullptr, &context, error, sizeof error);
    if (status != PLC_OK && std::string_view(error) != "out of memory") return PLC_INTERNAL;
    plc_context_destroy(context);
    return status;
  });
  CHECK(tried.failures >= 2);
}

TEST_CASE("a host that cancels at random moments, a thousand times, can always go on", "[faults]") {
  const Job job;
  const Context context = lent_context();
  const uint64_t whole =
      plc_surface_hash(samples::extract(context.get(), job.image, job.parameters).get());
  make_room_for_messages(context.get(), job);
  const int64_t before = faults.live;
  struct Moment {
    int left;
  };
  plc_extras extras = samples::no_extras();
  extras.progress = [](const plc_progress*, void* user) {
    return --static_cast<Moment*>(user)->left == 0 ? 1 : 0;
  };
  uint32_t random = 12345;
  int cancelled = 0, whole_runs = 0;
  while (cancelled < 1000) {
    random = random * 1664525U + 1013904223U;
    Moment moment{1 + static_cast<int>(random >> 16U) % 40};
    extras.progress_user = &moment;
    plc_surface* surface = nullptr;
    const plc_status status =
        plc_extract(context.get(), &job.image, &job.parameters, &extras, &surface);
    if (status == PLC_OK) {
      ++whole_runs;
      REQUIRE(plc_surface_hash(surface) == whole);
    } else {
      ++cancelled;
      REQUIRE(status == PLC_CANCELLED);
      REQUIRE(surface == nullptr);
    }
    plc_surface_destroy(surface);
    REQUIRE(faults.live == before);
  }
  std::cout << cancelled << " extractions cancelled, " << whole_runs << " more went through"
            << std::endl;
  CHECK(whole_runs > 0);
}

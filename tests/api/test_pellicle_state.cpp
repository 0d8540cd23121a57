// Runs of the C API as bytes: saved, restored, altered.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "engine/api/fingerprint.h"
#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"
#include "tests/samples/sample_hosts.h"
#include "tests/samples/sample_steps.h"

using namespace samples;
using Pyramid = PyramidHandle;
using Run = RunHandle;

TEST_CASE("a saved run goes on with the same bits, wherever it was saved", "[pellicle_state]") {
  const Scene s;
  const Context one = make_context(1), other = make_context(3, PLC_SIMD_SCALAR);
  const Pyramid pyramid = pyramid_of(one.get(), s.image, s.parameters);
  const Pyramid again = pyramid_of(other.get(), s.image, s.parameters);
  const Run run = run_of(one.get(), pyramid.get(), s.parameters);
  Run follower;
  plc_run_state state{};
  for (int i = 0; state.done == 0; ++i) {
    // Every seventh iteration the follower starts anew from the state, in another context.
    if (i % 7 == 0) {
      REQUIRE(restore(other.get(), again.get(), s.parameters, saved(one.get(), run.get()),
                      follower) == PLC_OK);
    }
    state = advance(one.get(), run.get(), PLC_ONE_ITERATION);
    const plc_run_state there = advance(other.get(), follower.get(), PLC_ONE_ITERATION);
    INFO("iteration " << i << ", level " << state.progress.level);
    REQUIRE(there.done == state.done);
    REQUIRE(there.progress.energy == state.progress.energy);
    REQUIRE(hash_now(other.get(), follower.get()) == hash_now(one.get(), run.get()));
  }
}

TEST_CASE("saving allocates nothing", "[pellicle_state]") {
  int64_t allocations = 0;
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = 1;
  options.allocate = [](size_t size, size_t alignment, void* user) {
    ++*static_cast<int64_t*>(user);
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  };
  options.release = [](void* data, size_t, size_t, void*) { std::free(data); };
  options.allocator_user = &allocations;
  plc_context* made = nullptr;
  REQUIRE(plc_context_create(&options, &made, nullptr, 0) == PLC_OK);
  const Context context(made);
  const Scene s;
  const Pyramid pyramid = pyramid_of(context.get(), s.image, s.parameters);
  const Run run = run_of(context.get(), pyramid.get(), s.parameters);
  advance(context.get(), run.get(), PLC_ONE_LEVEL);
  saved(context.get(), run.get());  // the hash of the voxels is computed once
  const int64_t before = allocations;
  CHECK(before > 0);
  CHECK(saved(context.get(), run.get()).size() > 1000);
  CHECK(allocations == before);
}

TEST_CASE("what sleeps is asleep in a restored run", "[pellicle_state]") {
  // The outside is calm long before the bottom of the hole is reached.
  Volume volume = sampled(empty_volume({40, 40, 40}), [](const Point& p) {
    const double ball = 15 - norm(p[0], p[1], p[2]);
    const double hole = std::max(norm(p[0], p[1], 0) - 5, -10 - p[2]);
    return std::clamp(0.5 + std::min(ball, hole) / 4, 0.0, 1.0);
  });
  const plc_image image = image_of(volume);
  plc_parameters p = parameters(0.5, 1);
  p.calm_speed = 1e-9;  // to the last iteration
  p.max_iterations = 80;
  const Context context = make_context(2);
  const Pyramid pyramid = pyramid_of(context.get(), image, p);
  const Run run = run_of(context.get(), pyramid.get(), p);
  plc_run_state state{};
  for (int i = 0; state.done == 0; ++i) {
    Run follower;
    if (i % 5 == 0) {
      REQUIRE(restore(context.get(), pyramid.get(), p, saved(context.get(), run.get()), follower) ==
              PLC_OK);
    }
    state = advance(context.get(), run.get(), PLC_ONE_ITERATION);
    if (follower == nullptr) continue;
    const plc_run_state there = advance(context.get(), follower.get(), PLC_ONE_ITERATION);
    INFO("iteration " << i);
    REQUIRE(there.progress.energy == state.progress.energy);
    REQUIRE(hash_now(context.get(), follower.get()) == hash_now(context.get(), run.get()));
  }
  // Some did sleep.
  const auto moves = [](const plc_surface* surface) { return level_of(surface, 1).moves; };
  p.sleeping = 0;
  CHECK(moves(surface_of(context.get(), run.get()).get()) <
        moves(extract(context.get(), image, p).get()) * 3 / 4);
}

TEST_CASE("a state that is none, or of something else, is refused in words", "[pellicle_state]") {
  const Scene s;
  const Context context = make_context();
  const Pyramid pyramid = pyramid_of(context.get(), s.image, s.parameters);
  const Run run = run_of(context.get(), pyramid.get(), s.parameters);
  advance(context.get(), run.get(), PLC_ONE_LEVEL);
  const std::vector<uint8_t> state = saved(context.get(), run.get());
  Run none;
  const auto refused = [&](const std::vector<uint8_t>& bytes, const plc_pyramid* of,
                           const plc_parameters& p) {
    CHECK(restore(context.get(), of, p, bytes, none) == PLC_INVALID_DATA);
    return std::string(plc_context_message(context.get()));
  };
  CHECK(refused({1, 2, 3}, pyramid.get(), s.parameters) == "state: truncated");
  CHECK(refused(std::vector<uint8_t>(100), pyramid.get(), s.parameters) ==
        "state: not one of a run");
  std::vector<uint8_t> altered = state;
  altered[altered.size() / 2] ^= 1;
  CHECK(refused(altered, pyramid.get(), s.parameters) == "state: truncated or altered");
  CHECK(refused({state.begin(), state.end() - 8}, pyramid.get(), s.parameters) ==
        "state: truncated or altered");
  altered = state;
  altered[8] ^= 1;
  CHECK(refused(altered, pyramid.get(), s.parameters) ==
        "state: of another version of the library");
  const std::string other = "state: of another image, other parameters or other extras";
  plc_parameters softer = s.parameters;
  softer.curvature *= 2;
  CHECK(refused(state, pyramid.get(), softer) == other);
  Scene changed;
  changed.volume.values[1000] += 0.001F;
  const Pyramid of_changed = pyramid_of(context.get(), changed.image, s.parameters);
  CHECK(refused(state, of_changed.get(), s.parameters) == other);
  Scene moved;
  moved.image.origin[0] += 1000;
  const Pyramid of_moved = pyramid_of(context.get(), moved.image, s.parameters);
  CHECK(refused(state, of_moved.get(), s.parameters) == other);
  Scene turned;
  const double quarter[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  std::copy(quarter, quarter + 9, turned.image.direction);
  const Pyramid of_turned = pyramid_of(context.get(), turned.image, s.parameters);
  CHECK(refused(state, of_turned.get(), s.parameters) == other);
  plc_extras extras = no_extras();
  const plc_pin pin{{0, 0, 0}, 1};
  extras.pins = &pin;
  extras.pin_count = 1;
  CHECK(restore(context.get(), pyramid.get(), s.parameters, state, none, &extras) ==
        PLC_INVALID_DATA);
  // A force where there was none, and one of another space.
  Host host = pushing(0.01F);
  plc_extras forced = extras_of(host);
  const auto with_force = [&](const std::vector<uint8_t>& bytes) {
    return restore(context.get(), pyramid.get(), s.parameters, bytes, none, &forced);
  };
  CHECK(with_force(state) == PLC_INVALID_DATA);
  const Run pushed = run_of(context.get(), pyramid.get(), s.parameters, &forced);
  const std::vector<uint8_t> of_pushed = saved(context.get(), pushed.get());
  CHECK(with_force(of_pushed) == PLC_OK);
  forced.space = PLC_SPACE_RAS;
  CHECK(with_force(of_pushed) == PLC_INVALID_DATA);
  // Room that is too small.
  size_t size = 0;
  std::vector<uint8_t> small(10, 7);
  CHECK(plc_run_save(context.get(), run.get(), small.data(), small.size(), &size) ==
        PLC_INVALID_ARGUMENT);
  CHECK(small == std::vector<uint8_t>(10, 7));
}

TEST_CASE("a state that somebody has altered and sealed again is refused or harmless",
          "[pellicle_state]") {
  const Scene s;
  const Context context = make_context();
  const Pyramid pyramid = pyramid_of(context.get(), s.image, s.parameters);
  plc_extras extras = no_extras();
  extras.level = [](const plc_level_report*, const plc_surface* surface, void*) {
    positions(surface, PLC_SPACE_LPS);
    faces(surface, PLC_SPACE_LPS);
    return PLC_VERDICT_CANCEL;
  };
  int taken = 0;
  for (const plc_amount amount : {PLC_ONE_ITERATION, PLC_ONE_LEVEL}) {
    Run run = run_of(context.get(), pyramid.get(), s.parameters);
    advance(context.get(), run.get(), amount);
    const std::vector<uint8_t> state = saved(context.get(), run.get());
    // All that comes before the surface.
    constexpr size_t kHead = 28, kFields = 700;
    for (size_t at = kHead; at < kFields; ++at) {
      for (const int value : {0, 1, 2, 3, 255}) {
        std::vector<uint8_t> forged = state;
        if (forged[at] == value) continue;
        forged[at] = static_cast<uint8_t>(value);
        const uint64_t sum = plc::words_hash(forged.data(), forged.size() - sizeof sum);
        std::memcpy(forged.data() + forged.size() - sizeof sum, &sum, sizeof sum);
        if (restore(context.get(), pyramid.get(), s.parameters, forged, run, &extras) != PLC_OK) {
          continue;
        }
        ++taken;
        plc_run_advance(context.get(), run.get(), PLC_ONE_ITERATION, nullptr);
        plc_surface* surface = nullptr;
        if (plc_run_surface(context.get(), run.get(), &surface) != PLC_OK) continue;
        const Surface kept(surface);
        const int levels = plc_surface_level_count(surface);
        REQUIRE(levels <= s.parameters.levels + 1);
        for (int i = 0; i < levels; ++i) {
          REQUIRE(level_of(surface, i).level == s.parameters.levels - i);
        }
      }
    }
  }
  CHECK(taken > 0);
}

// A scene, and the C API in steps: volumes, pyramids, runs, and runs as bytes.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"

namespace samples {

// Two balls that overlap, so that the topology changes, and a detached one for a late bubble.
inline Volume scene() {
  return sampled(empty_volume({36, 24, 22}), [](const Point& p) {
    const auto ball = [&](double x, double r) { return 1 - norm(p[0] - x, p[1], p[2]) / (2 * r); };
    return std::max({0.0, ball(-9, 6), ball(1, 5), ball(13, 3)});
  });
}

inline plc_parameters scene_parameters() {
  plc_parameters p = parameters(0.5, 2);
  p.max_iterations = 120;
  return p;
}

inline VolumeHandle volume_of(plc_context* context, const plc_image& image,
                              plc_ownership ownership = PLC_BORROW) {
  plc_volume* volume = nullptr;
  const plc_status status = plc_volume_create(context, &image, ownership, &volume);
  INFO(plc_context_message(context));
  REQUIRE(status == PLC_OK);
  return VolumeHandle(volume);
}

inline PyramidHandle pyramid_of(plc_context* context, const plc_image& image,
                                const plc_parameters& p) {
  plc_pyramid* pyramid = nullptr;
  const VolumeHandle volume = volume_of(context, image);
  const plc_status status = plc_pyramid_create(context, volume.get(), &p, &pyramid);
  INFO(plc_context_message(context));
  REQUIRE(status == PLC_OK);
  return PyramidHandle(pyramid);
}

inline RunHandle run_of(plc_context* context, const plc_pyramid* pyramid, const plc_parameters& p,
                        const plc_extras* extras = nullptr) {
  plc_run* run = nullptr;
  const plc_status status = plc_run_create(context, pyramid, &p, extras, &run);
  INFO(plc_context_message(context));
  REQUIRE(status == PLC_OK);
  return RunHandle(run);
}

inline plc_run_state advance(plc_context* context, plc_run* run, plc_amount amount) {
  plc_run_state state{};
  state.struct_size = sizeof state;
  const plc_status status = plc_run_advance(context, run, amount, &state);
  INFO(plc_context_message(context));
  REQUIRE(status == PLC_OK);
  return state;
}

inline Surface surface_of(plc_context* context, const plc_run* run) {
  plc_surface* surface = nullptr;
  REQUIRE(plc_run_surface(context, run, &surface) == PLC_OK);
  return Surface(surface);
}

inline uint64_t hash_now(plc_context* context, const plc_run* run) {
  return plc_surface_hash(surface_of(context, run).get());
}

inline std::vector<uint8_t> saved(plc_context* context, const plc_run* run) {
  size_t size = 0;
  REQUIRE(plc_run_save(context, run, nullptr, 0, &size) == PLC_OK);
  std::vector<uint8_t> state(size);
  REQUIRE(plc_run_save(context, run, state.data(), state.size(), &size) == PLC_OK);
  REQUIRE(size == state.size());
  return state;
}

inline plc_status restore(plc_context* context, const plc_pyramid* pyramid, const plc_parameters& p,
                          const std::vector<uint8_t>& state, RunHandle& run,
                          const plc_extras* extras = nullptr) {
  plc_run* restored = nullptr;
  const plc_status status =
      plc_run_restore(context, pyramid, &p, extras, state.data(), state.size(), &restored);
  run.reset(restored);
  CHECK((status == PLC_OK) == (restored != nullptr));
  return status;
}

struct Scene {
  Volume volume = scene();
  plc_image image = image_of(volume);
  plc_parameters parameters = scene_parameters();
};

}  // namespace samples

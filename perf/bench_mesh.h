// What the benchmarks work on: a closed surface in the state that an evolution leaves it in.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <utility>
#include <vector>

#include "engine/recover/evolution.h"
#include "engine/resolve/refinement.h"
#include "engine/start/initial_surface.h"
#include "pyramid/buffer.h"

namespace bench {

// 268 x 268 x 120 voxels, as a head CT has, of a smooth potential in [0,1]: 1/2 on rippled balls
// of radius about 16, 5 x 5 x 2 of them.
struct Image {
  static constexpr int32_t kDims[3] = {268, 268, 120};
  static constexpr int32_t kBalls[3] = {5, 5, 2};
  static constexpr float kRadius = 16;
  static constexpr float kIso = 0.5F;
  plc::Buffer<float> values;

  Image() {
    values.reserve(size_t{268} * 268 * 120);
    for (int32_t z = 0; z < kDims[2]; ++z) {
      for (int32_t y = 0; y < kDims[1]; ++y) {
        for (int32_t x = 0; x < kDims[0]; ++x) values.push_back(potential(x, y, z));
      }
    }
  }
  plc::ImageView view() const {
    plc::ImageView v;
    v.data = values.data();
    for (int a = 0; a < 3; ++a) v.dims[a] = kDims[a];
    return v;
  }
  // Between the places of the balls on axis a.
  static float pitch(int a) { return static_cast<float>(kDims[a]) / static_cast<float>(kBalls[a]); }

 private:
  static float potential(int32_t x, int32_t y, int32_t z) {
    const int32_t at[3] = {x, y, z};
    float squared = 0, ripple = 1;
    for (int a = 0; a < 3; ++a) {
      const float p = static_cast<float>(at[a]) + 0.5F;
      const float d = p - (std::floor(p / pitch(a)) + 0.5F) * pitch(a);
      squared += d * d;
      ripple *= std::cos(0.4F * d);
    }
    const float value = 1 - (std::sqrt(squared) + 2 * ripple) / (2 * kRadius);
    return value > 0 ? value : 0;
  }
};

inline plc::Guide guide_of(const Image& image) {
  plc::Guide guide;
  guide.image = image.view();
  guide.iso = Image::kIso;
  return guide;
}

inline void require(const plc::Status& status) {
  if (status.ok()) return;
  std::cerr << "bench_mesh: " << status.message() << '\n';
  std::exit(1);
}

// About 100,000 vertices in Morton order, moving: balls too large for the image that have shrunk
// towards it for 60 iterations, so that rings have the valences of an evolution. `shrink` > 1 gives
// about shrink^2 fewer vertices.
inline plc::Mesh evolved_mesh(const Image& image, double shrink = 1) {
  const plc::Schedule schedule(2);
  plc::Mesh mesh;
  mesh.delta = shrink / 1.2;
  for (int32_t i = 0; i < Image::kBalls[0] * Image::kBalls[1] * Image::kBalls[2]; ++i) {
    const int32_t at[3] = {i % 5, i / 5 % 5, i / 25};
    float centre[3];
    for (int a = 0; a < 3; ++a) centre[a] = (static_cast<float>(at[a]) + 0.5F) * Image::pitch(a);
    constexpr float kStart = 1.35F * Image::kRadius;
    require(plc::append_bubble(mesh, {centre[0], centre[1], centre[2]}, {kStart, kStart, kStart},
                               schedule));
  }
  plc::Evolution evolution(mesh, schedule, plc::Model{.time_step = 1});
  plc::Seconds seconds;
  plc::OperationCounts counts;
  evolution.restart();
  for (int i = 0; i < 60; ++i) {
    require(evolution.iterate(guide_of(image), seconds, counts));
  }
  mesh.renumber(plc::morton_order(mesh));
  return mesh;
}

}  // namespace bench

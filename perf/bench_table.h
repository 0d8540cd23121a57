// The kernels of the movement by name, and what they work on: the mesh of bench_mesh.h, and one of
// every stream that they write.
#pragma once
#include <algorithm>
#include <bit>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "kernels/guided_stage.h"
#include "kernels/image_force.h"
#include "kernels/integrate.h"
#include "kernels/ring_forces.h"
#include "perf/bench_mesh.h"
#include "pyramid/memory.h"

namespace bench {

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

inline kernels::Float3s raw(Streams3& s) {
  return {s.x.data(), s.y.data(), s.z.data()};
}
inline kernels::ConstFloat3s raw(const Streams3& s) {
  return {s.x.data(), s.y.data(), s.z.data()};
}

// The mesh, and one of every stream that kernels write.
struct Bench {
  Image image;
  Mesh mesh;
  Streams3 force, speed, rate, moved;
  Buffer<Float4> laplacian, stage;
  Streams3 start_velocity;
  Buffer<Float4> start;
  plc::Vector<uint32_t> list;
  double sum = 0;

  explicit Bench(double shrink = 1) : mesh(evolved_mesh(image, shrink)) {
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

using Kernel = std::function<void(Bench&, SimdTarget)>;

inline kernels::Rk4Streams rk4(Bench& b) {
  return {b.start.data(), raw(std::as_const(b.start_velocity)),
          raw(b.speed),   raw(b.moved),
          raw(b.rate),    b.stage.data()};
}
inline kernels::SurfaceForces forces(Bench& b) {
  return {b.mesh.rings(), b.laplacian.data(), 0.4F,
          b.image.view(), b.start.data(),     raw(std::as_const(b.mesh.normal)),
          -0.8F,          Image::kIso};
}
inline kernels::MoveStreams ends(Bench& b) {
  return {b.start.data(),       b.mesh.position.data(),
          raw(b.mesh.velocity), raw(std::as_const(b.mesh.normal)),
          b.mesh.path.data(),   b.mesh.turns.data()};
}
inline constexpr kernels::Rk4Coefficients kNewton{1, 0.5F, 1};
inline constexpr kernels::MoveBound kBound{0.3F, 0.3F, 20, 10};

using Table = std::vector<std::pair<std::string, Kernel>>;

inline void add_ring_kernels(Table& table) {
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

inline void add_motion_kernels(Table& table) {
  table.emplace_back("iso_force", [](Bench& b, SimdTarget simd) {
    Streams3& n = b.mesh.normal;
    kernels::iso_force(simd, b.image.view(), b.start.data(), raw(n), {-0.8F, Image::kIso}, 0, b.n(),
                       raw(b.force));
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

inline Table kernel_table() {
  Table table;
  add_ring_kernels(table);
  add_motion_kernels(table);
  return table;
}

}  // namespace bench

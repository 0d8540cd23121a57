// The kernels over vertices, each run once on random input: hashes of all that it writes.
#pragma once
#include <algorithm>
#include <numeric>
#include <random>

#include "kernels/face_pairs.h"
#include "kernels/guided_stage.h"
#include "kernels/hash_entries.h"
#include "kernels/integrate.h"
#include "kernels/nearby.h"
#include "kernels/ring_forces.h"
#include "pyramid/memory.h"
#include "tests/kernels/face_tree_samples.h"
#include "tests/kernels/golden_hash.h"

namespace golden {

// ---- ring_forces.h: dead vertices, common valences and long tails.

struct Rings {
  RandomRings rings = mixed_rings(64, 11);
  uint32_t n = rings.count();
  plc::RingView view = rings.view();
  const Float4* position = rings.position.data();
  plc::Blocks all = plc::Blocks::range(0, n);
};

inline constexpr plc::Metric kStretched{1.25F, 1, 2.4F};

inline uint64_t laplacian(SimdTarget simd) {
  const Rings r;
  std::vector<Float4> out(r.n);
  kernels::laplacian(simd, r.view, r.position, r.all, out.data());
  return hash_of(flatten(out));
}

inline uint64_t curvature_force(SimdTarget simd) {
  const Rings r;
  Three force(r.n);
  kernels::curvature_force(simd, r.view, r.position, 0.3F, 0, r.n, force.out());
  return hash_of(force);
}

inline uint64_t spring_force_in(SimdTarget simd, const plc::Metric& metric) {
  const Rings r;
  Three force(r.n, -1, 1, 5);
  kernels::spring_force(simd, r.view, r.position, {0.01F, 1.7F, metric}, 0, r.n, force.out());
  return hash_of(force);
}
inline uint64_t spring_force(SimdTarget simd) {
  return spring_force_in(simd, {});
}
inline uint64_t spring_force_stretched(SimdTarget simd) {
  return spring_force_in(simd, kStretched);
}

inline uint64_t normals(SimdTarget simd) {
  const Rings r;
  Three normal(r.n);
  kernels::normals(simd, r.view, r.position, r.all, normal.out());
  return hash_of(normal);
}

inline uint64_t normals_and_laplacian(SimdTarget simd) {
  const Rings r;
  Three normal(r.n);
  std::vector<Float4> mean(r.n);
  kernels::normals_and_laplacian(simd, r.view, r.position, r.all, normal.out(), mean.data());
  Fnv hash;
  add(hash, normal);
  hash.add_all(flatten(mean));
  return hash.value();
}

inline uint64_t metric_normals(SimdTarget simd) {
  const Three n(512, -1, 1, 7);
  Three m(512), step(512);
  kernels::metric_normals(simd, kStretched, n.in(), 0, 512, m.out(), step.out());
  Fnv hash;
  add(hash, m);
  add(hash, step);
  return hash.value();
}

inline uint64_t edge_violations(SimdTarget simd) {
  const Rings r;
  plc::Vector<uint8_t> flags(r.n);
  kernels::edge_violations(simd, r.view, r.position, 400, 60000, r.all, flags.data());
  Fnv hash;
  hash.add_all(flags);
  return hash.value();
}

inline uint64_t turned_faces(SimdTarget simd) {
  const Rings r;
  Three normal(r.n);
  kernels::normals(SimdTarget::kScalar, r.view, r.position, r.all, normal.out());
  plc::Vector<uint8_t> flags(r.n);
  kernels::turned_faces(simd, r.view, r.position, r.all, normal.in(), 0.1F, flags.data());
  Fnv hash;
  hash.add_all(flags);
  return hash.value();
}

inline uint64_t edge_length_sum_in(SimdTarget simd, const plc::Metric& metric) {
  const Rings r;
  Fnv hash;
  hash.add(kernels::edge_length_sum(simd, r.view, r.position, metric, 0, r.n));
  return hash.value();
}
inline uint64_t edge_length_sum(SimdTarget simd) {
  return edge_length_sum_in(simd, {});
}
inline uint64_t edge_length_sum_stretched(SimdTarget simd) {
  return edge_length_sum_in(simd, kStretched);
}

// ---- integrate.h and guided_stage.h: a step's streams, all of them random.

struct Step {
  RandomRings rings = mixed_rings(32, 13);
  uint32_t n = rings.count();
  plc::Blocks all = plc::Blocks::range(0, n);
  Three velocity{n, -2, 2, 20}, force{n, -2, 2, 23}, speed{n, -2, 2, 26}, moved{n, -2, 2, 29},
      rate{n, -2, 2, 32}, normal{n, -2, 2, 35};
  std::vector<float> image = random_floats(size_t{60} * 50 * 40, 0, 1, 14);
  std::vector<Float4> laplacian{n}, stage{n}, moved_to{n};
  std::vector<float> path = random_floats(n, 0, 1, 38);
  std::vector<uint8_t> turns = std::vector<uint8_t>(n, 0);
  kernels::Rk4Streams streams{rings.position.data(), velocity.in(), speed.out(),
                              moved.out(),           rate.out(),    stage.data()};
  kernels::SurfaceForces forces{rings.view(),
                                laplacian.data(),
                                0.3F,
                                {image.data(), {60, 50, 40}, {0.2F, 0.2F, 0.2F}, {3, 4, 5}},
                                rings.position.data(),
                                normal.in(),
                                -1.2F,
                                0.4F};
  kernels::Rk4Coefficients newton{1.3F, 0.45F, 0.7F};
  kernels::MoveBound bound{0.8F, 1.1F, 20, 10};
  kernels::MoveStreams ends{rings.position.data(), moved_to.data(), velocity.out(),
                            normal.in(),           path.data(),     turns.data()};

  Step() {
    laplacian.resize(n), stage.resize(n), moved_to.resize(n);
    kernels::laplacian(SimdTarget::kScalar, rings.view(), rings.position.data(), all,
                       laplacian.data());
  }
  uint64_t hash(const kernels::Movement& movement = {}) const {
    Fnv hash;
    for (const Three* s : {&velocity, &speed, &moved, &rate}) add(hash, *s);
    hash.add_all(flatten(stage));
    hash.add_all(flatten(moved_to));
    hash.add_all(path);
    hash.add(movement.energy);
    hash.add(movement.longest2);
    return hash.value();
  }
};

template <int kStage>
inline uint64_t rk4_stage(SimdTarget simd) {
  const Step s;
  kernels::rk4_stage(simd, kStage, s.newton, s.streams, s.force.in(), s.all);
  return s.hash();
}

template <int kStage>
inline uint64_t guided_stage(SimdTarget simd) {
  const Step s;
  kernels::guided_stage(simd, kStage, s.newton, s.forces, s.streams, s.all);
  return s.hash();
}

inline uint64_t max_squared(SimdTarget simd) {
  const Step s;
  Fnv hash;
  hash.add(kernels::max_squared(simd, s.moved.in(), s.all));
  return hash.value();
}

inline uint64_t move(SimdTarget simd) {
  Step s;
  return s.hash(kernels::move(simd, s.bound, s.moved.out(), s.rate.in(), s.ends, s.all));
}

inline uint64_t guided_move(SimdTarget simd) {
  const Step s;
  return s.hash(kernels::guided_move(simd, s.newton, s.forces, s.streams, s.bound, s.ends, s.all));
}

// ---- nearby.h

inline uint64_t near_or_turned(SimdTarget simd) {
  constexpr uint32_t kCount = 157;
  constexpr uint32_t kPadded = 160;
  const Three place(kPadded, 0, 4, 71), normal(kPadded, -1, 1, 74);
  const kernels::NearbyView view{place.x.data(),  place.y.data(),  place.z.data(), normal.x.data(),
                                 normal.y.data(), normal.z.data(), kCount};
  plc::Vector<uint32_t> hits(kCount + plc::kRingLanes);
  Fnv hash;
  for (uint32_t q = 0; q < kCount; ++q) {
    const kernels::NearbyQuery query{place.x[q],  place.y[q], place.z[q], normal.x[q], normal.y[q],
                                     normal.z[q], 1,          2.5F,       -0.2F};
    const uint32_t count = kernels::near_or_turned(simd, view, query, hits.data());
    for (uint32_t i = 0; i < count; ++i) hash.add(hits[i]);
    hash.add(count);
  }
  return hash.value();
}

// ---- face_pairs.h

inline uint64_t face_pairs(SimdTarget simd) {
  const samples::FaceTreeSample tree(500, 3, 80, 50);
  std::vector<uint32_t> nodes(tree.node_count());
  std::iota(nodes.begin(), nodes.end(), 0U);
  std::vector<kernels::CandidatePair> pairs(kernels::kMostPairs * nodes.size());
  Fnv hash;
  for (uint32_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    const size_t count =
        kernels::face_pairs(simd, tree.view(), leaf, nodes.data(), nodes.size(), pairs.data());
    for (size_t i = 0; i < count; ++i) {
      hash.add(pairs[i].f);
      hash.add(pairs[i].g);
    }
    hash.add(static_cast<uint32_t>(count));
  }
  return hash.value();
}

// ---- hash_entries.h

inline uint64_t entries_within(SimdTarget simd) {
  constexpr uint32_t kEntries = 3000;
  std::mt19937 bits(8);
  std::vector<uint32_t> ids(kEntries + plc::kRingLanes), places(kEntries + plc::kRingLanes);
  for (uint32_t& id : ids) id = static_cast<uint32_t>(bits());
  for (uint32_t& place : places) {
    const auto q = [&] { return static_cast<int32_t>(bits() % plc::kPlacePeriod); };
    const int32_t x = q(), y = q(), z = q();
    place = plc::coarse_place(x, y, z);
  }
  std::vector<kernels::EntryRun> runs;
  for (uint32_t i = 0; i < kEntries; i += i % 23 + 1) {
    runs.push_back({i, std::min(i + i % 37, kEntries)});
  }
  std::vector<uint32_t> out(size_t{40} * runs.size() + plc::kRingLanes);
  const int32_t low[3] = {100, -60, 300}, high[3] = {400, 250, 700};
  const uint32_t count =
      kernels::entries_within(simd, ids.data(), places.data(), runs.data(), runs.size(),
                              plc::coarse_box(low, high), out.data());
  Fnv hash;
  for (uint32_t i = 0; i < count; ++i) hash.add(out[i]);
  hash.add(count);
  return hash.value();
}

}  // namespace golden

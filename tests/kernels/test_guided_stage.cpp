// The fused stage against the kernels that it stands for, one after the other.
#include "kernels/guided_stage.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "kernels/image_force.h"
#include "kernels/ring_forces.h"
#include "kernels/scalar.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::Blocks;
using plc::Float4;
using plc::SimdTarget;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

constexpr kernels::Rk4Coefficients kNewton{1.0F / 0.7F, 0.45F, 0.9F};
constexpr kernels::MoveBound kBound{2.5F, 3.5F, 20, 10, 1.5F};
constexpr uint32_t kBlocks = 240;  // more than kernels fetch ahead

// A stage of a step in full swing.
struct Stage {
  RandomRings rings = mixed_rings(kBlocks, 31);
  std::vector<float> image = random_floats(size_t{60} * 50 * 40, 0, 1, 32);
  std::vector<Float4> laplacian, next, moved_to;
  std::vector<float> streams[21], path;
  std::vector<float> from_star = random_floats(rings.count(), -0.1F, 0.1F, 39);
  std::vector<float> compliance = random_floats(rings.count(), 0.1F, 2, 38);
  std::vector<uint8_t> turns;
  kernels::Movement movement;

  Stage() : laplacian(rings.count()), next(laplacian), moved_to(laplacian), path(rings.count()) {
    for (uint32_t v = 0; v < rings.count(); ++v) turns.push_back(static_cast<uint8_t>(37 * v));
    for (uint32_t i = 0; i < 21; ++i) streams[i] = random_floats(rings.count(), -3, 3, 40 + i);
    scalar::laplacian(rings.view(), rings.position.data(), all(), laplacian.data());
  }
  Blocks all() const { return Blocks::range(0, rings.count()); }
  kernels::Float3s three(size_t i) {
    return {streams[i].data(), streams[i + 1].data(), streams[i + 2].data()};
  }
  kernels::ConstFloat3s fixed(size_t i) const {
    return {streams[i].data(), streams[i + 1].data(), streams[i + 2].data()};
  }
  kernels::Rk4Streams rk4() {
    return {rings.position.data(), fixed(0), three(3), three(6), three(9), next.data()};
  }
  kernels::SurfaceForces forces() const {
    return {rings.view(),
            laplacian.data(),
            0.3F,
            {image.data(), {60, 50, 40}, {0.2F, 0.2F, 0.2F}, {3, 4, 5}},
            rings.position.data(),
            fixed(12),
            -1.2F,
            0.4F};
  }
  kernels::MoveStreams ends() {
    return {rings.position.data(), moved_to.data(), three(0), fixed(15), path.data(), turns.data()};
  }
  std::vector<float> result() const {
    std::vector<float> values = flatten(next);
    const std::vector<float> places = flatten(moved_to);
    values.insert(values.end(), places.begin(), places.end());
    for (size_t i = 0; i < 9; ++i) {
      values.insert(values.end(), streams[i].begin(), streams[i].end());
    }
    values.insert(values.end(), path.begin(), path.end());
    return values;
  }
  const std::vector<float>& rate(size_t axis) const { return streams[9 + axis]; }

  // The same by the kernels of one force each.
  void apart(int stage) {
    const kernels::SurfaceForces f = forces();
    const kernels::Float3s force = three(18);
    const uint32_t n = rings.count();
    scalar::curvature_force(f.ring, f.laplacian, f.curvature, 0, n, force);
    scalar::iso_force(f.image, f.position, f.normal, {f.attraction, f.iso}, 0, n, force);
    scalar::rk4_stage(stage, kNewton, rk4(), fixed(18), all());
  }
};

// Of an adaptive mesh, with sizes from a tenth of delta on.
kernels::SurfaceForces sized(Stage& s) {
  for (uint32_t v = 0; v < s.rings.count(); ++v) {
    s.rings.position[v].w = 0.1F * static_cast<float>(v % 40) - 0.9F;
  }
  kernels::SurfaceForces f = s.forces();
  f.sized = true;
  f.smoothing = 0.2F;
  f.facets = 0.25F;
  f.star = 0.75F;
  f.reach = 0.3F;
  f.from_star = s.from_star.data();
  f.compliance = s.compliance.data();
  return f;
}

float sample(const kernels::SurfaceForces& f, const Float4& place) {
  float value;
  scalar::sample_trilinear(f.image, &place, 0, 1, &value);
  return value;
}

// The image's value `ahead` of a vertex along its normal, from a single sample.
float own_value(const kernels::SurfaceForces& f, uint32_t v, float ahead = 0) {
  const Float4 &p = f.position[v], &l = f.laplacian[v];
  const float x = f.normal.x[v], y = f.normal.y[v], z = f.normal.z[v];
  const float off = f.facets * (l.x * x + l.y * y + l.z * z) + ahead;
  return sample(f, {p.x + off * x, p.y + off * y, p.z + off * z, 0});
}

// The image's value for a vertex, from single samples; stage > 0: with what stage 0 has left.
float sized_value(int stage, const kernels::SurfaceForces& f, uint32_t v) {
  const Float4& p = f.position[v];
  const float own = own_value(f, v);
  if (stage > 0) return own + f.from_star[v];
  const float part = std::min(p.w, f.star);
  const uint32_t valence = f.ring.valence[v];
  if (part <= 0 || valence == 0 || valence > plc::kRingSlots) return own;
  float sum = 0;
  for (uint32_t k = 0; k < valence; ++k) {
    const Float4& q = f.position[f.ring.slot(v, k)];
    sum += sample(f, {(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2, 0});
  }
  return own + (sum / static_cast<float>(valence) - own) * part;
}

// The inverse of what the forces on a vertex change by where it moves along its normal.
float expected_compliance(const kernels::SurfaceForces& f, uint32_t v) {
  const float rise = own_value(f, v, f.reach) - own_value(f, v, -f.reach);
  const float size = std::max(1.0F, 1 + f.position[v].w);
  const float bend = f.curvature / std::pow(size, 4.0F) + f.smoothing / (size * size);
  const float stiffness = std::abs(f.attraction) * std::abs(rise) / (2 * f.reach) +
                          static_cast<float>(kernels::kBendStiffness) * bend;
  return std::min(1 / stiffness, kernels::kMostCompliance);
}

}  // namespace

TEST_CASE("the image of an adaptive mesh is looked at in the middles of long edges, too",
          "[kernels]") {
  const int stage = GENERATE(0, 2);
  CAPTURE(stage);
  Stage expected;
  const kernels::SurfaceForces f = sized(expected);
  const uint32_t n = expected.rings.count();
  scalar::sized_iso_force(stage, f, f.position, 0, n, expected.three(18));
  Stage before;
  CHECK((expected.from_star != before.from_star) == (stage == 0));
  CHECK((expected.compliance != before.compliance) == (stage == 0));
  for (uint32_t v = 0; v < n; ++v) {
    if (stage == 0) {
      REQUIRE(expected.compliance[v] == Approx(expected_compliance(f, v)).epsilon(1e-3));
    }
    const float push = f.attraction * (f.iso - sized_value(stage, f, v));
    REQUIRE(expected.streams[18][v] ==
            Approx(before.streams[18][v] + push * f.normal.x[v]).margin(1e-4));
  }
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    Stage got;
    const kernels::SurfaceForces g = sized(got);
    kernels::sized_iso_force(simd, stage, g, g.position, 0, n, got.three(18));
    CHECK(first_difference(got.from_star, expected.from_star) == -1);
    CHECK(first_difference(got.compliance, expected.compliance) == -1);
    for (size_t a = 18; a < 21; ++a) {
      CHECK(first_difference(got.streams[a], expected.streams[a]) == -1);
    }
  }
}

TEST_CASE("a guided stage has the bits of its forces and its update one after the other",
          "[kernels]") {
  for (int stage = 0; stage < 4; ++stage) {
    Stage expected;
    expected.apart(stage);
    for (const SimdTarget simd : plc::available_simd_targets()) {
      CAPTURE(plc::simd_target_name(simd), stage);
      Stage got;
      kernels::guided_stage(simd, stage, kNewton, got.forces(), got.rk4(), got.all());
      CHECK(first_difference(got.result(), expected.result()) == -1);
      for (size_t a = 0; a < 3; ++a) {
        CHECK(first_difference(got.rate(a), expected.rate(a)) == -1);
      }
    }
  }
}

TEST_CASE("of an adaptive mesh stages have the bits of the scalar twin, and sizes stay",
          "[kernels]") {
  Stage uniform;
  scalar::guided_stage(1, kNewton, uniform.forces(), uniform.rk4(), uniform.all());
  for (int stage = 0; stage < 4; ++stage) {
    Stage expected;
    scalar::guided_stage(stage, kNewton, sized(expected), expected.rk4(), expected.all());
    if (stage == 1) {
      CHECK(first_difference(expected.result(), uniform.result()) != -1);
      Stage stiff;
      for (float& c : stiff.compliance) c *= 0.5F;
      scalar::guided_stage(stage, kNewton, sized(stiff), stiff.rk4(), stiff.all());
      CHECK(first_difference(expected.result(), stiff.result()) != -1);
    }
    for (const SimdTarget simd : plc::available_simd_targets()) {
      CAPTURE(plc::simd_target_name(simd), stage);
      Stage got;
      kernels::guided_stage(simd, stage, kNewton, sized(got), got.rk4(), got.all());
      CHECK(first_difference(got.result(), expected.result()) == -1);
    }
  }
  Stage expected;
  const auto forces = sized(expected);
  scalar::guided_move(kNewton, forces, expected.rk4(), kBound, expected.ends(), expected.all());
  for (uint32_t v = 0; v < expected.rings.count(); ++v) {
    REQUIRE(expected.moved_to[v].w == expected.rings.position[v].w);
  }
  for (const SimdTarget simd : plc::available_simd_targets()) {
    Stage got;
    const auto f = sized(got);
    kernels::guided_move(simd, kNewton, f, got.rk4(), kBound, got.ends(), got.all());
    CHECK(first_difference(got.result(), expected.result()) == -1);
  }
}

TEST_CASE("a guided move is the last stage and the move, and writes no rates", "[kernels]") {
  Stage expected;
  const Stage before;
  expected.apart(3);
  expected.movement =
      scalar::move(kBound, expected.three(6), expected.fixed(9), expected.ends(), expected.all());
  CHECK(expected.movement.energy > 0);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    Stage got;
    got.movement =
        kernels::guided_move(simd, kNewton, got.forces(), got.rk4(), kBound, got.ends(), got.all());
    CHECK(first_difference(got.result(), expected.result()) == -1);
    CHECK(first_difference(got.rate(1), before.rate(1)) == -1);
    CHECK(got.movement.energy == expected.movement.energy);
    CHECK(got.movement.longest2 == expected.movement.longest2);
  }
}

TEST_CASE("listed blocks move alike, and no others", "[kernels]") {
  const plc::Vector<uint32_t> list = {0, 1, 5, 6, 7, 23, 239};
  const Blocks blocks{list.data(), list.size()};
  Stage whole;
  scalar::guided_stage(1, kNewton, whole.forces(), whole.rk4(), whole.all());
  const Stage before;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    Stage got;
    kernels::guided_stage(simd, 1, kNewton, got.forces(), got.rk4(), blocks);
    for (uint32_t v = 0; v < got.rings.count(); ++v) {
      const bool listed = std::find(list.begin(), list.end(), v / plc::kRingLanes) != list.end();
      const Stage& from = listed ? whole : before;
      REQUIRE(got.next[v].x == from.next[v].x);
      REQUIRE(got.streams[6][v] == from.streams[6][v]);
      REQUIRE(got.rate(2)[v] == from.rate(2)[v]);
    }
  }
}

TEST_CASE("tasks of a list move their own blocks only, and together all of it", "[kernels]") {
  plc::Vector<uint32_t> list;
  for (uint32_t block = 0; block < kBlocks; block += block % 3 + 1) list.push_back(block);
  Stage whole;
  scalar::guided_stage(1, kNewton, whole.forces(), whole.rk4(), {list.data(), list.size()});
  const size_t middle = list.size() / 3;
  const Stage before;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    Stage got;
    const auto run = [&](size_t begin, size_t end) {
      kernels::guided_stage(simd, 1, kNewton, got.forces(), got.rk4(),
                            Blocks::of(list.data(), list.size(), begin, end));
    };
    run(middle, list.size());
    const uint32_t first = list[middle] * plc::kRingLanes;
    CHECK(got.next[first].x == whole.next[first].x);
    for (uint32_t v = 0; v < first; ++v) REQUIRE(got.next[v].x == before.next[v].x);
    run(0, middle);
    CHECK(first_difference(got.result(), whole.result()) == -1);
  }
}

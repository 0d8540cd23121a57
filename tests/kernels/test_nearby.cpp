#include "kernels/nearby.h"

#include <catch2/catch.hpp>

#include "kernels/scalar.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

namespace kernels = plc::kernels;
using plc::SimdTarget;

// Places in a cube of 4 and normals of about unit length.
struct Places {
  explicit Places(uint32_t places, uint32_t seed)
      : padded((places + plc::kRingLanes - 1) / plc::kRingLanes * plc::kRingLanes), count(places) {
    for (uint32_t i = 0; i < 6; ++i) {
      const float bound = i < 3 ? 2.0F : 0.6F;
      stream[i] = fixtures::random_floats(padded, -bound, bound, seed + i);
    }
  }
  kernels::NearbyView view() const {
    return {stream[0].data(),
            stream[1].data(),
            stream[2].data(),
            stream[3].data(),
            stream[4].data(),
            stream[5].data(),
            count};
  }
  uint32_t padded, count;
  std::vector<float> stream[6];
};

plc::Vector<uint32_t> hits_of(SimdTarget simd, const Places& places,
                              const kernels::NearbyQuery& query) {
  plc::Vector<uint32_t> hits(places.count, 7);
  hits.resize(kernels::near_or_turned(simd, places.view(), query, hits.data()));
  return hits;
}

constexpr kernels::NearbyQuery kQuery{0.1F, -0.2F, 0.3F, 0.6F, 0, 0.8F, 0.5F, 2.5F, 0.1F};

}  // namespace

TEST_CASE("what is near is found, and what is farther only where it is turned away", "[kernels]") {
  const Places places(500, 3);
  const auto hits = hits_of(SimdTarget::kScalar, places, kQuery);
  size_t next = 0;
  int near = 0, turned = 0;
  for (uint32_t i = 0; i < places.count; ++i) {
    const auto at = [&](int k) { return places.stream[k][i]; };
    const double x = at(0) - 0.1, y = at(1) + 0.2, z = at(2) - 0.3;
    const double squared = x * x + y * y + z * z;
    const double agreement = 0.6 * at(3) + 0.8 * at(5);
    const bool is_near = squared < 0.5;
    const bool is_turned = squared <= 2.5 && agreement <= 0.1;
    near += is_near ? 1 : 0;
    turned += is_turned ? 1 : 0;
    if (!is_near && !is_turned) continue;
    REQUIRE(next < hits.size());
    CHECK(hits[next++] == i);
  }
  CHECK(next == hits.size());
  CHECK(near > 5);
  CHECK(turned > 30);
}

TEST_CASE("every SIMD target finds the same, for any count, and never the padding", "[kernels]") {
  for (const uint32_t count : {0U, 1U, 5U, 16U, 17U, 63U, 64U, 65U, 100U, 333U}) {
    const Places places(count, 11 + count);
    const auto twin = hits_of(SimdTarget::kScalar, places, kQuery);
    for (const SimdTarget simd : plc::available_simd_targets()) {
      CAPTURE(count, plc::simd_target_name(simd));
      CHECK(hits_of(simd, places, kQuery) == twin);
    }
  }
}

TEST_CASE("bounds: nearer than near, up to far, agreement up to most", "[kernels]") {
  Places places(16, 1);
  for (auto& stream : places.stream) stream.assign(16, 0);
  places.stream[0] = {1, 2, 3, 1, 2, 3, 1, 2, 3, 9, 9, 9, 9, 9, 9, 9};
  places.stream[5] = {0.5F, 0.5F, 0.5F, 0.25F, 0.25F, 0.25F, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0};
  const kernels::NearbyQuery query{0, 0, 0, 0, 0, 1, 1, 4, 0.25F};
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CHECK(hits_of(simd, places, query) == plc::Vector<uint32_t>{3, 4});
    kernels::NearbyQuery wider = query;
    wider.near_squared = 1.5F;
    CHECK(hits_of(simd, places, wider) == plc::Vector<uint32_t>{0, 3, 4, 6});
  }
}

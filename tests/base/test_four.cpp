#include "engine/base/four.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

using plc::Four;
using plc::FourInts;

TEST_CASE("four floats are rounded down alike, up to the ends of what fits an integer", "[base]") {
  for (const float x : {0.0F, -0.0F, 0.25F, -0.25F, 1.0F, -1.0F, 8388607.5F, -8388607.5F,
                        16777216.0F, 2147483520.0F, -2147483648.0F, 0x1p-149F, -0x1p-149F}) {
    const FourInts low = plc::floor_four(Four{x, -x == 0x1p31F ? 0 : -x, 2.5F, -2.5F});
    CAPTURE(x);
    CHECK(low[0] == static_cast<int32_t>(std::floor(x)));
    if (x != -0x1p31F) CHECK(low[1] == static_cast<int32_t>(std::floor(-x)));
    CHECK(low[2] == 2);
    CHECK(low[3] == -3);
  }
}

TEST_CASE("of two zeros the first is the lesser and the greater of four", "[base]") {
  const Four zeros{0.0F, -0.0F, 0.0F, -0.0F}, others{-0.0F, 0.0F, 0.0F, -0.0F};
  float low[4], high[4];
  plc::store_four(plc::min_four(zeros, others), low);
  plc::store_four(plc::max_four(zeros, others), high);
  for (int k = 0; k < 4; ++k) {
    CHECK(std::signbit(low[k]) == std::signbit(zeros[k]));
    CHECK(std::signbit(high[k]) == std::signbit(zeros[k]));
  }
}

TEST_CASE("four intervals overlap where they touch, of zeros of either sign too", "[base]") {
  const Four low{-1, -1, -1, -1}, zero{0.0F, -0.0F, 0.0F, -0.0F}, high{1, 1, 1, 1};
  const Four other{-0.0F, 0.0F, 0.0F, -0.0F};
  CHECK(plc::overlap_four(low, zero, other, high));
  CHECK(plc::same_four(zero, other));
  CHECK_FALSE(plc::overlap_four(low, zero, Four{0, 0, 0x1p-149F, 0}, high));
}

TEST_CASE("the place of a record alone is loaded, bit for bit", "[base]") {
  const plc::Float4 record{-0.0F, 1, 0x1p-149F, 7};
  float place[4];
  plc::store_four(plc::load_four(record), place);
  CHECK(std::signbit(place[0]));
  CHECK(place[1] == 1);
  CHECK(place[2] == 0x1p-149F);
  CHECK(place[3] == 0);
}

TEST_CASE("a comparison of four has a bit for each lane where it holds", "[base]") {
  const uint32_t ids[4] = {7, 2, 7, ~0U};
  CHECK(plc::lane_bits(plc::load_four(ids) == 7) == 5);
  CHECK(plc::lane_bits(plc::load_four(ids) == -1) == 8);
  const Four values{1, 2, 3, 4};
  CHECK(plc::lane_bits(values - 1.0F >= 2.0F) == 12);
  CHECK(plc::lane_bits((5.0F - values >= 4.0F) | (values >= 4.0F)) == 9);
}

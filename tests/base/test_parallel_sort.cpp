#include "engine/base/parallel_sort.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <random>
#include <vector>

#include "engine/base/schedule.h"

TEST_CASE("pieces are sorted and merged into what one sort gives", "[parallel_sort]") {
  std::mt19937 random(7);
  const plc::Schedule schedule(3);
  for (const size_t count : {0U, 1U, 255U, 512U, 1000U, 1023U, 1024U, 5000U, 20000U}) {
    plc::Vector<uint32_t> values(count);
    for (uint32_t& v : values) v = static_cast<uint32_t>(random() % 5000);
    std::vector<uint32_t> upwards(values.begin(), values.end());
    std::sort(upwards.begin(), upwards.end());
    std::vector<uint32_t> downwards(upwards.rbegin(), upwards.rend());
    plc::parallel_sort(values, schedule);
    CHECK(std::equal(values.begin(), values.end(), upwards.begin(), upwards.end()));
    plc::parallel_sort(values, schedule, std::greater<uint32_t>());
    CHECK(std::equal(values.begin(), values.end(), downwards.begin(), downwards.end()));
  }
}

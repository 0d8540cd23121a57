// Hashes of what kernels have written.
#pragma once
#include <vector>

#include "engine/base/fnv.h"
#include "kernels/integrate.h"
#include "tests/samples/kernel_fixtures.h"

namespace golden {

using namespace fixtures;
using plc::Float4;
using plc::Fnv;
using plc::SimdTarget;
namespace kernels = plc::kernels;

inline uint64_t hash_of(const std::vector<float>& values) {
  Fnv hash;
  hash.add_all(values);
  return hash.value();
}

struct Three {
  std::vector<float> x, y, z;
  explicit Three(size_t count, float low = 0, float high = 0, uint32_t seed = 1)
      : x(random_floats(count, low, high, seed)),
        y(random_floats(count, low, high, seed + 1)),
        z(random_floats(count, low, high, seed + 2)) {}
  kernels::Float3s out() { return {x.data(), y.data(), z.data()}; }
  kernels::ConstFloat3s in() const { return {x.data(), y.data(), z.data()}; }
};

inline void add(Fnv& hash, const Three& streams) {
  for (const auto* s : {&streams.x, &streams.y, &streams.z}) hash.add_all(*s);
}
inline uint64_t hash_of(const Three& streams) {
  Fnv hash;
  add(hash, streams);
  return hash.value();
}

}  // namespace golden

#include "engine/state_hash.h"

#include <algorithm>
#include <bit>

namespace plc {

namespace {

class Fnv {
 public:
  template <typename T>
  void add(T value) {
    for (size_t i = 0; i < sizeof(T); ++i) {
      hash_ = (hash_ ^ (value >> (8 * i) & 0xFFU)) * 0x100000001B3ULL;
    }
  }
  uint64_t value() const { return hash_; }

 private:
  uint64_t hash_ = 0xCBF29CE484222325ULL;
};

}  // namespace

uint64_t state_hash(const Mesh& mesh) {
  Fnv hash;
  hash.add(static_cast<uint64_t>(mesh.vertex_count()));
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const Packed& p = mesh.packed[v];
    for (const float c : {p.x, p.y, p.z}) hash.add(std::bit_cast<uint32_t>(c));
  }
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const Neighbors ring = mesh.ring(v);
    hash.add(ring.size());
    const auto first =
        static_cast<uint32_t>(std::min_element(ring.begin(), ring.end()) - ring.begin());
    for (uint32_t k = 0; k < ring.size(); ++k) hash.add(ring[(first + k) % ring.size()]);
  }
  return hash.value();
}

}  // namespace plc

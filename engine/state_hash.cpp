#include "engine/state_hash.h"

#include <algorithm>

#include "engine/fnv.h"

namespace plc {

uint64_t state_hash(const Mesh& mesh) {
  Fnv hash;
  hash.add(static_cast<uint64_t>(mesh.vertex_count()));
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const Packed& p = mesh.packed[v];
    for (const float c : {p.x, p.y, p.z}) hash.add(c);
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

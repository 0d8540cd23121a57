#include "engine/mesh/state_hash.h"

namespace plc {

uint64_t state_hash(const Mesh& mesh) {
  Fnv hash;
  hash.add(static_cast<uint64_t>(mesh.vertex_count()));
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const Float4& p = mesh.position[v];
    for (const float c : {p.x, p.y, p.z}) hash.add(c);
  }
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const uint32_t d = mesh.valence(v);
    hash.add(d);
    uint32_t first = 0;
    for (uint32_t k = 1; k < d; ++k) {
      if (mesh.neighbor(v, k) < mesh.neighbor(v, first)) first = k;
    }
    for (uint32_t k = 0; k < d; ++k) hash.add(mesh.neighbor(v, (first + k) % d));
  }
  return hash.value();
}

PartHash part_hash(std::string_view part, const Streams3& streams) {
  Fnv hash;
  for (const Buffer<float>* s : {&streams.x, &streams.y, &streams.z}) hash.add_all(*s);
  return {part, hash.value()};
}

PartHash part_hash(std::string_view part, const Buffer<Float4>& records) {
  Fnv hash;
  for (const Float4& r : records) {
    for (const float c : {r.x, r.y, r.z, r.w}) hash.add(c);
  }
  return {part, hash.value()};
}

std::vector<PartHash> part_hashes(const Mesh& mesh) {
  Fnv rings;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    rings.add(mesh.valence(v));
    rings.add_all(mesh.ring(v));
  }
  Fnv counts;
  counts.add(mesh.slots());
  counts.add(mesh.vertex_count());
  counts.add(mesh.created());
  counts.add(mesh.delta);
  return {{"counts and delta", counts.value()},
          {"rings", rings.value()},
          part_hash("free ids", mesh.free_ids()),
          part_hash("position", mesh.position),
          part_hash("velocity", mesh.velocity),
          part_hash("normal", mesh.normal),
          part_hash("displacement", mesh.displacement),
          part_hash("path", mesh.path),
          part_hash("turns", mesh.turns),
          part_hash("cut id", mesh.cut_id),
          part_hash("cut iteration", mesh.cut_iteration)};
}

}  // namespace plc

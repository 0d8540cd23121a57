// A mesh as bytes and back: all that it hands on from pass to pass.
#include <algorithm>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/base/state_io.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/mesh_invariants.h"

namespace plc {

namespace {

bool within_reach(float x) {
  return std::abs(x) <= kReach;
}

bool within_reach(const Buffer<float>& b) {
  return std::all_of(b.begin(), b.end(), [](float x) { return within_reach(x); });
}

bool within_reach(const Streams3& s) {
  return within_reach(s.x) && within_reach(s.y) && within_reach(s.z);
}

bool within_reach(const Buffer<Float4>& b) {
  return std::all_of(b.begin(), b.end(), [](const Float4& p) {
    return within_reach(p.x) && within_reach(p.y) && within_reach(p.z) &&
           p.w >= SizeField::kLeast && p.w <= SizeField::kMost;
  });
}

}  // namespace

// Padding included: it may sleep or not. Rings without the places of their tails, which tell
// nothing.
void Mesh::save(StateWriter& to) const {
  to.add(delta);
  to.add(slots_);
  to.add(created_);
  visit_streams(*this, [&](const auto& stream) { to.add_some(stream, padded()); });
  to.add_some(valence_, slots_);
  for (uint32_t v = 0; v < slots_; ++v) {
    for (uint32_t k = 0; k < valence(v); ++k) to.add(neighbor(v, k));
  }
  to.add_all(free_);
}

bool Mesh::restore(StateReader& from) {
  clear();
  uint32_t slots = 0;
  from.read(delta);
  from.read(slots);
  uint32_t created = 0;
  from.read(created);
  from.demand(delta > 0 && std::isfinite(delta) && slots <= from.left() && slots <= most_vertices);
  if (!from.ok()) return false;
  grow(slots);
  created_ = created;
  const size_t n = padded();
  visit_streams(*this, [&](auto& stream) {
    from.read_all(stream);
    from.demand(stream.size() == n);
  });
  return restore_rings(from) && within_reach(position) && within_reach(velocity) &&
         within_reach(normal) && within_reach(displacement) && within_reach(path) &&
         broken_invariant(*this).empty();
}

bool Mesh::restore_rings(StateReader& from) {
  Buffer<uint16_t> valences;
  from.read_all(valences);
  from.demand(valences.size() == slots_);
  for (uint32_t v = 0; v < slots_ && from.ok(); ++v) {
    Neighbors ring;
    for (uint32_t k = 0; k < valences[v] && from.ok(); ++k) {
      uint32_t neighbor = 0;
      from.read(neighbor);
      from.demand(neighbor < slots_);
      ring.push_back(neighbor);
    }
    if (from.ok()) set_ring(v, ring);
  }
  from.read_all(free_);
  // Each dead one once.
  from.demand(free_.size() == slots_ - alive_);
  if (!from.ok()) return false;
  Buffer<uint8_t> listed(slots_);
  return std::all_of(free_.begin(), free_.end(), [&](uint32_t v) {
    if (v >= slots_ || alive(v) || listed[v] != 0) return false;
    listed[v] = 1;
    return true;
  });
}

}  // namespace plc

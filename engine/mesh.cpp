#include "engine/mesh.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>
#include <vector>

#include "engine/blocks.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// Tails come in powers of two from 16 up; class c holds 16 << c neighbours.
uint32_t tail_class(uint32_t length) {
  return static_cast<uint32_t>(std::countr_zero(std::bit_ceil(std::max(length, 16U)))) - 4;
}

template <typename T>
void permute(Buffer<T>& buffer, const Vector<uint32_t>& order) {
  Buffer<T> moved(buffer.size());
  for (size_t i = 0; i < order.size(); ++i) moved[i] = buffer[order[i]];
  buffer.swap(moved);
}

}  // namespace

void Streams3::resize(size_t n) {
  x.resize(n);
  y.resize(n);
  z.resize(n);
}

uint32_t Mesh::padded() const {
  return (slots_ + kRingLanes - 1) / kRingLanes * kRingLanes;
}

bool Mesh::adjacent(uint32_t u, uint32_t v) const {
  const uint32_t d = valence(u);
  for (uint32_t k = 0; k < d; ++k) {
    if (neighbor(u, k) == v) return true;
  }
  return false;
}

Neighbors Mesh::ring(uint32_t v) const {
  Neighbors out;
  const uint32_t d = valence(v);
  out.resize(d);
  uint32_t* to = out.data();
  for (uint32_t k = 0; k < d; ++k) to[k] = neighbor(v, k);
  return out;
}

void Mesh::place(uint32_t v, Vec3 p) {
  packed[v] = {p.x, p.y, p.z, 0};
  calm[v] = 0;
}

uint32_t Mesh::create(Vec3 p, Vec3 speed) {
  ++created_;
  uint32_t v = slots_;
  if (!free_.empty()) {
    v = free_.back();
    free_.pop_back();
  } else {
    grow(slots_ + 1);
  }
  place(v, p);
  velocity.set(v, speed);
  normal.set(v, {});
  displacement.set(v, {});
  path[v] = 0;
  stir[v] = 0;
  risk[v] = kNearRisk;
  operations[v] = 0;
  cut_id[v] = 0;
  cut_iteration[v] = 0;
  wake(v);
  return v;
}

void Mesh::destroy(uint32_t v) {
  set_valence(v, 0);
  velocity.set(v, {});
  normal.set(v, {});
  displacement.set(v, {});
  free_.push_back(v);
}

// Brings the tail in line with the new valence; the slots are not touched.
void Mesh::set_valence(uint32_t v, uint32_t d) {
  const uint32_t old_tail = valence_[v] > kRingSlots ? valence_[v] - kRingSlots : 0;
  const uint32_t new_tail = d > kRingSlots ? d - kRingSlots : 0;
  const bool keep = old_tail != 0 && new_tail != 0 && tail_class(old_tail) == tail_class(new_tail);
  if (!keep) {
    if (old_tail != 0) free_tail(column(v, kRingSlots), old_tail);
    if (new_tail != 0) column(v, kRingSlots) = allocate_tail(new_tail);
  }
  alive_ += static_cast<uint32_t>(d != 0) - static_cast<uint32_t>(valence_[v] != 0);
  valence_[v] = static_cast<uint16_t>(d);
  for (uint32_t k = d; k < kRingSlots; ++k) column(v, k) = v;
}

void Mesh::set_ring(uint32_t v, const Neighbors& ring) {
  set_valence(v, ring.size());
  const uint32_t* from = ring.data();
  const uint32_t inline_count = std::min(ring.size(), kRingSlots);
  for (uint32_t k = 0; k < inline_count; ++k) column(v, k) = from[k];
  if (ring.size() > kRingSlots) {
    std::copy(from + kRingSlots, from + ring.size(), tail_.data() + column(v, kRingSlots));
  }
}

void Mesh::replace(uint32_t v, uint32_t old_neighbor, uint32_t new_neighbor) {
  const uint32_t d = valence(v);
  for (uint32_t k = 0; k < d; ++k) {
    if (neighbor(v, k) != old_neighbor) continue;
    if (k < kRingSlots) {
      column(v, k) = new_neighbor;
    } else {
      tail_[column(v, kRingSlots) + k - kRingSlots] = new_neighbor;
    }
    return;
  }
}

void Mesh::replace(uint32_t v, uint32_t old_neighbor, uint32_t first, uint32_t second) {
  Neighbors r = ring(v);
  const uint32_t k = r.find(old_neighbor);
  r[k] = first;
  r.insert(k + 1, second);
  set_ring(v, r);
}

void Mesh::insert_after(uint32_t v, uint32_t neighbor, uint32_t added) {
  Neighbors r = ring(v);
  r.insert(r.find(neighbor) + 1, added);
  set_ring(v, r);
}

void Mesh::remove(uint32_t v, uint32_t neighbor) {
  Neighbors r = ring(v);
  r.erase(r.find(neighbor));
  set_ring(v, r);
}

void Mesh::clear() {
  Mesh empty;
  empty.delta = delta;
  *this = std::move(empty);
}

void Mesh::reserve(uint32_t vertices) {
  const uint32_t keep = slots_;
  grow(std::max(vertices, slots_));
  slots_ = keep;
}

void Mesh::grow(uint32_t slots) {
  slots_ = slots;
  const size_t n = padded();
  if (n <= valence_.size()) return;
  const size_t old = valence_.size();
  velocity.resize(n);
  normal.resize(n);
  displacement.resize(n);
  packed.resize(n);
  path.resize(n);
  idle.resize(n);
  calm.resize(n);
  stir.resize(n);
  risk.resize(n);
  operations.resize(n);
  cut_id.resize(n);
  cut_iteration.resize(n);
  columns_.resize(n * kRingColumns);
  valence_.resize(n);
  refresh_view();
  for (size_t v = old; v < n; ++v) {
    for (uint32_t k = 0; k < kRingSlots; ++k) {
      column(static_cast<uint32_t>(v), k) = static_cast<uint32_t>(v);
    }
  }
}

uint32_t Mesh::allocate_tail(uint32_t length) {
  auto& free = free_tails_[tail_class(length)];
  if (!free.empty()) {
    const uint32_t offset = free.back();
    free.pop_back();
    return offset;
  }
  const size_t offset = tail_.size();
  tail_.resize(offset + (16U << tail_class(length)));
  refresh_view();
  return static_cast<uint32_t>(offset);
}

void Mesh::free_tail(uint32_t offset, uint32_t length) {
  free_tails_[tail_class(length)].push_back(offset);
}

void Mesh::renumber(const Vector<uint32_t>& order, const Executor& executor) {
  Mesh to;
  to.delta = delta;
  to.grow(static_cast<uint32_t>(order.size()));
  carry_rings(order, to, executor);
  const size_t n = to.valence_.size();
  std::vector<std::function<void()>> streams;
  const auto carry = [&](auto& target, auto& source) {
    streams.emplace_back([&target, &source, &order, n] {
      permute(source, order);
      source.resize(n);
      target.swap(source);
    });
  };
  carry(to.packed, packed);
  carry(to.path, path);
  carry(to.idle, idle);
  carry(to.calm, calm);
  carry(to.stir, stir);
  carry(to.risk, risk);
  carry(to.operations, operations);
  carry(to.cut_id, cut_id);
  carry(to.cut_iteration, cut_iteration);
  for (const auto& [target, source] :
       {std::pair{&to.velocity, &velocity}, std::pair{&to.normal, &normal},
        std::pair{&to.displacement, &displacement}}) {
    carry(target->x, source->x);
    carry(target->y, source->y);
    carry(target->z, source->z);
  }
  executor.run(streams.size(), [&](size_t stream) { streams[stream](); });
  *this = std::move(to);
  refresh_view();
}

// `to` is new and has a slot for each vertex of `order`.
void Mesh::carry_rings(const Vector<uint32_t>& order, Mesh& to, const Executor& executor) const {
  constexpr size_t kBlock = 4096;
  Vector<uint32_t> new_id(slots_);
  run_blocks(executor, order.size(), kBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) new_id[order[i]] = static_cast<uint32_t>(i);
  });
  run_blocks(executor, order.size(), kBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const uint32_t d = valence_[order[i]];
      if (d > kRingSlots) continue;
      const auto v = static_cast<uint32_t>(i);
      to.valence_[v] = static_cast<uint16_t>(d);
      for (uint32_t k = 0; k < d; ++k) to.column(v, k) = new_id[neighbor(order[i], k)];
    }
  });
  to.alive_ = static_cast<uint32_t>(order.size());
  // Tails share an arena.
  for (uint32_t i = 0; i < order.size(); ++i) {
    if (valence_[order[i]] <= kRingSlots) continue;
    Neighbors r = ring(order[i]);
    for (uint32_t k = 0; k < r.size(); ++k) r[k] = new_id[r[k]];
    --to.alive_;
    to.set_ring(i, r);
  }
}

Vector<uint32_t> Mesh::faces() const {
  Vector<uint32_t> out;
  out.reserve(static_cast<size_t>(alive_) * 6);
  for (uint32_t v = 0; v < slots_; ++v) {
    const uint32_t d = valence(v);
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t a = neighbor(v, k);
      const uint32_t b = neighbor(v, k + 1 == d ? 0 : k + 1);
      if (v < a && v < b) out.insert(out.end(), {v, a, b});
    }
  }
  return out;
}

Mesh Mesh::copy() const {
  Mesh to(*this);
  to.refresh_view();
  return to;
}

uint64_t Mesh::bytes() const {
  const auto of = [](const auto& b) { return b.capacity() * sizeof(b[0]); };
  const auto of3 = [&](const Streams3& s) { return of(s.x) + of(s.y) + of(s.z); };
  return of3(velocity) + of3(normal) + of3(displacement) + of(packed) + of(path) + of(idle) +
         of(calm) + of(stir) + of(risk) + of(operations) + of(cut_id) + of(cut_iteration) +
         of(columns_) + of(valence_) + of(tail_);
}

}  // namespace plc

#include "engine/mesh/mesh.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// Tails come in powers of two from 16 up; class c holds 16 << c neighbours.
uint32_t tail_class(uint32_t length) {
  return static_cast<uint32_t>(std::countr_zero(std::bit_ceil(std::max(length, 16U)))) - 4;
}

[[maybe_unused]] bool distinct(const Vector<uint32_t>& ids, uint32_t below) {
  std::vector<bool> seen(below);
  return std::all_of(ids.begin(), ids.end(), [&](uint32_t v) {
    if (v >= below || seen[v]) return false;
    seen[v] = true;
    return true;
  });
}

// What a renumbered mesh has room for: ids are given anew when a sixteenth of them has been
// created (recovery.cpp), many of them anew in place of deleted ones. Beyond it streams are copied
// to half as much again.
size_t with_room(size_t padded) {
  return padded + padded / (2 * kRingLanes) / kRingLanes * kRingLanes;
}

// target: new, of `padded` elements: those of `source`, in this order, then zeros.
template <typename T>
void permute(const Buffer<T>& source, const Vector<uint32_t>& order, size_t padded,
             Buffer<T>& target) {
  target.reserve(with_room(padded));
  target.resize_uninitialized(order.size());
  for (size_t i = 0; i < order.size(); ++i) target[i] = source[order[i]];
  target.resize(padded);
}

}  // namespace

void Streams3::resize(size_t n, size_t room) {
  for (Buffer<float>* stream : {&x, &y, &z}) {
    stream->reserve(room);
    stream->resize(n);
  }
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
  assert(v < slots_);
  position[v] = {p.x, p.y, p.z, 0};
  resize(v);
  touch(v);
}

uint32_t Mesh::create(Vec3 p, Vec3 speed) {
  ++created_;
  uint32_t v = slots_;
  if (!free_.empty()) {
    v = free_.back();
    free_.pop_back();
  } else {
    grow(uint64_t{slots_} + 1);
  }
  assert(!alive(v));
  start_vertex(v);
  place(v, p);
  velocity.set(v, speed);
  return v;
}

// Everything but its ring.
void Mesh::start_vertex(uint32_t v) {
  visit_streams(*this, [v](auto& stream) { stream[v] = {}; });
  if (is_patch()) held[v] = 0;
  reset_bytes(v, VertexBytes::Reset::kCreated);
}

uint32_t Mesh::create_many(uint32_t count, const std::function<uint32_t(uint32_t)>& valence,
                           const Executor& executor) {
  constexpr size_t kBlock = 4096;
  assert(free_.empty());
  const uint32_t first = slots_;
  grow(uint64_t{slots_} + count);
  run_blocks(executor, count, kBlock, [&](size_t, size_t begin, size_t end) {
    for (auto i = static_cast<uint32_t>(begin); i < end; ++i) {
      const uint32_t d = valence(i);
      start_vertex(first + i);
      valence_[first + i] = static_cast<uint16_t>(d <= kRingSlots ? d : 0);
    }
  });
  created_ += count;
  alive_ += count;
  // Tails share an arena.
  for (uint32_t i = 0; i < count; ++i) {
    if (valence_[first + i] != 0) continue;
    --alive_;
    set_valence(first + i, valence(i));
  }
  return first;
}

void Mesh::destroy(uint32_t v) {
  assert(alive(v) && !is_held(v));
  set_valence(v, 0);
  velocity.set(v, {});
  normal.set(v, {});
  displacement.set(v, {});
  free_.push_back(v);
}

// Brings the tail in line with the new valence; the slots are not touched.
void Mesh::set_valence(uint32_t v, uint32_t d) {
  assert(v < slots_);
  if (d > kMaxValence) {
    throw std::length_error("a vertex would have " + std::to_string(d) + " neighbours");
  }
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
  exchange_ring(v, ring);
}

void Mesh::exchange_ring(uint32_t v, const Neighbors& ring) {
  assert(ring.size() == valence(v));
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
  assert(false && "replace: no such neighbour");
}

void Mesh::replace(uint32_t v, uint32_t old_neighbor, uint32_t first, uint32_t second) {
  Neighbors r = ring(v);
  const uint32_t k = r.find(old_neighbor);
  assert(k < r.size());
  r[k] = first;
  r.insert(k + 1, second);
  set_ring(v, r);
}

void Mesh::insert_after(uint32_t v, uint32_t neighbor, uint32_t added) {
  Neighbors r = ring(v);
  assert(r.contains(neighbor));
  r.insert(r.find(neighbor) + 1, added);
  set_ring(v, r);
}

void Mesh::remove(uint32_t v, uint32_t neighbor) {
  Neighbors r = ring(v);
  assert(r.contains(neighbor));
  r.erase(r.find(neighbor));
  set_ring(v, r);
}

void Mesh::take(Mesh&& other) {
  *this = std::move(other);
  for (VertexBytes* bytes : attached_) start_bytes(*bytes);
}

void Mesh::attach(VertexBytes& bytes) {
  attached_.add(bytes);
  start_bytes(bytes);
}

// As if every vertex had just been created.
void Mesh::start_bytes(VertexBytes& bytes) {
  bytes.bytes_.clear();
  bytes.bytes_.resize(valence_.size());
  std::fill_n(bytes.bytes_.begin(), slots_, bytes.first_);
}

void Mesh::clear() {
  Mesh empty;
  empty.delta = delta;
  empty.sizing = sizing;
  empty.inside_out = inside_out;
  empty.obstacles = obstacles;
  empty.stretch = stretch;
  empty.longest_edge = longest_edge;
  empty.most_vertices = most_vertices;
  empty.most_neighbors = most_neighbors;
  *this = std::move(empty);
  for (VertexBytes* bytes : attached_) bytes->bytes_ = {};
}

void Mesh::reserve(uint64_t vertices) {
  const uint32_t keep = slots_;
  grow(std::max<uint64_t>(vertices, slots_));
  slots_ = keep;
}

void Mesh::grow(uint64_t slots) {
  if (slots > most_vertices) throw TooManyVertices();
  slots_ = static_cast<uint32_t>(slots);
  const size_t n = padded();
  if (n <= valence_.size()) return;
  const size_t old = valence_.size();
  visit_streams(*this, [n](auto& stream) { stream.resize(n); });
  if (is_patch()) held.resize(n);
  for (VertexBytes* bytes : attached_) bytes->bytes_.resize(n);
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
  const size_t end = offset + (16U << tail_class(length));
  if (end > std::numeric_limits<uint32_t>::max()) throw TooManyVertices();
  tail_.resize(end);
  refresh_view();
  return static_cast<uint32_t>(offset);
}

void Mesh::free_tail(uint32_t offset, uint32_t length) {
  free_tails_[tail_class(length)].push_back(offset);
}

void Mesh::renumber(const Vector<uint32_t>& order, const Executor& executor) {
  assert(order.size() == alive_ && distinct(order, slots_));
  Mesh to;
  to.delta = delta;
  to.sizing = sizing;
  to.inside_out = inside_out;
  to.obstacles = obstacles;
  to.stretch = stretch;
  to.longest_edge = longest_edge;
  to.most_vertices = most_vertices;
  to.most_neighbors = most_neighbors;
  to.slots_ = to.alive_ = static_cast<uint32_t>(order.size());
  to.held_ = held_;
  to.patch_ = patch_;
  carry_rings(order, to, executor);
  std::vector<std::function<void()>> streams;
  visit_streams(to, *this, [&](auto& target, auto& source) {
    streams.emplace_back([&] {
      permute(source, order, to.padded(), target);
      source = {};
    });
  });
  if (is_patch()) {
    streams.emplace_back([&] { permute(held, order, to.padded(), to.held); });
  }
  const size_t own = streams.size();
  // Side by side, as the streams of a mesh are (buffer.h).
  std::vector<Buffer<uint8_t>> renumbered(attached_.size());
  for (VertexBytes* bytes : attached_) {
    streams.emplace_back([&, bytes, target = &renumbered[streams.size() - own]] {
      permute(bytes->bytes_, order, to.padded(), *target);
      bytes->bytes_ = {};
    });
  }
  executor.run(streams.size(), [&](size_t stream) { streams[stream](); });
  *this = std::move(to);
  size_t next = 0;
  for (VertexBytes* bytes : attached_) bytes->bytes_.swap(renumbered[next++]);
  refresh_view();
}

// `to` is new.
void Mesh::carry_rings(const Vector<uint32_t>& order, Mesh& to, const Executor& executor) const {
  constexpr size_t kBlock = 4096;
  Vector<uint32_t> new_id(slots_);
  run_blocks(executor, order.size(), kBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) new_id[order[i]] = static_cast<uint32_t>(i);
  });
  const size_t padded = to.padded();
  to.valence_.reserve(with_room(padded));
  to.valence_.resize_uninitialized(padded);
  to.columns_.reserve(with_room(padded) * kRingColumns);
  to.columns_.resize_uninitialized(padded * kRingColumns);
  to.refresh_view();
  run_blocks(executor, padded, kBlock, [&](size_t, size_t begin, size_t end) {
    for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
      const uint32_t known = v < order.size() ? valence_[order[v]] : 0;
      const uint32_t d = known <= kRingSlots ? known : 0;
      to.valence_[v] = static_cast<uint16_t>(d);
      for (uint32_t k = 0; k < d; ++k) to.column(v, k) = new_id[neighbor(order[v], k)];
      for (uint32_t k = d; k < kRingSlots; ++k) to.column(v, k) = v;
      to.column(v, kRingSlots) = 0;
    }
  });
  // Tails share an arena.
  for (uint32_t i = 0; i < order.size(); ++i) {
    if (valence_[order[i]] <= kRingSlots) continue;
    Neighbors r = ring(order[i]);
    for (uint32_t k = 0; k < r.size(); ++k) r[k] = new_id[r[k]];
    --to.alive_;
    to.set_ring(i, r);
  }
}

Vector<uint32_t> Mesh::faces(const Executor& executor) const {
  constexpr size_t kBlock = 4096;
  Vector<size_t> first(block_count(slots_, kBlock) + 1, 0);
  run_blocks(executor, slots_, kBlock, [&](size_t block, size_t begin, size_t end) {
    visit_faces(static_cast<uint32_t>(begin), static_cast<uint32_t>(end),
                [&](uint32_t, uint32_t, uint32_t) { ++first[block + 1]; });
  });
  for (size_t block = 1; block < first.size(); ++block) first[block] += first[block - 1];
  Vector<uint32_t> out(3 * first.back());
  run_blocks(executor, slots_, kBlock, [&](size_t block, size_t begin, size_t end) {
    uint32_t* to = out.data() + 3 * first[block];
    visit_faces(static_cast<uint32_t>(begin), static_cast<uint32_t>(end),
                [&](uint32_t v, uint32_t a, uint32_t b) {
                  to[0] = v, to[1] = a, to[2] = b;
                  to += 3;
                });
  });
  return out;
}

void Mesh::hold(const Vector<uint32_t>& to) {
  assert(to.size() == slots_);
  patch_ = true;
  held.resize(valence_.size());
  std::copy(to.begin(), to.end(), held.begin());
  held_ = slots_ - static_cast<uint32_t>(std::count(to.begin(), to.end(), 0U));
}

Mesh Mesh::copy() const {
  Mesh to(*this);
  to.refresh_view();
  return to;
}

void measure_edges(Mesh& mesh) {
  float longest = 0, of_size = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (mesh.is_absent(v)) continue;
    for (uint32_t k = 0; k < mesh.valence(v); ++k) {
      const uint32_t w = mesh.neighbor(v, k);
      if (mesh.is_absent(w)) continue;
      const float edge = length(mesh.at(v) - mesh.at(w));
      longest = std::max(longest, edge);
      of_size = std::max(of_size, edge / mesh.size_between(v, w));
    }
  }
  mesh.stretch = std::max(mesh.sizing != nullptr ? kSizedStretch : 1, of_size / kMaxEdge);
  mesh.longest_edge = longest;
  if (mesh.sizing != nullptr) {
    mesh.longest_edge = std::max(longest, mesh.longest_sized_edge());
  }
}

uint64_t Mesh::bytes() const {
  const auto of = [](const auto& b) { return b.capacity() * sizeof(b[0]); };
  uint64_t sum = of(columns_) + of(valence_) + of(tail_) + of(held);
  visit_streams(*this, [&](const auto& stream) { sum += of(stream); });
  for (const VertexBytes* bytes : attached_) sum += of(bytes->bytes_);
  return sum;
}

}  // namespace plc

// Voxels of an image that are not all in memory: boxes of them, "bricks", fetched as they are read.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace plc {

// What one coordinate of a voxel adds to where it lies.
struct BrickPlace {
  uint32_t brick = 0;  // to the number of its brick, x fastest
  uint32_t voxel = 0;  // to its number in the brick, x fastest
};

// The bricks of an image, as what reads voxels sees them: pyramid/brick_cache.h keeps them. A brick
// at the far border has as many voxels as all others; those beyond the image mean nothing.
// Thread-safe. Reading throws what fetching throws.
class Bricks {
 public:
  Bricks() = default;
  virtual ~Bricks() = default;
  Bricks(const Bricks&) = delete;
  Bricks& operator=(const Bricks&) = delete;

  // Within BrickReads, until the thread asks for the next brick of the image.
  const void* brick(uint32_t number) const {
    const void* voxels = table_[number].load();
    if (voxels == nullptr) return fetch(number);
    std::atomic<uint8_t>& lately = read_lately_[number];
    if (lately.load(std::memory_order_relaxed) == 0) lately.store(1, std::memory_order_relaxed);
    return voxels;
  }
  // Voxel (x, y, z), which lies in the image; Voxel is its type.
  template <class Voxel>
  Voxel voxel(int64_t x, int64_t y, int64_t z) const {
    const BrickPlace &i = places_[0][x], &j = places_[1][y], &k = places_[2][z];
    const void* voxels = brick(i.brick + j.brick + k.brick);
    return static_cast<const Voxel*>(voxels)[i.voxel + j.voxel + k.voxel];
  }
  // value(c, voxel) for the eight voxels of the cell whose first is (x, y, z), x fastest.
  template <class Voxel, class Value>
  void cell(int64_t x, int64_t y, int64_t z, const Value& value) const {
    const BrickPlace* i = places_[0] + x;
    const BrickPlace* j = places_[1] + y;
    const BrickPlace* k = places_[2] + z;
    if (i[0].brick == i[1].brick && j[0].brick == j[1].brick && k[0].brick == k[1].brick) {
      const auto* voxels = static_cast<const Voxel*>(brick(i[0].brick + j[0].brick + k[0].brick)) +
                           (i[0].voxel + j[0].voxel + k[0].voxel);
      const size_t row = j[1].voxel - j[0].voxel, plane = k[1].voxel - k[0].voxel;
      for (size_t c = 0; c < 8; ++c) {
        value(c, voxels[(c & 1) + (c >> 1 & 1) * row + (c >> 2) * plane]);
      }
      return;
    }
    for (size_t c = 0; c < 8; ++c) {
      const BrickPlace &u = i[c & 1], &v = j[c >> 1 & 1], &w = k[c >> 2];
      const void* voxels = brick(u.brick + v.brick + w.brick);
      value(c, static_cast<const Voxel*>(voxels)[u.voxel + v.voxel + w.voxel]);
    }
  }
  // visit(voxels, x, count): the voxels x .. end - 1 of row (y, z) in pieces, one behind the other.
  template <class Voxel, class Visit>
  void visit_row(int64_t y, int64_t z, int64_t x, int64_t end, const Visit& visit) const {
    while (x < end) {
      const int64_t next = std::min(end, (x / side_[0] + 1) * side_[0]);
      const BrickPlace &i = places_[0][x], &j = places_[1][y], &k = places_[2][z];
      const void* voxels = brick(i.brick + j.brick + k.brick);
      visit(static_cast<const Voxel*>(voxels) + (i.voxel + j.voxel + k.voxel), x, next - x);
      x = next;
    }
  }

 protected:
  friend class BrickReads;
  // Bricks that were found between enter() and leave() stay, but for those found before fetch();
  // enter() tells what to leave.
  virtual size_t enter() const = 0;
  virtual void leave(size_t reader) const noexcept = 0;
  virtual const void* fetch(uint32_t number) const = 0;
  // What enter() has told this thread.
  inline size_t reader() const;

  std::array<int64_t, 3> side_{1, 1, 1};         // of a brick, voxels
  std::array<const BrickPlace*, 3> places_{};    // of every coordinate on an axis
  std::atomic<const void*>* table_ = nullptr;    // null where a brick is not there
  std::atomic<uint8_t>* read_lately_ = nullptr;  // whether a brick has been read lately
};

// What reads bricks does so within one of these; `bricks` may be null. Those within others of the
// same thread and bricks cost next to nothing.
class BrickReads {
 public:
  explicit BrickReads(const Bricks* bricks) : bricks_(bricks), outer_(innermost) {
    if (bricks == nullptr) return;
    for (const BrickReads* reads = outer_; reads != nullptr; reads = reads->outer_) {
      if (reads->bricks_ == bricks) {
        bricks_ = nullptr;
        return;
      }
    }
    reader_ = bricks->enter();
    innermost = this;
  }
  ~BrickReads() {
    if (bricks_ == nullptr) return;
    innermost = outer_;
    bricks_->leave(reader_);
  }
  BrickReads(const BrickReads&) = delete;
  BrickReads& operator=(const BrickReads&) = delete;

 private:
  friend class Bricks;
  static inline thread_local const BrickReads* innermost = nullptr;
  const Bricks* bricks_;  // null where there is nothing to leave
  const BrickReads* outer_;
  size_t reader_ = 0;
};

size_t Bricks::reader() const {
  const BrickReads* reads = BrickReads::innermost;
  while (reads->bricks_ != this) reads = reads->outer_;
  return reads->reader_;
}

}  // namespace plc

// A set of voxels of an image: a bit each, in memory only where there are some.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

#include "engine/base/state_io.h"
#include "pyramid/memory.h"

namespace plc {

using Voxel = std::array<int32_t, 3>;  // x, y, z

inline bool is_within(const int32_t (&dims)[3], const Voxel& v) {
  return v[0] >= 0 && v[1] >= 0 && v[2] >= 0 && v[0] < dims[0] && v[1] < dims[1] && v[2] < dims[2];
}

// Every slice is cut into blocks of kBlock successive voxels; a block exists once a voxel of it was
// put in. The sets here follow surfaces: on an image of 1024^3 a byte per voxel would be a
// gigabyte, a bit 128 MiB, the blocks along a surface some megabytes beside 2 MiB that tell which
// there are.
//
// Voxels lie in the image. Several threads may read; several may change voxels of different slices.
class VoxelSet {
 public:
  VoxelSet() = default;
  explicit VoxelSet(const int32_t (&dims)[3])
      : width_(static_cast<size_t>(dims[0])),
        rows_(static_cast<size_t>(dims[1])),
        slices_(static_cast<size_t>(dims[2])),
        slice_blocks_((width_ * rows_ + kBlock - 1) / kBlock),
        blocks_(slice_blocks_ * slices_, nullptr),
        memory_(&Memory::current()) {}
  VoxelSet(const VoxelSet& other)
      : width_(other.width_),
        rows_(other.rows_),
        slices_(other.slices_),
        slice_blocks_(other.slice_blocks_),
        blocks_(other.blocks_.size(), nullptr),
        memory_(&Memory::current()) {
    try {
      for (size_t b = 0; b < blocks_.size(); ++b) {
        if (other.blocks_[b] != nullptr) std::memcpy(block(b), other.blocks_[b], kBlock / 8);
      }
    } catch (...) {
      clear();
      throw;
    }
  }
  VoxelSet(VoxelSet&& other) noexcept { swap(other); }
  VoxelSet& operator=(VoxelSet other) noexcept {
    swap(other);
    return *this;
  }
  ~VoxelSet() { clear(); }

  // Whether it is a set of some image's voxels at all.
  bool has_image() const { return !blocks_.empty(); }

  bool has(const Voxel& v) const {
    const Bit at = bit_of(v);
    const uint64_t* words = blocks_[at.block];
    return words != nullptr && (words[at.word] & at.mask) != 0;
  }
  void insert(const Voxel& v) {
    const Bit at = bit_of(v);
    block(at.block)[at.word] |= at.mask;
  }
  void erase(const Voxel& v) {
    const Bit at = bit_of(v);
    assert(at.block < blocks_.size());
    uint64_t* words = blocks_[at.block];
    if (words != nullptr) words[at.word] &= ~at.mask;
  }
  // Puts it in where it was not, and the other way round.
  void flip(const Voxel& v) {
    const Bit at = bit_of(v);
    block(at.block)[at.word] ^= at.mask;
  }

  // visit(x) for the voxels of a row with first <= x < end, x growing.
  template <typename Visit>
  void visit_row(int32_t y, int32_t z, int32_t first, int32_t end, const Visit& visit) const {
    assert(first >= 0 && end <= static_cast<int32_t>(width_) && y >= 0 && z >= 0);
    if (first >= end) return;
    const size_t begin = static_cast<size_t>(y) * width_;
    size_t i = begin + static_cast<size_t>(first);
    const size_t stop = begin + static_cast<size_t>(end);
    while (i < stop) {
      const uint64_t* words = blocks_[static_cast<size_t>(z) * slice_blocks_ + i / kBlock];
      const size_t next = (i / kBlock + 1) * kBlock;
      if (words == nullptr) {
        i = next;
        continue;
      }
      for (; i < stop && i < next; i = (i / kWord + 1) * kWord) {
        uint64_t bits = words[i % kBlock / kWord] >> i % kWord << i % kWord;
        for (; bits != 0; bits &= bits - 1) {
          const size_t at = i / kWord * kWord + static_cast<size_t>(std::countr_zero(bits));
          if (at >= stop) return;
          visit(static_cast<int32_t>(at - begin));
        }
      }
    }
  }
  // visit(voxel) for all, x fastest. It may erase voxels, its own among them.
  template <typename Visit>
  void visit(const Visit& visit) const {
    for (size_t b = 0; b < blocks_.size(); ++b) {
      const uint64_t* words = blocks_[b];
      for (size_t w = 0; words != nullptr && w < kBlock / kWord; ++w) {
        for (uint64_t later = ~uint64_t{0}; (words[w] & later) != 0;) {
          const auto bit = static_cast<size_t>(std::countr_zero(words[w] & later));
          later = bit + 1 == kWord ? 0 : ~uint64_t{0} << (bit + 1);
          visit(voxel_at(b, w * kWord + bit));
        }
      }
    }
  }

  // Of an image of the same size.
  void save(StateWriter& to) const {
    to.add(static_cast<uint64_t>(
        blocks_.size() - static_cast<size_t>(std::count(blocks_.begin(), blocks_.end(), nullptr))));
    for (size_t b = 0; b < blocks_.size(); ++b) {
      if (blocks_[b] == nullptr) continue;
      to.add(static_cast<uint64_t>(b));
      for (size_t w = 0; w < kBlock / kWord; ++w) to.add(blocks_[b][w]);
    }
  }
  void restore(StateReader& from) {
    uint64_t count = 0;
    from.read(count);
    for (uint64_t i = 0; i < count && from.ok(); ++i) {
      uint64_t b = 0;
      from.read(b);
      from.demand(b < blocks_.size() && from.left() >= kBlock / 8);
      if (!from.ok()) return;
      uint64_t* words = block(static_cast<size_t>(b));
      for (size_t w = 0; w < kBlock / kWord; ++w) from.read(words[w]);
    }
  }

 private:
  static constexpr size_t kWord = 64;
  static constexpr size_t kBlock = 4096;
  static constexpr size_t kAlignment = 64;

  struct Bit {
    size_t block, word;
    uint64_t mask;
  };
  Bit bit_of(const Voxel& v) const {
    const size_t i = static_cast<size_t>(v[1]) * width_ + static_cast<size_t>(v[0]);
    return {static_cast<size_t>(v[2]) * slice_blocks_ + i / kBlock, i % kBlock / kWord,
            uint64_t{1} << i % kWord};
  }
  Voxel voxel_at(size_t block, size_t bit) const {
    const size_t i = block % slice_blocks_ * kBlock + bit;
    return {static_cast<int32_t>(i % width_), static_cast<int32_t>(i / width_),
            static_cast<int32_t>(block / slice_blocks_)};
  }
  uint64_t* block(size_t index) {
    uint64_t*& words = blocks_[index];
    if (words == nullptr) {
      words = static_cast<uint64_t*>(memory_->allocate(kBlock / 8, kAlignment));
      std::memset(words, 0, kBlock / 8);
    }
    return words;
  }
  void clear() noexcept {
    for (uint64_t* words : blocks_) {
      if (words != nullptr) memory_->release(words, kBlock / 8, kAlignment);
    }
    blocks_.clear();
  }
  void swap(VoxelSet& other) noexcept {
    std::swap(width_, other.width_);
    std::swap(rows_, other.rows_);
    std::swap(slices_, other.slices_);
    std::swap(slice_blocks_, other.slice_blocks_);
    blocks_.swap(other.blocks_);
    std::swap(memory_, other.memory_);
  }

  size_t width_ = 0, rows_ = 0, slices_ = 0;
  size_t slice_blocks_ = 0;
  Vector<uint64_t*> blocks_;  // slice by slice
  Memory* memory_ = nullptr;  // of them
};

}  // namespace plc

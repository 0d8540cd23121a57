// Images by bricks, and the memory that they share: which bricks are there changes, what is read
// does not.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "kernels/bricks.h"
#include "kernels/voxels.h"
#include "pyramid/memory.h"

namespace plc {

class CachedBricks;

// Bricks of any number of images, within so many bytes together: those that were not read lately go
// first. What threads read just then stays, which may be more for a moment; and of each image there
// is room for a layer of bricks and a quarter, or all of it: passes that read slices in order would
// fetch the same bricks for every one of them. Thread-safe.
class BrickCache final : private Memory::Relief {
 public:
  // limit: bytes, of `memory`, which may ask for them back.
  BrickCache(Memory& memory, int64_t limit);
  ~BrickCache() override;
  BrickCache(const BrickCache&) = delete;
  BrickCache& operator=(const BrickCache&) = delete;

  int64_t limit() const { return limit_; }

 private:
  friend class CachedBricks;
  // What stands before the voxels of a brick. Lists of them need no memory: they are changed where
  // nothing may fail.
  struct alignas(64) Block {
    Block* next;
    const CachedBricks* owner;
    size_t size;     // of the voxels, bytes
    uint64_t epoch;  // of the owner: who has entered later has not found it
    uint32_t brick;
    void* voxels() { return this + 1; }
  };
  struct List {
    Block *first = nullptr, *last = nullptr;
    void push(Block* block);
    Block* pop();
    // The first that `wanted` is true of; null where there is none.
    template <class Wanted>
    Block* take(const Wanted& wanted);
  };

  // Changes what may be cached at least. Throws std::bad_alloc where that is more than half of what
  // the memory may hold.
  void need(int64_t bytes);
  // Room for a brick; throws std::bad_alloc.
  Block* take(size_t size);
  void put(Block* block);
  void give_back(Block* block);
  // All that the owner has.
  void forget(const CachedBricks& owner);
  bool relieve(size_t size) override;
  int64_t held() override;
  void evict(int64_t most);
  void retire(Block* block);
  void reclaim();
  void release(Block* block);
  bool release_spares();

  Memory& memory_;
  const int64_t limit_;
  std::mutex mutex_;
  List cached_;   // the next to go first
  List retired_;  // not to be found any more, but perhaps being read
  List spares_;
  int64_t cached_bytes_ = 0, spare_bytes_ = 0;
  size_t cached_count_ = 0;
  int64_t least_ = 0;
};

// The bricks of one image. Those of one value alone are kept as that value.
class CachedBricks : public Bricks {
 public:
  struct Counts {
    int64_t bricks = 0;      // of the image
    int64_t read = 0;        // fetched
    int64_t read_again = 0;  // of them, more than once
  };

  // dims, side: voxels of the image and of a brick. Throws std::bad_alloc.
  CachedBricks(std::shared_ptr<BrickCache> cache, VoxelType type,
               const std::array<int64_t, 3>& dims, const std::array<int64_t, 3>& side);
  // After what inherits this has ended all reading.
  ~CachedBricks() override;

  Counts counts() const;
  // visit(first voxel, count): the rows of a brick, as far as they lie in the image. Within
  // BrickReads.
  template <class Visit>
  void visit_brick(uint32_t number, const Visit& visit) const {
    const Box box = box_of(number);
    const auto* voxels = static_cast<const char*>(brick(number));
    const auto row = static_cast<int64_t>(voxel_size(type_)) * side_[0];
    for (int64_t z = 0; z < box.size[2]; ++z) {
      for (int64_t y = 0; y < box.size[1]; ++y) {
        visit(static_cast<const void*>(voxels + (z * side_[1] + y) * row), box.size[0]);
      }
    }
  }
  size_t brick_bytes() const { return brick_bytes_; }
  const std::shared_ptr<BrickCache>& cache() const { return cache_; }

 protected:
  // Writes brick `at`, counted in bricks; voxels beyond the image need not be. Called by any
  // thread, not twice at a time for the same brick. What it throws is thrown by who reads.
  virtual void fill(const std::array<int64_t, 3>& at, void* voxels) const = 0;
  // Bricks are filled anew from here on. Nobody may be reading.
  void forget();

  const VoxelType type_;
  const std::array<int64_t, 3> dims_;

 private:
  friend class BrickCache;
  static constexpr size_t kReaders = 256;
  static constexpr uint64_t kNobody = 0, kWaits = UINT64_MAX;
  static constexpr size_t kLocks = 64;
  static constexpr size_t kConstants = 8;

  struct Box {
    std::array<int64_t, 3> at, size;  // in bricks; voxels of it that lie in the image
  };
  Box box_of(uint32_t number) const;

  size_t enter() const override;
  void leave(size_t reader) const noexcept override;
  const void* fetch(uint32_t number) const override;
  void make(uint32_t number) const;

  // From here on nobody finds the brick; the epoch after which who has found it has left.
  uint64_t hide(uint32_t number) const;
  bool have_left(uint64_t epoch) const;
  bool read_lately(uint32_t number) const;
  // Whether all voxels within the image are the same.
  bool is_constant(const std::array<int64_t, 3>& size, const void* voxels) const;
  // The one that all bricks of this value share, or null: `block` becomes it where there is room.
  BrickCache::Block* constant(BrickCache::Block* block) const;

  std::shared_ptr<BrickCache> cache_;
  std::array<int64_t, 3> counts_{};  // bricks along the axes
  size_t brick_bytes_ = 0;
  int64_t least_ = 0;  // that is cached of it, where there is so much
  std::array<std::vector<BrickPlace>, 3> axis_;
  std::unique_ptr<std::atomic<const void*>[]> shown_;
  std::unique_ptr<std::atomic<uint8_t>[]> lately_;
  std::unique_ptr<std::atomic<uint8_t>[]> fetched_;  // whether once at least
  mutable std::atomic<uint64_t> epoch_{1};
  mutable std::array<std::atomic<uint64_t>, kReaders> readers_{};  // since when
  mutable std::array<std::mutex, kLocks> locks_;
  mutable std::mutex constants_mutex_;
  mutable std::array<BrickCache::Block*, kConstants> constants_{};  // from the first on
  mutable std::atomic<int64_t> read_{0}, read_again_{0};
};

}  // namespace plc

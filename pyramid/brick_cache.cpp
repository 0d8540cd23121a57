#include "pyramid/brick_cache.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <thread>
#include <utility>

namespace plc {

namespace {

// As many at a time go, so that some have been left by all threads when room is needed again.
constexpr int64_t kShare = 16;
// How often it is looked whether threads have left what they had found.
constexpr int kPatience = 10000;

int64_t signed_size(size_t size) {
  return static_cast<int64_t>(size);
}

}  // namespace

void BrickCache::List::push(Block* block) {
  block->next = nullptr;
  (last == nullptr ? first : last->next) = block;
  last = block;
}

BrickCache::Block* BrickCache::List::pop() {
  return take([](const Block&) { return true; });
}

template <class Wanted>
BrickCache::Block* BrickCache::List::take(const Wanted& wanted) {
  Block* before = nullptr;
  for (Block* block = first; block != nullptr; before = block, block = block->next) {
    if (!wanted(*block)) continue;
    (before == nullptr ? first : before->next) = block->next;
    if (last == block) last = before;
    return block;
  }
  return nullptr;
}

BrickCache::BrickCache(Memory& memory, int64_t limit) : memory_(memory), limit_(limit) {
  memory_.add_relief(*this);
}

BrickCache::~BrickCache() {
  memory_.remove_relief(*this);
  for (List* list : {&cached_, &retired_, &spares_}) {
    while (Block* block = list->pop()) release(block);
  }
}

void BrickCache::need(int64_t bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const int64_t most = memory_.limit() / 2;
  if (bytes > 0 && most != 0 && least_ + bytes > most) memory_.refuse(bytes);
  least_ += bytes;
}

BrickCache::Block* BrickCache::take(size_t size) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const int64_t most = std::max(limit_, least_);
    if (cached_bytes_ + signed_size(size) > most) {
      evict(std::max<int64_t>(most - most / kShare - signed_size(size), 0));
    }
    reclaim();
    if (Block* spare = spares_.take([size](const Block& b) { return b.size == size; })) {
      spare_bytes_ -= signed_size(size);
      return spare;
    }
  }
  auto* block = static_cast<Block*>(memory_.allocate(sizeof(Block) + size, alignof(Block)));
  block->size = size;
  return block;
}

void BrickCache::put(Block* block) {
  const std::lock_guard<std::mutex> lock(mutex_);
  cached_.push(block);
  cached_bytes_ += signed_size(block->size);
  ++cached_count_;
}

void BrickCache::give_back(Block* block) {
  const std::lock_guard<std::mutex> lock(mutex_);
  spares_.push(block);
  spare_bytes_ += signed_size(block->size);
}

void BrickCache::forget(const CachedBricks& owner) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (size_t left = cached_count_; left > 0; --left) {
    Block* block = cached_.pop();
    if (block->owner == &owner) {
      retire(block);
    } else {
      cached_.push(block);
    }
  }
  reclaim();
}

// As long as all that is cached is more than `most` bytes; bricks that were read lately get another
// turn.
void BrickCache::evict(int64_t most) {
  for (size_t looks = 2 * cached_count_; looks > 0 && cached_bytes_ > most; --looks) {
    Block* block = cached_.pop();
    if (block->owner->read_lately(block->brick)) {
      cached_.push(block);
    } else {
      retire(block);
    }
  }
}

void BrickCache::retire(Block* block) {
  cached_bytes_ -= signed_size(block->size);
  --cached_count_;
  block->epoch = block->owner->hide(block->brick);
  retired_.push(block);
}

// Those that nobody reads any more become spares.
void BrickCache::reclaim() {
  const auto left = [](const Block& block) { return block.owner->have_left(block.epoch); };
  while (Block* block = retired_.take(left)) {
    spares_.push(block);
    spare_bytes_ += signed_size(block->size);
  }
}

void BrickCache::release(Block* block) {
  memory_.release(block, sizeof(Block) + block->size, alignof(Block));
}

bool BrickCache::release_spares() {
  const bool any = spares_.first != nullptr;
  while (Block* block = spares_.pop()) release(block);
  spare_bytes_ = 0;
  return any;
}

bool BrickCache::relieve(size_t size) {
  const std::lock_guard<std::mutex> lock(mutex_);
  reclaim();
  if (release_spares()) return true;
  evict(std::max(cached_bytes_ - std::max(signed_size(size), cached_bytes_ / kShare), least_));
  // Threads that have found one of them are soon done with it.
  for (int i = 0; i < kPatience && retired_.first != nullptr; ++i) {
    reclaim();
    if (release_spares()) return true;
    std::this_thread::yield();
  }
  return release_spares();
}

int64_t BrickCache::held() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::max<int64_t>(cached_bytes_ - least_, 0) + spare_bytes_;
}

CachedBricks::CachedBricks(std::shared_ptr<BrickCache> cache, VoxelType type,
                           const std::array<int64_t, 3>& dims, const std::array<int64_t, 3>& side)
    : type_(type), dims_(dims), cache_(std::move(cache)) {
  side_ = side;
  brick_bytes_ = voxel_size(type);
  size_t count = 1, voxels = 1;
  for (size_t a = 0; a < 3; ++a) {
    counts_[a] = (dims[a] + side[a] - 1) / side[a];
    for (int64_t i = 0; i < dims[a]; ++i) {
      axis_[a].push_back({static_cast<uint32_t>(static_cast<size_t>(i / side[a]) * count),
                          static_cast<uint32_t>(static_cast<size_t>(i % side[a]) * voxels)});
    }
    places_[a] = axis_[a].data();
    count *= static_cast<size_t>(counts_[a]);
    voxels *= static_cast<size_t>(side[a]);
  }
  brick_bytes_ *= voxels;
  shown_ = std::make_unique<std::atomic<const void*>[]>(count);
  lately_ = std::make_unique<std::atomic<uint8_t>[]>(count);
  fetched_ = std::make_unique<std::atomic<uint8_t>[]>(count);
  const int64_t rows = std::min(counts_[1] * counts_[2], counts_[1] + counts_[1] / 4 + 1);
  least_ = counts_[0] * rows * signed_size(brick_bytes_);
  cache_->need(least_);
  table_ = shown_.get();
  read_lately_ = lately_.get();
}

CachedBricks::~CachedBricks() {
  forget();
  cache_->need(-least_);
  for (BrickCache::Block* block : constants_) {
    if (block != nullptr) cache_->give_back(block);
  }
}

CachedBricks::Counts CachedBricks::counts() const {
  return {counts_[0] * counts_[1] * counts_[2], read_.load(), read_again_.load()};
}

void CachedBricks::forget() {
  cache_->forget(*this);
  const auto count = static_cast<size_t>(counts().bricks);
  for (size_t i = 0; i < count; ++i) shown_[i].store(nullptr);
}

// Seen by have_left() of a brick that it may find: who hides one looks at readers after that.
size_t CachedBricks::enter() const {
  const size_t first = std::hash<std::thread::id>()(std::this_thread::get_id()) % kReaders;
  for (size_t i = first;; i = (i + 1) % kReaders) {
    uint64_t none = kNobody;
    if (readers_[i].compare_exchange_strong(none, epoch_.load())) return i;
    if ((i + 1) % kReaders == first) std::this_thread::yield();
  }
}

void CachedBricks::leave(size_t reader) const noexcept {
  readers_[reader].store(kNobody);
}

uint64_t CachedBricks::hide(uint32_t number) const {
  shown_[number].store(nullptr);
  return epoch_.fetch_add(1);
}

bool CachedBricks::have_left(uint64_t epoch) const {
  return std::all_of(readers_.begin(), readers_.end(), [epoch](const auto& reader) {
    const uint64_t since = reader.load();
    return since == kNobody || since > epoch;
  });
}

bool CachedBricks::read_lately(uint32_t number) const {
  return lately_[number].exchange(0, std::memory_order_relaxed) != 0;
}

// What waits for a brick needs none of the others.
const void* CachedBricks::fetch(uint32_t number) const {
  std::atomic<uint64_t>& own = readers_[reader()];
  for (;;) {
    own.store(kWaits);
    make(number);
    own.store(epoch_.load());
    if (const void* voxels = shown_[number].load(); voxels != nullptr) return voxels;
  }
}

// Unless it is there.
void CachedBricks::make(uint32_t number) const {
  const std::lock_guard<std::mutex> lock(locks_[number % kLocks]);
  if (shown_[number].load() != nullptr) return;
  const Box box = box_of(number);
  BrickCache::Block* block = cache_->take(brick_bytes_);
  block->owner = this;
  block->brick = number;
  try {
    fill(box.at, block->voxels());
  } catch (...) {
    cache_->give_back(block);
    throw;
  }
  read_.fetch_add(1, std::memory_order_relaxed);
  if (fetched_[number].exchange(1) != 0) read_again_.fetch_add(1, std::memory_order_relaxed);
  if (is_constant(box.size, block->voxels())) {
    if (BrickCache::Block* shared = constant(block); shared != nullptr) {
      if (shared != block) cache_->give_back(block);
      shown_[number].store(shared->voxels());
      return;
    }
  }
  lately_[number].store(1, std::memory_order_relaxed);
  shown_[number].store(block->voxels());
  cache_->put(block);
}

CachedBricks::Box CachedBricks::box_of(uint32_t number) const {
  const int64_t n = number;
  Box box{{n % counts_[0], n / counts_[0] % counts_[1], n / (counts_[0] * counts_[1])}, {}};
  for (size_t a = 0; a < 3; ++a) {
    box.size[a] = std::min(side_[a], dims_[a] - box.at[a] * side_[a]);
  }
  return box;
}

bool CachedBricks::is_constant(const std::array<int64_t, 3>& of, const void* voxels) const {
  const size_t size = voxel_size(type_);
  const auto* bytes = static_cast<const char*>(voxels);
  const size_t row = static_cast<size_t>(side_[0]) * size;
  const size_t used = static_cast<size_t>(of[0]) * size;
  for (int64_t z = 0; z < of[2]; ++z) {
    for (int64_t y = 0; y < of[1]; ++y) {
      const char* first = bytes + static_cast<size_t>(z * side_[1] + y) * row;
      if (std::memcmp(first, bytes, size) != 0) return false;
      if (std::memcmp(first, first + size, used - size) != 0) return false;
    }
  }
  return true;
}

BrickCache::Block* CachedBricks::constant(BrickCache::Block* block) const {
  const size_t size = voxel_size(type_);
  const std::lock_guard<std::mutex> lock(constants_mutex_);
  for (BrickCache::Block*& shared : constants_) {
    if (shared == nullptr) {
      auto* voxels = static_cast<char*>(block->voxels());
      for (size_t i = size; i < brick_bytes_; i += size) std::memcpy(voxels + i, voxels, size);
      shared = block;
      return shared;
    }
    if (std::memcmp(shared->voxels(), block->voxels(), size) == 0) return shared;
  }
  return nullptr;
}

}  // namespace plc

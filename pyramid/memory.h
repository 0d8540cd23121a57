// Where the memory of a context comes from, how much of it there is, and how much there may be.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <new>
#include <type_traits>
#include <vector>

namespace plc {

// Counts what it gives. Thread-safe. What was allocated must be released before it goes.
class Memory {
 public:
  using Allocate = void* (*)(size_t size, size_t alignment, void* user);
  using Release = void (*)(void* data, size_t size, size_t alignment, void* user);

  // Both null: the system's allocator (mimalloc where there is one).
  struct Hooks {
    Allocate allocate = nullptr;
    Release release = nullptr;
    void* user = nullptr;
  };

  Memory() = default;
  // limit: bytes at a time; 0: none.
  Memory(const Hooks& hooks, int64_t limit) : hooks_(hooks), limit_(limit) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  // Throws std::bad_alloc where there is none, or not within the limit. alignment: a power of two.
  void* allocate(size_t size, size_t alignment);
  void release(void* data, size_t size, size_t alignment) noexcept;
  int64_t now() const { return now_.load(std::memory_order_relaxed); }
  // Until the limit, with what reliefs would release; more than any machine has where there is
  // none.
  int64_t left() const;
  int64_t peak() const { return peak_.load(std::memory_order_relaxed); }
  int64_t limit() const { return limit_; }

  // Notes that so many bytes were asked for and are not to be had, and throws std::bad_alloc.
  [[noreturn]] void refuse(int64_t size) { refuse(static_cast<size_t>(size), now()); }
  // What allocate() has thrown for, the first time since this was forgotten. size 0: for nothing.
  struct Refusal {
    uint64_t size = 0;
    int64_t in_use = 0;  // when it was refused
  };
  Refusal refusal() const {
    return {refused_.load(std::memory_order_relaxed), in_use_.load(std::memory_order_relaxed)};
  }
  void forget_refusal() { refused_.store(0, std::memory_order_relaxed); }

  // Whoever holds memory that it can do without: asked, by any thread, before anything is refused.
  class Relief {
   public:
    virtual ~Relief() = default;
    // Whether it has released any; `size` bytes are wanted.
    virtual bool relieve(size_t size) = 0;
    // Bytes that it could release.
    virtual int64_t held() = 0;
  };
  void add_relief(Relief& relief);
  void remove_relief(Relief& relief);

  // What buffers of this thread are allocated from; where no MemoryScope says so, the system's.
  static Memory& current();

 private:
  friend class MemoryScope;
  static constinit thread_local Memory* scoped;
  void* try_allocate(size_t size, size_t alignment);
  bool relieve(size_t size);
  // Notes the refusal, and throws.
  [[noreturn]] void refuse(size_t size, int64_t in_use);

  Hooks hooks_;
  int64_t limit_ = 0;
  std::atomic<int64_t> now_{0};
  std::atomic<int64_t> peak_{0};
  std::atomic<uint64_t> refused_{0};
  std::atomic<int64_t> in_use_{0};
  mutable std::mutex reliefs_mutex_;
  std::vector<Relief*> reliefs_;
};

// Makes a memory the current one of this thread for as long as the scope lives.
class MemoryScope {
 public:
  explicit MemoryScope(Memory& memory) : before_(Memory::scoped) { Memory::scoped = &memory; }
  ~MemoryScope() { Memory::scoped = before_; }
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

 private:
  Memory* before_;
};

// For standard containers: the memory that was the current one when the container was made.
template <typename T>
class MemoryAllocator {
 public:
  using value_type = T;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;
  using is_always_equal = std::false_type;

  MemoryAllocator() : memory_(&Memory::current()) {}
  template <typename U>
  MemoryAllocator(const MemoryAllocator<U>& other) : memory_(other.memory()) {}

  T* allocate(size_t n) {
    if (n > static_cast<size_t>(-1) / 2 / kSize) throw std::bad_alloc();
    return static_cast<T*>(memory_->allocate(n * kSize, alignment()));
  }
  void deallocate(T* data, size_t n) noexcept { memory_->release(data, n * kSize, alignment()); }
  MemoryAllocator select_on_container_copy_construction() const { return {}; }
  Memory* memory() const { return memory_; }
  template <typename U>
  bool operator==(const MemoryAllocator<U>& other) const {
    return memory_ == other.memory();
  }

 private:
  static constexpr size_t kSize = sizeof(T);  // NOLINT(bugprone-sizeof-expression): or of pointers
  static constexpr size_t alignment() { return alignof(T) < 8 ? 8 : alignof(T); }
  Memory* memory_;
};

template <typename T>
using Vector = std::vector<T, MemoryAllocator<T>>;

}  // namespace plc

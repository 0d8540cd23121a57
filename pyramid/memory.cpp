#include "pyramid/memory.h"

#if defined(_WIN32)
#include <malloc.h>
#elif !defined(__EMSCRIPTEN__)
#include <dlfcn.h>
#endif
#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstdlib>

#include "pyramid/sanitized.h"

namespace plc {

namespace {

[[maybe_unused]] constexpr size_t kHugePage = size_t{1} << 21U;

// mimalloc 2 gives what is free back to the system after this option of it, by default after 25 ms:
// arrays that live for an iteration were then mapped anew in the next, 7 % of a run on two cores
// (MIMALLOC_DECOMMIT_DELAY=25 in the environment, which comes first). Where a host has loaded the
// same library, its options are the host's.
[[maybe_unused]] constexpr int kDecommitDelay = 15;
[[maybe_unused]] constexpr long kDecommitAfter = 1000;  // ms

// mimalloc as the system has it replaces malloc in every program that links it. A host's malloc is
// its own affair: the library is loaded beside it, its names seen by nobody else.
struct SystemAllocator {
#if defined(_WIN32)
  void* (*allocate)(size_t size, size_t alignment) = _aligned_malloc;
  void (*release)(void* data) = _aligned_free;
#else
  void* (*allocate)(size_t size, size_t alignment) = nullptr;
  void (*release)(void* data) = std::free;

  SystemAllocator() {
    allocate = [](size_t size, size_t alignment) -> void* {
      void* data = nullptr;
      return posix_memalign(&data, alignment, size) == 0 ? data : nullptr;
    };
    load_mimalloc();
  }

 private:
  void load_mimalloc() {
#if !defined(__EMSCRIPTEN__)
    if (PLC_SANITIZED_MEMORY != 0) return;
    constexpr const char* kName = "libmimalloc.so.2";
    const bool of_host = dlopen(kName, RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD) != nullptr;
    void* library = dlopen(kName, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return;
    void* set_default = dlsym(library, "mi_option_set_default");
    if (!of_host && set_default != nullptr) {
      reinterpret_cast<void (*)(int, long)>(set_default)(kDecommitDelay, kDecommitAfter);
    }
    void* aligned = dlsym(library, "mi_malloc_aligned");
    void* free = dlsym(library, "mi_free");
    if (aligned == nullptr || free == nullptr) return;
    allocate = reinterpret_cast<void* (*)(size_t, size_t)>(aligned);
    release = reinterpret_cast<void (*)(void*)>(free);
#endif
  }
#endif
};

const SystemAllocator& system_allocator() {
  static const SystemAllocator allocator;
  return allocator;
}

// Images, rings and streams, which are read all over the place, in huge pages where the system
// leaves that to the program: misses of the address cache were 10 to 15 % of a step of 120,000
// vertices. What is beside them in the same pages, too: 5 % of a run more, for 7 % more memory.
void advise_huge_pages([[maybe_unused]] void* data, [[maybe_unused]] size_t size) {
#if defined(__linux__)
  if (PLC_SANITIZED_MEMORY != 0 || size < kHugePage / 2) return;
  const size_t before = reinterpret_cast<uintptr_t>(data) % kHugePage;
  const size_t pages = (before + size + kHugePage - 1) / kHugePage;
  madvise(static_cast<char*>(data) - before, pages * kHugePage, MADV_HUGEPAGE);
#endif
}

void* allocate_of_system(size_t size, size_t alignment) {
  void* data = system_allocator().allocate(size, alignment);
  if (data != nullptr) advise_huge_pages(data, size);
  return data;
}

}  // namespace

constinit thread_local Memory* Memory::scoped = nullptr;

Memory& Memory::current() {
  static Memory system;
  return scoped == nullptr ? system : *scoped;
}

void Memory::refuse(size_t size, int64_t in_use) {
  uint64_t none = 0;
  if (refused_.compare_exchange_strong(none, size, std::memory_order_relaxed)) {
    in_use_.store(in_use, std::memory_order_relaxed);
  }
  throw std::bad_alloc();
}

int64_t Memory::left() const {
  if (limit_ == 0) return INT64_MAX;
  int64_t left = limit_ - now();
  const std::lock_guard<std::mutex> lock(reliefs_mutex_);
  for (Relief* relief : reliefs_) left += relief->held();
  return left;
}

void Memory::add_relief(Relief& relief) {
  const std::lock_guard<std::mutex> lock(reliefs_mutex_);
  reliefs_.push_back(&relief);
}

void Memory::remove_relief(Relief& relief) {
  const std::lock_guard<std::mutex> lock(reliefs_mutex_);
  std::erase(reliefs_, &relief);
}

bool Memory::relieve(size_t size) {
  const std::lock_guard<std::mutex> lock(reliefs_mutex_);
  return std::any_of(reliefs_.begin(), reliefs_.end(),
                     [size](Relief* relief) { return relief->relieve(size); });
}

void* Memory::allocate(size_t size, size_t alignment) {
  if (size > static_cast<size_t>(INT64_MAX) / 2) refuse(size, now());
  for (;;) {
    void* data = try_allocate(size, alignment);
    if (data != nullptr) return data;
    if (!relieve(size)) refuse(size, now());
  }
}

// Null where there is none, or not within the limit.
void* Memory::try_allocate(size_t size, size_t alignment) {
  const auto bytes = static_cast<int64_t>(size);
  const int64_t now = now_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  void* data = nullptr;
  if (limit_ == 0 || now <= limit_) {
    data = hooks_.allocate == nullptr ? allocate_of_system(size, alignment)
                                      : hooks_.allocate(size, alignment, hooks_.user);
  }
  if (data == nullptr) {
    now_.fetch_sub(bytes, std::memory_order_relaxed);
    return nullptr;
  }
  int64_t peak = peak_.load(std::memory_order_relaxed);
  while (peak < now && !peak_.compare_exchange_weak(peak, now, std::memory_order_relaxed)) {
  }
  return data;
}

void Memory::release(void* data, size_t size, size_t alignment) noexcept {
  if (data == nullptr) return;
  now_.fetch_sub(static_cast<int64_t>(size), std::memory_order_relaxed);
  if (hooks_.release == nullptr) {
    system_allocator().release(data);
  } else {
    hooks_.release(data, size, alignment, hooks_.user);
  }
}

}  // namespace plc

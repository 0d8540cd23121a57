#include "pyramid/memory.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <map>
#include <numeric>
#include <thread>
#include <vector>

#include "pyramid/buffer.h"

namespace {

using plc::Buffer;
using plc::Memory;
using plc::MemoryScope;
using plc::Vector;

// An allocator that remembers what it gave; aligned by hand, so that a wrong release is seen.
struct Ledger {
  struct Entry {
    size_t size, alignment;
    std::vector<char> bytes;
  };
  std::map<void*, Entry> entries;
  int refuse_from = -1;  // this many more allocations succeed; -1: all
  int wrong = 0;

  static void* allocate(size_t size, size_t alignment, void* user) {
    auto& self = *static_cast<Ledger*>(user);
    if (self.refuse_from == 0) return nullptr;
    if (self.refuse_from > 0) --self.refuse_from;
    Entry entry{size, alignment, std::vector<char>(size + alignment)};
    const auto address = reinterpret_cast<uintptr_t>(entry.bytes.data());
    void* data = entry.bytes.data() + (alignment - address % alignment) % alignment;
    self.entries.emplace(data, std::move(entry));
    return data;
  }
  static void release(void* data, size_t size, size_t alignment, void* user) {
    auto& self = *static_cast<Ledger*>(user);
    const auto found = self.entries.find(data);
    if (found == self.entries.end() || found->second.size != size ||
        found->second.alignment != alignment) {
      ++self.wrong;
      return;
    }
    self.entries.erase(found);
  }
  Memory::Hooks hooks() { return {allocate, release, this}; }
};

}  // namespace

TEST_CASE("memory counts what it has given, and the most of it", "[memory]") {
  Memory memory;
  void* a = memory.allocate(1000, 64);
  void* b = memory.allocate(500, 8);
  CHECK(reinterpret_cast<uintptr_t>(a) % 64 == 0);
  CHECK(memory.now() == 1500);
  memory.release(a, 1000, 64);
  CHECK(memory.now() == 500);
  CHECK(memory.peak() == 1500);
  memory.release(b, 500, 8);
  memory.release(nullptr, 500, 8);
  CHECK(memory.now() == 0);
}

TEST_CASE("nothing is given beyond the limit, and what was refused does not count", "[memory]") {
  Memory memory({}, 1000);
  void* a = memory.allocate(600, 64);
  CHECK_THROWS_AS(memory.allocate(401, 64), std::bad_alloc);
  CHECK(memory.now() == 600);
  CHECK(memory.peak() == 600);
  void* b = memory.allocate(400, 64);
  memory.release(a, 600, 64);
  memory.release(b, 400, 64);
  // The first is noted, until it is forgotten.
  CHECK(memory.refusal().size == 401);
  CHECK(memory.refusal().in_use == 600);
  memory.forget_refusal();
  CHECK(memory.refusal().size == 0);
  CHECK_THROWS_AS(memory.allocate(~size_t{0}, 64), std::bad_alloc);
  CHECK(memory.refusal().size == ~size_t{0});
  CHECK_THROWS_AS(memory.allocate(~size_t{0} / 4, 64), std::bad_alloc);
  CHECK(memory.now() == 0);
}

TEST_CASE("buffers and vectors come from the memory of their scope and go back to it", "[memory]") {
  Ledger ledger;
  Memory memory(ledger.hooks(), 0);
  {
    Buffer<double> small, large;
    Vector<uint32_t>* outlives = nullptr;
    {
      const MemoryScope scope(memory);
      for (double x = 0; x < 3; ++x) small.push_back(x);
      large.resize(100000);
      outlives = new Vector<uint32_t>(5000, 7U);
      CHECK(reinterpret_cast<uintptr_t>(large.data()) % Buffer<double>::kAlignment == 0);
      CHECK(memory.now() >= static_cast<int64_t>(100000 * sizeof(double) + 5000 * 4));
    }
    // Outside the scope they still grow, move and end where they came from.
    const size_t entries = ledger.entries.size();
    large.resize(300000);
    outlives->resize(20000);
    CHECK(ledger.entries.size() == entries);
    Buffer<double> elsewhere(10);
    elsewhere.swap(small);
    CHECK(elsewhere[2] == 2);
    const Vector<uint32_t> moved = std::move(*outlives);
    CHECK(moved.get_allocator().memory() == &memory);
    delete outlives;
    const Buffer<double> copy = large;
    CHECK(ledger.entries.size() == entries);
  }
  CHECK(ledger.entries.empty());
  CHECK(ledger.wrong == 0);
  CHECK(memory.now() == 0);
}

TEST_CASE("a buffer that cannot grow stays as it was", "[memory]") {
  Ledger ledger;
  Memory memory(ledger.hooks(), 0);
  {
    const MemoryScope scope(memory);
    Buffer<int> buffer(1000);
    std::iota(buffer.begin(), buffer.end(), 0);
    ledger.refuse_from = 0;
    CHECK_THROWS_AS(buffer.resize(2000), std::bad_alloc);
    CHECK(buffer.size() == 1000);
    CHECK(buffer[999] == 999);
  }
  CHECK(ledger.entries.empty());
  CHECK(memory.now() == 0);
}

TEST_CASE("scopes are of one thread, and nest", "[memory]") {
  Memory outer, inner;
  Memory& before = Memory::current();
  const MemoryScope scope(outer);
  {
    const MemoryScope nested(inner);
    CHECK(&Memory::current() == &inner);
    std::thread([&] { CHECK(&Memory::current() == &before); }).join();
  }
  CHECK(&Memory::current() == &outer);
}

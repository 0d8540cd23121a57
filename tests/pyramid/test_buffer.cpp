#include "pyramid/buffer.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <set>
#include <utility>

#include "pyramid/sanitized.h"

using plc::Buffer;

TEST_CASE("a buffer keeps its contents and its alignment when it grows", "[pyramid]") {
  Buffer<uint32_t> buffer;
  for (uint32_t i = 0; i < 5000; ++i) {
    buffer.push_back(i);
    REQUIRE(reinterpret_cast<uintptr_t>(buffer.data()) % Buffer<uint32_t>::kAlignment == 0);
  }
  for (uint32_t i = 0; i < 5000; ++i) REQUIRE(buffer[i] == i);
}

#if !PLC_SANITIZED_MEMORY
TEST_CASE("large buffers that lie side by side begin at different lines of a page", "[pyramid]") {
  // Or else the streams of a mesh compete for the same sets of the cache.
  struct {
    Buffer<float> streams[20];
  } mesh;
  std::set<uintptr_t> lines;
  for (Buffer<float>& stream : mesh.streams) {
    stream.resize(100000);
    lines.insert(reinterpret_cast<uintptr_t>(stream.data()) % 4096 / 64);
  }
  REQUIRE(lines.size() == 20);
}
#endif

TEST_CASE("new elements of a buffer are zero even where old ones stood", "[pyramid]") {
  Buffer<int> buffer(3);
  REQUIRE(buffer[2] == 0);
  buffer[2] = 7;
  buffer.resize(2);
  buffer.resize(4);
  REQUIRE(buffer[2] == 0);
  REQUIRE(buffer.capacity() >= 4);
}

TEST_CASE("a buffer can push an element of itself", "[pyramid]") {
  Buffer<int> buffer;
  buffer.push_back(42);
  for (int i = 0; i < 100; ++i) buffer.push_back(buffer[0]);
  for (const int value : buffer) REQUIRE(value == 42);
}

TEST_CASE("buffers copy, move and swap like values", "[pyramid]") {
  Buffer<int> a(2);
  a[0] = 1;
  Buffer<int> b = a;
  b[0] = 5;
  REQUIRE(a[0] == 1);
  Buffer<int> c = std::move(b);
  REQUIRE(c.size() == 2);
  REQUIRE(c[0] == 5);
  a = c;
  REQUIRE(a[0] == 5);
  const Buffer<int>& self = a;
  a = self;
  REQUIRE(a.size() == 2);
  Buffer<int> empty;
  Buffer<int> copy_of_empty = empty;
  REQUIRE(copy_of_empty.empty());
}

#if !PLC_SANITIZED_MEMORY  // whose allocator aborts at once
TEST_CASE("a buffer beyond all memory throws bad_alloc and stays as it was", "[pyramid]") {
  Buffer<double> buffer(3);
  buffer[1] = 2.0;
  REQUIRE_THROWS_AS(buffer.resize(static_cast<size_t>(-1) / 16), std::bad_alloc);
  REQUIRE(buffer.size() == 3);
  REQUIRE(buffer[1] == 2.0);
}
#endif

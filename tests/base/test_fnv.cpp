#include "engine/base/fnv.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace {

uint64_t hash_of(const std::string& text) {
  plc::Fnv hash;
  for (const char c : text) hash.add(static_cast<uint8_t>(c));
  return hash.value();
}

template <typename T>
uint64_t hash_of_value(T value) {
  plc::Fnv hash;
  hash.add(value);
  return hash.value();
}

}  // namespace

TEST_CASE("texts have the published hashes", "[fnv]") {
  CHECK(hash_of("") == 0xCBF29CE484222325ULL);
  CHECK(hash_of("a") == 0xAF63DC4C8601EC8CULL);
  CHECK(hash_of("foobar") == 0x85944171F73967E8ULL);
}

TEST_CASE("a value is its bytes, the lowest first, and a float its bits", "[fnv]") {
  CHECK(hash_of_value(uint32_t{0x64636261}) == hash_of("abcd"));
  CHECK(hash_of_value(uint16_t{0x6261}) == hash_of("ab"));
  CHECK(hash_of_value(1.0F) == hash_of_value(uint32_t{0x3F800000}));
  CHECK(hash_of_value(-2.0) == hash_of_value(uint64_t{0xC000000000000000}));
  CHECK(hash_of_value(0.0F) != hash_of_value(-0.0F));
}

TEST_CASE("a range is its values one after the other", "[fnv]") {
  plc::Fnv range, values;
  range.add_all(std::vector<float>{1, 2.5F, -3});
  for (const float v : {1.0F, 2.5F, -3.0F}) values.add(v);
  CHECK(range.value() == values.value());
}

// Bytes that several tasks of a loop set to the same value, in no order.
#pragma once
#include <atomic>
#include <cstdint>
#include <cstring>

namespace plc {

#if defined(__cpp_lib_atomic_ref)
inline uint8_t read_mark(uint8_t& mark) {
  return std::atomic_ref<uint8_t>(mark).load(std::memory_order_relaxed);
}
inline void set_mark(uint8_t& mark, uint8_t value) {
  std::atomic_ref<uint8_t>(mark).store(value, std::memory_order_relaxed);
}
#elif defined(__GNUC__)  // Clang's library had none before its version 19
inline uint8_t read_mark(uint8_t& mark) {
  return __atomic_load_n(&mark, __ATOMIC_RELAXED);
}
inline void set_mark(uint8_t& mark, uint8_t value) {
  __atomic_store_n(&mark, value, __ATOMIC_RELAXED);
}
#else
#error "std::atomic_ref is needed"
#endif

// visit(index) of the bytes that are not 0, ascending. They are few, so eight are looked at at
// once.
template <typename Visit>
void visit_marks(const uint8_t* marks, uint32_t count, const Visit& visit) {
  for (uint32_t i = 0; i < count; ++i) {
    uint64_t eight = 0;
    while (i + sizeof eight <= count &&
           (std::memcpy(&eight, marks + i, sizeof eight), eight == 0)) {
      i += sizeof eight;
    }
    if (i < count && marks[i] != 0) visit(i);
  }
}

}  // namespace plc

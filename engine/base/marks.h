// Numbers that several tasks of a loop read and set, in no order.
#pragma once
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace plc {

// replace_mark(): to `value` where it was `was`; whether it was.
#if defined(__cpp_lib_atomic_ref)
template <typename T>
T read_mark(T& mark) {
  return std::atomic_ref<T>(mark).load(std::memory_order_relaxed);
}
template <typename T>
void set_mark(T& mark, std::type_identity_t<T> value) {
  std::atomic_ref<T>(mark).store(value, std::memory_order_relaxed);
}
template <typename T>
bool replace_mark(T& mark, std::type_identity_t<T> was, std::type_identity_t<T> value) {
  return std::atomic_ref<T>(mark).compare_exchange_strong(was, value, std::memory_order_relaxed);
}
template <typename T>
void add_to_mark(T& mark, std::type_identity_t<T> more) {
  std::atomic_ref<T>(mark).fetch_add(more, std::memory_order_relaxed);
}
#elif defined(__GNUC__)  // Clang's library had none before its version 19
template <typename T>
T read_mark(T& mark) {
  return __atomic_load_n(&mark, __ATOMIC_RELAXED);
}
template <typename T>
void set_mark(T& mark, std::type_identity_t<T> value) {
  __atomic_store_n(&mark, value, __ATOMIC_RELAXED);
}
template <typename T>
bool replace_mark(T& mark, std::type_identity_t<T> was, std::type_identity_t<T> value) {
  return __atomic_compare_exchange_n(&mark, &was, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
}
template <typename T>
void add_to_mark(T& mark, std::type_identity_t<T> more) {
  __atomic_fetch_add(&mark, more, __ATOMIC_RELAXED);
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

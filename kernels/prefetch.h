// Fetching what is read soon; nothing where the compiler has no word for it.
#pragma once

namespace plc {

// Into the first cache.
inline void prefetch_near([[maybe_unused]] const void* p) {
#if defined(__GNUC__)
  __builtin_prefetch(p);
#endif
}
// Into the second.
inline void prefetch_far([[maybe_unused]] const void* p) {
#if defined(__GNUC__)
  __builtin_prefetch(p, 0, 2);
#endif
}

}  // namespace plc

// Fetching what is read soon; nothing where the compiler has no word for it.
#pragma once
#include "kernels/ring.h"

namespace plc {

// GCC takes a function that only fetches for one without effect, and drops calls of it that it has
// not inlined by then: what fetches is inlined always, and so is what calls it for that alone.
#if defined(__GNUC__)
#define PLC_FETCHES [[gnu::always_inline]] inline
#else
#define PLC_FETCHES inline
#endif

// Into the first cache.
PLC_FETCHES void prefetch_near([[maybe_unused]] const void* p) {
#if defined(__GNUC__)
  __builtin_prefetch(p);
#endif
}
// Into the second.
PLC_FETCHES void prefetch_far([[maybe_unused]] const void* p) {
#if defined(__GNUC__)
  __builtin_prefetch(p, 0, 2);
#endif
}
// Into the first: the valence of v, and as many slots as most rings have.
PLC_FETCHES void prefetch_ring_of(const RingView& rings, uint32_t v) {
  constexpr uint32_t kCommon = 6;
  prefetch_near(rings.valence + v);
  for (uint32_t k = 0; k < kCommon; ++k) prefetch_near(rings.columns + RingView::place(v, k));
}

}  // namespace plc

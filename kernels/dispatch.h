// Which compiled target of a kernel a SimdTarget means. For the kernels' own .cpp files, after
// hwy/foreach_target.h; nothing else includes it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"
#include "kernels/simd.h"

namespace plc::kernels {

// The targets a kernel may use when `simd` is asked for: that one and, where it was not compiled,
// worse ones.
inline int64_t simd_target_mask(SimdTarget simd) {
  int64_t targets = 0;
#if HWY_ARCH_X86
  switch (simd) {
    case SimdTarget::kAvx512:
      targets |= HWY_AVX3;
      [[fallthrough]];
    case SimdTarget::kAvx2:
      targets |= HWY_AVX2;
      [[fallthrough]];
    case SimdTarget::kSse4:
      targets |= HWY_SSE4;
      break;
    case SimdTarget::kNeon:
    case SimdTarget::kWasm:
    case SimdTarget::kScalar:
      break;
  }
#elif HWY_ARCH_WASM
  if (simd == SimdTarget::kWasm) targets = HWY_WASM;
#else
  if (simd == SimdTarget::kNeon) targets = HWY_NEON;
#endif
  return targets;
}

inline constexpr bool kOneTarget = (HWY_TARGETS & (HWY_TARGETS - 1)) == 0;

// Index of `simd` in the tables of HWY_EXPORT. The choice is local: Highway's own, which is a
// global of the process, is left alone. Looked up: some kernels take less time than finding it.
inline size_t dispatch_index(SimdTarget simd) {
  if constexpr (kOneTarget) return 0;
  static const auto indices = [] {
    std::array<size_t, kSimdTargets.size()> index{};
    for (const SimdTarget target : kSimdTargets) {
      hwy::ChosenTarget chosen;
      chosen.Update(simd_target_mask(target));
      index[static_cast<size_t>(target)] = chosen.GetIndex();
    }
    return index;
  }();
  return indices[static_cast<size_t>(simd)];
}

}  // namespace plc::kernels

// The function to call: the scalar twin, or the entry of the table that HWY_EXPORT(function) made.
#define PLC_DISPATCH(simd, function)     \
  ((simd) == plc::SimdTarget::kScalar    \
       ? &plc::kernels::scalar::function \
       : HWY_DISPATCH_TABLE(function)[plc::kernels::dispatch_index(simd)])

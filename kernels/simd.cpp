#include "kernels/simd.h"

#include "kernels/dispatch.h"

namespace plc {

bool simd_target_available(SimdTarget target) {
  if (target == SimdTarget::kScalar) return true;
  const int64_t mask = kernels::simd_target_mask(target);
  const int64_t own = mask & ~(mask - 1);  // better targets have lower bits
  // What was compiled without a choice, every processor of its kind has. Highway is not asked then:
  // of ARM it wants instructions for cryptography, which no kernel uses and not all have.
  if constexpr (kernels::kOneTarget) return (own & HWY_TARGETS) != 0;
  return (own & HWY_TARGETS & hwy::SupportedTargets()) != 0;
}

std::vector<SimdTarget> available_simd_targets() {
  std::vector<SimdTarget> targets;
  for (const SimdTarget target : kSimdTargets) {
    if (simd_target_available(target)) targets.push_back(target);
  }
  return targets;
}

// Asked of the processor once: under a hypervisor it takes microseconds.
SimdTarget best_simd_target() {
  static const SimdTarget best = available_simd_targets().back();
  return best;
}

std::string_view simd_target_name(SimdTarget target) {
  switch (target) {
    case SimdTarget::kScalar:
      return "scalar";
    case SimdTarget::kSse4:
      return "sse4";
    case SimdTarget::kAvx2:
      return "avx2";
    case SimdTarget::kAvx512:
      return "avx512";
    case SimdTarget::kNeon:
      return "neon";
    case SimdTarget::kWasm:
      return "wasm";
  }
  return "unknown";
}

}  // namespace plc

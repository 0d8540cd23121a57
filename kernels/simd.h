// Which instruction set the kernels run on. A value, not a global: two contexts may differ.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace plc {

// Kernels trust the caller: only available targets may be asked for. Those of one processor are in
// ascending order.
enum class SimdTarget : uint8_t { kScalar, kSse4, kAvx2, kAvx512, kNeon, kWasm };
inline constexpr std::array kSimdTargets = {SimdTarget::kScalar, SimdTarget::kSse4,
                                            SimdTarget::kAvx2,   SimdTarget::kAvx512,
                                            SimdTarget::kNeon,   SimdTarget::kWasm};

// The best target of this machine.
SimdTarget best_simd_target();
// Whether this machine (and this build) has the target; kScalar always is there.
bool simd_target_available(SimdTarget target);
// All targets available here, kScalar first.
std::vector<SimdTarget> available_simd_targets();
// "scalar", "sse4", "avx2", "avx512", "neon", "wasm".
std::string_view simd_target_name(SimdTarget target);

}  // namespace plc

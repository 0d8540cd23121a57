#include "kernels/simd.h"

#include <algorithm>
#include <catch2/catch.hpp>

using plc::SimdTarget;

TEST_CASE("the scalar target is always there and the best target is the last one", "[kernels]") {
  const std::vector<SimdTarget> targets = plc::available_simd_targets();
  REQUIRE(targets.front() == SimdTarget::kScalar);
  REQUIRE(targets.back() == plc::best_simd_target());
  REQUIRE(std::is_sorted(targets.begin(), targets.end()));
}

TEST_CASE("the available targets are the ones that are said to be available", "[kernels]") {
  const std::vector<SimdTarget> targets = plc::available_simd_targets();
  for (const SimdTarget target : plc::kSimdTargets) {
    const bool listed = std::find(targets.begin(), targets.end(), target) != targets.end();
    REQUIRE(plc::simd_target_available(target) == listed);
  }
}

#if defined(__x86_64__)
TEST_CASE("every instruction set of this processor was compiled", "[kernels]") {
  const bool sse4 = __builtin_cpu_supports("sse4.2") != 0;
  const bool avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  const bool avx512 = __builtin_cpu_supports("avx512bw") != 0 &&
                      __builtin_cpu_supports("avx512dq") != 0 &&
                      __builtin_cpu_supports("avx512vl") != 0;
  REQUIRE(plc::simd_target_available(SimdTarget::kSse4) == sse4);
  REQUIRE(plc::simd_target_available(SimdTarget::kAvx2) == avx2);
  REQUIRE(plc::simd_target_available(SimdTarget::kAvx512) == avx512);
}
#elif defined(__aarch64__)
TEST_CASE("NEON is what an ARM processor computes with", "[kernels]") {
  REQUIRE(plc::best_simd_target() == SimdTarget::kNeon);
}
#elif defined(__wasm_simd128__)
TEST_CASE("vectors of WebAssembly are computed with where they are compiled", "[kernels]") {
  REQUIRE(plc::best_simd_target() == SimdTarget::kWasm);
}
#endif

TEST_CASE("targets have the names that the command line uses", "[kernels]") {
  REQUIRE(plc::simd_target_name(SimdTarget::kScalar) == "scalar");
  REQUIRE(plc::simd_target_name(SimdTarget::kSse4) == "sse4");
  REQUIRE(plc::simd_target_name(SimdTarget::kAvx2) == "avx2");
  REQUIRE(plc::simd_target_name(SimdTarget::kAvx512) == "avx512");
  REQUIRE(plc::simd_target_name(SimdTarget::kNeon) == "neon");
  REQUIRE(plc::simd_target_name(SimdTarget::kWasm) == "wasm");
}

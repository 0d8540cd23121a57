// What libFuzzer calls: one program per target, which PELLICLE_FUZZ_TARGET names.
#include <cstddef>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fuzz::PELLICLE_FUZZ_TARGET(fuzz::Bytes(data, size));
  return 0;
}

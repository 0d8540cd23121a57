// The C API: versions and contexts.
#include <algorithm>
#include <cstring>
#include <string_view>

#include "engine/api/handles.h"

namespace {

#define PLC_TEXT_OF(x) #x
#define PLC_VERSION_TEXT_OF(a, b, c) PLC_TEXT_OF(a) "." PLC_TEXT_OF(b) "." PLC_TEXT_OF(c)
#define PLC_VERSION_TEXT \
  PLC_VERSION_TEXT_OF(PLC_VERSION_MAJOR, PLC_VERSION_MINOR, PLC_VERSION_PATCH)

constexpr int kMaxThreads = 1024;

bool target_of(plc_simd simd, plc::SimdTarget& target) {
  switch (simd) {
    case PLC_SIMD_AUTO:
      target = plc::best_simd_target();
      return true;
    case PLC_SIMD_SCALAR:
      target = plc::SimdTarget::kScalar;
      return true;
    case PLC_SIMD_SSE4:
      target = plc::SimdTarget::kSse4;
      return true;
    case PLC_SIMD_AVX2:
      target = plc::SimdTarget::kAvx2;
      return true;
    case PLC_SIMD_AVX512:
      target = plc::SimdTarget::kAvx512;
      return true;
    case PLC_SIMD_NEON:
      target = plc::SimdTarget::kNeon;
      return true;
    case PLC_SIMD_WASM:
      target = plc::SimdTarget::kWasm;
      return true;
  }
  return false;
}

void tell(char* error, size_t error_size, std::string_view line) {
  if (error == nullptr || error_size == 0) return;
  const size_t n = std::min(error_size - 1, line.size());
  std::memcpy(error, line.data(), n);
  error[n] = '\0';
}

plc::Status check(const plc_context_options& options) {
  if (options.threads < 0 || options.threads > kMaxThreads) {
    return plc::bad_argument("threads " + std::to_string(options.threads) + ": must be 0 .. 1024");
  }
  if ((options.allocate == nullptr) != (options.release == nullptr)) {
    return plc::bad_argument("allocate, release: both or neither must be NULL");
  }
  if (options.memory_limit < 0) {
    return plc::bad_argument("memory limit " + std::to_string(options.memory_limit) +
                             ": must not be negative");
  }
  return {};
}

plc::Status create(const plc_context_options* options, plc_context** context) {
  if (context == nullptr) return plc::bad_argument("context: must not be NULL");
  *context = nullptr;
  plc_context_options used;
  plc_context_options_defaults(&used);
  if (options != nullptr) {
    if (plc::Status s = plc::take_struct(options, plc_context_options_defaults, "options", used);
        !s.ok()) {
      return s;
    }
  }
  if (plc::Status s = check(used); !s.ok()) return s;
  plc::SimdTarget target{};
  if (!target_of(used.simd, target)) return plc::bad_argument("simd: not a plc_simd");
  if (!plc::simd_target_available(target)) {
    return plc::bad_argument("simd " + std::string(plc::simd_target_name(target)) +
                             ": this machine does not have it");
  }
  auto made = std::make_unique<plc_context>();
  made->host = std::make_shared<plc::Host>(
      plc::Memory::Hooks{used.allocate, used.release, used.allocator_user}, used.memory_limit,
      plc::Threads{used.threads, used.parallel_for, used.parallel_for_user}, target);
  made->host->log_fn = used.log;
  made->host->log_user = used.log_user;
  *context = made.release();
  return {};
}

}  // namespace

extern "C" {

const char* plc_version_string(void) {
  return PLC_VERSION_TEXT;
}

int plc_version(void) {
  return PLC_VERSION;
}

void plc_context_options_defaults(plc_context_options* options) {
  if (options == nullptr) return;
  *options = {};
  options->struct_size = sizeof *options;
}

plc_status plc_context_create(const plc_context_options* options, plc_context** context,
                              char* error, size_t error_size) {
  return plc::caught([&] { return create(options, context); },
                     [&](std::string_view line) { tell(error, error_size, line); });
}

void plc_context_destroy(plc_context* context) {
  delete context;
}

const char* plc_context_message(const plc_context* context) {
  return context == nullptr ? "" : context->message.c_str();
}
int plc_context_threads(const plc_context* context) {
  return context == nullptr ? 0 : context->host->schedule.threads();
}
const char* plc_context_simd(const plc_context* context) {
  return context == nullptr ? "" : plc::simd_target_name(context->host->simd).data();
}
plc_status plc_context_memory(const plc_context* context, int64_t* now, int64_t* peak) {
  if (context == nullptr) return PLC_INVALID_ARGUMENT;
  if (now != nullptr) *now = context->host->memory.now();
  if (peak != nullptr) *peak = context->host->memory.peak();
  return PLC_OK;
}

}  // extern "C"

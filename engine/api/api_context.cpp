// The C API: versions and contexts.
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
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

// Rounded up, in whole units: a point would be the locale's.
void write_bytes(uint64_t bytes, std::array<char, 32>& text) {
  constexpr uint64_t kKiB = 1024, kMiB = kKiB * kKiB, kMany = 10;
  const bool many = bytes >= kMany * kMiB;
  const uint64_t unit = many ? kMiB : kKiB;
  const uint64_t count = bytes / unit + (bytes % unit == 0 ? 0 : 1);
  std::snprintf(text.data(), text.size(), "%" PRIu64 " %s", bytes < kMany * kKiB ? bytes : count,
                bytes < kMany * kKiB ? "bytes" : (many ? "MiB" : "KiB"));
}

}  // namespace

void plc::tell_refusal(const Memory& memory, std::string& message) noexcept {
  const Memory::Refusal refusal = memory.refusal();
  if (refusal.size == 0) return;
  std::array<char, 32> asked{}, used{}, limit{};
  write_bytes(refusal.size, asked);
  write_bytes(static_cast<uint64_t>(refusal.in_use), used);
  write_bytes(static_cast<uint64_t>(memory.limit()), limit);
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), ": %s were asked for, %s are in use%s%s", asked.data(),
                used.data(), memory.limit() == 0 ? "" : ", the limit is ",
                memory.limit() == 0 ? "" : limit.data());
  try {
    message.append(line.data());
  } catch (const std::bad_alloc&) {
    return;
  }
}

extern "C" {

const char* plc_version_string(void) {
  return PLC_VERSION_TEXT;
}

int plc_version(void) {
  return PLC_VERSION;
}

const char* plc_status_string(plc_status status) {
  switch (status) {
    case PLC_OK:
      return "success";
    case PLC_INVALID_ARGUMENT:
      return "invalid argument: a parameter is outside its range";
    case PLC_INVALID_DATA:
      return "invalid data: the image or mesh cannot be used";
    case PLC_OUT_OF_MEMORY:
      return "out of memory";
    case PLC_CANCELLED:
      return "cancelled: a callback asked to stop";
    case PLC_INTERNAL:
      return "internal error: a bug of the engine, caught before it did harm";
  }
  return "not a status of this version of the library";
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
  return context == nullptr ? "" : plc::simd_target_name(context->host->schedule.simd()).data();
}
plc_status plc_context_memory(const plc_context* context, int64_t* now, int64_t* peak) {
  if (context == nullptr) return PLC_INVALID_ARGUMENT;
  if (now != nullptr) *now = context->host->memory.now();
  if (peak != nullptr) *peak = context->host->memory.peak();
  return PLC_OK;
}

}  // extern "C"

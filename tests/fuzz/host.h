// A host of the C API that trusts nothing: its memory is the C library's, so that sanitizers see
// every byte, and what a call says is checked.
#pragma once
#include <cstdlib>
#include <string>

#include "engine/pellicle.h"
#include "tests/fuzz/input.h"
#include "tests/samples/sample_handles.h"

namespace fuzz {

using samples::Context;
using samples::PyramidHandle;
using samples::RunHandle;
using samples::VolumeHandle;
using SurfaceHandle = samples::Surface;

inline void* allocate(size_t size, size_t alignment, void*) {
  void* data = nullptr;
  return posix_memalign(&data, alignment, size) == 0 ? data : nullptr;
}
inline void release(void* data, size_t, size_t, void*) {
  std::free(data);
}

// One thread and the C library's memory, `limit` bytes of it.
inline Context make_context(int64_t limit) {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = 1;
  options.allocate = allocate;
  options.release = release;
  options.memory_limit = limit;
  plc_context* context = nullptr;
  char error[256] = "";
  require(plc_context_create(&options, &context, error, sizeof error) == PLC_OK, error);
  return Context(context);
}

// A status that may be, and after a failure a message of one line. PLC_INTERNAL is a bug, always.
inline void check_status(const plc_context* context, plc_status status) {
  require(status >= PLC_OK && status < PLC_INTERNAL,
          "status " + std::to_string(status) + ": " + plc_context_message(context));
  if (status == PLC_OK) return;
  const std::string message = plc_context_message(context);
  require(!message.empty(), "a failure without a message");
  for (const char c : message) {
    require(static_cast<unsigned char>(c) >= ' ' && c != '\x7f',
            "a message of more than a line: " + message);
  }
}

inline plc_check surface_check(plc_context* context, const plc_surface* surface) {
  plc_check check{};
  check.struct_size = sizeof check;
  require(plc_surface_check(context, surface, &check) == PLC_OK, "a surface that is not checked");
  return check;
}

// What the engine promises of every surface that it gives.
inline void require_valid(plc_context* context, const plc_surface* surface,
                          const std::string& when) {
  const plc_check check = surface_check(context, surface);
  if (check.valid != 0) return;
  throw Broken(when + ": not valid: closed " + std::to_string(check.closed) + ", manifold " +
               std::to_string(check.manifold) + ", oriented " + std::to_string(check.oriented) +
               ", outward " + std::to_string(check.outward) + ", degenerate faces " +
               std::to_string(check.degenerate_faces) + ", self-intersections " +
               std::to_string(check.self_intersections));
}

}  // namespace fuzz

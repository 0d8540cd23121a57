// What the opaque handles of the C API hold, and how failures cross its boundary.
#pragma once
#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/api/frame.h"
#include "engine/base/float_environment.h"
#include "engine/base/mesh_arrays.h"
#include "engine/base/schedule.h"
#include "engine/mesh/face_rings.h"
#include "engine/mesh/mesh.h"
#include "engine/pellicle.h"
#include "engine/recover/recovery.h"
#include "kernels/simd.h"
#include "pyramid/memory.h"
#include "pyramid/status.h"
#include "pyramid/volume.h"

namespace plc {

// What a context and all that is made with it share: the last of them frees it.
struct Host {
  Host(const Memory::Hooks& hooks, int64_t limit, const Threads& threads, SimdTarget target)
      : memory(hooks, limit), schedule(threads, target) {}
  // To whoever listens.
  void log(plc_log_level level, const std::string& line) const {
    if (log_fn != nullptr) log_fn(level, line.c_str(), log_user);
  }

  Memory memory;
  Schedule schedule;
  plc_log_fn log_fn = nullptr;
  void* log_user = nullptr;
};

// A host's callback could not fetch a brick.
class BrickFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// In each of these the host comes first: it goes last, and with it the memory of the rest.

struct VolumeData {
  std::shared_ptr<Host> host;
  VolumeView view;
  Frame frame;
  Buffer<uint8_t> own;              // where the voxels are not borrowed
  std::optional<VoxelRange> range;  // where the host has told it
};

struct PyramidData {
  std::shared_ptr<Host> host;
  std::shared_ptr<const VolumeData> volume;
  plc_parameters given{}, parameters{};  // as given, and as derived
  VoxelRange range;
  Buffer<float> feature;  // what I_0 then is
  Pyramid images;
  std::vector<double> isos;   // normalised, of each level; none where no iso-value is set
  double seconds = 0;         // of all this
  double seconds_images = 0;  // of it, build_pyramid
};

}  // namespace plc

struct plc_context {
  std::shared_ptr<plc::Host> host;
  std::string message;
};

struct plc_volume {
  std::shared_ptr<const plc::VolumeData> data;
};

struct plc_pyramid {
  std::shared_ptr<const plc::PyramidData> data;
};

struct plc_surface {
  std::shared_ptr<plc::Host> host;
  plc::Mesh mesh;
  plc::MeshSpace space;
  plc::Frame frame;
  plc_parameters parameters{};
  plc::VoxelRange range;
  std::vector<plc::LevelRecord> records;
  std::vector<std::array<int64_t, 3>> level_dims;  // of the pyramid, from the coarsest on
  std::vector<double> level_units;                 // mm
  plc_seconds seconds{};
};

namespace plc {

// What a host is told of a failure, in one line.
inline std::string message_of(const Status& status) {
  std::string line = status.message();
  if (status.code() == ErrorCode::kInternal) {
    line = "internal error: " + line;
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  }
  return line;
}

// body(), which returns a Status; no exception gets past it. tell(line) says what was wrong, ""
// where nothing was.
template <typename Body, typename Tell>
plc_status caught(Body&& body, Tell&& tell) {
  try {
    Status status;
    try {
      status = body();
    } catch (const TooManyVertices&) {
      status = too_many_vertices();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const BrickFailure& e) {
      status = {ErrorCode::kInvalidData, e.what()};
    } catch (const std::exception& e) {
      status = {ErrorCode::kInternal, e.what()};
    } catch (...) {
      status = {ErrorCode::kInternal, "something was thrown that is no std::exception"};
    }
    tell(message_of(status));
    return static_cast<plc_status>(status.code());
  } catch (const std::bad_alloc&) {
    tell("out of memory");
    return PLC_OUT_OF_MEMORY;
  }
}

// Adds to a message how much memory was asked for, and how much there was; where there is none for
// that either, the message stays as it is.
void tell_refusal(const Memory& memory, std::string& message) noexcept;

// Runs body, which returns a Status, in the memory of the context; no exception gets past it.
template <typename Body>
plc_status guarded(plc_context* context, Body&& body) {
  if (context == nullptr) return PLC_INVALID_ARGUMENT;
  const std::shared_ptr<Host> host = context->host;
  host->memory.forget_refusal();
  const MemoryScope scope(host->memory);
  const FloatEnvironment environment;
  const plc_status status = caught(std::forward<Body>(body),
                                   [&](std::string_view line) { context->message.assign(line); });
  if (status == PLC_OUT_OF_MEMORY) tell_refusal(host->memory, context->message);
  return status;
}

// Counts below 0 become impossible ones, which check_mesh_input() tells as they were.
inline MeshArrays mesh_arrays(const double* xyz, int64_t vertex_count, const uint32_t* abc,
                              int64_t face_count) {
  return {xyz, static_cast<size_t>(vertex_count), abc, static_cast<size_t>(face_count)};
}

// Of a struct that a host fills in: what its version of the header has, the rest at its default.
template <typename T>
Status take_struct(const T* from, void (*defaults)(T*), const char* name, T& to) {
  if (from == nullptr) return bad_argument(std::string(name) + ": must not be NULL");
  size_t size = from->struct_size;
  if (size < sizeof size || size > sizeof to) {
    return bad_argument(std::string(name) + ": struct_size " + std::to_string(size) +
                        " is not that of this version or an earlier one");
  }
  defaults(&to);
  std::memcpy(static_cast<void*>(&to), from, size);
  to.struct_size = sizeof to;
  return {};
}

// Of a struct that a host has filled in for it: as much as its version of the header has.
template <typename T>
Status check_output(const T* to, const char* name) {
  if (to == nullptr) return bad_argument(std::string(name) + ": must not be NULL");
  const size_t size = to->struct_size;
  if (size < sizeof size || size > sizeof *to) {
    return bad_argument(std::string(name) + ": struct_size " + std::to_string(size) +
                        " is not that of this version or an earlier one");
  }
  return {};
}
template <typename T>
void give_struct(const T& value, T* to) {
  const size_t size = to->struct_size;
  std::memcpy(static_cast<void*>(to), &value, size);
  to->struct_size = size;
}

// Room for `count` values, of which there is capacity.
inline Status check_room(const char* name, const void* data, int64_t capacity, int64_t count) {
  if (capacity < count) {
    return bad_argument(std::string(name) + ": room for " + std::to_string(capacity) +
                        ", there are " + std::to_string(count));
  }
  if (data == nullptr && count > 0) return bad_argument(std::string(name) + ": must not be NULL");
  return {};
}

// Of an image but for its voxels: what tells where it lies.
Status check_frame(const plc_image& image);
Frame frame_of(const plc_image& image);
// The voxels of an image, by default the caller's; `own` gets them where they are not dense, or are
// to be copied.
Status take_voxels(const char* name, const plc_image& image, bool copy, const Executor& executor,
                   VolumeView& view, Buffer<uint8_t>& own);
std::shared_ptr<VolumeData> new_volume(const std::shared_ptr<Host>& host);

}  // namespace plc

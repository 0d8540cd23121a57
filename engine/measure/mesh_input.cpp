#include "engine/measure/mesh_input.h"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

#include "engine/base/blocks.h"
#include "engine/measure/mesh_topology.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kBlock = 8192;

// The smallest i in [0, count) that is bad, or count.
template <typename Bad>
size_t find_first(const Executor& executor, size_t count, const Bad& bad) {
  Vector<size_t> first(block_count(count, kBlock), count);
  run_blocks(executor, count, kBlock, [&](size_t block, size_t begin, size_t end) {
    for (size_t i = begin; i < end && first[block] == count; ++i) {
      if (bad(i)) first[block] = i;
    }
  });
  for (const size_t i : first) {
    if (i != count) return i;
  }
  return count;
}

bool usable(double x) {
  const double magnitude = std::abs(x);  // comparisons are false for NaN
  return x == 0 || (magnitude >= kCoordinateMin && magnitude <= kCoordinateMax);
}

std::string text(double x) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", x);
  return buffer;
}

Status check_counts(const double* xyz, int64_t vertex_count, const uint32_t* abc,
                    int64_t face_count) {
  constexpr int64_t kMaxVertices = int64_t{1} << 32;
  const auto error = [](const std::string& message) {
    return Status(ErrorCode::kInvalidArgument, message);
  };
  if (vertex_count < 0 || vertex_count > kMaxVertices) {
    return error("the mesh has " + std::to_string(vertex_count) + " vertices, expected 0 to " +
                 std::to_string(kMaxVertices));
  }
  if (face_count < 0 || face_count > kMaxFaces) {
    return error("the mesh has " + std::to_string(face_count) + " faces, expected 0 to " +
                 std::to_string(kMaxFaces));
  }
  if (vertex_count > 0 && xyz == nullptr) return error("the mesh has vertices but no coordinates");
  if (face_count > 0 && abc == nullptr) return error("the mesh has faces but no indices");
  return {};
}

Status check_values(const double* xyz, size_t vertex_count, const uint32_t* abc, size_t face_count,
                    const Executor& executor) {
  const size_t value =
      find_first(executor, 3 * vertex_count, [&](size_t i) { return !usable(xyz[i]); });
  if (value != 3 * vertex_count) {
    return {ErrorCode::kInvalidData,
            "vertex " + std::to_string(value / 3) + ": " + "xyz"[value % 3] + " is " +
                text(xyz[value]) +
                (std::isfinite(xyz[value]) ? ", expected 0 or a magnitude from 1e-70 to 1e+70"
                                           : ", expected a finite number")};
  }
  const size_t corner =
      find_first(executor, 3 * face_count, [&](size_t i) { return abc[i] >= vertex_count; });
  if (corner != 3 * face_count) {
    return {ErrorCode::kInvalidData,
            "face " + std::to_string(corner / 3) + ": corner " + std::to_string(corner % 3) +
                " is vertex " + std::to_string(abc[corner]) + ", expected an index below " +
                std::to_string(vertex_count)};
  }
  return {};
}

}  // namespace

Status check_mesh_input(const double* xyz, int64_t vertex_count, const uint32_t* abc,
                        int64_t face_count, const Executor& executor) {
  Status status = check_counts(xyz, vertex_count, abc, face_count);
  if (!status.ok()) return status;
  return check_values(xyz, static_cast<size_t>(vertex_count), abc, static_cast<size_t>(face_count),
                      executor);
}

}  // namespace plc

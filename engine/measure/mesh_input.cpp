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

Status check_counts(const MeshArrays& mesh) {
  const auto vertex_count = static_cast<int64_t>(mesh.vertex_count);
  const auto face_count = static_cast<int64_t>(mesh.face_count);
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
  if (vertex_count > 0 && mesh.xyz == nullptr)
    return error("the mesh has vertices but no coordinates");
  if (face_count > 0 && mesh.abc == nullptr) return error("the mesh has faces but no indices");
  return {};
}

Status check_values(const MeshArrays& mesh, const Executor& executor) {
  const size_t values = 3 * mesh.vertex_count, corners = 3 * mesh.face_count;
  const size_t value = find_first(executor, values, [&](size_t i) { return !usable(mesh.xyz[i]); });
  if (value != values) {
    return {ErrorCode::kInvalidData,
            "vertex " + std::to_string(value / 3) + ": " + "xyz"[value % 3] + " is " +
                text(mesh.xyz[value]) +
                (std::isfinite(mesh.xyz[value]) ? ", expected 0 or a magnitude from 1e-70 to 1e+70"
                                                : ", expected a finite number")};
  }
  const size_t corner =
      find_first(executor, corners, [&](size_t i) { return mesh.abc[i] >= mesh.vertex_count; });
  if (corner != corners) {
    return {ErrorCode::kInvalidData,
            "face " + std::to_string(corner / 3) + ": corner " + std::to_string(corner % 3) +
                " is vertex " + std::to_string(mesh.abc[corner]) + ", expected an index below " +
                std::to_string(mesh.vertex_count)};
  }
  return {};
}

}  // namespace

Status check_mesh_input(const MeshArrays& mesh, const Executor& executor) {
  Status status = check_counts(mesh);
  return status.ok() ? check_values(mesh, executor) : status;
}

}  // namespace plc

#include "tools/blocks/mesh_fragment.h"

#include <algorithm>
#include <cmath>

#ifdef PELLICLE_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#endif

#include "tools/file/failure.h"

namespace plc::tools {

namespace {

constexpr double kLargest = (1U << kPositionBits) - 1;

MeshFragment::Corner corner_at(const Place& place, const Place& low, double side) {
  MeshFragment::Corner corner = 0;
  for (size_t a = 0; a < 3; ++a) {
    // Halves go up: half of 65535 becomes 32768.
    const double step = std::floor((place[a] - low[a]) / side * kLargest + 0.5);
    corner |= static_cast<uint64_t>(step) << (kPositionBits * a);
  }
  return corner;
}

}  // namespace

MeshFragments::MeshFragments(const ChunkGrid& grid, int lod, const Int3& first, const Int3& end)
    : lod_(lod),
      side_(grid.chunk(lod)),
      first_(first),
      end_(end),
      cutter_(ChunkGrid::origin(), lod > 0 ? grid.chunk(lod - 1) : grid.chunk(0)) {
  for (size_t a = 0; a < 3; ++a) {
    low_[a] = ChunkGrid::origin() + static_cast<double>(first[a]) * side_;
    high_[a] = ChunkGrid::origin() + static_cast<double>(end[a]) * side_;
  }
}

void MeshFragments::add(const Triangle& face) {
  for (size_t a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax({face[0][a], face[1][a], face[2][a]});
    if (high < low_[a] || low >= high_[a]) return;
  }
  for (const auto& [corners, cube] : cutter_.cut(face)) {
    Int3 chunk{};
    Place low{};
    unsigned eighth = 0;
    bool inside = true;
    for (size_t a = 0; a < 3; ++a) {
      chunk[a] = lod_ > 0 ? cube[a] >> 1 : cube[a];
      if (lod_ > 0) eighth |= static_cast<unsigned>(cube[a] & 1) << a;
      low[a] = ChunkGrid::origin() + static_cast<double>(chunk[a]) * side_;
      inside = inside && chunk[a] >= first_[a] && chunk[a] < end_[a];
    }
    if (!inside) continue;
    std::array<MeshFragment::Corner, 3> made{};
    for (size_t k = 0; k < 3; ++k) made[k] = corner_at(corners[k], low, side_);
    if (made[0] == made[1] || made[1] == made[2] || made[2] == made[0]) continue;
    MeshFragment& fragment = fragments_[chunk];
    fragment.faces.push_back(made);
    fragment.eighths = static_cast<uint8_t>(fragment.eighths | 1U << eighth);
  }
}

#ifdef PELLICLE_DRACO

// Of 0, the smallest, to 10, the fastest.
constexpr int kSpeed = 5;

bool has_draco() {
  return true;
}

std::string packed_fragment(const MeshFragment& fragment) {
  std::vector<MeshFragment::Corner> corners;
  for (const auto& face : fragment.faces) corners.insert(corners.end(), face.begin(), face.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  const auto index_of = [&](MeshFragment::Corner corner) {
    const auto found = std::lower_bound(corners.begin(), corners.end(), corner);
    return draco::PointIndex(static_cast<uint32_t>(found - corners.begin()));
  };

  draco::Mesh mesh;
  mesh.set_num_points(static_cast<uint32_t>(corners.size()));
  draco::GeometryAttribute positions;
  positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_INT32, false,
                 3 * sizeof(int32_t), 0);
  const int id = mesh.AddAttribute(positions, true, static_cast<uint32_t>(corners.size()));
  for (size_t v = 0; v < corners.size(); ++v) {
    std::array<int32_t, 3> xyz{};
    for (size_t a = 0; a < 3; ++a) {
      xyz[a] =
          static_cast<int32_t>(corners[v] >> (kPositionBits * a) & ((1U << kPositionBits) - 1));
    }
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(static_cast<uint32_t>(v)),
                                          xyz.data());
  }
  for (const auto& face : fragment.faces) {
    mesh.AddFace({index_of(face[0]), index_of(face[1]), index_of(face[2])});
  }
  draco::Encoder encoder;
  encoder.SetSpeedOptions(kSpeed, kSpeed);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
  if (!status.ok()) throw Failure{std::string("a chunk cannot be packed: ") + status.error_msg()};
  return {buffer.data(), buffer.size()};
}

#else

bool has_draco() {
  return false;
}

std::string packed_fragment(const MeshFragment& /*fragment*/) {
  throw Failure{
      "meshes for neuroglancer cannot be written, as this was built without libdraco-dev"};
}

#endif

}  // namespace plc::tools

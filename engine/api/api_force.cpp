#include "engine/api/api_force.h"
#include "pyramid/memory.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace plc {

namespace {

// Beyond this movements would be lost in floats.
constexpr float kMaxForce = 1e6F;

class HostForce {
 public:
  HostForce(const plc_extras& extras, const Frame& frame, const Executor& executor)
      : extras_(extras),
        executor_(executor),
        to_space_(frame.to(extras.space)),
        to_voxel_(to_space_.inverse()),
        unit_(extras.space == PLC_SPACE_VOXEL
                  ? 1.0
                  : *std::min_element(frame.spacing.begin(), frame.spacing.end())) {}

  Status add(int level, const MeshSpace& space, const Mesh& mesh, const Float4* position,
             Streams3& force) const {
    Vector<uint32_t> ids;
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      if (mesh.alive(v)) ids.push_back(v);
    }
    const size_t n = ids.size();
    Vector<float> xyz(3 * n), normals(3 * n), forces(3 * n, 0.0F);
    constexpr size_t kChunk = 4096;
    executor_.run((n + kChunk - 1) / kChunk, [&](size_t chunk) {
      for (size_t i = chunk * kChunk; i < std::min(n, (chunk + 1) * kChunk); ++i) {
        const Float4& p = position[ids[i]];
        put_point({p.x, p.y, p.z}, space, xyz.data() + 3 * i);
        put_normal(mesh.normal.at(ids[i]), space, normals.data() + 3 * i);
      }
    });
    const plc_force_points points{sizeof points, level, static_cast<int64_t>(n), xyz.data(),
                                  normals.data()};
    if (extras_.force(&points, forces.data(), extras_.force_user) != 0) {
      return {ErrorCode::kCancelled, "cancelled by the force callback"};
    }
    for (size_t i = 0; i < n; ++i) {
      const float* f = forces.data() + 3 * i;
      if (!std::all_of(f, f + 3, [](float x) { return std::abs(x) <= kMaxForce; })) {
        return {ErrorCode::kInvalidArgument,
                "force callback: the force on vertex " + std::to_string(i) + " of level " +
                    std::to_string(level) + " is not finite, or above 1e6"};
      }
      force.set(ids[i], in_mesh(f, space, mesh.delta));
    }
    return {};
  }

 private:
  void put_point(Vec3 at, const MeshSpace& space, float* to) const {
    const auto p = to_space_.point({static_cast<double>(at.x) / space.step[0],
                                    static_cast<double>(at.y) / space.step[1],
                                    static_cast<double>(at.z) / space.step[2]});
    for (size_t a = 0; a < 3; ++a) to[a] = static_cast<float>(p[a]);
  }

  // Normals map by the transposed inverse.
  void put_normal(Vec3 n, const MeshSpace& space, float* to) const {
    const std::array<double, 3> across{static_cast<double>(n.x) * space.step[0],
                                       static_cast<double>(n.y) * space.step[1],
                                       static_cast<double>(n.z) * space.step[2]};
    std::array<double, 3> out{};
    double squared = 0;
    for (size_t a = 0; a < 3; ++a) {
      for (size_t b = 0; b < 3; ++b) out[a] += to_voxel_.m[3 * b + a] * across[b];
      squared += out[a] * out[a];
    }
    const double length = squared > 0 ? std::sqrt(squared) : 1;
    for (size_t a = 0; a < 3; ++a) to[a] = static_cast<float>(out[a] / length);
  }

  // A force of 1 is delta U_0 long, as that of (7); what it moves along an axis, in mesh units, is
  // less where these are longer.
  Vec3 in_mesh(const float* f, const MeshSpace& space, double delta) const {
    const auto voxels = to_voxel_.vector(
        {static_cast<double>(f[0]), static_cast<double>(f[1]), static_cast<double>(f[2])});
    float m[3];
    for (size_t a = 0; a < 3; ++a) {
      m[a] = static_cast<float>(voxels[a] * space.step[a] * delta * unit_);
    }
    return {m[0], m[1], m[2]};
  }

  const plc_extras& extras_;
  const Executor& executor_;
  Affine to_space_, to_voxel_;
  double unit_;  // U_0 in the space's unit
};

}  // namespace

LevelForce level_force(const plc_extras& extras, const Frame& frame, const Executor& executor) {
  if (extras.force == nullptr) return {};
  return [host = HostForce(extras, frame, executor)](
             int level, const MeshSpace& space, const Mesh& mesh, const Float4* position,
             Streams3& force) { return host.add(level, space, mesh, position, force); };
}

}  // namespace plc

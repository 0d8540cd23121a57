#include "engine/start/regular_iso_surface.h"

#include <algorithm>
#include <cmath>

#include "engine/guard/self_meeting.h"
#include "engine/resolve/refinement.h"
#include "engine/start/thinning.h"
#include "engine/transform/deletion.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// Crossings are merged anew, but for voxels whose faces have met, so many times; then not at all.
constexpr int kTries = 8;

// Puts merged vertices where the value is iso: the mean of crossings around a thin part lies inside
// it, and the part would start too thin to be held.
class Projection {
 public:
  Projection(const ImageView& image, const LatticeValues& values, float iso)
      : image_(image), values_(values), iso_(iso) {}

  // voxel: the number of the one inside that the place belongs to.
  Vec3 project(Vec3 p, uint64_t voxel) const {
    const Vec3 from = place(voxel), way = in_voxels(p) - from;
    const float at_voxel = value(from), at_p = value(from + way);
    const float longer = (at_voxel - iso_) / (at_voxel - at_p);
    if (std::isnan(longer)) return p;
    // No farther from the voxel than crossings are: late_bubbles.cpp counts on it.
    const float farthest = std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)});
    const float longest = static_cast<float>(1 - kIsoMargin) / farthest;
    const Vec3 q = from + way * std::min(std::clamp(longer, kShortest, kLongest), longest);
    return {(q.x - image_.offset[0]) / image_.scale[0], (q.y - image_.offset[1]) / image_.scale[1],
            (q.z - image_.offset[2]) / image_.scale[2]};
  }

 private:
  static constexpr float kShortest = 0.8F, kLongest = 1.5F;

  Vec3 place(uint64_t voxel) const {
    const auto width = static_cast<uint64_t>(image_.dims[0]) + 2;
    const auto height = static_cast<uint64_t>(image_.dims[1]) + 2;
    const uint64_t row = voxel / width, plane = row / height;
    // The lattice has a point more on every side.
    return {static_cast<float>(voxel % width) - 1, static_cast<float>(row % height) - 1,
            static_cast<float>(plane) - 1};
  }
  Vec3 in_voxels(Vec3 p) const {
    return {p.x * image_.scale[0] + image_.offset[0], p.y * image_.scale[1] + image_.offset[1],
            p.z * image_.scale[2] + image_.offset[2]};
  }
  // Trilinear.
  float value(Vec3 c) const {
    const float at[3] = {c.x, c.y, c.z};
    int32_t low[3];
    float part[3];
    for (size_t a = 0; a < 3; ++a) {
      low[a] =
          std::clamp(static_cast<int32_t>(std::floor(at[a])), 0, std::max(image_.dims[a] - 2, 0));
      part[a] = std::clamp(at[a] - static_cast<float>(low[a]), 0.0F, 1.0F);
    }
    float sum = 0;
    for (uint32_t corner = 0; corner < 8; ++corner) {
      float weight = 1;
      int32_t v[3];
      for (uint32_t a = 0; a < 3; ++a) {
        const bool up = (corner >> a & 1) != 0 && image_.dims[a] > 1;
        weight *= (corner >> a & 1) != 0 ? part[a] : 1 - part[a];
        v[a] = low[a] + (up ? 1 : 0);
      }
      if (weight != 0) sum += weight * values_.at(v[0], v[1], v[2]);
    }
    return sum;
  }

  const ImageView& image_;
  const LatticeValues& values_;
  float iso_;
};

// Merges the vertices of each voxel, but for those that stay apart.
class Merging {
 public:
  Merging(Mesh& mesh, const Vector<uint64_t>& voxel, const Vector<uint8_t>& apart,
          const Projection& projection)
      : mesh_(mesh),
        voxel_(voxel),
        apart_(apart),
        projection_(projection),
        merged_(mesh.slots(), 1) {}

  void run() {
    for (uint32_t v = 0; v < mesh_.slots(); ++v) {
      while (mesh_.alive(v) && apart_[v] == 0 && contract_one(v)) {
      }
      if (mesh_.alive(v) && merged_[v] > 1) {
        mesh_.place(v, projection_.project(mesh_.at(v), voxel_[v]));
      }
    }
  }

 private:
  // The first edge of v that may be contracted; v stays.
  bool contract_one(uint32_t v) {
    for (uint32_t k = 0; k < mesh_.valence(v); ++k) {
      const Edge e = edge_at(mesh_, v, k);
      if (voxel_[e.v] != voxel_[v] || !can_contract(mesh_, e)) continue;
      const auto of_v = static_cast<float>(merged_[v]), of_w = static_cast<float>(merged_[e.v]);
      const Vec3 mean = (mesh_.at(v) * of_v + mesh_.at(e.v) * of_w) * (1 / (of_v + of_w));
      merged_[v] += merged_[e.v];
      delete_edge(mesh_, e, mean);
      return true;
    }
    return false;
  }

  Mesh& mesh_;
  const Vector<uint64_t>& voxel_;
  const Vector<uint8_t>& apart_;
  const Projection& projection_;
  Vector<uint32_t> merged_;  // crossings that a vertex stands for
};

// The voxels of faces that meet stay apart. False where there are none.
bool set_apart(const Mesh& mesh, const Schedule& schedule, const Vector<uint64_t>& voxel,
               Vector<uint8_t>& apart) {
  Vector<uint64_t> voxels;
  for (const auto& face : meeting_faces(mesh, schedule)) {
    for (const uint32_t v : face) voxels.push_back(voxel[v]);
  }
  if (voxels.empty()) return false;
  std::sort(voxels.begin(), voxels.end());
  for (size_t v = 0; v < voxel.size(); ++v) {
    if (std::binary_search(voxels.begin(), voxels.end(), voxel[v])) apart[v] = 1;
  }
  return true;
}

}  // namespace

Status regular_iso_surface(const ImageObject& object, const LatticeValues& values,
                           const Schedule& schedule, Mesh& mesh, int64_t least,
                           const StartHooks& hooks) {
  if (mesh.sizing != nullptr) {
    const auto make = [&](Crossings& crossings) -> Status {
      if (Status s = iso_crossings(object, values, least, schedule, crossings); !s.ok()) return s;
      return ask(hooks.go_on);
    };
    return thin_out(make, schedule, hooks, mesh);
  }
  Vector<uint64_t> voxel;
  if (Status s = iso_surface(object, values, schedule, mesh, &voxel); !s.ok()) {
    return s;
  }
  const Mesh crossings = mesh.copy();
  Vector<uint8_t> apart(mesh.slots(), 0);
  const Projection projection(object.image, values, object.iso);
  for (int i = 0; i < kTries; ++i) {
    Merging(mesh, voxel, apart, projection).run();
    if (!set_apart(mesh, schedule, voxel, apart)) {
      mesh.renumber(morton_order(mesh, schedule), schedule);
      return {};
    }
    mesh.take(crossings.copy());
  }
  return {};
}

}  // namespace plc

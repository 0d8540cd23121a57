#include "engine/start/thinning.h"

#include <numeric>

#include "engine/base/constants.h"
#include "engine/guard/self_meeting.h"
#include "engine/resolve/refinement.h"
#include "engine/transform/deletion.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// In sizes: how near to one that stays others are merged into it.
constexpr float kThinReach = 1.05F;
// The first part of the way: what meets when it is thinned out further stays as fine as that. And
// it is faster.
constexpr float kHalfway = 0.6F;
// Vertices are merged anew, but for those whose faces have met, so many times; then not at all.
constexpr int kTries = 8;

class Thinning {
 public:
  // stays: of vertices that are not merged; a byte each.
  Thinning(Mesh& mesh, const Vector<uint8_t>& stays, float reach)
      : mesh_(mesh), stays_(stays), reach_(reach), into_(mesh.slots()) {}

  void run() {
    std::iota(into_.begin(), into_.end(), 0U);
    for (uint32_t v = 0; v < mesh_.slots(); ++v) {
      while (mesh_.alive(v) && stays_[v] == 0 && merge_one(v)) {
      }
    }
  }
  // What v was merged into, or itself.
  uint32_t left_of(uint32_t v) const {
    while (into_[v] != v) v = into_[v];
    return v;
  }

 private:
  // The first neighbour that may be merged into v.
  bool merge_one(uint32_t v) {
    const float reach = reach_ * mesh_.size(v);
    for (uint32_t k = 0; k < mesh_.valence(v); ++k) {
      const uint32_t w = mesh_.neighbor(v, k);
      const float squared = squared_distance(mesh_.at(v), mesh_.at(w));
      if (stays_[w] != 0 || squared >= reach * reach) continue;
      const Edge e = edge_at(mesh_, v, k);
      if (!can_contract(mesh_, e) || !keeps_shape(e)) continue;
      into_[w] = v;
      delete_edge(mesh_, e, mesh_.at(v));
      return true;
    }
    return false;
  }

  // Whether the faces of e.v, with e.u in its place, neither turn too far nor get too long.
  bool keeps_shape(const Edge& e) const {
    const uint32_t valence = mesh_.valence(e.v);
    uint32_t x = mesh_.neighbor(e.v, valence - 1);
    for (uint32_t k = 0; k < valence; ++k) {
      const uint32_t y = mesh_.neighbor(e.v, k);
      const float longest = kMaxEdge * mesh_.size_between(e.u, y);
      const float squared_edge = squared_distance(mesh_.at(e.u), mesh_.at(y));
      if (y != e.u && squared_edge >= longest * longest) return false;
      if (x != e.u && y != e.u) {
        const Vec3 before = area_vector(mesh_, e.v, x, y), after = area_vector(mesh_, e.u, x, y);
        const float both = dot(before, after);
        constexpr float kSquaredCosine = kFoldCosine * kFoldCosine;
        if (!(both > 0 && both * both > kSquaredCosine * squared(before) * squared(after))) {
          return false;
        }
      }
      x = y;
    }
    return true;
  }

  Mesh& mesh_;
  const Vector<uint8_t>& stays_;
  float reach_;
  Vector<uint32_t> into_;
};

// What was merged into the vertices of faces that meet stays. False where there are none.
bool find_staying(const Mesh& mesh, const Schedule& schedule, const Thinning& thinning,
                  Vector<uint8_t>& stays) {
  const auto meeting = meeting_faces(mesh, schedule);
  if (meeting.empty()) return false;
  Vector<uint8_t> meets(stays.size(), 0);
  for (const auto& face : meeting) {
    for (const uint32_t v : face) meets[v] = 1;
  }
  for (uint32_t v = 0; v < stays.size(); ++v) stays[v] |= meets[thinning.left_of(v)];
  return true;
}

}  // namespace

void thin_out(Mesh& mesh, const Schedule& schedule) {
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.resize(v);
  for (const float part : {kHalfway, 1.0F}) {
    const Mesh before = mesh.copy();
    Vector<uint8_t> stays(mesh.slots(), 0);
    for (int i = 0; i < kTries; ++i) {
      Thinning thinning(mesh, stays, part * kThinReach);
      thinning.run();
      if (!find_staying(mesh, schedule, thinning, stays)) break;
      mesh.take(before.copy());
    }
    mesh.renumber(morton_order(mesh, schedule), schedule);
  }
}

}  // namespace plc

#include "engine/detect/surroundings.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/base/marks.h"
#include "engine/base/parallel_sort.h"
#include "engine/detect/risk.h"
#include "kernels/nearby.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

constexpr size_t kTaskVertices = 128;
// A group is what follows one another in a box whose sides are no longer than this, in delta:
// vertices are numbered along a curve that keeps neighbours together.
constexpr float kGroupBox = 8;
// Nothing is turned so far.
constexpr float kNone = -2;

// A vertex and its neighbours, to be asked for again and again: where in the ring one stands is as
// good as random, and no branch depends on it. Slots past the valence hold the vertex itself.
class ClosedRing {
 public:
  ClosedRing(const Mesh& mesh, uint32_t v) : mesh_(mesh), v_(v), long_(mesh.valence(v) > kCommon) {
    const RingView rings = mesh.rings();
    for (uint32_t k = 0; k < kCommon; ++k) slots_[k] = rings.column(v, k);
  }
  bool contains(uint32_t w) const {
    uint32_t found = static_cast<uint32_t>(w == v_);
    for (uint32_t k = 0; k < kCommon; ++k) found |= static_cast<uint32_t>(slots_[k] == w);
    return found != 0 || (long_ && mesh_.adjacent(v_, w));
  }

 private:
  static constexpr uint32_t kCommon = 8;  // nearly every ring has no more
  const Mesh& mesh_;
  uint32_t v_;
  bool long_;
  uint32_t slots_[kCommon];
};

}  // namespace

void Surroundings::search(const Vector<uint32_t>& due, const SpatialHash& hash,
                          const VertexBytes* risk) {
  risk_ = risk;
  risks_.clear();
  risks_.resize(mesh_.slots());
  gather_near(search(due, hash, Wanted::kNearAndRisk));
  gather_at_risk();
}

void Surroundings::search_folded(const Vector<uint32_t>& folded, const SpatialHash& hash,
                                 const VertexBytes& risk) {
  risk_ = &risk;
  if (folded.empty()) return;
  search(folded, hash, Wanted::kNearAndRisk);
  gather_at_risk();
}

void Surroundings::search_near(const Vector<uint32_t>& all, const SpatialHash& hash) {
  gather_near(search(all, hash, Wanted::kNear));
  at_risk_.clear();
}

size_t Surroundings::search(const Vector<uint32_t>& due, const SpatialHash& hash, Wanted wanted) {
  assert(std::is_sorted(due.begin(), due.end()));
  assert(due.empty() || due.back() < mesh_.slots());
  const float reach = wanted == Wanted::kNear ? kMinApart : kRiskReach;
  if (wanted == Wanted::kNearAndRisk) {
    is_due_.assign(mesh_.slots() / kBits + 1, 0);
    for (const uint32_t v : due) is_due_[v / kBits] |= uint64_t{1} << v % kBits;
  }
  const size_t tasks = block_count(due.size(), kTaskVertices);
  tasks_.resize(std::max(tasks_.size(), tasks));
  run_blocks(executor_, due.size(), kTaskVertices, [&](size_t index, size_t begin, size_t end) {
    Task& task = tasks_[index];
    task.too_near.clear();
    const Spares<Scratch>::Lent lent = scratches_.lend();
    Scratch& scratch = *lent;
    for (size_t i = begin; i < end;) {
      Vec3 low, high;
      float size;
      const size_t count = group_size(due.data() + i, end - i, low, high, size);
      const float far = mesh_.far_reach(reach, size);
      const Vec3 span{far, far, far};
      hash.collect(mesh_, low - span, high + span, scratch.around);
      search_group(due.data() + i, count, wanted, scratch, task);
      i += count;
    }
  });
  return tasks;
}

void Surroundings::gather_at_risk() {
  at_risk_.clear();
  visit_marks(risks_.data(), mesh_.slots(), [&](uint32_t v) { at_risk_.push_back(v); });
}

void Surroundings::gather_near(size_t tasks) {
  too_near_.clear();
  for (size_t index = 0; index < tasks; ++index) {
    const Vector<VertexPair>& found = tasks_[index].too_near;
    too_near_.insert(too_near_.end(), found.begin(), found.end());
  }
  parallel_sort(too_near_, executor_);
  too_near_.erase(std::unique(too_near_.begin(), too_near_.end()), too_near_.end());
}

// How many of the vertices make a group, its box and the largest of their sizes.
size_t Surroundings::group_size(const uint32_t* due, size_t count, Vec3& low, Vec3& high,
                                float& largest) const {
  const float longest = kGroupBox * mesh_.size(due[0]);
  largest = mesh_.size(due[0]);
  low = high = mesh_.at(due[0]);
  size_t size = 1;
  for (; size < count; ++size) {
    const Vec3 p = mesh_.at(due[size]);
    const Vec3 l{std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    const Vec3 h{std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    const Vec3 extent = h - l;
    if (std::max(std::max(extent.x, extent.y), extent.z) > longest) break;
    low = l;
    high = h;
    largest = std::max(largest, mesh_.size(due[size]));
  }
  return size;
}

// Against which other vertices are turned or not. Where the surface folds, the vertex's own normal
// does not tell of the faces that are turned over: without one all that is near counts as turned,
// as the cosine of 0 is below kRiskDot.
Vec3 Surroundings::sheet_normal(uint32_t v) const {
  return risk_ != nullptr && ((*risk_)[v] & kFoldRisk) != 0 ? Vec3{} : mesh_.normal.at(v);
}

// The places of what is around, and the normals where they are wanted.
void Surroundings::fetch(Wanted wanted, Scratch& scratch) const {
  const size_t count = scratch.around.ids.size();
  const size_t padded = block_count(count, kRingLanes) * kRingLanes;
  for (auto& stream : scratch.streams) stream.resize(std::max(stream.size(), padded));
  scratch.hits.resize(std::max(scratch.hits.size(), count));
  auto& [x, y, z, nx, ny, nz] = scratch.streams;
  for (size_t i = 0; i < count; ++i) {
    const Float4& p = mesh_.position[scratch.around.ids[i]];
    x[i] = p.x, y[i] = p.y, z[i] = p.z;
  }
  if (wanted == Wanted::kNear) return;
  for (size_t i = 0; i < count; ++i) {
    const Vec3 n = sheet_normal(scratch.around.ids[i]);
    nx[i] = n.x, ny[i] = n.y, nz[i] = n.z;
  }
}

void Surroundings::search_group(const uint32_t* due, size_t count, Wanted wanted, Scratch& scratch,
                                Task& task) {
  fetch(wanted, scratch);
  const auto around = static_cast<uint32_t>(scratch.around.ids.size());
  const auto& [x, y, z, nx, ny, nz] = scratch.streams;
  const bool near_only = wanted == Wanted::kNear;
  // With no normal to compare with nothing is turned, whatever is in the streams.
  const kernels::NearbyView view =
      near_only
          ? kernels::NearbyView{x.data(), y.data(), z.data(), x.data(), y.data(), z.data(), around}
          : kernels::NearbyView{x.data(),  y.data(),  z.data(), nx.data(),
                                ny.data(), nz.data(), around};
  for (size_t i = 0; i < count; ++i) {
    const float near = mesh_.far_reach(kMinApart, mesh_.size(due[i]));
    const float far = near_only ? near : mesh_.far_reach(kRiskReach, mesh_.size(due[i]));
    const Vec3 p = mesh_.at(due[i]);
    const Vec3 n = near_only ? Vec3{} : sheet_normal(due[i]);
    const uint32_t hits = kernels::near_or_turned(
        executor_.simd(), view,
        {p.x, p.y, p.z, n.x, n.y, n.z, near * near, far * far, near_only ? kNone : kRiskDot},
        scratch.hits.data());
    if (near_only) {
      list_near(due[i], hits, scratch, task);
    } else {
      judge(due[i], hits, scratch, task);
    }
  }
}

bool Surroundings::too_near(uint32_t v, uint32_t w) const {
  const float near = kMinApart * mesh_.size_between(v, w);
  return squared_distance(mesh_.at(v), mesh_.at(w)) < near * near;
}

// The pairs in which v has the smaller id; the other one sees the others.
void Surroundings::list_near(uint32_t v, uint32_t hits, const Scratch& scratch, Task& task) const {
  const size_t most = task.too_near.size() + kMostNear;
  for (uint32_t k = 0; k < hits && task.too_near.size() < most; ++k) {
    const uint32_t w = scratch.around.ids[scratch.hits[k]];
    if (w > v && mesh_.alive(w) && too_near(v, w) && !mesh_.adjacent(v, w))
      task.too_near.push_back({v, w});
  }
}

void Surroundings::judge(uint32_t v, uint32_t hits, Scratch& scratch, Task& task) {
  const Vec3 p = mesh_.at(v), n = sheet_normal(v);
  const ClosedRing ring(mesh_, v);
  scratch.turned.clear();
  const size_t most = task.too_near.size() + kMostNear;
  for (uint32_t k = 0; k < hits; ++k) {
    const uint32_t w = scratch.around.ids[scratch.hits[k]];
    if (ring.contains(w) || !mesh_.alive(w)) continue;
    if (too_near(v, w) && task.too_near.size() < most) {
      task.too_near.push_back({std::min(v, w), std::max(v, w)});
    }
    if (w < v && is_due(w)) continue;  // w has looked at v
    const float far = kRiskReach * mesh_.stretch * std::max(mesh_.size(v), mesh_.size(w));
    if (dot(n, sheet_normal(w)) <= kRiskDot && squared_distance(p, mesh_.at(w)) <= far * far)
      scratch.turned.push_back(w);
  }
  if (!scratch.turned.empty()) mark_risk(v, scratch.turned);
}

// Of two that are known to be at risk nothing is to be found: which tasks have come before makes no
// difference to the marks.
void Surroundings::mark_risk(uint32_t v, const Vector<uint32_t>& turned) {
  const bool large = mesh_.valence(v) > kRiskRing;
  std::optional<Risk> risk;
  bool marked = read_mark(risks_[v]) != 0;
  for (const uint32_t w : turned) {
    if (marked && read_mark(risks_[w]) != 0) continue;
    if (!large && !risk) risk.emplace(mesh_, v);
    if (!large && !risk->may_meet(w)) continue;
    set_mark(risks_[v], 1);
    set_mark(risks_[w], 1);
    marked = true;
  }
}

}  // namespace plc

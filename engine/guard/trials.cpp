#include "engine/guard/trials.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

constexpr size_t kTaskTrials = 4;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr Box3 kNothing{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

void include(Box3& box, Vec3 p) {
  const float at[3] = {p.x, p.y, p.z};
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::min(box.low[k], at[k]);
    box.high[k] = std::max(box.high[k], at[k]);
  }
}

void include(Box3& box, const Box3& other) {
  include(box, Vec3{other.low[0], other.low[1], other.low[2]});
  include(box, Vec3{other.high[0], other.high[1], other.high[2]});
}

Proposal propose(const Mesh& mesh, const Candidate& c, uint32_t place) {
  if (c.operation == Operation::kCreation) return propose_creation(mesh, c.edge);
  if (c.operation == Operation::kInversion) return propose_inversion(mesh, c.edge);
  if (c.operation == Operation::kAnnular) {
    return propose_annular(mesh, c.cycle(), annular_copies(mesh, c.cycle(), kAnnularRetreat));
  }
  return propose_deletion(mesh, c.edge, Trials::deletion_place(mesh, c.edge, place));
}

}  // namespace

Vec3 Trials::deletion_place(const Mesh& mesh, const Edge& e, uint32_t place) {
  if (place == 0) return midpoint(mesh.at(e.u), mesh.at(e.v));
  return mesh.at(place == 1 ? e.u : e.v);
}

bool Trials::can_try(const Mesh& mesh, const Candidate& c) {
  if (c.operation == Operation::kAxial) return false;
  // Where an apex has valence 3 a tetrahedron is deleted, and not an edge.
  return c.operation != Operation::kDeletion ||
         (mesh.valence(c.edge.a) > 3 && mesh.valence(c.edge.b) > 3);
}

uint32_t Trials::first_admitted(const Candidate& c, EmbeddingGuard& guard, Box3* tried) const {
  const uint32_t places = c.operation == Operation::kDeletion ? kPlaces : 1;
  for (uint32_t place = 0; place < places; ++place) {
    const bool admitted = guard.embeds(mesh_, hash_, propose(mesh_, c, place));
    if (tried != nullptr) include(*tried, guard.box());
    if (admitted) return place;
  }
  return kRefused;
}

void Trials::run(const Vector<const Candidate*>& candidates) {
  boxes_.clear();
  centres_.clear();
  first_centre_.assign(1, 0);
  trials_.resize(candidates.size());
  guards_.resize(std::max(guards_.size(), block_count(candidates.size(), kTaskTrials)));
  run_blocks(executor_, candidates.size(), kTaskTrials, [&](size_t task, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      trials_[i].box = kNothing;
      trials_[i].admitted = first_admitted(*candidates[i], guards_[task], &trials_[i].box);
    }
  });
}

uint32_t Trials::admitted(const Candidate& c, size_t trial) {
  if (trial == kUntried) return first_admitted(c, guard_, nullptr);
  const Trial& t = trials_[trial];
  if (!find_overlapping(t.box)) return t.admitted;
  if (t.admitted == 0 && guard_.embeds_beside(mesh_, propose(mesh_, c, 0), around_)) return 0;
  return first_admitted(c, guard_, nullptr);
}

// Fills around_ with the centres of the operations that have been applied within the box. False
// where there is none.
bool Trials::find_overlapping(const Box3& box) {
  around_.clear();
  bool found = false;
  for (size_t i = 0; i < boxes_.size(); ++i) {
    for (uint32_t hits = boxes_[i].overlapping(box); hits != 0; hits &= hits - 1) {
      const size_t operation = i * BoxLanes::kLanes + static_cast<uint32_t>(std::countr_zero(hits));
      around_.insert(around_.end(), centres_.data() + first_centre_[operation],
                     centres_.data() + first_centre_[operation + 1]);
      found = true;
    }
  }
  return found;
}

void Trials::begin(const Vector<uint32_t>& footprint) {
  box_ = kNothing;
  for (const uint32_t v : footprint) include(box_, mesh_.at(v));
}

void Trials::changed(uint32_t v) {
  include(box_, mesh_.at(v));
  centres_.push_back(v);
}

void Trials::end() {
  const auto index = static_cast<uint32_t>(first_centre_.size() - 1);
  const uint32_t lane = index % BoxLanes::kLanes;
  if (lane == 0) {
    boxes_.emplace_back();
    for (uint32_t k = 0; k < BoxLanes::kLanes; ++k) boxes_.back().set(k, kNothing);
  }
  boxes_.back().set(lane, box_);
  first_centre_.push_back(static_cast<uint32_t>(centres_.size()));
}

}  // namespace plc

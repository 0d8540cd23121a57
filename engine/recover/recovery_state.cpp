// A recovery between two iterations as bytes and back.
#include <limits>
#include <type_traits>

#include "engine/guard/self_meeting.h"
#include "engine/recover/recovery.h"

namespace plc {

namespace {

// visit(field) for every field, in this order.
template <typename Record, typename Visit>
void visit_record(Record& r, const Visit& visit) {
  visit(r.level);
  visit(r.delta);
  visit(r.iterations);
  visit(r.vertices);
  visit(r.converged);
  visit(r.energy);
  visit(r.speed);
  for (auto* x : {&r.seconds.topology, &r.seconds.normals, &r.seconds.dynamics, &r.seconds.total}) {
    visit(*x);
  }
  auto& o = r.operations;
  for (auto* n : {&o.creation, &o.inversion, &o.deletion, &o.annular, &o.axial, &o.tetrahedron,
                  &o.refinement, &o.deferred, &o.refused, &o.reverted, &o.moves, &o.checks}) {
    visit(*n);
  }
  visit(r.late.bubbles);
  visit(r.late.cavities);
  visit(r.late.volume);
  visit(r.frozen_sites);
  visit(r.frozen_vertices);
}

template <typename Round, typename Visit>
void visit_round(Round& r, const Visit& visit) {
  for (auto* n : {&r.number, &r.iteration, &r.calm, &r.confirmation.since,
                  &r.confirmation.not_before, &r.repairs}) {
    visit(*n);
  }
  visit(r.late);
  visit(r.searched_early);
  visit(r.searched);
  visit(r.settled);
  visit(r.most_vertices);
}

template <typename Progress, typename Visit>
void visit_progress(Progress& p, const Visit& visit) {
  for (auto* n : {&p.level, &p.levels, &p.iteration}) visit(*n);
  visit(p.vertices);
  for (auto* x : {&p.energy, &p.speed, &p.fraction}) visit(*x);
}

}  // namespace

void Recovery::save(StateWriter& to) const {
  const auto add = [&](const auto& value) { to.add(value); };
  add(level_);
  add(entered_);
  add(phase_);
  add(done_);
  add(energy_);
  visit_round(round_, add);
  add(late_iterations_);
  visit_progress(progress_, add);
  ProgressEstimate::visit_fields(estimate_, add);
  add(static_cast<uint32_t>(records_.size()));
  for (const LevelRecord& r : records_) visit_record(r, add);
  for (const VoxelSet* voxels : {&tried_, &folds_}) {
    add(voxels->has_image());
    if (voxels->has_image()) voxels->save(to);
  }
  mesh_.save(to);
  evolution_.save(to);
}

Status Recovery::restore(StateReader& from) {
  if (!read(from) || !from.at_end()) return {ErrorCode::kInvalidData, "state: altered"};
  if (phase_ == Phase::kStart) return {};
  if (Status s = build_gradient_image(); !s.ok()) return s;
  return build_sizing();
}

bool Recovery::read(StateReader& from) {
  // Every whole number counts something: none is negative, or so large that counting on overflows.
  const auto number = [&](auto& value) {
    from.read(value);
    using T = std::remove_reference_t<decltype(value)>;
    if constexpr (std::is_integral_v<T> && std::is_signed_v<T>) {
      from.demand(value >= 0 && value <= std::numeric_limits<T>::max() / 2);
    }
  };
  number(level_);
  number(entered_);
  from.read(phase_, Phase::kVerdict);
  number(done_);
  number(energy_);
  visit_round(round_, number);
  number(late_iterations_);
  visit_progress(progress_, number);
  ProgressEstimate::visit_fields(estimate_, number);
  uint32_t records = 0;
  number(records);
  // Between two levels the next one has no record yet.
  const int next = phase_ == Phase::kStart && !done_ ? 1 : 0;
  from.demand(level_ >= 0 && level_ <= levels_ && entered_ == level_ + next &&
              static_cast<int64_t>(records) == levels_ - level_ + 1 - next && records >= 1);
  if (!from.ok()) return false;
  records_.resize(records);
  for (LevelRecord& r : records_) {
    visit_record(r, number);
    from.demand(r.level == levels_ - static_cast<int>(&r - records_.data()));
  }
  mesh_.clear();
  enter(entered_);
  if (!read_set(from, tried_) || !read_set(from, folds_) || !mesh_.restore(from)) return false;
  if (mesh_.vertex_count() != 0 && mesh_.delta != delta_of(entered_)) return false;
  if ((done_ || phase_ == Phase::kVerdict) && !mesh_.in_order()) return false;
  evolution_.restore(from);
  if (!from.ok()) return false;
  if (!meeting_faces(mesh_, schedule_).empty()) return false;
  if (Obstacles::Meeting meeting; obstacles_ && obstacles_->find_meeting(mesh_, meeting)) {
    return false;
  }
  return spec_.sizes || mesh_.uniform();
}

bool Recovery::read_set(StateReader& from, VoxelSet& voxels) const {
  bool has_image = false;
  from.read(has_image);
  voxels = has_image ? VoxelSet(guide_.image.dims) : VoxelSet();
  if (has_image) voxels.restore(from);
  return from.ok();
}

}  // namespace plc

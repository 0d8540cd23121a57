// What of the object the surface has missed, and what it holds that is too little of it.
#include <array>
#include <optional>

#include "engine/base/constants.h"
#include "engine/recover/recovery.h"
#include "engine/start/crumbs.h"
#include "engine/start/folds.h"

namespace plc {

// Whether missed places are still to be searched for in this round. On a coarse level they are not:
// what it has missed is searched for when the next finer one starts.
bool Recovery::searched_again() const {
  return level_ == 0 && !round_.searched && round_.number < kLateRounds &&
         late_iterations_ < spec_.max_iterations;
}

// ... and, of an adaptive mesh, before it has come to rest.
bool Recovery::is_due_early() const {
  return mesh_.sizing != nullptr && searched_again() && round_.number == 0 &&
         !round_.searched_early && round_.iteration >= kEarlySearch && near_rest() &&
         !evolution_.travelling();
}

bool Recovery::near_rest() const {
  return energy_ <= kLateEnergy * spec_.epsilon;
}

// Where something was added, another round begins. Of an adaptive mesh at rest all sleeps then but
// what has been added, and what that wakes.
Status Recovery::search(bool& added) {
  const bool settled = mesh_.sizing != nullptr && round_.calm >= kCalmIterations;
  if (settled) evolution_.settle();
  Status s = add_late_bubbles(added);
  if (s.ok() && added) {
    start_round(round_.number + 1, true);
    round_.settled = settled;
  }
  return s;
}

// Starts bubbles in what the surface has missed, and makes an adaptive mesh fine where they are and
// where it is folded; `added` becomes whether there was anything.
Status Recovery::add_late_bubbles(bool& added) {
  added = false;
  const bool at_rest = mesh_.vertex_count() == 0 || near_rest();
  const std::optional<float> iso = iso_of(level_);
  if (!spec_.late_bubbles || !iso || !at_rest) return {};
  const double start = now();
  const uint32_t before = mesh_.vertex_count();
  LateBubbles late;
  const ImageObject object{guide_.image, *iso, spec_.inside_above};
  const MissedPlaces places = find_late_places(mesh_, object, schedule_, tried_, voxel_room());
  const bool adaptive = mesh_.sizing != nullptr;
  const bool folded = adaptive && find_folds(mesh_, folds_);
  const bool lowered = folded || (adaptive && places.count != std::array<int64_t, 2>{0, 0});
  if (lowered) lower_sizes();
  if (Status s = start_late_bubbles(object, places, schedule_, mesh_, late, record().operations);
      !s.ok()) {
    return s;
  }
  evolution_.notify("late bubbles");
  const auto& mm = user_.millimetres;
  record().late.bubbles += late.bubbles;
  record().late.cavities += late.cavities;
  record().late.volume += late.volume * static_cast<double>(mm[0]) * static_cast<double>(mm[1]) *
                          static_cast<double>(mm[2]);
  added = folded || mesh_.vertex_count() != before;
  if (added) {
    if (lowered) resize_all();
    renumber();
    evolution_.restart();
  }
  record().seconds.topology += now() - start;
  record().seconds.total += now() - start;
  return {};
}

// Of an adaptive mesh on the full image. What starts where the user says, as patches do, is what
// the user wants.
void Recovery::delete_crumbs() {
  const Init init = spec_.start.init;
  const bool is_asked_for = init == Init::kSeeds || init == Init::kMask || init == Init::kMesh;
  const std::optional<float> iso = iso_of(level_);
  if (mesh_.sizing == nullptr || level_ != 0 || !iso || is_asked_for) return;
  plc::delete_crumbs(mesh_, {guide_.image, *iso, spec_.inside_above});
}

}  // namespace plc

#include "engine/recover/recovery.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/constants.h"
#include "engine/mesh/face_rings.h"
#include "engine/recover/cost.h"
#include "engine/recover/frozen_sites.h"
#include "engine/resolve/refinement.h"
#include "engine/start/folds.h"

namespace plc {

namespace {

EvolutionOptions evolution_options(const RecoverySpec& spec, int levels) {
  EvolutionOptions options;
  // The speed along the normal that every vertex would have at the energy epsilon.
  const bool complies = spec.sizes && !spec.isos.empty() && spec.user.attachments.empty();
  const Model model = complies ? complying(spec.model) : spec.model;
  const double speed = std::sqrt(2 * spec.epsilon / static_cast<double>(model.mass)) *
                       static_cast<double>(stable_time_step(model));
  if (spec.sleeping) options.speeds.calm = static_cast<float>(kCalmSpeed * speed);
  options.speeds.turn = static_cast<float>(kTurnSpeed * speed);
  if (spec.sizes && spec.start.init == Init::kIso && levels == 0) {
    constexpr double kLeast = 1e-30;  // its square is something in double precision
    options.counted = static_cast<float>(std::max(std::sqrt(kMostEnergy) * speed, kLeast));
  }
  options.slow_vertices = spec.slow_vertices;
  return options;
}

}  // namespace

Recovery::Recovery(Pyramid pyramid, RecoverySpec spec, const Schedule& schedule,
                   RecoveryHooks hooks, Mesh& mesh, std::vector<LevelRecord>& records)
    : pyramid_(std::move(pyramid)),
      spec_(std::move(spec)),
      schedule_(schedule),
      hooks_(std::move(hooks)),
      mesh_(mesh),
      records_(records),
      levels_(static_cast<int>(pyramid_.levels.size()) - 1),
      evolution_(mesh, schedule, spec_.model, evolution_options(spec_, levels_)),
      level_(levels_) {
  evolution_.set_observer(hooks_.pass);
}

Status Recovery::start() {
  while (!done_ && phase_ == Phase::kStart) {
    if (Status s = start_level(); !s.ok()) return s;
  }
  return {};
}

Status Recovery::advance(Amount amount) {
  // Goes on until the next iteration or level would begin: the checks at the end of one belong to
  // it.
  for (bool moved = false; !done_;) {
    if (moved && phase_ == Phase::kStart && amount != Amount::kAll) return {};
    if (moved && phase_ == Phase::kIterate && amount == Amount::kIteration) return {};
    moved = moved || phase_ == Phase::kIterate;
    if (Status s = step(); !s.ok()) return s;
  }
  return {};
}

Status Recovery::step() {
  switch (phase_) {
    case Phase::kStart:
      return start_level();
    case Phase::kIterate:
      return iterate();
    case Phase::kSearch: {
      phase_ = Phase::kIterate;
      bool& searched = is_due_early() ? round_.searched_early : round_.searched;
      searched = true;
      bool added = false;
      return search(added);
    }
    case Phase::kCheck:
      check();
      return {};
    case Phase::kVerify:
      return verify();
    case Phase::kRoundEnd:
      return end_round();
    case Phase::kVerdict:
      return ask_verdict();
  }
  return {ErrorCode::kInternal, "recovery: no such phase"};
}

void Recovery::renumber() {
  mesh_.renumber(spec_.renumbering ? morton_order(mesh_, schedule_) : living_order(mesh_),
                 schedule_);
  evolution_.notify("ids");
}

// U_h in mesh units.
double Recovery::unit_of(int h) const {
  return image_of(h).unit / pyramid_.levels[0].unit;
}

// A level on which the object does not show, or cannot hold the surface, is passed over: the
// surface then starts on the next finer one.
Status Recovery::start_level() {
  records_.emplace_back();
  record().level = level_;
  enter(level_);
  tried_ = VoxelSet();
  folds_ = VoxelSet();
  const bool fresh = mesh_.vertex_count() == 0;
  if (fresh) {
    // What conforms goes by the sizes; those of a patch depend on what it holds.
    mesh_.delta = delta_of(level_);
    if (!spec_.start.patch) {
      if (Status s = build_sizing(); !s.ok()) return s;
    }
    const LevelImage level{pyramid_, level_,         spec_.pad_voxels,
                           space_,   iso_of(level_), spec_.inside_above};
    StartHooks hooks;
    hooks.go_on = [this, parts = 0]() mutable {
      if (levels_ == 0) progress_.fraction = ProgressEstimate::at_start(++parts);
      return !hooks_.progress || hooks_.progress({level_, levels_, 0, 0, 0, 0, progress_.fraction});
    };
    hooks.before_thinning = [this](const HalfEdges& surface, const Buffer<float>& xyz) {
      if (find_folds(mesh_, surface, xyz, schedule_, folds_)) lower_sizes();
    };
    if (Status s = start_surface(spec_.start, level, delta_of(level_), schedule_, mesh_,
                                 record().operations, hooks);
        !s.ok()) {
      // So that it can be started again.
      mesh_.clear();
      records_.pop_back();
      return s;
    }
    evolution_.notify("start");
  }
  bool added = false;
  if (mesh_.vertex_count() == 0 && mesh_.sizing != nullptr && level_ == 0 &&
      spec_.start.init == Init::kIso) {
    // Of an iso-surface that is thinner than its edges nothing may be left once it conforms.
    if (Status s = add_late_bubbles(added); !s.ok()) return s;
  }
  if (mesh_.vertex_count() == 0 && !mesh_.is_patch()) return leave_level();
  estimate_.start_level();
  if (fresh) estimate_.add_start(record().operations, mesh_.vertex_count());
  if (Status s = adapt(fresh && spec_.start.conforms()); !s.ok()) return s;
  if (Status s = build_gradient_image(); !s.ok()) return s;
  if (!fresh || mesh_.is_patch()) {
    if (Status s = add_late_bubbles(added); !s.ok()) return s;
  }
  // Other starts are near what they approach. What is frozen halfway on a coarse level goes on with
  // the next one.
  const bool from_bubbles = fresh && !spec_.start.conforms();
  evolution_.travel(from_bubbles && level_ == 0 ? iterations_across() : 0);
  late_iterations_ = 0;
  start_round(0, false);
  return {};
}

// Figure 12, first loop: refine until the density fits the image. With rho = sqrt 3 that is one
// refinement per level; for other factors delta is set to fit afterwards, and creations and
// deletions do the rest.
Status Recovery::adapt(bool conformed) {
  const double start = now();
  const double target = delta_of(level_);
  // What of a patch is of the level above was refined when the patch was made (patch.h).
  const int steps = mesh_.is_patch() ? 0 : refinements_between(mesh_.delta, target);
  for (int i = 0; i < steps; ++i) {
    if (uint64_t{mesh_.vertex_count()} * 3 > mesh_.most_vertices) return too_many_vertices();
    refine(mesh_, schedule_, spec_.renumbering);
    ++record().operations.refinement;
  }
  mesh_.delta = target;
  if (mesh_.sizing == nullptr) {
    if (Status s = build_sizing(); !s.ok()) return s;
  }
  for (uint32_t v = 0; v < mesh_.slots(); ++v) {
    mesh_.resize(v);
    mesh_.wake(v);
    mesh_.turns[v] = 0;
  }
  evolution_.restart();
  evolution_.notify("refinement");
  if (mesh_.is_patch() || (mesh_.sizing != nullptr && !conformed)) {
    // Before anything moves, the edges are brought to the sizes of this level.
    measure_edges(mesh_);
    evolution_.check_all(record().seconds, record().operations);
    if (mesh_.is_patch()) {
      measure_edges(mesh_);  // those of what is held are as they were
    } else {
      mesh_.stretch = kSizedStretch;
      mesh_.longest_edge = mesh_.longest_sized_edge();
    }
    renumber();
    evolution_.restart();
  }
  record().delta = target;
  record().seconds.topology += now() - start;
  record().seconds.total += now() - start;
  return {};
}

void Recovery::start_round(int number, bool late) {
  round_ = {};
  round_.number = number;
  round_.late = late;
  estimate_.start_round();
  double room = most_vertices(pyramid_, level_, spec_.pad_voxels, spec_.scale);
  // most_vertices() is for edges of delta; the finest sizes have more vertices to the same area.
  if (spec_.sizes) room *= std::max(1.0, 1 / (spec_.sizes->finest * spec_.sizes->finest));
  // A surface that starts outside of the image may have more.
  round_.most_vertices = std::max(static_cast<int64_t>(std::min(room, 1.0 * mesh_.most_vertices)),
                                  int64_t{2} * mesh_.vertex_count());
  record().converged = false;
  phase_ = Phase::kIterate;
}

int Recovery::iterations_left() const {
  return spec_.max_iterations - (round_.late ? late_iterations_ : round_.iteration);
}

// How many iterations a vertex takes through the image, from corner to corner.
int Recovery::iterations_across() const {
  double squared = 0;
  for (size_t a = 0; a < 3; ++a) {
    const double side = static_cast<double>(pyramid_.levels[0].dims[a]) * space_.step[a];
    squared += side * side;
  }
  const double move = static_cast<double>(spec_.model.max_move) * mesh_.delta;
  return static_cast<int>(std::min(std::sqrt(squared) / move, 1e9));
}

Status Recovery::iterate() {
  if (mesh_.vertex_count() == 0) {
    phase_ = Phase::kRoundEnd;
    return {};
  }
  LevelRecord& r = record();
  if (Status s = evolution_.iterate(guide_, r.seconds, r.operations); !s.ok()) return s;
  ++r.iterations;
  ++round_.iteration;
  if (round_.late) ++late_iterations_;
  if (Status s = check_growth(); !s.ok()) return s;
  r.energy = energy_ = evolution_.energy();
  r.speed = evolution_.speed();
  const bool slow = spec_.calm_speed == 0 || r.speed < spec_.calm_speed;
  round_.calm = r.energy < spec_.epsilon && slow ? round_.calm + 1 : 0;
  r.converged = confirmed(round_.calm);
  estimate_progress();
  renumber_if_scattered();
  if (is_due_early()) phase_ = Phase::kSearch;
  if (r.converged || iterations_left() == 0) phase_ = Phase::kCheck;
  return report_progress();
}

Status Recovery::check_growth() const {
  if (mesh_.vertex_count() <= round_.most_vertices) return {};
  return {ErrorCode::kInvalidData,
          "level " + std::to_string(level_) + ": the surface has grown to " +
              std::to_string(mesh_.vertex_count()) + " vertices, the image has room for " +
              std::to_string(round_.most_vertices) + ": its forces drive it on without end"};
}

Status Recovery::report_progress() const {
  if (hooks_.progress && !hooks_.progress(progress_)) return {ErrorCode::kCancelled, "cancelled"};
  return {};
}

void Recovery::count_frozen() {
  const auto sites = frozen_sites(mesh_);
  record().frozen_sites = static_cast<int64_t>(sites.size());
  record().frozen_vertices = 0;
  for (const FrozenSite& site : sites) record().frozen_vertices += site.vertices;
}

void Recovery::check() {
  evolution_.check_all(record().seconds, record().operations);
  delete_crumbs();
  record().vertices = mesh_.vertex_count();
  // The search for faces that meet takes twice as long where a twentieth of the vertices have ids
  // far from those of their neighbours.
  renumber();
  evolution_.restart();
  phase_ = Phase::kVerify;
}

// The guards keep the surface from meeting itself. Every level ends with a test that they did;
// where they did not, the run fails with a message that says so, unless further iterations repair
// it.
Status Recovery::verify() {
  constexpr int kRepairs = 50;
  if (evolution_.embedded()) {
    Obstacles::Meeting meeting;
    if (obstacles_ && obstacles_->find_meeting(mesh_, meeting)) {
      return {ErrorCode::kInternal, "the surface meets an obstacle"};
    }
    phase_ = Phase::kRoundEnd;
    return {};
  }
  if (round_.repairs == kRepairs) {
    return {ErrorCode::kInternal, "level " + std::to_string(level_) +
                                      ": the surface meets itself and could not be parted"};
  }
  if (Status s = evolution_.iterate(guide_, record().seconds, record().operations); !s.ok()) {
    return s;
  }
  ++round_.repairs;
  return report_progress();
}

Status Recovery::end_round() {
  if (searched_again()) {
    bool added = false;
    if (Status s = search(added); !s.ok() || added) return s;
  }
  if (mesh_.vertex_count() == 0) return leave_level();
  if (!mesh_.in_order()) {  // repairs have made or deleted vertices
    renumber();
    evolution_.restart();
  }
  count_frozen();
  phase_ = Phase::kVerdict;
  return {};
}

Status Recovery::ask_verdict() {
  const LevelVerdict verdict = hooks_.level ? hooks_.level(record()) : LevelVerdict::kAccept;
  if (verdict == LevelVerdict::kCancel) return {ErrorCode::kCancelled, "cancelled"};
  if (verdict == LevelVerdict::kMore) {
    start_round(round_.number + 1, false);
    return {};
  }
  done_ = verdict == LevelVerdict::kStop;
  return leave_level();
}

Status Recovery::leave_level() {
  if (hooks_.left) hooks_.left(record());
  pyramid_.levels[static_cast<size_t>(level_)].release();
  done_ = done_ || level_ == 0 || mesh_.is_patch();
  if (level_ == 0 && mesh_.vertex_count() == 0 && !mesh_.is_patch()) {
    return {ErrorCode::kInvalidData,
            "no surface: nothing in the image holds one at this iso-value; check the iso-value, or "
            "use weaker internal forces"};
  }
  if (done_) {
    mesh_.sizing = nullptr;
    mesh_.obstacles = nullptr;
  }
  phase_ = Phase::kStart;
  if (done_) {
    progress_.fraction = 1;
    progress_.vertices = mesh_.vertex_count();
    if (!mesh_.in_order()) renumber();
  } else {
    --level_;
  }
  return {};
}

// Whether the level has converged. `calm` is for how many iterations in a row it has been calm;
// every vertex must have been awake in the last kConfirmIterations of them, but in a settled round.
bool Recovery::confirmed(int calm) {
  Confirmation& c = round_.confirmation;
  const int iteration = round_.iteration;
  if (c.since != 0 && calm < iteration - c.since) {
    c = {0, iteration + kConfirmPause};
  }
  if (calm < kCalmIterations) return false;
  if (round_.settled) return iteration >= kMinSettledIterations;
  const int least = mesh_.sizing != nullptr && round_.late ? kMinLateIterations : kMinIterations;
  if (c.since != 0) {
    return iteration >= least && iteration - c.since >= kConfirmIterations;
  }
  const bool soon = iteration >= std::max(c.not_before, least - kConfirmIterations);
  if (soon && mesh_.sizing != nullptr && searched_again()) {
    phase_ = Phase::kSearch;
    return false;
  }
  if (!evolution_.any_asleep()) return iteration >= least;
  if (!soon) return false;
  evolution_.wake_all();
  c.since = iteration;
  return false;
}

// Gives new ids when a sixteenth of all vertices have been created since the last time: to read a
// neighbour that is far away in memory takes three times as long, and the boxes around vertices of
// successive ids grow.
void Recovery::renumber_if_scattered() {
  if (!spec_.renumbering || mesh_.created() <= mesh_.vertex_count() / 16) return;
  renumber();
  evolution_.restart();
}

void Recovery::estimate_progress() {
  const LevelRecord& r = record();
  ProgressEstimate::Ahead ahead;
  ahead.iterations = iterations_left();
  ahead.vertices = mesh_.vertex_count();
  ahead.finer_levels = level_;
  ahead.late = round_.late;
  ahead.calm = r.converged;
  ahead.sized = mesh_.sizing != nullptr;
  // The last level is expected to get late bubbles if an earlier one has had some; an adaptive mesh
  // is folded somewhere.
  const bool late = std::any_of(records_.begin(), records_.end(), [](const LevelRecord& l) {
    return l.late.bubbles + l.late.cavities > 0;
  });
  ahead.again = spec_.late_bubbles && (late || ahead.sized) && !round_.late;
  const double done = estimate_.add(r.operations, r.energy / spec_.epsilon, ahead);
  progress_ = {level_,   levels_, static_cast<int>(r.iterations),    mesh_.vertex_count(),
               r.energy, r.speed, std::max(progress_.fraction, done)};
}

Status pyramidal_recover_shape(Pyramid pyramid, const RecoverySpec& spec, const Schedule& schedule,
                               const RecoveryHooks& hooks, Mesh& mesh,
                               std::vector<LevelRecord>& records) {
  Recovery recovery(std::move(pyramid), spec, schedule, hooks, mesh, records);
  if (Status s = recovery.start(); !s.ok()) return s;
  return recovery.advance(Amount::kAll);
}

}  // namespace plc

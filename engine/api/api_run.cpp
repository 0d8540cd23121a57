#include "engine/api/api_run.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "engine/api/api_extras.h"
#include "engine/api/api_force.h"
#include "engine/api/api_surface.h"
#include "engine/api/fingerprint.h"
#include "engine/api/parameters.h"
#include "engine/mesh/face_rings.h"
#include "engine/recover/cost.h"
#include "engine/resolve/refinement.h"
#include "pyramid/check_volume.h"
#include "pyramid/mask.h"

namespace plc {

namespace {

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

// What a pyramid reads of the parameters.
bool same_pyramid(const plc_parameters& a, const plc_parameters& b) {
  return same(a.iso, b.iso) && a.inside_below == b.inside_below &&
         a.level_iso_count == b.level_iso_count &&
         std::equal(a.level_iso, a.level_iso + a.level_iso_count, b.level_iso) &&
         same(a.window_low, b.window_low) && same(a.window_high, b.window_high) &&
         same(a.pad_value, b.pad_value) && a.feature == b.feature &&
         a.feature_sigma == b.feature_sigma && a.levels == b.levels && a.reduction == b.reduction;
}

void take_pyramid(const plc_parameters& from, plc_parameters& to) {
  to.iso = from.iso;
  to.inside_below = from.inside_below;
  to.level_iso_count = from.level_iso_count;
  std::copy_n(from.level_iso, PLC_MAX_LEVELS, to.level_iso);
  to.window_low = from.window_low;
  to.window_high = from.window_high;
  to.pad_value = from.pad_value;
  to.feature = from.feature;
  to.feature_sigma = from.feature_sigma;
  to.levels = from.levels;
  to.reduction = from.reduction;
}

}  // namespace

Status Run::prepare(std::shared_ptr<const PyramidData> pyramid, Pyramid images, Lasting lasting,
                    const plc_parameters& parameters, const plc_extras& extras) {
  const double start = now();
  pyramid_ = std::move(pyramid);
  surface_ = std::make_unique<plc_surface>();
  surface_->host = host_;
  surface_->parameters = parameters;
  plc_parameters& p = surface_->parameters;
  take_pyramid(pyramid_->parameters, p);
  surface_->frame = pyramid_->volume->frame;
  surface_->range = pyramid_->range;
  for (size_t h = images.levels.size(); h-- > 0;) {
    surface_->level_dims.push_back(images.levels[h].dims);
    surface_->level_units.push_back(images.levels[h].unit);
  }
  const double unit = images.levels[0].unit;
  const VolumeView& volume = pyramid_->volume->view;
  double side = volume.spacing[0] * static_cast<double>(volume.dims[0]);
  for (size_t a = 1; a < 3; ++a) {
    side = std::min(side, volume.spacing[a] * static_cast<double>(volume.dims[a]));
  }
  if (Status s = derive_mesh(unit, side, p); !s.ok()) return s;
  derive_init(extras, p);
  RecoverySpec spec = recovery_spec(p, unit);
  spec.isos = pyramid_->isos;
  take_extras(extras, surface_->frame, spec);
  extras_ = extras;
  spec.force = level_force(extras_, surface_->frame, host_->schedule);
  if (p.init == PLC_INIT_MASK) {
    if (Status s = build_mask(*extras.mask, lasting, spec.start.mask); !s.ok()) return s;
  }
  given_hash_ ^= given_hash(spec);
  extras_.seeds = nullptr;
  extras_.mask = nullptr;
  extras_.mesh_xyz = nullptr;
  extras_.mesh_abc = nullptr;
  extras_.mesh_held = nullptr;
  extras_.attachments = nullptr;
  extras_.pins = nullptr;
  extras_.obstacle_xyz = nullptr;
  extras_.obstacle_abc = nullptr;
  // Of a patch the whole image would tell too much.
  patch_ = spec.start.patch;
  if (!patch_) {
    if (Status s = check_cost(images, spec); !s.ok()) return s;
  }
  recovery_.emplace(std::move(images), std::move(spec), host_->schedule, hooks(), surface_->mesh,
                    surface_->records);
  surface_->seconds.struct_size = sizeof surface_->seconds;
  surface_->seconds.preparation = pyramid_->seconds + (now() - start);
  surface_->seconds.images = pyramid_->seconds_images;
  return {};
}

// Refused before anything is made of it where even a quarter would not fit: of noise less is left
// than is told. A warning where it is more than the image explains.
Status Run::check_cost(const Pyramid& images, const RecoverySpec& spec) const {
  constexpr double kSure = 4;
  constexpr double kFew = 1000;
  const Cost cost = expected_cost(images, spec.isos, spec.inside_above, spec.pad_voxels, spec.scale,
                                  spec.sizes && spec.start.init == Init::kIso, host_->schedule);
  const std::string what = "about " + number_text(cost.vertices, 3) + " vertices and " +
                           number_text(cost.bytes / (1 << 20), 3) + " MiB";
  if (cost.bytes / kSure > static_cast<double>(host_->memory.left()) ||
      cost.vertices / kSure > static_cast<double>(kMaxMeshVertices)) {
    return {ErrorCode::kOutOfMemory, "the surface would have " + what + ", more than there is"};
  }
  const bool much = cost.vertices > std::max(cost.voxels, kFew);
  host_->log(much ? PLC_LOG_WARNING : PLC_LOG_INFO,
             "expected: " + what + (much ? ", more than the image has voxels" : ""));
  return {};
}

Status check_agreement(const PyramidData& pyramid, const plc_parameters& parameters) {
  if (same_pyramid(parameters, pyramid.given) || same_pyramid(parameters, pyramid.parameters)) {
    return {};
  }
  return bad_argument(
      "parameters: iso, window, pad value, feature, levels or reduction are not those that the "
      "pyramid was made with");
}

// 1 where the mask is not 0.
Status Run::build_mask(const plc_image& mask, Lasting lasting, Pyramid& pyramid) {
  VolumeView volume;
  if (Status s =
          take_voxels("mask", mask, lasting == Lasting::kRun, host_->schedule, volume, own_mask_);
      !s.ok()) {
    return s;
  }
  if (!is_any_set(volume, host_->schedule)) {
    return {ErrorCode::kInvalidData, "mask: every voxel is 0"};
  }
  volume.spacing = pyramid_->volume->view.spacing;
  given_hash_ = voxels_hash(volume, host_->schedule);
  // Clipped at 1, voxels without a sign are 0 or 1 as they are.
  if (volume.type != VoxelType::kU8 && volume.type != VoxelType::kU16) {
    set_voxels(volume, host_->schedule, mask_);
    volume.type = VoxelType::kU8;
    volume.voxels = mask_.data();
  }
  PyramidSpec spec = pyramid_spec(surface_->parameters);
  spec.window_low = 0;
  spec.window_high = 1;
  spec.pad_value = 0;
  return build_pyramid(volume, spec, host_->schedule, pyramid);
}

RecoveryHooks Run::hooks() {
  RecoveryHooks hooks;
  if (extras_.progress != nullptr) {
    hooks.progress = [this](const RecoveryProgress& p) {
      const plc_progress out = progress(p);
      return extras_.progress(&out, extras_.progress_user) == 0;
    };
  }
  if (extras_.level != nullptr) {
    hooks.level = [this](const LevelRecord&) { return ask_user(); };
  }
  hooks.left = [this](const LevelRecord& record) { tell(record); };
  return hooks;
}

plc_progress Run::progress(const RecoveryProgress& p) const {
  const double spent = surface_->seconds.evolution + (busy_ ? now() - since_ : 0);
  return {sizeof(plc_progress), p.level, p.levels, p.iteration, p.vertices, p.energy, p.speed,
          p.fraction,           spent};
}

LevelVerdict Run::ask_user() {
  surface_->space = recovery_->space();
  plc_level_report report = level_report(*surface_, surface_->records.size() - 1);
  switch (extras_.level(&report, surface_.get(), extras_.level_user)) {
    case PLC_VERDICT_MORE:
      return LevelVerdict::kMore;
    case PLC_VERDICT_STOP:
      return LevelVerdict::kStop;
    case PLC_VERDICT_CANCEL:
      return LevelVerdict::kCancel;
    default:
      return LevelVerdict::kAccept;
  }
}

// What a host that listens is told of a level that has been left.
void Run::tell(const LevelRecord& r) const {
  if (host_->log_fn == nullptr) return;
  const std::string level = "level " + std::to_string(r.level) + ": ";
  if (r.vertices == 0) {
    host_->log(PLC_LOG_INFO, level + (r.iterations == 0 ? "nothing that holds a surface"
                                                        : "nothing is left of the surface"));
    return;
  }
  const std::string what = std::to_string(r.iterations) + " iterations, " +
                           std::to_string(r.vertices) + " vertices, energy " +
                           number_text(r.energy) + ", " + number_text(r.seconds.total) + " s";
  host_->log(r.converged ? PLC_LOG_INFO : PLC_LOG_WARNING,
             level + (r.converged ? "converged, " : "not converged, ") + what);
}

Status Run::usable() const {
  if (busy_) return bad_argument("run: it is in the middle of a call");
  if (failed_) return bad_argument("run: it has ended by an error, there is nothing to go on with");
  return {};
}

Status Run::can_be_saved() const {
  if (!patch_) return {};
  return bad_argument("run: of a patch, which cannot be saved");
}

// What fails, or throws, ends the run; but for what was cancelled. All that the run keeps is of its
// own host's memory, whatever context the call is made with.
Status Run::guard(const std::function<Status()>& body) {
  if (Status s = usable(); !s.ok()) return s;
  const MemoryScope scope(host_->memory);
  busy_ = failed_ = true;
  since_ = now();
  const auto end = [this](bool failed) {
    surface_->seconds.evolution += now() - since_;
    surface_->space = recovery_->space();
    busy_ = false;
    failed_ = failed;
  };
  try {
    Status s = body();
    end(!s.ok() && s.code() != ErrorCode::kCancelled);
    return s;
  } catch (...) {
    end(true);
    throw;
  }
}

Status Run::start() {
  return guard([this] { return recovery_->start(); });
}

Status Run::advance(Amount amount) {
  return guard([this, amount] { return recovery_->advance(amount); });
}

plc_run_state Run::state() const {
  plc_run_state state{};
  state.done = recovery_->done() ? 1 : 0;
  state.between_levels = recovery_->between_levels() ? 1 : 0;
  state.progress = progress(recovery_->progress());
  return state;
}

std::unique_ptr<plc_surface> Run::surface() const {
  const MemoryScope scope(host_->memory);
  auto copy = std::make_unique<plc_surface>();
  copy->host = host_;
  copy->mesh.take(surface_->mesh.copy());
  copy->mesh.sizing = nullptr;  // the run's own
  copy->mesh.obstacles = nullptr;
  if (!copy->mesh.in_order()) {
    copy->mesh.renumber(morton_order(copy->mesh, host_->schedule), host_->schedule);
  }
  copy->space = surface_->space;
  copy->frame = surface_->frame;
  copy->parameters = surface_->parameters;
  copy->range = surface_->range;
  copy->records = surface_->records;
  copy->level_dims = surface_->level_dims;
  copy->level_units = surface_->level_units;
  copy->seconds = surface_->seconds;
  return copy;
}

std::unique_ptr<plc_surface> Run::release() {
  recovery_.reset();
  return std::move(surface_);
}

}  // namespace plc

using plc::Status;

namespace {

// The arguments of plc_run_create and plc_run_restore, checked, and a run without a surface yet.
Status new_run(plc_context* context, const plc_pyramid* pyramid, const plc_parameters* parameters,
               const plc_extras* extras, plc_run** run, std::unique_ptr<plc_run>& made) {
  if (pyramid == nullptr || run == nullptr) {
    return plc::bad_argument("pyramid, run: must not be NULL");
  }
  plc_parameters p;
  plc_extras e;
  if (Status s = plc::take_struct(parameters, plc_parameters_defaults, "parameters", p); !s.ok()) {
    return s;
  }
  if (Status s = plc::check_parameters(p); !s.ok()) return s;
  if (Status s = plc::check_agreement(*pyramid->data, p); !s.ok()) return s;
  plc_image mask;
  const plc::VolumeData& volume = *pyramid->data->volume;
  if (Status s = plc::check_extras(extras, p, volume.view, volume.frame, e, mask); !s.ok())
    return s;
  made = std::make_unique<plc_run>(context->host);
  return made->run.prepare(pyramid->data, plc::borrowed(pyramid->data->images), plc::Lasting::kRun,
                           p, e);
}

}  // namespace

extern "C" {

plc_status plc_run_create(plc_context* context, const plc_pyramid* pyramid,
                          const plc_parameters* parameters, const plc_extras* extras,
                          plc_run** run) {
  if (run != nullptr) *run = nullptr;
  return plc::guarded(context, [&]() -> Status {
    std::unique_ptr<plc_run> made;
    if (Status s = new_run(context, pyramid, parameters, extras, run, made); !s.ok()) return s;
    if (Status s = made->run.start(); !s.ok()) return s;
    *run = made.release();
    return {};
  });
}

plc_status plc_run_restore(plc_context* context, const plc_pyramid* pyramid,
                           const plc_parameters* parameters, const plc_extras* extras,
                           const void* state, size_t size, plc_run** run) {
  if (run != nullptr) *run = nullptr;
  return plc::guarded(context, [&]() -> Status {
    if (state == nullptr) return plc::bad_argument("state: must not be NULL");
    std::unique_ptr<plc_run> made;
    if (Status s = new_run(context, pyramid, parameters, extras, run, made); !s.ok()) return s;
    if (Status s = made->run.can_be_saved(); !s.ok()) return s;
    if (Status s = made->run.restore(static_cast<const uint8_t*>(state), size); !s.ok()) return s;
    *run = made.release();
    return {};
  });
}

void plc_run_destroy(plc_run* run) {
  delete run;
}

plc_status plc_run_advance(plc_context* context, plc_run* run, plc_amount amount,
                           plc_run_state* state) {
  return plc::guarded(context, [&]() -> Status {
    if (run == nullptr) return plc::bad_argument("run: must not be NULL");
    if (amount < PLC_ONE_ITERATION || amount > PLC_ALL_LEVELS) {
      return plc::bad_argument("amount: not a plc_amount");
    }
    if (state != nullptr) {
      if (Status s = plc::check_output(state, "state"); !s.ok()) return s;
    }
    if (Status s = run->run.advance(static_cast<plc::Amount>(amount)); !s.ok()) return s;
    if (state != nullptr) plc::give_struct(run->run.state(), state);
    return {};
  });
}

plc_status plc_run_get_state(plc_context* context, const plc_run* run, plc_run_state* state) {
  return plc::guarded(context, [&]() -> Status {
    if (run == nullptr) return plc::bad_argument("run: must not be NULL");
    if (Status s = plc::check_output(state, "state"); !s.ok()) return s;
    if (Status s = run->run.usable(); !s.ok()) return s;
    plc::give_struct(run->run.state(), state);
    return {};
  });
}

plc_status plc_run_surface(plc_context* context, const plc_run* run, plc_surface** surface) {
  if (surface != nullptr) *surface = nullptr;
  return plc::guarded(context, [&]() -> Status {
    if (run == nullptr || surface == nullptr) {
      return plc::bad_argument("run, surface: must not be NULL");
    }
    if (Status s = run->run.usable(); !s.ok()) return s;
    *surface = run->run.surface().release();
    return {};
  });
}

plc_status plc_run_save(plc_context* context, const plc_run* run, void* state, size_t capacity,
                        size_t* size) {
  return plc::guarded(context, [&]() -> Status {
    if (run == nullptr || size == nullptr) {
      return plc::bad_argument("run, size: must not be NULL");
    }
    if (Status s = run->run.usable(); !s.ok()) return s;
    if (Status s = run->run.can_be_saved(); !s.ok()) return s;
    plc::StateWriter count;
    run->run.save(count);
    if (state != nullptr || capacity != 0) {
      if (Status s = plc::check_room("state", state, static_cast<int64_t>(capacity),
                                     static_cast<int64_t>(count.size()));
          !s.ok()) {
        return s;
      }
      plc::StateWriter writer(static_cast<uint8_t*>(state));
      run->run.save(writer);
    }
    *size = count.size();
    return {};
  });
}

}  // extern "C"

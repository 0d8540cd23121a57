#include "tests/campaign/campaign_watch.h"

#include <sys/resource.h>

#include <vector>

namespace campaign {

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Context Watch::one_thread() {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = 1;
  plc_context* made = nullptr;
  plc_context_create(&options, &made, nullptr, 0);
  return Context(made);
}

Context Watch::lent_context(int64_t memory_limit) {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = way_.threads;
  options.simd = way_.simd;
  options.memory_limit = memory_limit;
  if (way_.own_memory) memory_.lend(options);
  if (way_.backwards) lend_backward_loops(options);
  plc_context* made = nullptr;
  plc_context_create(&options, &made, nullptr, 0);
  return Context(made);
}

RunRecord Watch::run(int64_t memory_limit, samples::Soup* mesh) {
  const double start = processor_seconds();
  Context context = lent_context(memory_limit);
  if (context == nullptr || checker_ == nullptr) {
    fail(Finding::kStatus, "no context of " + std::to_string(way_.threads) + " threads, target " +
                               std::to_string(way_.simd));
    return record_;
  }
  std::vector<std::byte> gaps;
  const plc_image image = way_.strided ? strided(case_.image, gaps) : case_.image;
  Surface surface = way_.steps ? in_steps(context.get(), image) : extract(context.get(), image);
  record_.seconds = processor_seconds() - start;
  plc_context_memory(context.get(), nullptr, &record_.memory);
  check_status();
  if ((record_.status == PLC_OK) != (surface != nullptr)) {
    fail(Finding::kStatus, "status " + std::to_string(record_.status) +
                               (surface == nullptr ? " without" : " with") + " a surface");
  }
  if (surface != nullptr && record_.status == PLC_OK) {
    record_.hash = plc_surface_hash(surface.get());
    record_.vertices = plc_surface_vertex_count(surface.get());
    if (exact_) check_result(surface.get());
    if (mesh != nullptr) *mesh = soup_of(checker_.get(), surface.get(), case_.space);
  }
  // Context before surface: what a handle needs of others it keeps alive.
  other_.reset();
  context.reset();
  surface.reset();
  if (const std::string fault = memory_.fault(); !fault.empty()) fail(Finding::kInvariant, fault);
  return record_;
}

plc_extras Watch::listening() {
  plc_extras extras = case_.extras();
  extras.progress = [](const plc_progress* p, void* self) {
    return static_cast<Watch*>(self)->progress(*p);
  };
  extras.level = [](const plc_level_report* report, const plc_surface* surface, void* self) {
    return static_cast<Watch*>(self)->level(*report, surface);
  };
  if (case_.force != UserForce::kNone) {
    extras.force = [](const plc_force_points* points, float* forces, void* self) {
      return static_cast<Watch*>(self)->force(*points, forces);
    };
  }
  extras.progress_user = extras.level_user = extras.force_user = this;
  return extras;
}

bool Watch::succeeds(plc_context* context, plc_status status) {
  record_.status = status;
  record_.message = plc_context_message(context);
  return status == PLC_OK;
}

Surface Watch::extract(plc_context* context, const plc_image& image) {
  const plc_extras extras = listening();
  plc_surface* made = reinterpret_cast<plc_surface*>(this);
  succeeds(context, plc_extract(context, &image, &case_.parameters, &extras, &made));
  return Surface(made);
}

Surface Watch::in_steps(plc_context* context, const plc_image& image) {
  plc_volume* made_volume = nullptr;
  if (!succeeds(context, plc_volume_create(context, &image, way_.ownership, &made_volume))) {
    return nullptr;
  }
  Volume volume(made_volume);
  plc_pyramid* made_pyramid = nullptr;
  if (!succeeds(context,
                plc_pyramid_create(context, volume.get(), &case_.parameters, &made_pyramid))) {
    return nullptr;
  }
  const Pyramid pyramid(made_pyramid);
  volume.reset();
  const plc_extras extras = listening();
  plc_run* made_run = nullptr;
  if (!succeeds(context,
                plc_run_create(context, pyramid.get(), &case_.parameters, &extras, &made_run))) {
    return nullptr;
  }
  Run run(made_run);
  for (bool done = false; !done;) {
    if (!advance(context, pyramid, run, done)) return nullptr;
  }
  plc_surface* made = nullptr;
  succeeds(context, plc_run_surface(context, run.get(), &made));
  return Surface(made);
}

// One call; false where the run has ended without a result.
bool Watch::advance(plc_context*& context, const Pyramid& pyramid, Run& run, bool& done) {
  const bool due = way_.save_at >= 0 && !record_.saved && iterations() >= way_.save_at;
  if (due && !restore(context, pyramid, run)) return false;
  plc_run_state state{};
  state.struct_size = sizeof state;
  const bool had_paused = record_.paused;
  if (!succeeds(context, plc_run_advance(context, run.get(), way_.amount, &state))) {
    // The run goes on where it was cancelled.
    return record_.status == PLC_CANCELLED && record_.paused && !had_paused && !cancels();
  }
  done = state.done != 0;
  if (way_.look_every != 0 && iterations() >= looked_at_ + way_.look_every) {
    looked_at_ = iterations();
    look(context, run.get());
  }
  return true;
}

// In another context, of one thread and the best target.
bool Watch::restore(plc_context*& context, const Pyramid& pyramid, Run& run) {
  record_.saved = true;
  size_t size = 0;
  if (!succeeds(context, plc_run_save(context, run.get(), nullptr, 0, &size))) return false;
  std::vector<std::byte> state(size);
  if (!succeeds(context, plc_run_save(context, run.get(), state.data(), size, &size))) return false;
  run.reset();
  other_ = one_thread();
  context = other_.get();
  const plc_extras extras = listening();
  plc_run* made = nullptr;
  const plc_status status = plc_run_restore(context, pyramid.get(), &case_.parameters, &extras,
                                            state.data(), state.size(), &made);
  run.reset(made);
  return succeeds(context, status);
}

void Watch::look(plc_context* context, const plc_run* run) {
  plc_surface* made = nullptr;
  const plc_status status = plc_run_surface(context, run, &made);
  const Surface surface(made);
  if (status == PLC_OUT_OF_MEMORY && way_.memory_part > 0) return;
  if (status != PLC_OK) {
    return fail(Finding::kStatus, std::string("plc_run_surface: ") + plc_context_message(context));
  }
  // Between levels there may be none.
  if (plc_surface_vertex_count(made) == 0) return;
  check(exact_soup(made), "after " + std::to_string(iterations()) + " iterations", false);
}

}  // namespace campaign

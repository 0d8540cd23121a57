// Random phantoms evolve step by step with random parameters. What interrupts them is random, too:
// cancelled calls, saved and restored runs, the library's own ways of stopping. After every step
// the surface is valid, and a restored run goes where the other one goes.
#include <string>
#include <vector>

#include "tests/fuzz/host.h"
#include "tests/fuzz/scenario.h"

namespace fuzz {

namespace {

constexpr int kMostSteps = 48;
constexpr int64_t kMemory = int64_t{1} << 30;

// Cancels at a given one of the calls that are to come.
struct Canceller {
  int after = -1;  // -1: never
  double fraction = 0;
  bool fell = false;

  static int progress(const plc_progress* p, void* user) {
    auto* self = static_cast<Canceller*>(user);
    self->fell |= !(p->fraction >= self->fraction && p->fraction <= 1);
    self->fraction = p->fraction;
    if (self->after < 0) return 0;
    return self->after-- == 0 ? 1 : 0;
  }
};

class Evolution {
 public:
  explicit Evolution(Input& input) : input_(input), scenario_(input) {}

  void run() {
    if (!prepare()) return;
    for (int step = 0; step < kMostSteps && !input_.empty(); ++step) {
      if (!advance(step)) return;
      check(step);
      if (state_.done != 0) return finish();
      interrupt();
    }
  }

 private:
  // False where the object or the start is refused, which is no finding.
  bool prepare() {
    plc_volume* volume = nullptr;
    const plc_ownership ownership = input_.flag() ? PLC_BORROW : PLC_COPY;
    expect_ok(plc_volume_create(context_.get(), &scenario_.image(), ownership, &volume));
    volume_.reset(volume);
    plc_pyramid* pyramid = nullptr;
    const plc_parameters* parameters = &scenario_.parameters();
    plc_status status = plc_pyramid_create(context_.get(), volume, parameters, &pyramid);
    check_status(context_.get(), status);
    require((status == PLC_OK) == (pyramid != nullptr),
            "a pyramid without PLC_OK, or none with it");
    if (status != PLC_OK) return false;
    pyramid_.reset(pyramid);
    if (input_.flag()) volume_.reset();
    extras_ = scenario_.extras();
    extras_.progress = Canceller::progress;
    extras_.progress_user = &canceller_;
    plc_run* run = nullptr;
    status = plc_run_create(context_.get(), pyramid, parameters, &extras_, &run);
    check_status(context_.get(), status);
    require((status == PLC_OK) == (run != nullptr), "a run without PLC_OK, or none with it");
    run_.reset(run);
    if (status == PLC_OK) check(-1);
    return status == PLC_OK;
  }

  // False where the run has ended.
  bool advance(int step) {
    constexpr plc_amount kAmounts[] = {PLC_ONE_ITERATION, PLC_ONE_ITERATION, PLC_ONE_ITERATION,
                                       PLC_ONE_ITERATION, PLC_ONE_LEVEL,     PLC_ALL_LEVELS};
    const plc_amount amount = input_.one_of(kAmounts);
    canceller_.after = input_.below(3) == 0 ? static_cast<int>(input_.below(8)) : -1;
    const int after = canceller_.after;
    state_.struct_size = sizeof state_;
    const plc_status status = plc_run_advance(context_.get(), run_.get(), amount, &state_);
    check_status(context_.get(), status);
    require(!canceller_.fell, "a fraction that falls, or is none");
    require(status != PLC_CANCELLED || after >= 0, "cancelled by nobody");
    require(status != PLC_INVALID_ARGUMENT, plc_context_message(context_.get()));
    follow(amount, after, status);
    if (status == PLC_OK || status == PLC_CANCELLED) return true;
    require_ended(step);
    return false;
  }

  // The restored run does what the other one has done.
  void follow(plc_amount amount, int after, plc_status status) {
    if (twin_ == nullptr) return;
    twin_canceller_.after = after;
    plc_run_state state{};
    state.struct_size = sizeof state;
    const plc_status same = plc_run_advance(context_.get(), twin_.get(), amount, &state);
    require(same == status, "a restored run ends in status " + std::to_string(same) + ", not " +
                                std::to_string(status));
    if (status != PLC_OK) return;
    require(state.done == state_.done && state.between_levels == state_.between_levels &&
                state.progress.level == state_.progress.level &&
                state.progress.iteration == state_.progress.iteration &&
                state.progress.vertices == state_.progress.vertices,
            "a restored run is elsewhere");
  }

  SurfaceHandle surface_of(const plc_run* run) {
    plc_surface* surface = nullptr;
    expect_ok(plc_run_surface(context_.get(), run, &surface));
    require(surface != nullptr, "no surface with PLC_OK");
    return SurfaceHandle(surface);
  }

  void check(int step) {
    const SurfaceHandle surface = surface_of(run_.get());
    const std::string when = "after step " + std::to_string(step);
    if (plc_surface_vertex_count(surface.get()) > 0) {
      require_valid(context_.get(), surface.get(), when);
    }
    if (twin_ == nullptr) return;
    const SurfaceHandle other = surface_of(twin_.get());
    require(plc_surface_hash(surface.get()) == plc_surface_hash(other.get()),
            when + ": a restored run has another surface");
  }

  void interrupt() {
    switch (input_.below(6)) {
      case 0:
        restore(twin_, twin_canceller_);
        break;
      case 1:  // goes on with the restored one alone
        restore(run_, canceller_);
        break;
      case 2:
        twin_.reset();
        break;
      case 3:
        if (input_.flag()) volume_.reset();
        break;
      default:
        break;
    }
  }

  // The state of the run as it is, restored into `to`.
  void restore(RunHandle& to, Canceller& canceller) {
    size_t size = 0;
    expect_ok(plc_run_save(context_.get(), run_.get(), nullptr, 0, &size));
    std::vector<unsigned char> state(size);
    expect_ok(plc_run_save(context_.get(), run_.get(), state.data(), state.size(), &size));
    require(size == state.size(), "a state of two sizes");
    plc_extras extras = extras_;
    extras.progress_user = &canceller;
    canceller.fraction = 0;
    plc_run* run = nullptr;
    expect_ok(plc_run_restore(context_.get(), pyramid_.get(), &scenario_.parameters(), &extras,
                              state.data(), state.size(), &run));
    to.reset(run);
  }

  void finish() {
    state_.done = 0;
    expect_ok(plc_run_advance(context_.get(), run_.get(), PLC_ALL_LEVELS, &state_));
    require(state_.done == 1, "a run that was done is not any more");
    if (!input_.flag()) return;
    plc_extras extras = scenario_.extras();
    plc_surface* surface = nullptr;
    expect_ok(plc_extract(context_.get(), &scenario_.image(), &scenario_.parameters(), &extras,
                          &surface));
    const SurfaceHandle whole(surface);
    const SurfaceHandle stepped = surface_of(run_.get());
    require(plc_surface_hash(whole.get()) == plc_surface_hash(stepped.get()),
            "steps lead elsewhere than plc_extract");
  }

  void require_ended(int step) {
    const std::string when = " of a run that has ended in step " + std::to_string(step);
    plc_surface* surface = nullptr;
    require(plc_run_surface(context_.get(), run_.get(), &surface) == PLC_INVALID_ARGUMENT &&
                surface == nullptr,
            "a surface" + when);
    size_t size = 0;
    require(plc_run_save(context_.get(), run_.get(), nullptr, 0, &size) == PLC_INVALID_ARGUMENT,
            "a state" + when);
    require(plc_run_advance(context_.get(), run_.get(), PLC_ONE_ITERATION, nullptr) ==
                PLC_INVALID_ARGUMENT,
            "a step" + when);
  }

  void expect_ok(plc_status status) {
    require(status == PLC_OK,
            "status " + std::to_string(status) + ": " + plc_context_message(context_.get()));
  }

  Input& input_;
  Scenario scenario_;
  plc_extras extras_{};
  Canceller canceller_, twin_canceller_;
  plc_run_state state_{};
  Context context_ = make_context(kMemory);
  VolumeHandle volume_;
  PyramidHandle pyramid_;
  RunHandle run_, twin_;
};

}  // namespace

void evolution(Bytes bytes) {
  Input input(bytes);
  Evolution(input).run();
}

}  // namespace fuzz

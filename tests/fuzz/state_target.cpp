// Saved states of a run, altered: what is not the state of a run is refused, and nothing else
// happens. An unaltered one is taken. Some get a checksum that fits, as nobody but a forger makes
// it: these may be taken, but the surface stays valid.
#include <algorithm>
#include <vector>

#include "engine/api/fingerprint.h"
#include "tests/fuzz/host.h"
#include "tests/samples/sample_volumes.h"

namespace fuzz {

namespace {

constexpr int64_t kMemory = int64_t{512} << 20;

// A sphere and a run on its way, once for all inputs.
class Saved {
 public:
  Saved() {
    samples::Volume shape;
    shape.dims = {12, 12, 12};
    volume_ = samples::sphere_potential(shape, 0.35);
    plc_image image;
    plc_image_defaults(&image);
    image.type = PLC_F32;
    image.voxels = volume_.values.data();
    std::copy(volume_.dims.begin(), volume_.dims.end(), image.dims);
    plc_parameters_defaults(&parameters_);
    parameters_.iso = 0.5;
    parameters_.levels = 1;
    plc_volume* volume = nullptr;
    expect_ok(plc_volume_create(context(), &image, PLC_BORROW, &volume));
    const VolumeHandle owner(volume);
    plc_pyramid* pyramid = nullptr;
    expect_ok(plc_pyramid_create(context(), volume, &parameters_, &pyramid));
    pyramid_.reset(pyramid);
    plc_run* run = nullptr;
    expect_ok(plc_run_create(context(), pyramid, &parameters_, nullptr, &run));
    const RunHandle runner(run);
    for (int i = 0; i < 5; ++i) {
      expect_ok(plc_run_advance(context(), run, PLC_ONE_ITERATION, nullptr));
    }
    size_t size = 0;
    expect_ok(plc_run_save(context(), run, nullptr, 0, &size));
    state_.resize(size);
    expect_ok(plc_run_save(context(), run, state_.data(), size, &size));
  }

  const std::vector<uint8_t>& state() const { return state_; }

  void restore(const std::vector<uint8_t>& bytes, bool forged) const {
    plc_run* run = nullptr;
    plc_extras extras;
    plc_extras_defaults(&extras);
    extras.level = export_surface;
    extras.level_user = context();
    const plc_status status = plc_run_restore(context(), pyramid_.get(), &parameters_, &extras,
                                              bytes.data(), bytes.size(), &run);
    check_status(context(), status);
    const RunHandle owner(run);
    require((status == PLC_OK) == (run != nullptr), "a run without PLC_OK, or none with it");
    require(status == PLC_OK || bytes != state_, "an unaltered state refused");
    require(status != PLC_OK || bytes == state_ || forged, "an altered state taken");
    if (status != PLC_OK) {
      require(status == PLC_INVALID_DATA || bytes.empty(), plc_context_message(context()));
      return;
    }
    const plc_status advanced = plc_run_advance(context(), run, PLC_ONE_ITERATION, nullptr);
    check_status(context(), advanced);
    require(advanced == PLC_OK || forged, plc_context_message(context()));
    plc_surface* surface = nullptr;
    const plc_status taken = plc_run_surface(context(), run, &surface);
    check_status(context(), taken);
    require(taken == PLC_OK || forged, plc_context_message(context()));
    const SurfaceHandle kept(surface);
    if (taken != PLC_OK) return;
    require_valid(context(), surface, "a restored run");
    const int levels = plc_surface_level_count(surface);
    require(levels <= parameters_.levels + 1, "more levels than the pyramid has");
    for (int i = 0; i < levels; ++i) {
      plc_level_report report{};
      report.struct_size = sizeof report;
      expect_ok(plc_surface_level(context(), surface, i, &report));
      require(report.level == parameters_.levels - i, "a level that is another");
    }
  }

 private:
  // Into rooms of the documented sizes.
  static plc_verdict export_surface(const plc_level_report*, const plc_surface* surface,
                                    void* user) {
    auto* context = static_cast<plc_context*>(user);
    const int64_t vertices = plc_surface_vertex_count(surface);
    const int64_t faces = plc_surface_face_count(surface);
    std::vector<float> xyz(static_cast<size_t>(3 * vertices));
    std::vector<uint32_t> abc(static_cast<size_t>(3 * faces));
    require(plc_surface_positions(context, surface, PLC_SPACE_LPS, xyz.data(), vertices) == PLC_OK,
            plc_context_message(context));
    require(plc_surface_faces(context, surface, PLC_SPACE_LPS, abc.data(), faces) == PLC_OK,
            plc_context_message(context));
    for (const uint32_t v : abc) require(int64_t{v} < vertices, "a face of no vertex");
    return PLC_VERDICT_ACCEPT;
  }

  plc_context* context() const { return context_.get(); }
  void expect_ok(plc_status status) const {
    require(status == PLC_OK, plc_context_message(context()));
  }
  Context context_ = make_context(kMemory);
  samples::Volume volume_;
  plc_parameters parameters_{};
  PyramidHandle pyramid_;
  std::vector<uint8_t> state_;
};

void alter(Input& input, std::vector<uint8_t>& bytes) {
  // Headers first: what they say of sizes is what can do harm.
  const size_t reach = input.flag() ? std::min<size_t>(bytes.size(), 256) : bytes.size();
  const size_t at = reach == 0 ? 0 : input.raw<uint32_t>() % reach;
  switch (input.below(6)) {
    case 0:
      bytes.resize(at);
      break;
    case 1:
      bytes.insert(bytes.begin() + static_cast<ptrdiff_t>(at), input.raw<uint8_t>());
      break;
    case 2:
      bytes.insert(bytes.end(), bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(at));
      break;
    case 3: {
      const auto value = input.raw<uint64_t>();
      for (size_t i = 0; i < sizeof value && at + i < bytes.size(); ++i) {
        bytes[at + i] = static_cast<uint8_t>(value >> (8 * i));
      }
      break;
    }
    default:
      if (at < bytes.size()) bytes[at] = input.raw<uint8_t>();
  }
}

void seal(std::vector<uint8_t>& bytes) {
  uint64_t sum = 0;
  if (bytes.size() < sizeof sum) return;
  sum = plc::words_hash(bytes.data(), bytes.size() - sizeof sum);
  std::memcpy(bytes.data() + bytes.size() - sizeof sum, &sum, sizeof sum);
}

}  // namespace

void state(Bytes bytes) {
  static const Saved saved;
  Input input(bytes);
  std::vector<uint8_t> altered = saved.state();
  for (uint32_t changes = input.below(5); changes > 0; --changes) alter(input, altered);
  const bool forged = input.flag();
  if (forged) seal(altered);
  saved.restore(altered, forged);
}

}  // namespace fuzz

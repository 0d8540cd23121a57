// Every function of the C API with arguments of any kind, in any order. None crashes, each says a
// status that there is; a failure has a message, and leaves outputs as they were.
#include <array>
#include <string>
#include <vector>

#include "tests/fuzz/host.h"
#include "tests/fuzz/random_arguments.h"

namespace fuzz {

namespace {

constexpr int kMostCalls = 10;
constexpr int64_t kMemory = int64_t{256} << 20;

// What callbacks answer: the next byte, from a few of the input's.
struct Answers {
  std::array<uint8_t, 8> bytes{};
  size_t next = 0;
  uint8_t take() { return bytes[next++ % bytes.size()]; }
};

int on_progress(const plc_progress*, void* user) {
  return static_cast<Answers*>(user)->take() % 8 == 7 ? 1 : 0;
}
plc_verdict on_level(const plc_level_report*, const plc_surface*, void* user) {
  return static_cast<plc_verdict>(static_cast<Answers*>(user)->take() % 5 - 1);
}
int on_force(const plc_force_points* points, float* forces, void* user) {
  const uint8_t answer = static_cast<Answers*>(user)->take();
  if (answer % 16 == 15) return 1;
  if (points->count > 0 && answer % 16 == 14) forces[0] = NAN;
  if (points->count > 0 && answer % 16 == 13) forces[0] = 1e30F;
  return 0;
}

// Few seeds, places and corners, their counts not always those of the arrays.
class RandomExtras {
 public:
  explicit RandomExtras(Input& input) : mask_(input) {
    plc_extras_defaults(&extras_);
    for (uint8_t& byte : answers_.bytes) byte = input.raw<uint8_t>();
    if (input.flag()) extras_.progress = on_progress;
    if (input.flag()) extras_.level = on_level;
    if (input.below(4) == 0) extras_.force = on_force;
    extras_.progress_user = extras_.level_user = extras_.force_user = &answers_;
    extras_.space = random_enum<plc_space>(input, 3);
    for (plc_seed& seed : seeds_) {
      for (double& c : seed.centre) c = input.below(8) == 0 ? random_double(input) : 4;
      seed.radius = input.below(4) == 0 ? random_double(input) : 3;
    }
    for (plc_attachment& a : attachments_)
      a = {{4, 4, 4}, random_double(input), random_double(input)};
    for (plc_pin& p : pins_) p = {{4, random_double(input), 4}, random_double(input)};
    for (double& c : xyz_) c = input.below(16) == 0 ? random_double(input) : input.below(8);
    for (uint32_t& v : abc_) v = input.below(5);
    lend(input, seeds_, 1, extras_.seeds, extras_.seed_count);
    lend(input, attachments_, 1, extras_.attachments, extras_.attachment_count);
    lend(input, pins_, 1, extras_.pins, extras_.pin_count);
    lend(input, xyz_, 3, extras_.mesh_xyz, extras_.mesh_vertex_count);
    lend(input, abc_, 3, extras_.mesh_abc, extras_.mesh_face_count);
    if (input.flag()) extras_.mask = &mask_.image();
  }
  const plc_extras& extras() const { return extras_; }

 private:
  // Mostly all of them, sometimes none, or a count that cannot be.
  template <typename T, size_t kCount>
  static void lend(Input& input, const std::array<T, kCount>& values, int64_t of_each,
                   const T*& pointer, int64_t& count) {
    constexpr int64_t kCounts[] = {-1, INT64_MIN, INT64_MAX, int64_t{1} << 61};
    const uint32_t way = input.below(16);
    if (way == 0) return;
    pointer = way == 1 ? nullptr : values.data();
    count = way == 2 ? input.one_of(kCounts) : static_cast<int64_t>(kCount) / of_each;
  }
  RandomImage mask_;
  Answers answers_;
  std::array<plc_seed, 2> seeds_{};
  std::array<plc_attachment, 2> attachments_{};
  std::array<plc_pin, 2> pins_{};
  std::array<double, 15> xyz_{};
  std::array<uint32_t, 18> abc_{};
  plc_extras extras_{};
};

class Caller {
 public:
  explicit Caller(Input& input) : input_(input), context_(make_context(kMemory)) {}

  void call() {
    static constexpr void (Caller::*kCalls[])() = {
        &Caller::create_context,  &Caller::create_volume,     &Caller::look_at_volume,
        &Caller::create_pyramid,  &Caller::look_at_pyramid,   &Caller::create_run,
        &Caller::advance_run,     &Caller::look_at_run,       &Caller::extract,
        &Caller::look_at_surface, &Caller::values_of_surface, &Caller::records_of_surface,
        &Caller::look_at_context, &Caller::destroy_something};
    null_ = input_.below(64);
    (this->*input_.one_of(kCalls))();
  }

 private:
  // Now and then one argument is NULL: that of the given number, the context's is 0.
  template <typename T>
  T* maybe(uint32_t number, T* pointer) const {
    return number == null_ ? nullptr : pointer;
  }
  plc_context* context() { return asked_ = maybe(0, context_.get()); }
  // Of the call on the last context().
  bool ok(plc_status status) {
    if (asked_ == nullptr) {
      require(status == PLC_INVALID_ARGUMENT, "NULL for a context is not refused");
      return false;
    }
    check_status(asked_, status);
    return status == PLC_OK;
  }
  template <typename Handle, typename T>
  void keep(Handle& handle, plc_status status, T* made) {
    require(ok(status) == (made != nullptr), "a handle without PLC_OK, or none with it");
    if (made != nullptr) handle.reset(made);
  }
  // A call that fills a struct; it is left alone where the call fails.
  template <typename T, typename Call>
  void fill(const Call& call) {
    Sized<T> out(input_, T{});
    T* given = maybe(5, out.get());
    const plc_status status = call(given);
    if (!ok(status)) require(out.is_untouched(), "a struct changed by a call that failed");
    require(given != nullptr || status != PLC_OK, "NULL for a struct is not refused");
  }

  void create_context() {
    plc_context_options options;
    plc_context_options_defaults(&options);
    options.threads = input_.below(4) == 0 ? random_int(input_) : 1;
    if (options.threads > 2 && options.threads <= 1024) options.threads = 2;
    options.simd = random_enum<plc_simd>(input_, 5);
    if (input_.flag()) options.allocate = allocate;
    if (input_.flag()) options.release = release;
    options.memory_limit = input_.below(4) == 0 ? input_.raw<int64_t>() : 0;
    Sized<plc_context_options> given(input_, options);
    plc_context* made = nullptr;
    Room<char> error(input_.below(40));
    const size_t size = input_.below(40);
    Room<char> line(static_cast<int64_t>(size));
    const plc_status status =
        plc_context_create(maybe(1, given.get()), maybe(2, &made), maybe(3, line.data()), size);
    require(status >= PLC_OK && status < PLC_INTERNAL,
            "a context in status " + std::to_string(status));
    require(made == nullptr || status == PLC_OK, "a context without PLC_OK");
    require(status == PLC_OK || size == 0 || line.data() == nullptr ||
                std::memchr(line.data(), 0, size) != nullptr || line.is_untouched(),
            "an error without an end");
    plc_context_destroy(made);
  }

  void create_volume() {
    RandomImage random(input_);
    Sized<plc_image> image(input_, random.image());
    plc_volume* made = nullptr;
    const auto ownership = random_enum<plc_ownership>(input_, 2);
    plc_volume** to = maybe(1, &made);
    const plc_status status = plc_volume_create(context(), maybe(1, image.get()), ownership, to);
    if (to == nullptr) return void(ok(status));
    keep(volume_, status, made);
    if (made != nullptr) images_.push_back(std::move(random));
  }
  void look_at_volume() {
    double low = 7, high = 7;
    plc_status status =
        plc_volume_range(context(), maybe(1, volume_.get()), maybe(2, &low), maybe(3, &high));
    if (!ok(status)) require(low == 7 && high == 7, "a range changed by a call that failed");
    fill<plc_image>(
        [&](plc_image* to) { return plc_volume_image(context(), maybe(1, volume_.get()), to); });
  }

  void create_pyramid() {
    Sized<plc_parameters> parameters(input_, parameters_ = random_parameters(input_));
    plc_pyramid* made = nullptr;
    const plc_status status =
        plc_pyramid_create(context(), maybe(1, volume_.get()), maybe(2, parameters.get()), &made);
    keep(pyramid_, status, made);
  }
  void look_at_pyramid() {
    const plc_pyramid* pyramid = maybe(1, pyramid_.get());
    const int levels = plc_pyramid_levels(pyramid);
    require(pyramid != nullptr ? levels >= 0 : levels == -1, "a strange number of levels");
    fill<plc_parameters>(
        [&](plc_parameters* to) { return plc_pyramid_parameters(context(), pyramid, to); });
    const int h = random_int(input_);
    fill<plc_pyramid_level>(
        [&](plc_pyramid_level* to) { return plc_pyramid_level_info(context(), pyramid, h, to); });
    plc_pyramid_level level{};
    level.struct_size = sizeof level;
    const int known = static_cast<int>(input_.below(3));
    if (plc_pyramid_level_info(context_.get(), pyramid, known, &level) != PLC_OK) return;
    const int64_t count = level.dims[0] * level.dims[1] * level.dims[2];
    const int64_t capacity = count + static_cast<int64_t>(input_.below(3)) - 1;
    Room<float> values(capacity);
    const plc_status status =
        plc_pyramid_values(context(), pyramid, known, maybe(1, values.data()), capacity);
    if (!ok(status)) require(values.is_untouched(), "values changed by a call that failed");
    require(status != PLC_OK || capacity >= count, "values beyond their room");
  }

  void create_run() {
    extras_ = std::make_unique<RandomExtras>(input_);
    Sized<plc_parameters> parameters(
        input_, input_.below(4) == 0 ? random_parameters(input_) : parameters_);
    Sized<plc_extras> extras(input_, extras_->extras());
    plc_run* made = nullptr;
    run_.reset();  // before what its callbacks are given
    const plc_status status =
        plc_run_create(context(), maybe(1, pyramid_.get()), maybe(2, parameters.get()),
                       maybe(3, extras.get()), &made);
    keep(run_, status, made);
  }
  void advance_run() {
    const auto amount = random_enum<plc_amount>(input_, 3);
    Sized<plc_run_state> state(input_, plc_run_state{});
    plc_run_state* given = input_.flag() ? nullptr : state.get();
    if (!ok(plc_run_advance(context(), maybe(1, run_.get()), amount, given))) {
      require(state.is_untouched(), "a state changed by a call that failed");
    }
  }
  void look_at_run() {
    plc_surface* made = nullptr;
    const plc_status made_status = plc_run_surface(context(), maybe(1, run_.get()), &made);
    keep(surface_, made_status, made);
    size_t size = 7;
    if (!ok(plc_run_save(context(), maybe(1, run_.get()), nullptr, 0, &size))) {
      require(size == 7, "a size changed by a call that failed");
      return;
    }
    const int64_t room = static_cast<int64_t>(size) - input_.below(2);
    Room<unsigned char> state(room);
    const plc_status status = plc_run_save(context(), maybe(1, run_.get()), maybe(2, state.data()),
                                           static_cast<size_t>(room), &size);
    if (!ok(status)) require(state.is_untouched(), "a state written by a call that failed");
  }

  void extract() {
    const RandomImage random(input_);
    const RandomExtras random_extras(input_);
    Sized<plc_image> image(input_, random.image());
    Sized<plc_parameters> parameters(input_, random_parameters(input_));
    Sized<plc_extras> extras(input_, random_extras.extras());
    plc_surface* made = nullptr;
    const plc_status status =
        plc_extract(context(), maybe(1, image.get()), maybe(2, parameters.get()),
                    input_.flag() ? nullptr : extras.get(), &made);
    keep(surface_, status, made);
  }

  void look_at_surface() {
    const plc_surface* surface = maybe(1, surface_.get());
    const auto space = random_enum<plc_space>(input_, 3);
    require(surface != nullptr ||
                (plc_surface_hash(surface) == 0 && plc_surface_level_count(surface) == 0),
            "something of NULL");
    fill<plc_measures>(
        [&](plc_measures* to) { return plc_surface_measure(context(), surface, space, to); });
    fill<plc_check>([&](plc_check* to) { return plc_surface_check(context(), surface, to); });
  }
  void values_of_surface() {
    const plc_surface* surface = maybe(1, surface_.get());
    const auto space = random_enum<plc_space>(input_, 3);
    const auto scalar = random_enum<plc_scalar>(input_, 5);
    const int64_t vertices = plc_surface_vertex_count(surface) + input_.below(3) - 1;
    const int64_t faces = plc_surface_face_count(surface) + input_.below(3) - 1;
    Room<float> positions(3 * vertices), normals(3 * vertices), scalars(vertices);
    Room<double> exact(3 * vertices);
    Room<uint32_t> corners(3 * faces);
    const auto left = [&](plc_status status, const auto& room) {
      if (!ok(status)) require(room.is_untouched(), "values changed by a call that failed");
    };
    left(plc_surface_positions(context(), surface, space, maybe(2, positions.data()), vertices),
         positions);
    left(plc_surface_positions_f64(context(), surface, space, maybe(2, exact.data()), vertices),
         exact);
    int64_t sites = 0;
    ok(plc_surface_frozen_sites(context(), surface, space, nullptr, nullptr, 0, &sites));
    const int64_t room = sites + input_.below(3) - 1;
    Room<double> places(3 * room);
    left(plc_surface_frozen_sites(context(), surface, space, maybe(2, places.data()), nullptr, room,
                                  &sites),
         places);
    left(plc_surface_normals(context(), surface, space, maybe(2, normals.data()), vertices),
         normals);
    left(plc_surface_scalars(context(), surface, space, scalar, maybe(2, scalars.data()), vertices),
         scalars);
    left(plc_surface_faces(context(), surface, space, maybe(2, corners.data()), faces), corners);
  }
  void records_of_surface() {
    const plc_surface* surface = maybe(1, surface_.get());
    const int index = random_int(input_);
    fill<plc_level_report>(
        [&](plc_level_report* to) { return plc_surface_level(context(), surface, index, to); });
    fill<plc_seconds>([&](plc_seconds* to) { return plc_surface_seconds(context(), surface, to); });
    fill<plc_parameters>(
        [&](plc_parameters* to) { return plc_surface_parameters(context(), surface, to); });
    double low = 7, high = 7;
    if (!ok(plc_surface_input_range(context(), surface, maybe(1, &low), maybe(2, &high)))) {
      require(low == 7 && high == 7, "a range changed by a call that failed");
    }
  }

  void look_at_context() {
    const plc_context* context = maybe(1, context_.get());
    require(plc_context_message(context) != nullptr, "no message");
    require(context != nullptr ||
                (plc_context_threads(context) == 0 && *plc_context_simd(context) == 0),
            "something of NULL");
    int64_t now = -1, peak = -1;
    const plc_status status = plc_context_memory(context, maybe(1, &now), maybe(2, &peak));
    require((status == PLC_OK) == (context != nullptr), "memory of NULL, or none of a context");
    require(now <= kMemory && peak <= kMemory, "memory beyond the limit");
  }

  void destroy_something() {
    switch (input_.below(4)) {
      case 0:
        return volume_.reset();
      case 1:
        return pyramid_.reset();
      case 2:
        return run_.reset();
      default:
        return surface_.reset();
    }
  }

  Input& input_;
  Context context_;
  plc_context* asked_ = nullptr;  // by the last call
  uint32_t null_ = 0;
  plc_parameters parameters_{};
  std::vector<RandomImage> images_;  // lent to volumes, and to what was made of them
  std::unique_ptr<RandomExtras> extras_;
  VolumeHandle volume_;
  PyramidHandle pyramid_;
  RunHandle run_;
  SurfaceHandle surface_;
};

}  // namespace

void api(Bytes bytes) {
  Input input(bytes);
  Caller caller(input);
  for (int i = 0; i < kMostCalls && !input.empty(); ++i) caller.call();
}

}  // namespace fuzz

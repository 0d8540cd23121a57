#include "tests/fuzz/scenario.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/samples/sample_meshes.h"

namespace fuzz {

namespace {

samples::Volume random_volume(Input& input) {
  samples::Volume shape;
  // Powers of 2: positions in mm are those of the mesh, not rounded to others.
  constexpr double kSpacings[] = {1, 1, 1, 0.5, 2};
  for (size_t a = 0; a < 3; ++a) {
    shape.dims[a] = 8 + input.below(13);
    shape.spacing[a] = input.one_of(kSpacings);
  }
  const uint64_t seed = input.raw<uint16_t>();
  samples::Volume volume;
  switch (input.below(5)) {
    case 0:
      volume = samples::sphere_potential(shape, input.within(0.15, 0.45));
      break;
    case 1:
      volume = samples::chain_potential(shape);
      break;
    case 2:
      volume = samples::shell(shape);
      break;
    case 3:
      volume = samples::noise(shape, input.within(2, 6) * shape.smallest() / 16, seed);
      break;
    default:
      volume = samples::blobs(shape, 1 + static_cast<int>(input.below(10)), seed);
  }
  constexpr double kNoises[] = {0, 0, 0.05, 0.2, 0.5};
  samples::add_noise(volume, input.one_of(kNoises), seed);
  for (float& value : volume.values) value = std::clamp(value, 0.0F, 1.0F);
  return volume;
}

}  // namespace

Scenario::Scenario(Input& input) {
  volume_ = random_volume(input);
  make_image(input);
  plc_parameters_defaults(&parameters_);
  plc_extras_defaults(&extras_);
  choose_object(input);
  choose_pyramid(input);
  choose_model(input);
  choose_pace(input);
  choose_start(input);
  if (input.below(4) == 0) choose_places(input);
}

void Scenario::make_image(Input& input) {
  plc_image_defaults(&image_);
  std::copy(volume_.dims.begin(), volume_.dims.end(), image_.dims);
  std::copy(volume_.spacing.begin(), volume_.spacing.end(), image_.spacing);
  if (input.flag()) {
    image_.type = PLC_U8;
    for (const float value : volume_.values) bytes_.push_back(static_cast<uint8_t>(value * 255));
    image_.voxels = bytes_.data();
  } else {
    image_.type = PLC_F32;
    image_.voxels = volume_.values.data();
  }
}

void Scenario::choose_object(Input& input) {
  const double full = image_.type == PLC_U8 ? 255 : 1;
  plc_parameters& p = parameters_;
  p.iso = full * input.within(0.2, 0.7);
  p.inside_below = input.below(5) == 0 ? 1 : 0;
  if (input.below(4) == 0) {
    p.window_low = p.iso - full * input.within(0.05, 0.6);
    p.window_high = p.iso + full * input.within(0.05, 0.6);
  }
  if (input.below(16) == 0) {
    p.feature = PLC_FEATURE_GRADIENT_NORM;
    p.feature_sigma = input.within(0, 1.5);
    p.iso = full * input.within(0.02, 0.2);
    p.window_low = p.window_high = NAN;
  }
  constexpr plc_force kForces[] = {PLC_FORCE_ISO, PLC_FORCE_ISO, PLC_FORCE_ISO, PLC_FORCE_BOTH,
                                   PLC_FORCE_GRADIENT};
  p.force = input.one_of(kForces);
  if (p.force != PLC_FORCE_ISO) {
    p.gradient = input.within(-2, 2);
    p.gradient_tangent = input.within(-0.5, 0.5);
    p.gradient_bound = input.within(0.02, 1);
  }
}

void Scenario::choose_pyramid(Input& input) {
  parameters_.levels = static_cast<int>(input.below(5)) - 1;
  constexpr double kReductions[] = {1.25, 1.5, 1.7320508075688772, 1.7320508075688772, 2};
  parameters_.reduction = input.one_of(kReductions);
  constexpr plc_anisotropy kMethods[] = {PLC_ANISOTROPY_VOXEL, PLC_ANISOTROPY_PHYSICAL,
                                         PLC_ANISOTROPY_METRIC};
  parameters_.anisotropy = input.one_of(kMethods);
}

void Scenario::choose_model(Input& input) {
  plc_parameters& p = parameters_;
  constexpr double kCurvatures[] = {0.4, 0.4, 0, 0.05, 0.1, 1};
  p.curvature = input.one_of(kCurvatures);
  constexpr double kSprings[] = {0, 0, 0.001, 0.01, 0.1};
  p.spring = input.one_of(kSprings);
  p.rest_length = static_cast<plc_rest_length>(input.below(3));
  p.rest_length_value = input.within(0, 3);
  constexpr double kAttractions[] = {1, 1, 0.3, 2, 5};
  p.attraction = input.one_of(kAttractions);
  constexpr double kMasses[] = {1, 1, 0.3, 4};
  p.mass = input.one_of(kMasses);
  constexpr double kDampings[] = {0.5, 0.5, 0, 0.1, 2};
  p.damping = input.one_of(kDampings);
  constexpr double kTimeSteps[] = {1, 1, 0.3, 2};
  p.time_step = input.one_of(kTimeSteps);
  constexpr double kMoves[] = {0.4, 0.4, 0.1, 1};
  p.max_move = input.one_of(kMoves);
  p.bound = input.below(4) == 0 ? PLC_BOUND_SCALE : PLC_BOUND_CLAMP;
}

void Scenario::choose_pace(Input& input) {
  plc_parameters& p = parameters_;
  constexpr double kEpsilons[] = {1e-4, 1e-3, 1e-5, 1};
  p.epsilon = input.one_of(kEpsilons);
  p.calm_speed = input.below(4) == 0 ? input.within(0, 0.1) : 0;
  p.max_iterations = 1 + static_cast<int>(input.below(40));
  const uint8_t ways = input.raw<uint8_t>();
  p.late_bubbles = (ways & 1) == 0 ? 1 : 0;
  p.sleeping = (ways & 2) == 0 ? 1 : 0;
}

void Scenario::choose_start(Input& input) {
  constexpr plc_init kInits[] = {PLC_INIT_BUBBLE, PLC_INIT_BUBBLE, PLC_INIT_BUBBLES, PLC_INIT_SEEDS,
                                 PLC_INIT_ISO,    PLC_INIT_MASK,   PLC_INIT_MESH};
  parameters_.init = input.one_of(kInits);
  extras_.space = input.flag() ? PLC_SPACE_VOXEL : PLC_SPACE_LPS;
  const auto extent = volume_.extent();
  const auto place = [&](double* to) {
    for (size_t a = 0; a < 3; ++a) to[a] = input.within(0, 1) * extent[a] / volume_.spacing[a];
  };
  switch (parameters_.init) {
    case PLC_INIT_BUBBLES:
      for (int& count : parameters_.bubbles) count = 1 + static_cast<int>(input.below(4));
      break;
    case PLC_INIT_SEEDS:
      seeds_.resize(1 + input.below(3));
      for (plc_seed& seed : seeds_) {
        place(seed.centre);
        seed.radius = 0.5 + input.within(0, 0.5) * volume_.smallest();
      }
      extras_.seeds = seeds_.data();
      extras_.seed_count = static_cast<int64_t>(seeds_.size());
      break;
    case PLC_INIT_MASK: {
      const float level = static_cast<float>(input.within(0.2, 0.8));
      for (const float value : volume_.values) mask_voxels_.push_back(value > level ? 1 : 0);
      mask_ = image_;
      mask_.type = PLC_U8;
      mask_.voxels = mask_voxels_.data();
      extras_.mask = &mask_;
      break;
    }
    case PLC_INIT_MESH: {
      const double size = input.within(0.3, 1) * volume_.smallest() / 4;
      const samples::Soup soup = input.flag() ? samples::torus(12, 8, 1, 0.45) : samples::cube();
      double centre[3];
      place(centre);
      const samples::Soup at = samples::moved(soup, centre[0], centre[1], centre[2], size);
      xyz_ = at.xyz;
      abc_.assign(at.abc.begin(), at.abc.end());
      extras_.mesh_xyz = xyz_.data();
      extras_.mesh_vertex_count = static_cast<int64_t>(xyz_.size() / 3);
      extras_.mesh_abc = abc_.data();
      extras_.mesh_face_count = static_cast<int64_t>(abc_.size() / 3);
      break;
    }
    default:
      break;
  }
}

void Scenario::choose_places(Input& input) {
  const auto somewhere = [&](double* to) {
    for (size_t a = 0; a < 3; ++a)
      to[a] = input.within(0, 1) * static_cast<double>(volume_.dims[a]);
  };
  attachments_.resize(input.below(3));
  for (plc_attachment& a : attachments_) {
    somewhere(a.place);
    a.radius = input.within(0.5, 8);
    a.strength = input.within(0, 20);
  }
  pins_.resize(input.below(3));
  for (plc_pin& p : pins_) {
    somewhere(p.place);
    p.radius = input.within(0.5, 6);
  }
  extras_.attachments = attachments_.data();
  extras_.attachment_count = static_cast<int64_t>(attachments_.size());
  extras_.pins = pins_.data();
  extras_.pin_count = static_cast<int64_t>(pins_.size());
}

}  // namespace fuzz

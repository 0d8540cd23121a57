// Whole runs of the engine: a random image with random parameters from a seed, and its name.
#pragma once
#include <cstdio>
#include <string>

#include "engine/base/constants.h"
#include "engine/recover/recovery.h"
#include "pyramid/pyramid.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace samples {

struct Run {
  std::string name;
  Volume volume;
  double iso = 0.5;
  plc::PyramidSpec pyramid;
  plc::RecoverySpec recovery;
};

// The iso-value of I_0 on all levels. The time step is shorter than the default one and the levels
// may take longer: the hashes that tests have recorded are of such runs.
inline Run make_run(std::string name, Volume volume, double iso, int levels) {
  Run run{std::move(name), std::move(volume), iso, {}, {}};
  run.pyramid.levels = levels;
  run.pyramid.pad_voxels = run.recovery.pad_voxels = plc::kPadVoxels;
  run.recovery.model.time_step = 1;
  run.recovery.max_iterations = 2000;
  run.recovery.isos.assign(static_cast<size_t>(levels) + 1, iso);
  return run;
}

// It borrows the run's volume.
inline plc::Pyramid pyramid_of(const Run& run, const plc::Executor& executor = kSerial) {
  plc::Pyramid pyramid;
  const plc::Status status = plc::build_pyramid(run.volume.view(), run.pyramid, executor, pyramid);
  if (!status.ok()) pyramid.levels.clear();
  return pyramid;
}

inline Volume random_volume(Random& random, std::string& kind) {
  Volume shape;
  constexpr double kSpacings[] = {1, 1, 1, 1.3, 2};
  for (size_t a = 0; a < 3; ++a) {
    shape.dims[a] = random.integer(20, 32);
    shape.spacing[a] = random.one_of(kSpacings);
  }
  const uint64_t seed = random.bits();
  constexpr const char* kKinds[] = {"sphere", "chain", "sponge", "blobs",
                                    "blobs",  "shell", "caverns"};
  kind = random.one_of(kKinds);
  if (kind == "sphere") return sphere_potential(shape, 0.4);
  if (kind == "chain") return chain_potential(shape);
  if (kind == "blobs") return blobs(shape, static_cast<int>(random.integer(3, 12)), seed);
  if (kind == "shell") return shell(shape);
  if (kind == "caverns") return noise(shape, random.uniform(3, 6) * shape.smallest() / 24, seed);
  Volume sponge = menger(3);
  sponge.spacing = shape.spacing;
  return sponge;
}

inline plc::Model random_model(Random& random) {
  plc::Model m;
  constexpr float kCurvatures[] = {0, 0.05F, 0.1F, 0.4F, 0.4F, 1};
  m.curvature = random.one_of(kCurvatures);
  constexpr float kSprings[] = {0, 0, 0.001F, 0.01F, 0.1F};
  m.spring = random.one_of(kSprings);
  m.rest_length = static_cast<plc::RestLength>(random.integer(0, 2));
  m.rest_length_value = 1.5F;
  constexpr float kAttractions[] = {-1, -1, -0.5F, -2};
  m.attraction = random.one_of(kAttractions);
  constexpr float kMasses[] = {1, 1, 0.5F, 4};
  m.mass = random.one_of(kMasses);
  constexpr float kDampings[] = {0.5F, 0.5F, 0.1F, 1};
  m.damping = random.one_of(kDampings);
  constexpr float kTimeSteps[] = {1, 1, 0.5F, 2};
  m.time_step = random.one_of(kTimeSteps);
  constexpr float kMoves[] = {0.4F, 0.4F, 0.2F, 1};
  m.max_move = random.one_of(kMoves);
  m.bound = random.integer(0, 2) == 0 ? plc::Bound::kScale : plc::Bound::kClamp;
  return m;
}

// As many bubbles as have room on the coarsest level; none: one bubble around the object.
inline void choose_bubbles(Run& run, Random& random) {
  const auto& spacing = run.volume.spacing;
  const double finest = std::min({spacing[0], spacing[1], spacing[2]});
  const bool physical = run.recovery.scale.anisotropy == plc::Anisotropy::kPhysical;
  double delta = 1 / plc::kUnitPerDelta;
  for (int h = 0; h < run.pyramid.levels; ++h) delta *= run.pyramid.reduction;
  auto& start = run.recovery.start;
  for (size_t a = 0; a < 3; ++a) {
    const double step = physical ? spacing[a] / finest : 1;
    // 3.9 delta apart the radius is 1.2 delta. Voxels of coarse levels, which kMetric lives in, are
    // longer than they should be where sizes are rounded.
    const double room = static_cast<double>(run.volume.dims[a]) * step / (5 * delta);
    if (room < 1) return;
    start.bubbles[a] =
        static_cast<int>(random.integer(1, std::min(static_cast<int64_t>(room), int64_t{6})));
  }
  start.init = plc::Init::kBubbles;
}

// A dark object in a bright image instead.
inline void turn_dark(Run& run) {
  for (float& value : run.volume.values) value = 1 - value;
  run.iso = 1 - run.iso;
  for (double& iso : run.recovery.isos) iso = 1 - iso;
  run.pyramid.pad_value = 1;
  run.recovery.inside_above = false;
  run.recovery.model.attraction *= -1;
}

inline Run random_run(uint64_t seed) {
  Random random(seed);
  std::string kind;
  Volume volume = random_volume(random, kind);
  constexpr double kNoises[] = {0, 0, 0.05, 0.2};
  const double noise_amplitude = random.one_of(kNoises);
  add_noise(volume, noise_amplitude, random.bits());
  Run run = make_run(kind, std::move(volume), random.uniform(0.3, 0.5),
                     static_cast<int>(random.integer(0, 3)));
  constexpr double kReductions[] = {1.25, 1.5, plc::kRefinement, plc::kRefinement, 2};
  run.pyramid.reduction = random.one_of(kReductions);
  auto& r = run.recovery;
  // Thin parts fade on coarse levels.
  for (size_t h = 1; h < r.isos.size(); ++h) r.isos[h] = r.isos[h - 1] * 0.65;
  r.model = random_model(random);
  if (random.integer(0, 4) == 0) turn_dark(run);
  constexpr plc::Anisotropy kMethods[] = {plc::Anisotropy::kPhysical, plc::Anisotropy::kMetric,
                                          plc::Anisotropy::kVoxel};
  constexpr const char* kMethodNames[] = {"", "mm", "voxels", "metric"};
  r.scale.anisotropy = random.one_of(kMethods);
  const auto& spacing = run.volume.spacing;
  if (random.integer(0, 2) == 0) choose_bubbles(run, random);
  constexpr double kEpsilons[] = {1e-4, 1e-5, 5e-6};
  r.epsilon = random.one_of(kEpsilons);
  r.max_iterations = 100;
  char name[320];
  const auto& d = run.volume.dims;
  std::snprintf(name, sizeof name,
                "seed %llu: %s %dx%dx%d spacing %g,%g,%g noise %g iso %.3f levels %d rho %.3f "
                "%s %d,%d,%d %s alpha_c %g alpha_e %g (rest %d) alpha_I %g m %g gamma %g dt %g "
                "move %g %s epsilon %g",
                static_cast<unsigned long long>(seed), kind.c_str(), static_cast<int>(d[0]),
                static_cast<int>(d[1]), static_cast<int>(d[2]), spacing[0], spacing[1], spacing[2],
                noise_amplitude, run.iso, run.pyramid.levels, run.pyramid.reduction,
                r.start.init == plc::Init::kBubble ? "bubble" : "bubbles", r.start.bubbles[0],
                r.start.bubbles[1], r.start.bubbles[2],
                kMethodNames[static_cast<int>(r.scale.anisotropy)],
                static_cast<double>(r.model.curvature), static_cast<double>(r.model.spring),
                static_cast<int>(r.model.rest_length), static_cast<double>(r.model.attraction),
                static_cast<double>(r.model.mass), static_cast<double>(r.model.damping),
                static_cast<double>(r.model.time_step), static_cast<double>(r.model.max_move),
                r.model.bound == plc::Bound::kClamp ? "clamp" : "scale", r.epsilon);
  run.name = name;
  return run;
}

}  // namespace samples

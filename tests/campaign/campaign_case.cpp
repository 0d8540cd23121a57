#include "tests/campaign/campaign_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "kernels/simd.h"
#include "pyramid/pyramid.h"
#include "tests/campaign/campaign_faults.h"
#include "tests/campaign/campaign_image.h"
#include "tests/campaign/campaign_start.h"

namespace campaign {

namespace {

constexpr const char* kInitNames[] = {"bubble", "bubbles", "seeds", "iso", "mask", "mesh", "auto"};
constexpr const char* kTypeNames[] = {"u8", "i16", "u16", "i32", "f32"};
constexpr int64_t kEndless = int64_t{1} << 40;
constexpr const char* kSpaceNames[] = {"LPS", "RAS", "voxel"};

void choose_pyramid(Case& c) {
  Random random = draws(c.seed, Part::kPyramid);
  plc_parameters& p = c.parameters;
  constexpr double kReductions[] = {2, 1.5, 1.7320508075688772, 1.7320508075688772};
  p.reduction = random.integer(0, 2) == 0 ? random.uniform(1.2, 2) : random.one_of(kReductions);
  p.levels = static_cast<int>(random.integer(-1, 3));
  std::array<int64_t, 3> padded{};
  for (size_t a = 0; a < 3; ++a) padded[a] = c.image.dims[a] + 12;
  p.levels = std::min(p.levels, plc::max_levels(padded, p.reduction));
  p.anisotropy =
      static_cast<plc_anisotropy>(random.integer(PLC_ANISOTROPY_PHYSICAL, PLC_ANISOTROPY_METRIC));
}

// Far from anything useful, within what the API takes.
double wild(Random& random) {
  double value = random.uniform(1, 10);
  for (int64_t i = random.integer(-6, 5); i != 0; i += i < 0 ? 1 : -1) value *= i < 0 ? 0.1 : 10;
  return value;
}

void choose_wild(plc_parameters& p, Random& random) {
  double* const coefficients[] = {&p.curvature, &p.spring,  &p.attraction, &p.gradient,
                                  &p.mass,      &p.damping, &p.time_step};
  for (int64_t i = random.integer(1, 3); i > 0; --i) {
    double* const chosen = random.one_of(coefficients);
    *chosen = std::max(1e-6, wild(random));
  }
}

void choose_model(Case& c) {
  Random random = draws(c.seed, Part::kModel);
  plc_parameters& p = c.parameters;
  constexpr double kCurvatures[] = {0, 0.05, 0.1, 0.1, 0.4, 0.4, 1, 5};
  p.curvature = random.one_of(kCurvatures);
  constexpr double kSprings[] = {0, 0, 0, 0, 0, 0.001, 0.001, 0.01, 0.01, 0.1, 0.1, 1};
  p.spring = random.one_of(kSprings);
  p.rest_length = static_cast<plc_rest_length>(random.integer(PLC_REST_ZERO, PLC_REST_VALUE));
  p.rest_length_value = random.uniform(0, once_in(random, 10) ? 2.5 : 1.6);
  constexpr double kAttractions[] = {1, 1, 1, 0.25, 0.5, 2, 4};
  p.attraction = random.one_of(kAttractions);
  constexpr double kMasses[] = {1, 1, 1, 0.25, 4};
  p.mass = random.one_of(kMasses);
  constexpr double kDampings[] = {0.5, 0.5, 0.5, 0, 0.1, 1, 3};
  p.damping = random.one_of(kDampings);
  constexpr double kTimeSteps[] = {1, 1, 1, 0.2, 0.5, 2, 4};
  p.time_step = random.one_of(kTimeSteps);
  constexpr double kMoves[] = {0.4, 0.4, 0.4, 0.05, 0.2, 0.7, 1};
  p.max_move = random.one_of(kMoves);
  p.bound = random.integer(0, 2) == 0 ? PLC_BOUND_SCALE : PLC_BOUND_CLAMP;
  if (once_in(random, 30)) choose_wild(p, random);
  constexpr double kEpsilons[] = {1e-4, 1e-4, 1e-3, 1e-5, 0.02};
  p.epsilon = random.one_of(kEpsilons);
  if (once_in(random, 8)) p.calm_speed = random.uniform(0, 0.1);
  constexpr int kIterations[] = {20, 20, 30, 30, 40, 8, 3, 100};
  p.max_iterations = random.one_of(kIterations);
  p.late_bubbles = random.integer(0, 3) == 0 ? 0 : 1;
  p.sleeping = random.integer(0, 2) == 0 ? 0 : 1;
}

// Of thin and noisy objects, too: what is drawn stays, how the surface moves over it is as shipped.
// Nobody else pulls at it, or ends it before it rests: one level in a thousand takes more
// iterations than are shipped.
void choose_rest(Case& c, Random& random) {
  plc_parameters defaults;
  plc_parameters_defaults(&defaults);
  plc_parameters& p = c.parameters;
  c.rests = true;
  constexpr double kCurvatures[] = {0.05, 0.1, 0.4, 0.4};
  p.curvature = random.one_of(kCurvatures);
  p.spring = defaults.spring;
  p.attraction = defaults.attraction;
  p.gradient = std::abs(p.gradient);
  p.gradient_tangent = 0;  // turns.h
  p.mass = defaults.mass;
  p.damping = defaults.damping;
  p.time_step = defaults.time_step;
  p.max_move = defaults.max_move;
  p.bound = defaults.bound;
  p.epsilon = defaults.epsilon;
  p.calm_speed = defaults.calm_speed;
  p.max_iterations = 4 * defaults.max_iterations;
  p.late_bubbles = p.sleeping = 1;
  c.force = UserForce::kNone;
  c.attachments.clear();
  c.pins.clear();
  c.more_level = c.stop_level = -1;
  c.cancel_at = 0;
  c.work = kEndless;
}

// A third of what may have one.
void choose_mesh(Case& c) {
  Random random = draws(c.seed, Part::kMesh);
  plc_parameters& p = c.parameters;
  p.mesh = PLC_MESH_UNIFORM;
  if (!once_in(random, 3) || std::isnan(p.iso)) return;
  p.mesh = PLC_MESH_ADAPTIVE;
  p.spring = 0;
  const double voxel = std::min({c.image.spacing[0], c.image.spacing[1], c.image.spacing[2]});
  if (once_in(random, 2)) p.tolerance = voxel * random.uniform(0.005, 0.5);
  if (once_in(random, 2)) p.edge_min = voxel * random.uniform(0.3, 1.5);
  if (once_in(random, 2)) p.edge_max = voxel * random.uniform(1.5, 9.5);
}

void choose_second(Case& c) {
  Random random = draws(c.seed, Part::kRuns);
  Way& way = c.second;
  constexpr int kThreads[] = {1, 2, 2, 3, 3, 8};
  way.threads = random.one_of(kThreads);
  // The best that the machine has of what was drawn.
  constexpr size_t kTargets[] = {0, 1, 2, 3};
  const std::vector<plc::SimdTarget> targets = plc::available_simd_targets();
  const size_t target = std::min(random.one_of(kTargets), targets.size() - 1);
  way.simd = static_cast<plc_simd>(PLC_SIMD_SCALAR + static_cast<int>(targets[target]));
  c.work = once_in(random, 60) ? 500000 : 15000;
  way.own_memory = once_in(random, 4);
  way.backwards = once_in(random, 6);
  way.strided = once_in(random, 4);
  way.steps = random.integer(0, 1) == 0;
  way.ownership = random.integer(0, 1) == 0 ? PLC_COPY : PLC_BORROW;
  constexpr plc_amount kAmounts[] = {PLC_ONE_ITERATION, PLC_ONE_ITERATION, PLC_ONE_LEVEL,
                                     PLC_ALL_LEVELS};
  way.amount = random.one_of(kAmounts);
  if (once_in(random, 3)) way.pause_at = static_cast<int>(random.integer(1, 40));
  if (once_in(random, 3)) way.save_at = static_cast<int>(random.integer(0, 40));
  if (once_in(random, 3)) way.look_every = static_cast<int>(random.integer(1, 12));
  if (once_in(random, 12)) way.memory_part = random.uniform(0, 1);
}

}  // namespace

plc::Frame Case::frame() const {
  plc::Frame f;
  std::copy_n(image.spacing, 3, f.spacing.begin());
  std::copy_n(image.origin, 3, f.origin.begin());
  std::copy_n(image.direction, 9, f.direction.begin());
  return f;
}

plc_extras Case::extras() const {
  plc_extras e;
  plc_extras_defaults(&e);
  e.space = space;
  if (!seeds.empty() && !without_seeds) {
    e.seeds = seeds.data();
    e.seed_count = bad_count ? -1 : static_cast<int64_t>(seeds.size());
  } else if (bad_count) {
    e.seed_count = -1;
  }
  if (!mask_voxels.empty() && !without_mask) e.mask = &mask;
  if (!mesh.abc.empty() && !without_mesh) {
    e.mesh_xyz = mesh.xyz.data();
    e.mesh_vertex_count = static_cast<int64_t>(mesh.vertex_count());
    e.mesh_abc = mesh.abc.data();
    e.mesh_face_count = static_cast<int64_t>(mesh.face_count());
  }
  e.attachments = attachments.data();
  e.attachment_count = static_cast<int64_t>(attachments.size());
  e.pins = pins.data();
  e.pin_count = static_cast<int64_t>(pins.size());
  return e;
}

const char* init_name(plc_init init) {
  return init <= PLC_INIT_AUTO ? kInitNames[init] : "?";
}

Case make_case(uint64_t seed) {
  Case c;
  c.seed = seed;
  plc_parameters_defaults(&c.parameters);
  choose_image(c);
  choose_pyramid(c);
  choose_model(c);
  choose_values(c);
  choose_start(c);
  choose_extras(c);
  choose_second(c);
  c.refusals.push_back({PLC_CANCELLED, "cancelled"});
  c.refusals.push_back({PLC_INVALID_DATA, "no surface: nothing in the image holds one"});
  // Strong springs, as long as edges may be, let a mesh grow for ever.
  c.refusals.push_back({PLC_INVALID_DATA, "its forces drive it on without end"});
  Random rest = draws(seed, Part::kRest);
  // Without an iso-value a surface may drift where there are no edges, for a thousand iterations.
  if (once_in(rest, 8) && c.parameters.force != PLC_FORCE_GRADIENT) choose_rest(c, rest);
  choose_mesh(c);
  Random random = draws(seed, Part::kFault);
  if (once_in(random, 16)) choose_fault(c, random);
  return c;
}

std::string description(const Case& c) {
  const plc_parameters& p = c.parameters;
  const plc_image& image = c.image;
  const Way& way = c.second;
  std::ostringstream out;
  out.precision(9);
  const auto three = [&](const char* name, const auto* values) {
    out << ' ' << name << ' ' << values[0] << ',' << values[1] << ',' << values[2];
  };
  out << "seed " << c.seed << ": " << c.phantom << ' '
      << (image.type <= PLC_F32 ? kTypeNames[image.type] : "?");
  three("dims", image.dims);
  three("spacing", image.spacing);
  three("origin", image.origin);
  out << " direction";
  for (const double d : image.direction) out << ' ' << d;
  out << "\n  iso " << p.iso << " inside_below " << p.inside_below << " window " << p.window_low
      << ".." << p.window_high << " pad " << p.pad_value << " feature " << p.feature << " sigma "
      << p.feature_sigma << " level_iso";
  for (int h = 0; h < std::min(p.level_iso_count, PLC_MAX_LEVELS); ++h)
    out << ' ' << p.level_iso[h];
  out << "\n  levels " << p.levels << " reduction " << p.reduction << " anisotropy " << p.anisotropy
      << " init " << init_name(p.init);
  three("bubbles", p.bubbles);
  out << " seeds " << c.seeds.size() << " mask " << c.mask_voxels.size() << " mesh "
      << c.mesh.face_count() << " attachments " << c.attachments.size() << " pins " << c.pins.size()
      << " force " << static_cast<int>(c.force) << " x " << c.force_strength << "\n  curvature "
      << p.curvature << " spring " << p.spring << " rest " << p.rest_length << ' '
      << p.rest_length_value << " force " << p.force << " attraction " << p.attraction
      << " gradient " << p.gradient << ' ' << p.gradient_tangent << ' ' << p.gradient_bound
      << " mass " << p.mass << " damping " << p.damping << " time_step " << p.time_step << " mesh "
      << p.mesh << " tolerance " << p.tolerance << " edges " << p.edge_min << "," << p.edge_max
      << " max_move " << p.max_move << " bound " << p.bound << "\n  epsilon " << p.epsilon
      << " calm_speed " << p.calm_speed << " max_iterations " << p.max_iterations
      << " late_bubbles " << p.late_bubbles << " sleeping " << p.sleeping << " more "
      << c.more_level << " stop " << c.stop_level << " cancel " << c.cancel_at << " work " << c.work
      << " rests " << c.rests << "\n  space "
      << (c.space <= PLC_SPACE_VOXEL ? kSpaceNames[c.space] : "?")
      << (c.fault.empty() ? "" : ", wrong on purpose: ") << c.fault << "\n  second run: threads "
      << way.threads << " target " << way.simd << " steps " << way.steps << " ownership "
      << way.ownership << " amount " << way.amount << " pause " << way.pause_at << " save "
      << way.save_at << " look " << way.look_every << " strided " << way.strided << " own memory "
      << way.own_memory << " backwards " << way.backwards << " memory part " << way.memory_part
      << '\n';
  return out.str();
}

bool write_nrrd(const Case& c, const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return false;
  constexpr const char* kTypes[] = {"uint8", "int16", "uint16", "int32", "float"};
  const plc_image& i = c.image;
  std::fprintf(file,
               "NRRD0004\ntype: %s\ndimension: 3\nspace: left-posterior-superior\n"
               "sizes: %d %d %d\nspace directions:",
               kTypes[i.type], static_cast<int>(i.dims[0]), static_cast<int>(i.dims[1]),
               static_cast<int>(i.dims[2]));
  for (size_t a = 0; a < 3; ++a) {
    std::fprintf(file, " (%.17g,%.17g,%.17g)", i.direction[a] * i.spacing[a],
                 i.direction[3 + a] * i.spacing[a], i.direction[6 + a] * i.spacing[a]);
  }
  std::fprintf(file, "\nspace origin: (%.17g,%.17g,%.17g)\nendian: little\nencoding: raw\n\n",
               i.origin[0], i.origin[1], i.origin[2]);
  const bool written = std::fwrite(c.voxels.data(), 1, c.voxels.size(), file) == c.voxels.size();
  return std::fclose(file) == 0 && written;
}

bool write_off(const samples::Soup& mesh, const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) return false;
  std::fprintf(file, "OFF\n%zu %zu 0\n", mesh.vertex_count(), mesh.face_count());
  for (size_t i = 0; i < mesh.xyz.size(); i += 3) {
    std::fprintf(file, "%.9g %.9g %.9g\n", mesh.xyz[i], mesh.xyz[i + 1], mesh.xyz[i + 2]);
  }
  for (size_t i = 0; i < mesh.abc.size(); i += 3) {
    std::fprintf(file, "3 %u %u %u\n", mesh.abc[i], mesh.abc[i + 1], mesh.abc[i + 2]);
  }
  return std::fclose(file) == 0;
}

}  // namespace campaign

// The C API: what a surface tells about itself.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "tests/samples/sample_api.h"

namespace {

using samples::Context;
using samples::Surface;

constexpr plc_space kSpaces[] = {PLC_SPACE_LPS, PLC_SPACE_RAS, PLC_SPACE_VOXEL};
constexpr double kPi = 3.14159265358979323846;

// A ball, off the middle of a box of anisotropic voxels.
constexpr double kRadius = 6;
const samples::Volume& ball() {
  static const samples::Volume volume =
      samples::sampled(samples::empty_volume({20, 16, 14}, {1, 1.25, 1.5}), [](const auto& p) {
        return std::max(0.0, 1 - samples::norm(p[0] - 0.7, p[1] + 0.3, p[2]) / (2 * kRadius));
      });
  return volume;
}
// Its centre in voxel indices.
constexpr double kCentre[3] = {9.5 + 0.7, 7.5 - 0.3 / 1.25, 6.5};

struct Frame {
  const char* name;
  double direction[9];
};
constexpr double kHalf = 0.5, kRoot = 0.86602540378443865;
const Frame kFrames[] = {
    {"identity", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
    {"turned", {kHalf, -kRoot, 0, kRoot, kHalf, 0, 0, 0, 1}},
    {"mirrored in x", {-1, 0, 0, 0, 1, 0, 0, 0, 1}},
    {"axes swapped", {0, 1, 0, 1, 0, 0, 0, 0, 1}},
    {"turned and mirrored", {kHalf, kRoot, 0, kRoot, -kHalf, 0, 0, 0, 1}},
    {"all mirrored", {-1, 0, 0, 0, -1, 0, 0, 0, -1}},
};

plc_image framed(const Frame& frame) {
  plc_image image = samples::image_of(ball());
  std::copy_n(frame.direction, 9, image.direction);
  image.origin[0] = 100;
  image.origin[1] = -50;
  image.origin[2] = 7.5;
  return image;
}

// Where a voxel index lies in the space, by the definition of the header.
std::array<double, 3> placed(const plc_image& image, plc_space space, const double (&voxel)[3]) {
  std::array<double, 3> p{};
  for (size_t i = 0; i < 3; ++i) {
    if (space == PLC_SPACE_VOXEL) {
      p[i] = voxel[i];
      continue;
    }
    p[i] = image.origin[i];
    for (size_t j = 0; j < 3; ++j) {
      p[i] += image.direction[3 * i + j] * image.spacing[j] * voxel[j];
    }
    if (space == PLC_SPACE_RAS && i < 2) p[i] = -p[i];
  }
  return p;
}

}  // namespace

TEST_CASE("the surface lies where the image has it, in every space and frame", "[pellicle]") {
  const Context context = samples::make_context();
  for (const Frame& frame : kFrames) {
    const plc_image image = framed(frame);
    const Surface surface = samples::extract(context.get(), image, samples::parameters(0.5, 0));
    const auto voxels = samples::positions(surface.get(), PLC_SPACE_VOXEL);
    for (const plc_space space : kSpaces) {
      CAPTURE(frame.name, static_cast<int>(space));
      const auto xyz = samples::positions(surface.get(), space);
      const auto centre = placed(image, space, kCentre);
      double worst = 0, farthest = 0, nearest = 1e9;
      for (size_t i = 0; i < xyz.size(); i += 3) {
        const auto expected = placed(image, space, {voxels[i], voxels[i + 1], voxels[i + 2]});
        double squared = 0;
        for (size_t a = 0; a < 3; ++a) {
          worst = std::max(worst, std::abs(xyz[i + a] - expected[a]));
          squared += (xyz[i + a] - centre[a]) * (xyz[i + a] - centre[a]);
        }
        farthest = std::max(farthest, std::sqrt(squared));
        nearest = std::min(nearest, std::sqrt(squared));
      }
      CHECK(worst < 1e-4);
      if (space == PLC_SPACE_VOXEL) continue;
      CHECK(farthest < kRadius + 0.3);
      CHECK(nearest > kRadius - 0.3);
    }
  }
}

TEST_CASE("faces and normals look outward in every space, also where it is mirrored",
          "[pellicle]") {
  const Context context = samples::make_context();
  for (const Frame& frame : kFrames) {
    const plc_image image = framed(frame);
    const Surface surface = samples::extract(context.get(), image, samples::parameters(0.5, 0));
    for (const plc_space space : kSpaces) {
      CAPTURE(frame.name, static_cast<int>(space));
      const plc_measures measures = samples::measured(context.get(), surface.get(), space);
      const double voxel_volume = space == PLC_SPACE_VOXEL ? 1 : 1 * 1.25 * 1.5;
      CHECK(measures.volume * (1.875 / voxel_volume) ==
            Approx(4.0 / 3 * kPi * kRadius * kRadius * kRadius).epsilon(0.08));
      CHECK(measures.euler == 2);
      CHECK(measures.genus == 0);
      CHECK(measures.components == 1);
      CHECK(measures.vertices == plc_surface_vertex_count(surface.get()));
      CHECK(measures.faces == plc_surface_face_count(surface.get()));
      const auto xyz = samples::positions(surface.get(), space);
      const auto n = samples::normals(surface.get(), space);
      const auto centre = placed(image, space, kCentre);
      for (size_t i = 0; i < n.size(); i += 3) {
        double outward = 0, squared = 0;
        for (size_t a = 0; a < 3; ++a) {
          outward += static_cast<double>(n[i + a]) * (xyz[i + a] - centre[a]);
          squared += static_cast<double>(n[i + a]) * n[i + a];
        }
        CHECK(outward > 0);
        CHECK(squared == Approx(1).epsilon(1e-5));
      }
    }
  }
}

TEST_CASE("the surface is valid by the check of any mesh", "[pellicle]") {
  const Context context = samples::make_context();
  const Surface surface =
      samples::extract(context.get(), framed(kFrames[4]), samples::parameters(0.5, 1));
  for (const plc_space space : kSpaces) {
    const auto floats = samples::positions(surface.get(), space);
    const std::vector<double> xyz(floats.begin(), floats.end());
    const auto abc = samples::faces(surface.get(), space);
    plc_check check{};
    check.struct_size = sizeof check;
    REQUIRE(plc_check_mesh(context.get(), xyz.data(), static_cast<int64_t>(xyz.size() / 3),
                           abc.data(), static_cast<int64_t>(abc.size() / 3), &check) == PLC_OK);
    CHECK(check.valid == 1);
    CHECK(check.outward == 1);
    CHECK(check.measures.struct_size == sizeof(plc_measures));
    CHECK(check.measures.volume > 0);
  }
}

TEST_CASE("small voxels far away are told in doubles, where floats of them meet", "[pellicle]") {
  const Context context = samples::make_context();
  plc_image image = framed(kFrames[4]);
  const auto p = samples::parameters(0.5, 0);
  const Surface near = samples::extract(context.get(), image, p);
  for (double& x : image.spacing) x *= 1e-6;
  image.origin[0] = 1e5;
  const Surface far = samples::extract(context.get(), image, p);
  REQUIRE(plc_surface_hash(near.get()) == plc_surface_hash(far.get()));
  for (const plc_space space : kSpaces) {
    const auto floats = samples::positions(far.get(), space);
    const auto xyz = samples::positions_f64(far.get(), space);
    const auto abc = samples::faces(far.get(), space);
    REQUIRE(std::equal(floats.begin(), floats.end(), xyz.begin(),
                       [](float x, double y) { return x == static_cast<float>(y); }));
    const auto valid = [&](const std::vector<double>& points) {
      plc_check check{};
      check.struct_size = sizeof check;
      REQUIRE(plc_check_mesh(context.get(), points.data(), static_cast<int64_t>(points.size() / 3),
                             abc.data(), static_cast<int64_t>(abc.size() / 3), &check) == PLC_OK);
      return check.valid != 0;
    };
    CHECK(valid(xyz));
    CHECK(valid({floats.begin(), floats.end()}) == (space == PLC_SPACE_VOXEL));
    const auto expected = samples::normals(near.get(), space);
    const auto normals = samples::normals(far.get(), space);
    REQUIRE(std::equal(normals.begin(), normals.end(), expected.begin(),
                       [](float x, float y) { return std::abs(x - y) < 1e-4F; }));
  }
  double none = 7;
  CHECK(plc_surface_positions_f64(context.get(), near.get(), PLC_SPACE_LPS, &none, 1) ==
        PLC_INVALID_ARGUMENT);
  CHECK(plc_surface_positions_f64(context.get(), nullptr, PLC_SPACE_LPS, &none, 1) ==
        PLC_INVALID_ARGUMENT);
  CHECK(none == 7);
}

TEST_CASE("where a surface was frozen is told, in every space", "[pellicle]") {
  const Context context = samples::make_context();
  samples::Volume volume = samples::noise(samples::empty_volume({26, 26, 26}), 3, 1);
  samples::add_noise(volume, 0.2, 2);
  const plc_image image = samples::image_of(volume);
  plc_parameters uniform = samples::parameters(0.5, 1);
  uniform.mesh = PLC_MESH_UNIFORM;
  const Surface noisy = samples::extract(context.get(), image, uniform);
  int64_t count = 0;
  REQUIRE(plc_surface_frozen_sites(context.get(), noisy.get(), PLC_SPACE_LPS, nullptr, nullptr, 0,
                                   &count) == PLC_OK);
  REQUIRE(count > 0);
  const auto places = [&](plc_space space, std::vector<int64_t>& vertices) {
    std::vector<double> xyz(3 * static_cast<size_t>(count));
    vertices.resize(static_cast<size_t>(count));
    REQUIRE(plc_surface_frozen_sites(context.get(), noisy.get(), space, xyz.data(), vertices.data(),
                                     count, &count) == PLC_OK);
    return xyz;
  };
  std::vector<int64_t> vertices, again;
  const auto voxels = places(PLC_SPACE_VOXEL, vertices), lps = places(PLC_SPACE_LPS, again);
  CHECK(vertices == again);
  CHECK(std::is_sorted(vertices.rbegin(), vertices.rend()));
  const plc_level_report level = samples::level_of(noisy.get(), 1);
  CHECK(level.frozen_sites == count);
  CHECK(level.frozen_vertices == std::accumulate(vertices.begin(), vertices.end(), int64_t{0}));
  for (size_t i = 0; i < voxels.size(); i += 3) {
    const double voxel[3] = {voxels[i], voxels[i + 1], voxels[i + 2]};
    const auto expected = placed(image, PLC_SPACE_LPS, voxel);
    for (size_t a = 0; a < 3; ++a) {
      CHECK(voxel[a] > -1.5);
      CHECK(voxel[a] < 26.5);
      CHECK(lps[i + a] == Approx(expected[a]).margin(1e-4));
    }
  }
  double none = 7;
  int64_t there = 0;
  CHECK(plc_surface_frozen_sites(context.get(), noisy.get(), PLC_SPACE_LPS, &none, nullptr,
                                 count - 1, &there) == PLC_INVALID_ARGUMENT);
  CHECK(there == count);
  CHECK(plc_surface_frozen_sites(context.get(), noisy.get(), PLC_SPACE_LPS, &none, nullptr, 1,
                                 nullptr) == PLC_INVALID_ARGUMENT);
  CHECK(plc_surface_frozen_sites(context.get(), nullptr, PLC_SPACE_LPS, &none, nullptr, 1,
                                 &there) == PLC_INVALID_ARGUMENT);
  CHECK(none == 7);
  const Surface clean =
      samples::extract(context.get(), framed(kFrames[0]), samples::parameters(0.5, 0));
  CHECK(plc_surface_frozen_sites(context.get(), clean.get(), PLC_SPACE_LPS, nullptr, nullptr, 0,
                                 &there) == PLC_OK);
  CHECK(there == 0);
}

TEST_CASE("the frame changes nothing but the places: the hash is of mesh space", "[pellicle]") {
  const Context context = samples::make_context();
  const plc_parameters p = samples::parameters(0.5, 1);
  const uint64_t first =
      plc_surface_hash(samples::extract(context.get(), framed(kFrames[0]), p).get());
  for (const Frame& frame : kFrames) {
    CHECK(plc_surface_hash(samples::extract(context.get(), framed(frame), p).get()) == first);
  }
  CHECK(plc_surface_hash(
            samples::extract(context.get(), framed(kFrames[0]), samples::parameters(0.51, 1))
                .get()) != first);
}

TEST_CASE("levels are reported from coarse to fine", "[pellicle]") {
  const Context context = samples::make_context();
  plc_parameters p = samples::parameters(0.5, 2);
  p.reduction = 1.5;
  const Surface surface = samples::extract(context.get(), framed(kFrames[0]), p);
  REQUIRE(plc_surface_level_count(surface.get()) == 3);
  int64_t transformations = 0;
  for (int i = 0; i < 3; ++i) {
    const plc_level_report r = samples::level_of(surface.get(), i);
    const int h = 2 - i;
    CHECK(r.level == h);
    CHECK(r.unit == Approx(std::pow(1.5, h)));
    CHECK(r.delta == Approx(std::pow(1.5, h) / 1.2));
    // I_0 is 20 x 16 x 14 voxels and six of padding on every side.
    const int64_t padded[3] = {32, 28, 26};
    for (int a = 0; a < 3; ++a) {
      int64_t expected = padded[a];
      for (int level = 0; level < h; ++level) {
        expected = static_cast<int64_t>(std::floor(static_cast<double>(expected) / 1.5));
      }
      CHECK(std::abs(r.dims[a] - expected) <= 1);
      if (h == 0) CHECK(r.dims[a] == padded[a]);
    }
    CHECK(r.iterations >= 20);
    CHECK(r.converged == 1);
    CHECK(r.energy >= 0);
    CHECK(r.energy < 5e-6);
    CHECK(r.vertices > 0);
    CHECK((r.iso > 0 && r.iso <= 0.5));
    CHECK(r.seconds_total > 0);
    CHECK(r.seconds_topology + r.seconds_normals + r.seconds_dynamics <= 1.5 * r.seconds_total + 1);
    transformations += r.creations + r.inversions + r.deletions;
    if (h == 0) {
      CHECK(r.iso == Approx(0.5));
      CHECK(r.vertices == plc_surface_vertex_count(surface.get()));
    }
  }
  CHECK(transformations > 0);
  plc_level_report r{};
  const auto level = [&](int i, plc_level_report* report) {
    return plc_surface_level(context.get(), surface.get(), i, report);
  };
  CHECK(level(0, &r) == PLC_INVALID_ARGUMENT);
  r.struct_size = sizeof r;
  CHECK(level(-1, &r) == PLC_INVALID_ARGUMENT);
  CHECK(level(3, &r) == PLC_INVALID_ARGUMENT);
  CHECK(std::string(plc_context_message(context.get())) == "level 3: the surface has 3");
  CHECK(level(0, nullptr) == PLC_INVALID_ARGUMENT);
  CHECK(level(0, &r) == PLC_OK);
}

TEST_CASE("of a noisy image an adaptive mesh is recovered from the levels above it", "[pellicle]") {
  const Context context = samples::make_context();
  constexpr int64_t kSide = 56;
  const auto used_for = [&](double noise) {
    samples::Volume volume = samples::empty_volume({kSide, kSide, kSide});
    samples::Random random(4);
    for (int64_t i = 0; i < kSide * kSide * kSide; ++i) {
      const auto away = [=](int64_t k) { return static_cast<double>(k) - 0.5 * (kSide - 1); };
      const double r =
          std::hypot(away(i % kSide), away(i / kSide % kSide), away(i / kSide / kSide));
      const double value = std::clamp(0.5 + 0.1 * (14 - r), 0.0, 1.0);
      volume.values.push_back(static_cast<float>(value + random.uniform(-noise, noise)));
    }
    const Surface surface =
        samples::extract(context.get(), samples::image_of(volume), samples::parameters(0.5, -1));
    plc_measures measures{};
    measures.struct_size = sizeof measures;
    REQUIRE(plc_surface_measure(context.get(), surface.get(), PLC_SPACE_LPS, &measures) == PLC_OK);
    CHECK(measures.genus == 0);
    CHECK(measures.volume == Approx(4.0 / 3 * 3.14159 * 14 * 14 * 14).epsilon(0.05));
    return samples::parameters_of(surface.get());
  };
  CHECK(used_for(0.1).levels == 0);
  const plc_parameters used = used_for(0.6);
  CHECK(used.init == PLC_INIT_BUBBLE);
  REQUIRE(used.levels == 3);
  // The coarser ones cover the object, which lies where I_0 has it on the finest of them.
  CHECK(used.level_iso[0] < 0.45);
  CHECK(used.level_iso[2] == Approx(0.5));
  CHECK(used.level_iso[3] == Approx(0.5));
}

TEST_CASE("the parameters as used have everything filled in", "[pellicle]") {
  const Context context = samples::make_context();
  plc_parameters p = samples::parameters(0.5, -1);
  const Surface at_iso = samples::extract(context.get(), framed(kFrames[0]), p);
  CHECK(samples::parameters_of(at_iso.get()).init == PLC_INIT_ISO);
  CHECK(samples::parameters_of(at_iso.get()).levels == 0);
  p.init = PLC_INIT_BUBBLE;
  const Surface surface = samples::extract(context.get(), framed(kFrames[0]), p);
  const plc_parameters used = samples::parameters_of(surface.get());
  CHECK(used.struct_size == sizeof used);
  CHECK(used.levels == 3);
  CHECK(used.level_iso_count == 4);
  CHECK(used.level_iso[3] == Approx(0.5));
  CHECK(used.window_low < 0.5);
  CHECK(used.window_high > 0.5);
  CHECK(std::isfinite(used.pad_value));
  CHECK(used.curvature == p.curvature);
  plc_seconds seconds{};
  seconds.struct_size = sizeof seconds;
  REQUIRE(plc_surface_seconds(context.get(), surface.get(), &seconds) == PLC_OK);
  CHECK(seconds.images > 0);
  CHECK(seconds.preparation >= seconds.images);
  CHECK(seconds.evolution > 0);
  // Used again as they are they give the same surface.
  const Surface again = samples::extract(context.get(), framed(kFrames[0]), used);
  CHECK(plc_surface_hash(again.get()) == plc_surface_hash(surface.get()));
}

TEST_CASE("iso-values of levels are taken as given, coarse to fine", "[pellicle]") {
  const Context context = samples::make_context();
  plc_parameters p = samples::parameters(0.5, 1);
  p.window_low = 0;
  p.window_high = 1;
  p.level_iso_count = 2;
  p.level_iso[0] = 0.45;
  p.level_iso[1] = 0.4;
  const Surface surface = samples::extract(context.get(), framed(kFrames[0]), p);
  CHECK(samples::level_of(surface.get(), 0).iso == Approx(0.45));
  CHECK(samples::level_of(surface.get(), 1).iso == Approx(0.4));
}

TEST_CASE("a dark object in a bright image is the same surface", "[pellicle]") {
  const Context context = samples::make_context();
  samples::Volume dark = ball();
  for (float& value : dark.values) value = 3 - 2 * value;
  plc_image image = framed(kFrames[0]);
  const Surface bright = samples::extract(context.get(), image, samples::parameters(0.5, 1));
  image.voxels = dark.values.data();
  plc_parameters p = samples::parameters(2, 1);
  p.inside_below = 1;
  const Surface surface = samples::extract(context.get(), image, p);
  const plc_measures one = samples::measured(context.get(), bright.get(), PLC_SPACE_LPS);
  const plc_measures other = samples::measured(context.get(), surface.get(), PLC_SPACE_LPS);
  CHECK(other.volume == Approx(one.volume).epsilon(0.01));
  CHECK(other.area == Approx(one.area).epsilon(0.01));
  CHECK(other.euler == 2);
}

TEST_CASE("both methods for anisotropic images find the ball in mm", "[pellicle]") {
  const Context context = samples::make_context();
  for (const plc_anisotropy method : {PLC_ANISOTROPY_PHYSICAL, PLC_ANISOTROPY_VOXEL}) {
    plc_parameters p = samples::parameters(0.5, 1);
    p.anisotropy = method;
    const Surface surface = samples::extract(context.get(), framed(kFrames[1]), p);
    const plc_measures m = samples::measured(context.get(), surface.get(), PLC_SPACE_RAS);
    CHECK(m.volume == Approx(4.0 / 3 * kPi * kRadius * kRadius * kRadius).epsilon(0.08));
    CHECK(m.area == Approx(4 * kPi * kRadius * kRadius).epsilon(0.06));
  }
}

TEST_CASE("measures of another struct size are refused", "[pellicle]") {
  const Context context = samples::make_context();
  const Surface surface =
      samples::extract(context.get(), framed(kFrames[0]), samples::parameters(0.5, 0));
  plc_measures measures{};
  CHECK(plc_surface_measure(context.get(), surface.get(), PLC_SPACE_LPS, &measures) ==
        PLC_INVALID_ARGUMENT);
}

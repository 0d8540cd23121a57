// The C API: starts from seeds, masks and meshes, and what is wrong with extras.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>

#include "tests/samples/sample_api.h"

namespace {

using Catch::Matchers::Contains;
using samples::Context;
using samples::Surface;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A ball about the middle of a box of anisotropic voxels.
constexpr double kRadius = 6;
const samples::Volume& ball() {
  static const samples::Volume volume =
      samples::sampled(samples::empty_volume({20, 16, 14}, {1, 1.25, 1.5}), [](const auto& p) {
        return std::max(0.0, 1 - samples::norm(p[0], p[1], p[2]) / (2 * kRadius));
      });
  return volume;
}
constexpr std::array<double, 3> kMiddle = {9.5, 7.5, 6.5};  // voxels

double ball_volume(double r) {
  return 4.0 / 3 * 3.14159265358979 * r * r * r;
}

// Turned about z, and mirrored: x and y to the right and the front.
plc_image framed(bool mirrored) {
  plc_image image = samples::image_of(ball());
  const double turned[9] = {0.5, -0.86602540378443865, 0, 0.86602540378443865, 0.5, 0, 0, 0, 1};
  std::copy_n(turned, 9, image.direction);
  if (mirrored) {
    for (const size_t i : {2U, 5U, 8U}) image.direction[i] *= -1;
  }
  image.origin[0] = 100;
  image.origin[1] = -50;
  image.origin[2] = 7.5;
  return image;
}

// Where a voxel lies, by the definition of the header.
std::array<double, 3> place_of(const plc_image& image, const std::array<double, 3>& voxel,
                               plc_space space) {
  std::array<double, 3> p{};
  for (size_t i = 0; i < 3; ++i) {
    p[i] = image.origin[i];
    for (size_t j = 0; j < 3; ++j) {
      p[i] += image.direction[3 * i + j] * image.spacing[j] * voxel[j];
    }
    if (space == PLC_SPACE_RAS && i < 2) p[i] *= -1;
    if (space == PLC_SPACE_VOXEL) p[i] = voxel[i];
  }
  return p;
}

std::array<double, 3> middle(const plc_image& image, plc_space space) {
  return place_of(image, kMiddle, space);
}

plc_parameters starting(plc_init init) {
  plc_parameters p = samples::parameters(0.5, 0);
  p.init = init;
  return p;
}

void check_ball(plc_context* context, const plc_surface* surface) {
  const plc_measures m = samples::measured(context, surface, PLC_SPACE_LPS);
  CHECK(m.components == 1);
  CHECK(m.genus == 0);
  CHECK(m.volume == Approx(ball_volume(kRadius)).epsilon(0.08));
}

struct Mesh {
  std::vector<double> xyz;
  std::vector<uint32_t> abc;

  Mesh(const plc_surface* surface, plc_space space) : abc(samples::faces(surface, space)) {
    for (const float x : samples::positions(surface, space)) {
      xyz.push_back(static_cast<double>(x));
    }
  }
  plc_extras extras(plc_space space) const {
    plc_extras e = samples::no_extras();
    e.space = space;
    e.mesh_xyz = xyz.data();
    e.mesh_vertex_count = static_cast<int64_t>(xyz.size() / 3);
    e.mesh_abc = abc.data();
    e.mesh_face_count = static_cast<int64_t>(abc.size() / 3);
    return e;
  }
};

// The message of an extraction that must fail for its extras.
std::string failure(plc_init init, const std::function<void(plc_extras&)>& change,
                    plc_status expected = PLC_INVALID_ARGUMENT) {
  const Context context = samples::make_context();
  const plc_image image = samples::image_of(ball());
  const plc_parameters p = starting(init);
  plc_extras extras = samples::no_extras();
  change(extras);
  auto* surface = reinterpret_cast<plc_surface*>(&extras);
  CHECK(plc_extract(context.get(), &image, &p, &extras, &surface) == expected);
  CHECK(surface == nullptr);
  std::string message = plc_context_message(context.get());
  CHECK_THAT(message, !Contains("\n"));
  return message;
}

constexpr plc_space kSpaces[] = {PLC_SPACE_LPS, PLC_SPACE_RAS, PLC_SPACE_VOXEL};

}  // namespace

TEST_CASE("extras hold nothing by default", "[pellicle]") {
  const plc_extras e = samples::no_extras();
  CHECK(e.struct_size == sizeof e);
  CHECK(e.space == PLC_SPACE_LPS);
  CHECK((e.progress == nullptr && e.level == nullptr && e.force == nullptr));
  CHECK((e.seeds == nullptr && e.mask == nullptr && e.mesh_xyz == nullptr));
  CHECK((e.attachments == nullptr && e.pins == nullptr));
  CHECK(e.seed_count + e.mesh_face_count + e.attachment_count + e.pin_count == 0);
}

TEST_CASE("seeds lie where they are put, in every space and frame", "[pellicle]") {
  const Context context = samples::make_context();
  for (const bool mirrored : {false, true}) {
    const plc_image image = framed(mirrored);
    for (const plc_space space : kSpaces) {
      const auto at = middle(image, space);
      const plc_seed seed{{at[0], at[1], at[2]}, 3};  // mm, in voxel space too
      plc_extras extras = samples::no_extras();
      extras.space = space;
      extras.seeds = &seed;
      extras.seed_count = 1;
      // Before it has moved.
      plc_parameters p = starting(PLC_INIT_SEEDS);
      p.max_iterations = 1;
      p.max_move = 1e-4;
      p.late_bubbles = 0;
      const Surface start = samples::extract(context.get(), image, p, &extras);
      const plc_measures m = samples::measured(context.get(), start.get(), PLC_SPACE_LPS);
      CHECK(m.volume == Approx(ball_volume(3)).epsilon(0.25));
      const auto lps = middle(image, PLC_SPACE_LPS);
      std::array<double, 3> mean{};
      const std::vector<float> xyz = samples::positions(start.get(), PLC_SPACE_LPS);
      for (size_t i = 0; i < xyz.size(); ++i) {
        mean[i % 3] += static_cast<double>(xyz[i]) * 3 / static_cast<double>(xyz.size());
      }
      for (size_t a = 0; a < 3; ++a) CHECK(mean[a] == Approx(lps[a]).margin(0.3));
      // And grown.
      const Surface grown =
          samples::extract(context.get(), image, starting(PLC_INIT_SEEDS), &extras);
      check_ball(context.get(), grown.get());
    }
  }
}

TEST_CASE("a mask of any type starts the surface where it is not 0", "[pellicle]") {
  const Context context = samples::make_context();
  const plc_image image = framed(false);
  std::vector<int16_t> voxels;
  for (const float value : ball().values) voxels.push_back(value > 0.7F ? -3 : 0);
  plc_image mask;
  plc_image_defaults(&mask);  // its frame is not looked at
  mask.type = PLC_I16;
  mask.voxels = voxels.data();
  std::copy_n(image.dims, 3, mask.dims);
  plc_extras extras = samples::no_extras();
  extras.mask = &mask;
  plc_parameters p = starting(PLC_INIT_MASK);
  for (const int levels : {0, 1}) {
    p.levels = levels;
    check_ball(context.get(), samples::extract(context.get(), image, p, &extras).get());
  }
  p.levels = 0;
  p.max_iterations = 1;
  p.max_move = 1e-4;
  p.late_bubbles = 0;
  const Surface start = samples::extract(context.get(), image, p, &extras);
  CHECK(samples::measured(context.get(), start.get(), PLC_SPACE_LPS).volume ==
        Approx(ball_volume(0.6 * kRadius)).epsilon(0.3));
}

TEST_CASE("the iso-surface of the coarsest image is a start", "[pellicle]") {
  const Context context = samples::make_context();
  for (const int levels : {0, 1}) {
    plc_parameters p = starting(PLC_INIT_ISO);
    p.levels = levels;
    check_ball(context.get(), samples::extract(context.get(), framed(true), p).get());
  }
}

TEST_CASE("a surface that was extracted goes in again, in every space and frame", "[pellicle]") {
  const Context context = samples::make_context();
  for (const bool mirrored : {false, true}) {
    const plc_image image = framed(mirrored);
    const Surface first = samples::extract(context.get(), image, starting(PLC_INIT_BUBBLE));
    const double volume = samples::measured(context.get(), first.get(), PLC_SPACE_LPS).volume;
    for (const plc_space space : kSpaces) {
      const Mesh mesh(first.get(), space);
      const plc_extras extras = mesh.extras(space);
      const Surface again =
          samples::extract(context.get(), image, starting(PLC_INIT_MESH), &extras);
      check_ball(context.get(), again.get());
      CHECK(samples::measured(context.get(), again.get(), PLC_SPACE_LPS).volume ==
            Approx(volume).epsilon(0.01));
      // It was there already.
      plc_level_report before{}, after{};
      before.struct_size = after.struct_size = sizeof before;
      before = samples::level_of(first.get(), 0);
      after = samples::level_of(again.get(), 0);
      CHECK(after.iterations < before.iterations);
      CHECK(after.late_bubbles == 0);
    }
  }
}

TEST_CASE("a mesh given in the wrong space is inside out or elsewhere, and refused", "[pellicle]") {
  const Context context = samples::make_context();
  const plc_image image = framed(true);
  const Surface first = samples::extract(context.get(), image, starting(PLC_INIT_BUBBLE));
  Mesh mesh(first.get(), PLC_SPACE_LPS);
  for (size_t f = 0; f < mesh.abc.size(); f += 3) std::swap(mesh.abc[f + 1], mesh.abc[f + 2]);
  plc_surface* surface = nullptr;
  const plc_parameters p = starting(PLC_INIT_MESH);
  plc_extras extras = mesh.extras(PLC_SPACE_LPS);
  CHECK(plc_extract(context.get(), &image, &p, &extras, &surface) == PLC_INVALID_DATA);
  CHECK_THAT(plc_context_message(context.get()), Contains("wrongly oriented"));
  CHECK(surface == nullptr);
}

TEST_CASE("what is wrong with a mesh is told at the places that were given", "[pellicle]") {
  const Context context = samples::make_context();
  const plc_image image = framed(true);
  const Surface first = samples::extract(context.get(), image, starting(PLC_INIT_BUBBLE));
  Mesh mesh(first.get(), PLC_SPACE_RAS);
  mesh.abc[1] = mesh.abc[0];
  double middle[3];
  for (size_t a = 0; a < 3; ++a) {
    middle[a] = (2 * mesh.xyz[3 * mesh.abc[0] + a] + mesh.xyz[3 * mesh.abc[2] + a]) / 3;
  }
  char place[96];
  std::snprintf(place, sizeof place, "at (%.6g, %.6g, %.6g)", middle[0], middle[1], middle[2]);
  plc_surface* surface = nullptr;
  for (const plc_anisotropy method : {PLC_ANISOTROPY_VOXEL, PLC_ANISOTROPY_PHYSICAL}) {
    plc_parameters p = starting(PLC_INIT_MESH);
    p.anisotropy = method;
    plc_extras extras = mesh.extras(PLC_SPACE_RAS);
    CHECK(plc_extract(context.get(), &image, &p, &extras, &surface) == PLC_INVALID_DATA);
    CHECK_THAT(plc_context_message(context.get()), Contains("repeats a vertex") && Contains(place));
  }
}

TEST_CASE("starts that lack what they start from are refused", "[pellicle]") {
  const auto nothing = [](plc_extras&) {};
  CHECK(failure(PLC_INIT_SEEDS, nothing) == "seeds: none given");
  CHECK(failure(PLC_INIT_MESH, nothing) == "mesh: none given");
  CHECK(failure(PLC_INIT_MASK, nothing) == "mask: none given for PLC_INIT_MASK");
}

TEST_CASE("extras of another version, and arrays that are none, are refused", "[pellicle]") {
  const auto wrong = [](const std::function<void(plc_extras&)>& change) {
    return failure(PLC_INIT_BUBBLE, change);
  };
  CHECK_THAT(wrong([](auto& e) { e.struct_size = 4; }), Contains("struct_size"));
  CHECK(wrong([](auto& e) { e.space = static_cast<plc_space>(3); }) == "space: not a plc_space");
  CHECK(wrong([](auto& e) { e.seed_count = 1; }) == "seeds: must not be NULL");
  CHECK(wrong([](auto& e) { e.mesh_vertex_count = 4; }) == "mesh vertices: must not be NULL");
  CHECK(wrong([](auto& e) { e.mesh_face_count = 4; }) == "mesh faces: must not be NULL");
  CHECK(wrong([](auto& e) { e.attachment_count = 1; }) == "attachments: must not be NULL");
  CHECK(wrong([](auto& e) { e.pin_count = 1; }) == "pins: must not be NULL");
  CHECK(wrong([](auto& e) { e.seed_count = -1; }) == "seeds: a negative count");
  CHECK(wrong([](auto& e) { e.mesh_vertex_count = -4; }) == "mesh vertices: a negative count");
  CHECK(wrong([](auto& e) { e.mesh_face_count = -4; }) == "mesh faces: a negative count");
  CHECK(wrong([](auto& e) { e.attachment_count = -1; }) == "attachments: a negative count");
  CHECK(wrong([](auto& e) { e.pin_count = -2; }) == "pins: a negative count");
  CHECK(wrong([](auto& e) { e.pin_count = (1 << 24) + 1; }) == "pins: more than 16777216");
  CHECK(wrong([](auto& e) { e.mesh_face_count = (int64_t{1} << 32) + 1; }) ==
        "mesh faces: more than 4294967296");
}

TEST_CASE("places and radii that cannot be are refused by number", "[pellicle]") {
  const auto seeds = [](plc_seed last) {
    const plc_seed both[2] = {{{9, 9, 9}, 3}, last};
    return failure(PLC_INIT_SEEDS, [&](auto& e) {
      e.seeds = both;
      e.seed_count = 2;
    });
  };
  CHECK(seeds({{9, kNan, 9}, 3}) == "seed 1: its place is not finite");
  CHECK(seeds({{9, 9, kInfinity}, 3}) == "seed 1: its place is not finite");
  CHECK(seeds({{9, 9, 9}, 0}) == "seed 1: radius 0.000000 is not a positive length");
  CHECK_THAT(seeds({{9, 9, 9}, kNan}), Contains("seed 1: radius"));
  CHECK_THAT(seeds({{9, 9, 9}, kInfinity}), Contains("seed 1: radius"));
  CHECK_THAT(seeds({{9, 9, 9}, 0.1}), Contains("too small for level 0"));
  for (const double radius : {1e300, 3000.0}) {
    CHECK_THAT(seeds({{9, 9, 9}, radius}), Contains("beyond the image"));
  }
  CHECK(seeds({{9, 9, 9}, 3}) == "seed 1: touches seed 0 on level 0");

  const auto pin = [](const plc_pin& one) {
    return failure(PLC_INIT_BUBBLE, [&](auto& e) {
      e.pins = &one;
      e.pin_count = 1;
    });
  };
  CHECK(pin({{kNan, 0, 0}, 3}) == "pin 0: its place is not finite");
  CHECK(pin({{0, 0, 0}, -1}) == "pin 0: radius -1.000000 is not a positive length");

  const auto attachment = [](const plc_attachment& one) {
    return failure(PLC_INIT_BUBBLE, [&](auto& e) {
      e.attachments = &one;
      e.attachment_count = 1;
    });
  };
  CHECK(attachment({{0, kInfinity, 0}, 3, 1}) == "attachment 0: its place is not finite");
  CHECK_THAT(attachment({{0, 0, 0}, 0, 1}), Contains("attachment 0: radius"));
  for (const double strength : {-1.0, 2e6, kNan}) {
    CHECK_THAT(attachment({{0, 0, 0}, 3, strength}),
               Contains("attachment 0: strength") && Contains("is not within 0 .. 1e6"));
  }
}

TEST_CASE("places outside the image are refused with the place, and the image's bounds",
          "[pellicle]") {
  const Context context = samples::make_context();
  const plc_image image = framed(true);
  plc_parameters p = starting(PLC_INIT_SEEDS);
  p.max_iterations = 1;
  p.late_bubbles = 0;
  // Just within half a voxel of the outermost centres, and just beyond it, on each side.
  for (const plc_space space : kSpaces) {
    for (size_t axis = 0; axis < 3; ++axis) {
      for (const bool high : {false, true}) {
        for (const bool beyond : {false, true}) {
          std::array<double, 3> voxel = kMiddle;
          const double past = beyond ? 0.51 : 0.49;
          voxel[axis] = high ? static_cast<double>(image.dims[axis] - 1) + past : -past;
          const auto at = place_of(image, voxel, space);
          const plc_seed seed{{at[0], at[1], at[2]}, 3};
          const plc_pin pin{{at[0], at[1], at[2]}, 3};
          const plc_attachment attachment{{at[0], at[1], at[2]}, 3, 1};
          for (const std::string name : {"seed 0", "pin 0", "attachment 0"}) {
            CAPTURE(space, axis, high, beyond, name);
            plc_extras e = samples::no_extras();
            e.space = space;
            const auto middle_place = middle(image, space);
            const plc_seed inside{{middle_place[0], middle_place[1], middle_place[2]}, 3};
            e.seeds = name == "seed 0" ? &seed : &inside;
            e.seed_count = 1;
            e.pins = &pin;
            e.pin_count = name == "pin 0" ? 1 : 0;
            e.attachments = &attachment;
            e.attachment_count = name == "attachment 0" ? 1 : 0;
            plc_surface* surface = nullptr;
            const plc_status status = plc_extract(context.get(), &image, &p, &e, &surface);
            const Surface owner(surface);
            CHECK(status == (beyond ? PLC_INVALID_ARGUMENT : PLC_OK));
            if (beyond) {
              CHECK_THAT(plc_context_message(context.get()),
                         Contains(name + ": lies at (") && Contains("outside the image"));
            }
          }
        }
      }
    }
  }
}

TEST_CASE("the bounds of the image are told in the space of the places", "[pellicle]") {
  const auto message = [](plc_space space, const plc_pin& pin) {
    return failure(PLC_INIT_BUBBLE, [&](auto& e) {
      e.space = space;
      e.pins = &pin;
      e.pin_count = 1;
    });
  };
  CHECK(message(PLC_SPACE_VOXEL, {{9, -3, 9}, 3}) ==
        "pin 0: lies at (9, -3, 9), outside the image, which reaches from (-0.5, -0.5, -0.5) to "
        "(19.5, 15.5, 13.5) (voxels)");
  CHECK(message(PLC_SPACE_LPS, {{9, 1e300, 9}, 3}) ==
        "pin 0: lies at (9, 1e+300, 9), outside the image, which reaches from (-0.5, -0.625, "
        "-0.75) to (19.5, 19.375, 20.25) (LPS, mm)");
  CHECK_THAT(message(PLC_SPACE_RAS, {{9, 9, 9}, 3}),
             Contains("from (-19.5, -19.375, -0.75) to (0.5, 0.625, 20.25) (RAS, mm)"));
}

TEST_CASE("places, normals and measures are those of a sheared image", "[pellicle]") {
  const Context context = samples::make_context();
  // Two balls, of which only one is started in.
  const samples::Volume volume =
      samples::sampled(samples::empty_volume({44, 20, 20}, {1, 1, 1}), [](const auto& p) {
        return std::max(0.0, 1 - samples::norm(std::abs(p[0]) - 11, p[1], p[2]) / (2 * kRadius));
      });
  plc_image straight = samples::image_of(volume);
  plc_image sheared = straight;
  // The second axis leans by 30 degrees towards the first one, the third one is mirrored.
  const double leaning[9] = {1, 0.5, 0, 0, 0.86602540378443865, 0, 0, 0, -1};
  std::copy_n(leaning, 9, sheared.direction);
  const double part = 0.86602540378443865;
  std::vector<Surface> surfaces;
  for (const plc_image& image : {straight, sheared}) {
    const auto at = place_of(image, {10.5, 9.5, 9.5}, PLC_SPACE_LPS);
    const plc_seed seed{{at[0], at[1], at[2]}, 5};
    plc_extras extras = samples::no_extras();
    extras.seeds = &seed;
    extras.seed_count = 1;
    surfaces.push_back(samples::extract(context.get(), image, starting(PLC_INIT_SEEDS), &extras));
  }
  const plc_surface* surface = surfaces[1].get();
  const plc_measures voxels = samples::measured(context.get(), surface, PLC_SPACE_VOXEL);
  CHECK(voxels.components == 2);
  for (const plc_space space : {PLC_SPACE_LPS, PLC_SPACE_RAS}) {
    CHECK(samples::measured(context.get(), surface, space).volume ==
          Approx(part * voxels.volume).epsilon(1e-6));
  }
  CHECK(samples::level_of(surface, 0).late_bubbles == 1);
  CHECK(samples::level_of(surface, 0).late_volume ==
        Approx(part * samples::level_of(surfaces[0].get(), 0).late_volume).epsilon(0.01));
  const auto indices = samples::positions(surface, PLC_SPACE_VOXEL);
  const auto places = samples::positions(surface, PLC_SPACE_LPS);
  std::vector<float> normals(places.size());
  REQUIRE(plc_surface_normals(context.get(), surface, PLC_SPACE_LPS, normals.data(),
                              static_cast<int64_t>(normals.size() / 3)) == PLC_OK);
  double least = 1;
  double off = 0;
  for (size_t v = 0; v < places.size(); v += 3) {
    std::array<double, 3> voxel{}, to_centre{};
    for (size_t a = 0; a < 3; ++a) voxel[a] = static_cast<double>(indices[v + a]);
    const auto expected = place_of(sheared, voxel, PLC_SPACE_LPS);
    // Of a leaning ball: its axis through the place, by the inverse transposed.
    const double middle_x = voxel[0] < 21.5 ? 10.5 : 32.5;
    const std::array<double, 3> ray{voxel[0] - middle_x, voxel[1] - 9.5, voxel[2] - 9.5};
    to_centre = {ray[0], (ray[1] - 0.5 * ray[0]) / part, -ray[2]};
    const double length = samples::norm(to_centre[0], to_centre[1], to_centre[2]);
    double along = 0;
    for (size_t a = 0; a < 3; ++a) {
      off = std::max(off, std::abs(expected[a] - static_cast<double>(places[v + a])));
      along += static_cast<double>(normals[v + a]) * to_centre[a] / length;
    }
    least = std::min(least, along);
  }
  CHECK(off < 1e-4);
  CHECK(least > 0.8);
  plc_check check{};
  check.struct_size = sizeof check;
  REQUIRE(plc_surface_check(context.get(), surface, &check) == PLC_OK);
  CHECK(check.valid == 1);
}

TEST_CASE("masks that do not fit are refused", "[pellicle]") {
  const std::vector<uint8_t> voxels(static_cast<size_t>(20 * 16 * 14), 0);
  const auto mask = [&](const std::function<void(plc_image&)>& change,
                        plc_status expected = PLC_INVALID_ARGUMENT) {
    plc_image image = samples::image_of(ball());
    image.type = PLC_U8;
    image.voxels = voxels.data();
    change(image);
    return failure(
        PLC_INIT_MASK, [&](auto& e) { e.mask = &image; }, expected);
  };
  CHECK_THAT(mask([](auto& m) { m.struct_size = 1; }), Contains("mask: struct_size"));
  CHECK(mask([](auto& m) { m.voxels = nullptr; }) == "mask: no voxels");
  CHECK(mask([](auto& m) { m.type = static_cast<plc_voxel_type>(7); }) ==
        "mask: type is not a plc_voxel_type");
  CHECK(mask([](auto& m) { m.dims[1] = 17; }) ==
        "mask of 20 x 17 x 14 voxels: the image has 20 x 16 x 14");
  CHECK(mask([](auto&) {}, PLC_INVALID_DATA) == "mask: every voxel is 0");
}

TEST_CASE("a mesh that is no surface is refused with what is wrong and where", "[pellicle]") {
  const double xyz[] = {5, 5, 5, 12, 5, 5, 5, 12, 5, 5, 5, 12};
  const uint32_t abc[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const auto mesh = [&](int64_t vertices, int64_t faces) {
    return failure(
        PLC_INIT_MESH,
        [&](auto& e) {
          e.mesh_xyz = xyz;
          e.mesh_abc = abc;
          e.mesh_vertex_count = vertices;
          e.mesh_face_count = faces;
        },
        PLC_INVALID_DATA);
  };
  CHECK_THAT(mesh(4, 3), Contains("mesh: ") && (Contains("open") || Contains("border")));
  CHECK_THAT(mesh(3, 4), Contains("mesh: "));
}

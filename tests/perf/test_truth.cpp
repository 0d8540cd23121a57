#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/schedule.h"
#include "perf/truth/deviations.h"
#include "perf/truth/inside_parts.h"
#include "tests/samples/sample_meshes.h"
#include "tools/file/failure.h"

namespace {

using plc::Double3;
using truth::Scene;

Scene scene_of(std::vector<std::string> words) {
  Scene scene = truth::take_scene(words);
  CHECK(words.empty());
  return scene;
}

std::string error_of(std::vector<std::string> words) {
  try {
    (void)truth::take_scene(words);
  } catch (const plc::tools::Failure& failure) {
    return failure.message;
  }
  return "none";
}

// A ball blurred by a Gaussian, at distance d from its centre: the exact integral.
double blurred_ball(double d, double radius, double sigma) {
  const double a = (radius - d) / sigma, b = (radius + d) / sigma;
  return (std::erf(a / std::sqrt(2.0)) + std::erf(b / std::sqrt(2.0))) / 2 -
         sigma / (d * std::sqrt(2 * truth::kPi)) * (std::exp(-a * a / 2) - std::exp(-b * b / 2));
}

// Its mean over a voxel, by the rule of Gauss of four points along each axis.
double ball_voxel(const Double3& p, double radius, double sigma) {
  constexpr double kAt[4] = {-0.430568155797026, -0.169990521792428, 0.169990521792428,
                             0.430568155797026};
  constexpr double kWeight[4] = {0.173927422568727, 0.326072577431273, 0.326072577431273,
                                 0.173927422568727};
  double sum = 0;
  for (size_t i = 0; i < 4; ++i) {
    for (size_t j = 0; j < 4; ++j) {
      for (size_t k = 0; k < 4; ++k) {
        const Double3 q = p + Double3{kAt[i], kAt[j], kAt[k]};
        sum += kWeight[i] * kWeight[j] * kWeight[k] * blurred_ball(length(q), radius, sigma);
      }
    }
  }
  return sum;
}

truth::Surface ball_surface(const Scene& scene, double radius) {
  const samples::Soup soup = samples::sphere(6);
  truth::Surface surface{soup.xyz, {soup.abc.begin(), soup.abc.end()}};
  for (size_t i = 0; i < surface.xyz.size(); i += 3) {
    double* p = surface.xyz.data() + i;
    const Double3 q = scene.centre + Double3{p[0], p[1], p[2]} * radius;
    p[0] = q.x, p[1] = q.y, p[2] = q.z;
  }
  return surface;
}

}  // namespace

TEST_CASE("the image of a ball is its exact integral", "[truth]") {
  const plc::SerialExecutor executor;
  for (const auto& [sigma, bound] : {std::pair{0.5, 2e-3}, {1.0, 4e-4}, {2.0, 1e-4}}) {
    const Scene scene = scene_of({"ball:8", "--sigma", std::to_string(sigma)});
    const std::vector<float> image = truth::FineField(scene, executor).voxels();
    double worst = 0;
    size_t i = 0;
    for (int z = 0; z < scene.dims[2]; ++z) {
      for (int y = 0; y < scene.dims[1]; ++y) {
        for (int x = 0; x < scene.dims[0]; ++x) {
          const Double3 p = Double3{double(x), double(y), double(z)} - scene.centre;
          const double off = std::abs(double(image[i++]) - ball_voxel(p, 8, sigma));
          worst = std::max(worst, off);
        }
      }
    }
    INFO("sigma " << sigma);
    CHECK(worst < bound);
  }
}

TEST_CASE("without a blur the image holds the object's volume", "[truth]") {
  const plc::SerialExecutor executor;
  for (const char* shape : {"ball:6", "torus:7,3", "cylinder:5,9", "plate:1,12", "rod:1.5,9",
                            "links:7,2", "balls:1,5"}) {
    const Scene scene = scene_of({shape});
    double sum = 0;
    for (const float value : truth::FineField(scene, executor).voxels()) sum += double(value);
    INFO(shape);
    CHECK(sum == Approx(scene.shape.volume).epsilon(3e-3));
  }
  // What there is no closed form for, against its fine mesh.
  const Scene scene = scene_of({"saddle:4,7,8", "--voxels", "1,1,3"});
  const truth::FineField field(scene, executor);
  double sum = 0;
  for (const float value : field.voxels()) sum += double(value);
  const truth::Surface mesh = object_surface(scene, field, executor);
  const auto whole = truth::Truth(scene, executor).measure(mesh);
  CHECK(sum == Approx(whole.volume).epsilon(5e-3));
  CHECK(whole.object.to_truth.rms < 0.005);
  CHECK(whole.genus == 0);
}

TEST_CASE("a plane cuts a box into the parts that geometry says", "[truth]") {
  const Double3 half{0.5, 1, 0.25};
  CHECK(truth::part_below_plane(half, 0, {0.6, 0, 0.8}) == Approx(0.5));
  CHECK(truth::part_below_plane(half, -0.25, {1, 0, 0}) == Approx(0.75).epsilon(1e-3));
  CHECK(truth::part_below_plane(half, 3, {0, 1, 0}) == 0);
  // A corner of equal sides: a sixth of their product.
  const double s = 1 / std::sqrt(3.0);
  CHECK(truth::part_below_plane({0.5, 0.5, 0.5}, s, {s, s, s}) == Approx(1.0 / 48));
}

TEST_CASE("the half level of a blurred ball lies where theory says", "[truth]") {
  const plc::Schedule schedule(2);
  for (const char* voxels : {"1,1,1", "1,1,3"}) {
    const Scene scene = scene_of({"ball:12", "--sigma", "1", "--voxels", voxels});
    const truth::FineField field(scene, schedule);
    const truth::Surface iso = iso_surface(field, schedule);
    REQUIRE(!iso.abc.empty());
    double inside = 0, least = 1, most = -1;
    for (size_t i = 0; i < iso.xyz.size(); i += 3) {
      const Double3 p{iso.xyz[i], iso.xyz[i + 1], iso.xyz[i + 2]};
      const double off = -scene.signed_distance(p);
      inside += off * 3 / double(iso.xyz.size());
      least = std::min(least, off), most = std::max(most, off);
    }
    INFO(voxels);
    if (voxels[4] == '1') {
      const double theory = (1 + 1.0 / 12) / 12;
      CHECK(inside == Approx(theory).margin(0.003));
      CHECK(most - least < 0.003);
    } else {
      // The blur is that of the voxels: three times as wide along z.
      CHECK(most > 2 * least);
    }
  }
}

TEST_CASE("an exact fine sphere is measured to be at no distance", "[truth]") {
  const plc::Schedule schedule(2);
  const Scene scene = scene_of({"ball:10", "--oblique"});
  const truth::Truth truth(scene, schedule);
  const truth::Measured m = truth.measure(ball_surface(scene, 10));
  CHECK(m.object.to_truth.rms < 0.004);
  CHECK(m.object.to_truth.max < 0.008);
  CHECK(m.object.from_truth.rms < 0.004);
  CHECK(m.components == 1);
  CHECK(m.genus == 0);
  CHECK(m.area == Approx(scene.shape.area).epsilon(1e-3));
  CHECK(m.curvature < 0.001);

  // Signs and sizes: a ball half a voxel larger, and one as much smaller.
  for (const double off : {0.25, -0.25}) {
    const truth::Measured moved = truth.measure(ball_surface(scene, 10 + off));
    CHECK(moved.object.to_truth.bias == Approx(off).margin(0.005));
    CHECK(moved.object.from_truth.bias == Approx(0.25).margin(0.005));
    CHECK(moved.object.from_truth.far == 0);
    REQUIRE(moved.iso.has_value());
    CHECK(moved.iso->to_truth.bias == Approx(off + 1.0 / 120).margin(0.01));
  }
}

TEST_CASE("what the blur takes away has no iso-surface", "[truth]") {
  const plc::SerialExecutor executor;
  const Scene scene = scene_of({"plate:1,12", "--sigma", "1"});
  const truth::Truth truth(scene, executor);
  CHECK(truth.iso().abc.empty());
  CHECK(!truth.object().abc.empty());
}

TEST_CASE("scenes that cannot be are refused by name", "[truth]") {
  CHECK(error_of({"egg"}).find("egg: not a shape") == 0);
  CHECK(error_of({"ball:x"}) == "ball:x: 1 number is expected");
  CHECK(error_of({"ball:1,2"}) == "ball:1,2: 1 number is expected");
  CHECK(error_of({"ball:-1"}).find("ball:-1: sizes above 0") == 0);
  CHECK(error_of({"torus:3,4"}).find("torus: its tube") == 0);
  CHECK(error_of({}) == "a shape is expected");
  CHECK(error_of({"ball", "--sigma", "-1"}) == "--sigma -1: 0 to 10 is expected");
  CHECK(error_of({"ball", "--sigma"}).find("--sigma: ") == 0);
  CHECK(error_of({"ball", "--turn", "1,2"}) == "--turn: 3 numbers are expected");
  CHECK(error_of({"ball", "--voxels", "1,1,0"}).find("--voxels 1,1,0: 1 to 8") == 0);
}

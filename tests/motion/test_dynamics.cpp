// Dynamics against the paper's equations (4)-(8), evaluated directly in double.
#include "engine/motion/dynamics.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/constants.h"
#include "tests/motion/reference_dynamics.h"

namespace {

using plc::Bound;
using plc::Mesh;
using plc::Model;
using plc::RestLength;

using reference::ball;
using reference::distance;
using reference::Gradient;
using reference::Image;
using reference::Points;
using reference::Reference;
using reference::to_point;

// A bumpy sphere of radius about 6 with random velocities, edges about 1.3.
void fill(Mesh& mesh, double delta, bool moving = true) {
  samples::Random random(23);
  samples::Soup soup = samples::moved(samples::sphere(3), 0, 0, 0, 6);
  for (double& c : soup.xyz) c += random.uniform(-0.2, 0.2);
  samples::fill_mesh(mesh, soup, delta);
  const auto part = [&] { return static_cast<float>(random.uniform(-0.1, 0.1)); };
  if (!moving) return;
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.velocity.set(v, {part(), part(), part()});
}

constexpr float kIso = 0.5F;

void step(Mesh& mesh, plc::Dynamics& dynamics, const Image& image) {
  plc::Seconds seconds;
  plc::Guide guide;
  guide.image = image.view();
  guide.iso = kIso;
  CHECK(dynamics.step(guide, seconds).ok());
  CHECK(seconds.normals >= 0);
  CHECK(mesh.vertex_count() > 0);
}

// The greatest distance between the engine's displacements or velocities and the reference's.
double difference(const plc::Streams3& streams, const Points& expected) {
  double most = 0;
  for (uint32_t v = 0; v < expected.size(); ++v) {
    most = std::max(most, distance(to_point(streams.at(v)), expected[v]));
  }
  return most;
}

// A step without a bound: engine against reference.
void check_step(const Model& model) {
  const Image image = ball();
  Mesh mesh;
  fill(mesh, 1);
  Reference reference(mesh, model, image, static_cast<double>(kIso));
  const auto dt = static_cast<double>(plc::stable_time_step(model));
  reference.step(dt);
  const auto bound = static_cast<double>(model.max_move);
  reference.clamp(bound, bound / dt);
  const plc::Schedule schedule(1);
  plc::Dynamics dynamics(mesh, schedule, model);
  step(mesh, dynamics, image);
  CAPTURE(model.curvature, model.spring, static_cast<int>(model.rest_length), model.mass);
  CHECK(difference(mesh.displacement, reference.displacement) < 3e-6);
  CHECK(difference(mesh.velocity, reference.velocity) < 6e-6);
  CHECK(dynamics.energy() == Approx(reference.energy(dt)).epsilon(1e-4));
}

Model gradient_model(float normal, float tangent) {
  Model model;
  model.spring = 0.05F;
  model.gradient_normal = normal;
  model.gradient_tangent = tangent;
  model.max_move = 1;
  model.time_step = 0.5F;
  return model;
}

// The same with the gradient force and a metric.
void check_guided(const Model& model, const Gradient* gradient, const plc::Metric& metric,
                  double delta) {
  const Image image = ball();
  Mesh mesh;
  fill(mesh, delta);
  Reference reference(mesh, model, image, static_cast<double>(kIso), gradient, metric);
  const auto dt = static_cast<double>(plc::stable_time_step(model));
  reference.step(dt);
  const double bound = static_cast<double>(model.max_move) * delta;
  reference.clamp(bound, bound / dt);
  const plc::Schedule schedule(1);
  plc::Dynamics dynamics(mesh, schedule, model);
  plc::Guide guide;
  if (model.attraction != 0) guide.image = image.view();
  guide.iso = kIso;
  if (gradient != nullptr) guide.gradient = gradient->view();
  guide.metric = metric;
  plc::Seconds seconds;
  REQUIRE(dynamics.step(guide, seconds).ok());
  CAPTURE(model.gradient_normal, model.gradient_tangent, metric.x, metric.z, delta);
  CHECK(difference(mesh.displacement, reference.displacement) < 4e-6);
  CHECK(difference(mesh.velocity, reference.velocity) < 1e-5);
}

}  // namespace

TEST_CASE("a step follows equations (4) to (7) for every rest length", "[dynamics]") {
  for (const RestLength rest : {RestLength::kZero, RestLength::kMean, RestLength::kValue}) {
    Model model;
    model.curvature = 0.4F;
    model.spring = 0.05F;
    model.rest_length = rest;
    model.rest_length_value = 1.4F;
    model.max_move = 1;
    model.time_step = 0.5F;
    check_step(model);
  }
}

TEST_CASE("each force alone, and none but damping, move the vertices as written", "[dynamics]") {
  for (const int only : {0, 1, 2, 3}) {
    Model model;
    model.max_move = 1;
    model.curvature = only == 0 ? 0.7F : 0;
    model.spring = only == 1 ? 0.2F : 0;
    model.rest_length = RestLength::kMean;
    model.attraction = only == 2 ? -1.5F : -1e-6F;
    model.damping = 0.3F;
    check_step(model);
  }
}

TEST_CASE("mass, damping, time step and the attraction's sign enter as written", "[dynamics]") {
  for (const float mass : {0.5F, 4.0F}) {
    for (const float damping : {0.0F, 2.0F}) {
      for (const float attraction : {-2.0F, 1.0F}) {
        Model model;
        model.mass = mass;
        model.damping = damping;
        model.attraction = attraction;
        model.time_step = 0.3F;
        model.max_move = 1;
        check_step(model);
      }
    }
  }
}

TEST_CASE("the gradient force enters as (8) has it, along the normal and across", "[dynamics]") {
  const Gradient gradient = reference::whirl();
  for (const auto& [normal, tangent] :
       {std::array{0.6F, 0.0F}, std::array{0.0F, -0.4F}, std::array{-0.3F, 0.7F}}) {
    for (const double delta : {1.0, 0.6}) {
      Model model = gradient_model(normal, tangent);
      check_guided(model, &gradient, {}, delta);
      model.attraction = 0;  // alone: the image is not read
      check_guided(model, &gradient, {}, delta);
    }
  }
}

TEST_CASE("a step without a gradient image takes no force of its coefficients", "[dynamics]") {
  check_guided(gradient_model(0.6F, 0.3F), nullptr, {}, 1);
}

TEST_CASE("a metric makes the step that of the mesh in the forces' lengths, for every force",
          "[dynamics]") {
  const Gradient gradient = reference::whirl();
  for (const plc::Metric& metric : {plc::Metric{1, 1, 3}, plc::Metric{1.3F, 0.8F, 2}}) {
    for (const RestLength rest : {RestLength::kZero, RestLength::kMean, RestLength::kValue}) {
      Model model = gradient_model(0.3F, 0.2F);
      model.rest_length = rest;
      model.rest_length_value = 1.4F;
      check_guided(model, nullptr, metric, 0.7);
      check_guided(model, &gradient, metric, 0.7);
    }
  }
}

TEST_CASE("the same surface moves alike in millimetres and in voxels under a metric",
          "[dynamics]") {
  // The same voxels twice: 2 mesh units long on z, or 1 mesh unit and twice as long for forces.
  const Image image = ball();
  const Gradient gradient = reference::whirl();
  Mesh voxels, millimetres;
  fill(voxels, 1, false);
  fill(millimetres, 1, false);
  for (uint32_t v = 0; v < millimetres.slots(); ++v) {
    const plc::Vec3 p = millimetres.at(v);
    millimetres.place(v, {p.x, p.y, 2 * p.z});
  }
  Model model = gradient_model(0.2F, 0.1F);
  model.rest_length = RestLength::kMean;
  const plc::Schedule schedule(1);
  plc::Dynamics in_voxels(voxels, schedule, model);
  plc::Dynamics in_millimetres(millimetres, schedule, model);
  plc::Guide guide;
  guide.image = image.view();
  guide.iso = kIso;
  guide.gradient = gradient.view();
  plc::Guide stretched = guide;
  guide.image.scale[2] = guide.gradient.scale[2] = 0.5F;
  stretched.metric.z = 2;
  plc::Seconds seconds;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(in_voxels.step(stretched, seconds).ok());
    REQUIRE(in_millimetres.step(guide, seconds).ok());
    float longest = 0, most = 0;
    for (uint32_t v = 0; v < voxels.slots(); ++v) {
      const plc::Vec3 a = voxels.displacement.at(v), b = millimetres.displacement.at(v);
      longest = std::max(longest, plc::length(b));
      most = std::max(most, plc::length(plc::Vec3{a.x, a.y, 2 * a.z} - b));
    }
    CHECK(longest < 1);  // the bound is one of the mesh, and so not the same for both
    CHECK(longest > 0.03F);
    CHECK(most < 3e-5F);
  }
}

TEST_CASE("delta scales the image force and the rest length", "[dynamics]") {
  const Image image = ball();
  Model model;
  model.spring = 0.1F;
  model.rest_length = RestLength::kValue;
  model.rest_length_value = 2;
  model.max_move = 1;
  Mesh mesh;
  fill(mesh, 0.6);
  Reference reference(mesh, model, image, 0.5);
  const auto dt = static_cast<double>(plc::stable_time_step(model));
  reference.step(dt);
  reference.clamp(0.6, 0.6 / dt);
  const plc::Schedule schedule(1);
  plc::Dynamics dynamics(mesh, schedule, model);
  step(mesh, dynamics, image);
  CHECK(difference(mesh.displacement, reference.displacement) < 3e-6);
  CHECK(dynamics.energy() == Approx(reference.energy(dt)).epsilon(1e-4));
}

TEST_CASE("the first bound holds every vertex to the longest movement and its speed",
          "[dynamics]") {
  const Image image = ball();
  Model model;
  model.max_move = 0.02F;
  Mesh mesh;
  fill(mesh, 0.8);
  Reference reference(mesh, model, image, 0.5);
  const auto dt = static_cast<double>(plc::stable_time_step(model));
  reference.step(dt);
  REQUIRE(reference.longest() > 0.05);
  reference.clamp(0.016, 0.016 / dt);
  const plc::Schedule schedule(1);
  plc::Dynamics dynamics(mesh, schedule, model);
  step(mesh, dynamics, image);
  CHECK(difference(mesh.displacement, reference.displacement) < 3e-6);
  CHECK(difference(mesh.velocity, reference.velocity) < 6e-6);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    CHECK(plc::length(mesh.displacement.at(v)) <= 0.016F * 1.00001F);
  }
}

TEST_CASE("the second bound shortens the time step for all", "[dynamics]") {
  const Image image = ball();
  Model model;
  model.time_step = 1;
  model.max_move = 0.05F;
  model.bound = Bound::kScale;
  Mesh mesh;
  fill(mesh, 1, false);
  // From rest the displacement is about quadratic in the time step.
  const plc::Schedule schedule(1);
  plc::Dynamics dynamics(mesh, schedule, model);
  Mesh start;
  fill(start, 1, false);
  step(mesh, dynamics, image);
  float fastest = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    fastest = std::max(fastest, plc::length(mesh.displacement.at(v)));
  }
  CHECK(fastest <= 0.05F * 1.00001F);
  CHECK(fastest > 0.02F);
  // Unclamped: the displacements are those of one shorter step, found by bisection.
  Reference reference(start, model, image, 0.5);
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    reference.step((low + high) / 2);
    (reference.longest() < static_cast<double>(fastest) ? low : high) = (low + high) / 2;
  }
  CHECK(difference(mesh.displacement, reference.displacement) < 1e-5);
  CHECK(difference(mesh.velocity, reference.velocity) < 1e-4);
  CHECK(dynamics.energy() == Approx(reference.energy(high)).epsilon(1e-3));
}

TEST_CASE("a scaled time step is that of one step only", "[dynamics]") {
  const Image image = ball();
  Model model;
  model.time_step = 1;
  model.max_move = 0.05F;
  model.bound = Bound::kScale;
  Mesh mesh;
  fill(mesh, 1);
  const plc::Schedule schedule(1);
  plc::Dynamics dynamics(mesh, schedule, model);
  step(mesh, dynamics, image);
  // Now at rest and with hardly a force: the next step is the model's own.
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.velocity.set(v, {1e-4F, 0, 0});
  Model weak = model;
  weak.attraction = -1e-6F;
  weak.curvature = 0;
  weak.damping = 0;
  plc::Dynamics calm(mesh, schedule, weak);
  step(mesh, calm, image);
  CHECK(mesh.displacement.x[3] == Approx(1e-4).epsilon(1e-2));
}

TEST_CASE("a step moves the vertices, lengthens their paths and remembers where they were",
          "[dynamics]") {
  const Image image = ball();
  Mesh mesh;
  fill(mesh, 1);
  std::vector<plc::Vec3> before;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    before.push_back(mesh.at(v));
    mesh.path[v] = 0.25F;
  }
  const plc::Schedule schedule(1);
  plc::Dynamics dynamics(mesh, schedule, Model());
  step(mesh, dynamics, image);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const plc::Vec3 d = mesh.displacement.at(v);
    CHECK(plc::squared_distance(mesh.at(v), before[v] + d) == 0);
    CHECK(mesh.path[v] == Approx(0.25F + plc::length(d)));
    CHECK(dynamics.before()[v].y == before[v].y);
  }
}

TEST_CASE("deleted vertices and padding neither move nor count", "[dynamics]") {
  const Image image = ball();
  samples::Soup soup = samples::moved(samples::sphere(2), 0, 0, 0, 5);
  soup.append(samples::moved(samples::sphere(2), 0, 0, 0, 2));
  Mesh both, alone;
  samples::fill_mesh(both, soup, 1);
  samples::fill_mesh(alone, samples::moved(samples::sphere(2), 0, 0, 0, 5), 1);
  for (uint32_t v = 66; v < 132; ++v) both.destroy(v);
  const plc::Schedule schedule(1);
  Model model;
  model.spring = 0.1F;
  plc::Dynamics first(both, schedule, model);
  plc::Dynamics second(alone, schedule, model);
  for (int i = 0; i < 3; ++i) {
    step(both, first, image);
    step(alone, second, image);
  }
  CHECK(first.energy() == Approx(second.energy()).epsilon(1e-6));
  for (uint32_t v = 0; v < 66; ++v) {
    CHECK(plc::length(both.at(v) - alone.at(v)) < 1e-5F);
  }
  for (uint32_t v = 66; v < both.padded(); ++v) {
    CHECK(plc::length(both.displacement.at(v)) == 0);
    CHECK(plc::length(both.velocity.at(v)) == 0);
  }
}

TEST_CASE("the time step is lowered to what the stiffest mode takes", "[dynamics]") {
  Model model;
  model.curvature = 0.4F;
  CHECK(plc::stable_time_step(model) == 1.5F);
  model.time_step = 5;
  CHECK(plc::stable_time_step(model) == Approx(2.2 / std::sqrt(2.6 * 0.4 + 1)));
  model.spring = 2;
  model.mass = 3;
  CHECK(plc::stable_time_step(model) == Approx(2.2 * std::sqrt(3 / (2.6 * 0.4 + 24 + 1))));
  model.attraction = 7;
  CHECK(plc::stable_time_step(model) == Approx(2.2 * std::sqrt(3 / (2.6 * 0.4 + 24 + 7))));
  CHECK(plc::stable_time_step(model, 11) == Approx(2.2 * std::sqrt(3 / (2.6 * 0.4 + 24 + 7 + 11))));
  model.gradient_normal = 3;
  model.gradient_tangent = -6;  // (8) changes by 2 over U_h, 1.2 delta
  CHECK(plc::stable_time_step(model) == Approx(2.2 * std::sqrt(3 / (2.6 * 0.4 + 24 + 7 + 10))));
}

TEST_CASE("the time step is lowered to what the damping takes", "[dynamics]") {
  plc::Model model;
  model.time_step = 1.5F;
  model.damping = 10;
  model.mass = 2;
  CHECK(plc::stable_time_step(model) == Approx(0.5));
  model.damping = 0;
  CHECK(plc::stable_time_step(model) > 0.5F);
}

TEST_CASE("stiff models stay bounded for hundreds of steps", "[dynamics]") {
  const Image image = ball();
  for (const auto& [curvature, spring, attraction] :
       {std::array{50.0F, 0.0F, -1.0F}, std::array{0.0F, 5.0F, -1.0F},
        std::array{0.0F, 0.0F, -50.0F}, std::array{20.0F, 2.0F, -10.0F}}) {
    Model model;
    model.curvature = curvature;
    model.spring = spring;
    model.rest_length = RestLength::kMean;
    model.attraction = attraction;
    Mesh mesh;
    fill(mesh, 1, false);
    const plc::Schedule schedule(1);
    plc::Dynamics dynamics(mesh, schedule, model);
    for (int i = 0; i < 300; ++i) step(mesh, dynamics, image);
    CAPTURE(curvature, spring, attraction);
    CHECK(dynamics.energy() < 1e-3);
    for (uint32_t v = 0; v < mesh.slots(); ++v) CHECK(plc::length(mesh.at(v)) < 20);
  }
}

TEST_CASE("an adaptive mesh goes to its place as fast in a faint image as in a steep one",
          "[dynamics]") {
  Image steep = ball(), faint = steep;
  for (float& value : steep.values) value = kIso + (value - kIso) * 13;
  for (float& value : faint.values) value = kIso + (value - kIso) * 9;
  const plc::Schedule schedule(1);
  const auto moved = [&](const Image& image, bool sized) {
    plc::Sizing sizing;
    sizing.object = {image.view(), kIso, true};
    plc::SizeSpec spec;
    spec.finest = spec.coarsest = 1;
    REQUIRE(sizing.field.build(image.view(), kIso, 1, spec, schedule).ok());
    Model model;
    model.curvature = 0;
    Mesh mesh;
    samples::fill_mesh(mesh, samples::moved(samples::sphere(3), 0, 0, 0, 6.9), 1);
    if (sized) mesh.sizing = &sizing;
    plc::Dynamics dynamics(mesh, schedule, model);
    for (int i = 0; i < 2; ++i) step(mesh, dynamics, image);
    Points points;
    for (uint32_t v = 0; v < mesh.slots(); ++v) points.push_back(to_point(mesh.at(v)));
    return points;
  };
  const auto apart = [&](bool sized) {
    const Points a = moved(steep, sized), b = moved(faint, sized);
    double most = 0;
    for (size_t v = 0; v < a.size(); ++v) most = std::max(most, distance(a[v], b[v]));
    return most;
  };
  CHECK(apart(false) > 0.02);
  CHECK(apart(true) < 1e-4);
}

TEST_CASE("an adaptive mesh that noise makes stiff comes to rest", "[dynamics]") {
  const Image clean = ball();
  Image noisy = clean;
  samples::Random random(5);
  for (float& value : noisy.values) value += static_cast<float>(random.uniform(-0.3, 0.3));
  const plc::Schedule schedule(1);
  plc::Sizing sizing;
  sizing.object = {clean.view(), kIso, true};
  plc::SizeSpec spec;
  spec.finest = spec.coarsest = 1;
  REQUIRE(sizing.field.build(noisy.view(), kIso, 1, spec, schedule).ok());
  REQUIRE(sizing.field.noise() > plc::kMostNoise);
  Model model;
  model.curvature = 2;
  Mesh mesh;
  fill(mesh, 1, false);
  mesh.sizing = &sizing;
  plc::Dynamics dynamics(mesh, schedule, model);
  for (int i = 0; i < 300; ++i) step(mesh, dynamics, clean);
  CHECK(dynamics.energy() < 1e-3);
  for (uint32_t v = 0; v < mesh.slots(); ++v) CHECK(plc::length(mesh.at(v)) < 20);
}

TEST_CASE("a sphere in the potential of a ball settles on the iso-surface", "[dynamics]") {
  const Image image = ball();
  Model model;
  model.curvature = 0.05F;
  Mesh mesh;
  samples::fill_mesh(mesh, samples::moved(samples::sphere(3), 0, 0, 0, 8.5), 1);
  const plc::Schedule schedule(1);
  plc::Dynamics dynamics(mesh, schedule, model);
  for (int i = 0; i < 150; ++i) step(mesh, dynamics, image);
  CHECK(dynamics.energy() < 1e-7);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    CHECK(plc::length(mesh.at(v)) == Approx(0.3 * 24).epsilon(0.02));
  }
}

TEST_CASE("a step has the same bits on every thread count and SIMD target", "[dynamics]") {
  const Image image = ball();
  const Gradient gradient = reference::whirl();
  plc::Guide guided;
  guided.image = image.view();
  guided.iso = kIso;
  guided.gradient = gradient.view();
  guided.metric = {1, 1.2F, 2};
  plc::Seconds seconds;
  std::vector<std::vector<float>> results;
  for (const Bound bound : {Bound::kClamp, Bound::kScale}) {
    results.clear();
    for (const int threads : {1, 3}) {
      for (const plc::SimdTarget simd : plc::available_simd_targets()) {
        Model model;
        model.spring = 0.02F;
        model.gradient_normal = 0.2F;
        model.gradient_tangent = 0.1F;
        model.bound = bound;
        model.max_move = 0.03F;
        Mesh mesh;
        samples::fill_mesh(mesh, samples::moved(samples::sphere(5), 0, 0, 0, 8), 0.3);
        REQUIRE(mesh.padded() > 4 * plc::kGrain);
        const plc::Schedule schedule(threads, simd);
        plc::Dynamics dynamics(mesh, schedule, model);
        for (int i = 0; i < 5; ++i) step(mesh, dynamics, image);
        for (int i = 0; i < 3; ++i) REQUIRE(dynamics.step(guided, seconds).ok());
        std::vector<float> result{static_cast<float>(dynamics.energy())};
        for (uint32_t v = 0; v < mesh.slots(); ++v) result.push_back(mesh.position[v].x);
        results.push_back(result);
      }
    }
    for (const auto& result : results) CHECK(result == results[0]);
  }
}

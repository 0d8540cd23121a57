// The C API: simplifying and rounding of any mesh.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"
#include "tests/samples/sample_shapes.h"

namespace {

using Catch::Matchers::Contains;
using samples::Context;
using samples::Soup;

int64_t vertices(const Soup& m) {
  return static_cast<int64_t>(m.vertex_count());
}
int64_t faces(const Soup& m) {
  return static_cast<int64_t>(m.face_count());
}

struct Simplified {
  plc_status status = PLC_INTERNAL;
  Soup mesh;
  plc_simplified told{};
};

using Change = std::function<void(plc_simplify_options&)>;

Simplified simplified(
    plc_context* context, const Soup& m, double tolerance,
    const Change& change = [](plc_simplify_options&) {}) {
  plc_simplify_options options;
  plc_simplify_options_defaults(&options);
  options.tolerance = tolerance;
  change(options);
  Simplified r;
  plc_simplified_defaults(&r.told);
  r.told.struct_size = sizeof r.told;
  r.mesh.xyz.resize(m.xyz.size());
  r.mesh.abc.resize(m.abc.size());
  r.status = plc_mesh_simplify(context, m.xyz.data(), vertices(m), m.abc.data(), faces(m), &options,
                               r.mesh.xyz.data(), r.mesh.abc.data(), &r.told);
  if (r.status != PLC_OK) return r;
  r.mesh.xyz.resize(static_cast<size_t>(r.told.vertices) * 3);
  r.mesh.abc.resize(static_cast<size_t>(r.told.faces) * 3);
  return r;
}

// By another way than that of the simplification: the largest of samples.
double distance(plc_context* context, const Soup& a, const Soup& b) {
  plc_distances d{};
  d.struct_size = sizeof d;
  REQUIRE(plc_mesh_distance(context, a.xyz.data(), vertices(a), a.abc.data(), faces(a),
                            b.xyz.data(), vertices(b), b.abc.data(), faces(b), nullptr,
                            &d) == PLC_OK);
  return d.max;
}

plc_check check_of(plc_context* context, const Soup& m) {
  plc_check check{};
  check.struct_size = sizeof check;
  REQUIRE(plc_check_mesh(context, m.xyz.data(), vertices(m), m.abc.data(), faces(m), &check) ==
          PLC_OK);
  return check;
}

void demand_within(plc_context* context, const Soup& given, const Simplified& s, double tolerance) {
  REQUIRE(s.status == PLC_OK);
  INFO(s.told.from_at_least << " " << s.told.to_at_least << " " << distance(context, s.mesh, given)
                            << " " << s.told.vertices);
  CHECK(check_of(context, s.mesh).valid == 1);
  CHECK(s.told.from_at_most <= tolerance);
  CHECK(s.told.to_at_most <= tolerance);
  CHECK(distance(context, s.mesh, given) <= s.told.from_at_most);
  CHECK(distance(context, given, s.mesh) <= s.told.to_at_most);
}

struct Rounded {
  plc_status status = PLC_INTERNAL;
  Soup mesh;
  int64_t moved = -1;
};

Rounded rounded(plc_context* context, const Soup& m) {
  Rounded r;
  r.mesh = m;
  std::vector<float> floats(m.xyz.size(), -7);
  r.status = plc_mesh_round(context, m.xyz.data(), vertices(m), m.abc.data(), faces(m),
                            floats.data(), &r.moved);
  r.mesh.xyz.assign(floats.begin(), floats.end());
  return r;
}

double farthest_moved(const Soup& a, const Soup& b) {
  double most = 0;
  for (size_t i = 0; i < a.xyz.size(); ++i) most = std::max(most, std::abs(a.xyz[i] - b.xyz[i]));
  return most;
}

// Each ends where floats are 8e-6 apart.
Soup two_shells(double gap) {
  Soup shell = samples::moved(samples::sphere(3), 100, 90, 110);
  shell.append(samples::flipped(samples::moved(samples::sphere(3), 100, 90, 110, 1 - gap)));
  return shell;
}
Soup flat_ball(double thickness) {
  Soup ball = samples::sphere(3);
  for (size_t i = 2; i < ball.xyz.size(); i += 3) ball.xyz[i] *= thickness;
  return samples::moved(ball, 100, 90, 110);
}

}  // namespace

TEST_CASE("a ball becomes a coarser ball within the tolerance", "[pellicle_simplify]") {
  const Context context = samples::make_context();
  const Soup ball = samples::sphere(5);
  int64_t before = vertices(ball);
  for (const double tolerance : {0.005, 0.02, 0.1}) {
    const Simplified s = simplified(context.get(), ball, tolerance);
    demand_within(context.get(), ball, s, tolerance);
    CHECK(s.told.vertices < before / 2);
    before = s.told.vertices;
  }
}

TEST_CASE("of two nested sheets closer than the tolerance none meets the other",
          "[pellicle_simplify]") {
  const Context context = samples::make_context();
  Soup shell = samples::sphere(4);
  shell.append(samples::flipped(samples::moved(samples::sphere(4), 0, 0, 0, 0.98)));
  const Simplified s = simplified(context.get(), shell, 0.1);
  demand_within(context.get(), shell, s, 0.1);
  CHECK(s.told.vertices < vertices(shell));
}

TEST_CASE("linked tori stay linked and of genus 1", "[pellicle_simplify]") {
  const Context context = samples::make_context();
  Soup tori = samples::torus(60, 30, 1, 0.3);
  Soup other = samples::torus(60, 30, 1, 0.3);
  for (size_t i = 0; i < other.xyz.size(); i += 3) {
    const double y = other.xyz[i + 1];
    other.xyz[i] += 1;
    other.xyz[i + 1] = -other.xyz[i + 2];
    other.xyz[i + 2] = y;
  }
  tori.append(other);
  const Simplified s = simplified(context.get(), tori, 0.05);
  demand_within(context.get(), tori, s, 0.05);
  CHECK(s.told.vertices < vertices(tori) / 4);
  CHECK(s.told.vertices * 2 == s.told.faces);  // Euler's number is still 0
}

TEST_CASE("any number of threads simplifies to the same bits", "[pellicle_simplify]") {
  const Soup ball = samples::sphere(5);
  const Simplified one = simplified(samples::make_context(1).get(), ball, 0.02);
  REQUIRE(one.status == PLC_OK);
  for (const int threads : {2, 4}) {
    const Simplified many = simplified(samples::make_context(threads).get(), ball, 0.02);
    CHECK(many.mesh.xyz == one.mesh.xyz);
    CHECK(many.mesh.abc == one.mesh.abc);
  }
}

TEST_CASE("asked for one side, the result alone is near", "[pellicle_simplify]") {
  const Context context = samples::make_context();
  // A spike, which one side does not need.
  Soup ball = samples::sphere(4);
  for (size_t k = 0; k < 3; ++k) ball.xyz[k] *= 1.5;
  const Simplified both = simplified(context.get(), ball, 0.1);
  demand_within(context.get(), ball, both, 0.1);
  const Simplified one =
      simplified(context.get(), ball, 0.1, [](plc_simplify_options& o) { o.one_sided = 1; });
  REQUIRE(one.status == PLC_OK);
  CHECK(check_of(context.get(), one.mesh).valid == 1);
  CHECK(one.told.from_at_most <= 0.1);
  CHECK(one.told.vertices <= both.told.vertices);
}

TEST_CASE("progress never falls, and cancels", "[pellicle_simplify]") {
  const Context context = samples::make_context();
  struct Told {
    double fraction = 0, stop_at = 2;
    int calls = 0;
  } told;
  const auto listen = [&told](plc_simplify_options& o) {
    o.progress_user = &told;
    o.progress = [](double fraction, void* user) {
      auto& t = *static_cast<Told*>(user);
      if (fraction < t.fraction || fraction > 1) t.calls = -1000000;
      t.fraction = fraction;
      ++t.calls;
      return fraction >= t.stop_at ? 1 : 0;
    };
  };
  const Soup ball = samples::sphere(4);
  CHECK(simplified(context.get(), ball, 0.02, listen).status == PLC_OK);
  CHECK(told.calls > 3);
  CHECK(told.fraction > 0.8);
  told = {0, 0.3, 0};
  const Simplified stopped = simplified(context.get(), ball, 0.02, listen);
  CHECK(stopped.status == PLC_CANCELLED);
  CHECK(told.fraction < 0.8);
}

TEST_CASE("what cannot be simplified is refused in a line", "[pellicle_simplify]") {
  const Context context = samples::make_context();
  Soup open = samples::sphere(2);
  open.abc.resize(open.abc.size() - 3);
  CHECK(simplified(context.get(), open, 0.1).status == PLC_INVALID_DATA);
  CHECK_THAT(plc_context_message(context.get()), Contains("3 edges have one face"));
  CHECK(simplified(context.get(), samples::sphere(2), 0).status == PLC_INVALID_ARGUMENT);
  CHECK_THAT(plc_context_message(context.get()), Contains("tolerance"));
  CHECK(simplified(context.get(), samples::sphere(2), 1e-13).status == PLC_INVALID_ARGUMENT);
  CHECK_THAT(plc_context_message(context.get()), Contains("tolerance 1e-13"));
  CHECK(simplified(context.get(), samples::sphere(2), 1e-9).status == PLC_OK);
}

TEST_CASE("sheets nearer to each other than floats are rounded by lie apart when rounded",
          "[pellicle_simplify]") {
  const Context context = samples::make_context();
  for (const Soup& m : {two_shells(1e-7), two_shells(3e-9), flat_ball(1e-7), flat_ball(3e-9)}) {
    REQUIRE(check_of(context.get(), m).valid == 1);
    const Rounded r = rounded(context.get(), m);
    REQUIRE(r.status == PLC_OK);
    CHECK(check_of(context.get(), r.mesh).valid == 1);
    CHECK(r.moved > 0);
    CHECK(farthest_moved(m, r.mesh) < 5e-3);
  }
}

TEST_CASE("what floats hold is rounded and nothing else", "[pellicle_simplify]") {
  const Context context = samples::make_context();
  const Soup m = two_shells(1e-2);
  const Rounded r = rounded(context.get(), m);
  REQUIRE(r.status == PLC_OK);
  CHECK(r.moved == 0);
  for (size_t i = 0; i < m.xyz.size(); ++i) {
    REQUIRE(r.mesh.xyz[i] == static_cast<double>(static_cast<float>(m.xyz[i])));
  }
}

TEST_CASE("what is not valid, or too small for floats, is not rounded", "[pellicle_simplify]") {
  const Context context = samples::make_context();
  Soup open = samples::sphere(2);
  open.abc.resize(open.abc.size() - 3);
  Soup met = samples::sphere(2);
  met.append(samples::moved(samples::sphere(2), 1, 0, 0));
  const auto message = [&] { return std::string(plc_context_message(context.get())); };
  for (const auto& [m, told] :
       {std::pair(open, "3 edges have one face"), std::pair(met, "pairs of faces meet"),
        std::pair(samples::moved(samples::sphere(2), 1e3, 0, 0, 1e-6),
                  "rounded to floats, faces of the mesh meet"),
        std::pair(samples::moved(samples::sphere(2), 0, 0, 0, 1e40),
                  "rounded to floats, faces of the mesh meet")}) {
    const Rounded r = rounded(context.get(), m);
    CHECK(r.status == PLC_INVALID_DATA);
    CHECK_THAT(message(), Contains(told));
    CHECK(r.moved == -1);
    CHECK(r.mesh.xyz[0] == -7);
  }
  CHECK(plc_mesh_round(context.get(), met.xyz.data(), vertices(met), met.abc.data(), faces(met),
                       nullptr, nullptr) == PLC_INVALID_ARGUMENT);
}

#include "engine/guard/motion_guard.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "engine/base/constants.h"
#include "engine/detect/surroundings.h"
#include "engine/transform/edge.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Mesh;
using plc::Vec3;
using samples::Soup;

// What Evolution does around a movement: normals of its start, the table and risks of its end.
class Movement {
 public:
  explicit Movement(Mesh& mesh) : mesh_(mesh), before_(mesh.position) {
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      if (mesh.alive(v)) mesh.normal.set(v, plc::vertex_normal(mesh, v));
    }
  }
  void move(uint32_t v, Vec3 by) {
    mesh_.place(v, mesh_.at(v) + by);
    mesh_.velocity.set(v, by);
  }
  // all_due: as if the constraints of every vertex were to be checked; else of none.
  int64_t guard(const plc::Executor& executor = samples::kSerial, bool all_due = true) {
    plc::MotionGuard guard(mesh_, executor);
    hash_.build(mesh_, plc::kMinApart * static_cast<float>(mesh_.delta), executor);
    plc::Vector<uint32_t> all, due;
    for (uint32_t v = 0; v < mesh_.slots(); ++v) {
      if (mesh_.alive(v)) all.push_back(v);
    }
    guard.assess(all, {});  // nothing was near so far
    if (all_due) due = all;
    plc::Vector<uint32_t> blocks(mesh_.padded() / plc::kRingLanes);
    std::iota(blocks.begin(), blocks.end(), 0U);
    guard.find_folds(blocks);
    plc::Surroundings around(mesh_, executor);
    around.search(due, hash_, &guard.risk());
    around.search_folded(guard.newly_folded(), hash_, guard.risk());
    guard.assess(due, around.at_risk());
    plc::Vector<uint32_t> back;
    const int64_t count = guard.take_back(before_, hash_, back);
    CHECK(static_cast<int64_t>(back.size()) == count);
    for (const uint32_t v : back) CHECK(is_back(v));
    return count;
  }
  bool is_back(uint32_t v) const {
    const plc::Float4& p = mesh_.position[v];
    return p.x == before_[v].x && p.y == before_[v].y && p.z == before_[v].z;
  }
  plc::SpatialHash& hash() { return hash_; }

 private:
  Mesh& mesh_;
  plc::Buffer<plc::Float4> before_;
  plc::SpatialHash hash_;
};

constexpr double kDelta = 0.16;  // edges of sphere(3) are 0.19 .. 0.28

Soup spheres(double gap) {
  Soup soup = samples::sphere(3);
  soup.append(samples::moved(samples::sphere(3), 0.03, 0.02, 2 + gap));
  return soup;
}

}  // namespace

TEST_CASE("a movement that keeps the surface apart stays", "[motion_guard]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.3), kDelta);
  Movement movement(mesh);
  for (uint32_t v = 0; v < mesh.slots(); ++v) movement.move(v, {0.02F, 0, 0});
  CHECK(movement.guard() == 0);
  for (uint32_t v = 0; v < mesh.slots(); ++v) CHECK_FALSE(movement.is_back(v));
}

TEST_CASE("parts that have gone into each other go back and lose their speed", "[motion_guard]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.05), kDelta);
  REQUIRE(samples::meeting_count(mesh) == 0);
  Movement movement(mesh);
  for (uint32_t v = 258; v < mesh.slots(); ++v) movement.move(v, {0, 0, -0.06F});
  REQUIRE(samples::meeting_count(mesh) > 0);
  const int64_t back = movement.guard();
  CHECK(samples::meeting_count(mesh) == 0);
  int64_t counted = 0;
  for (uint32_t v = 258; v < mesh.slots(); ++v) {
    if (!movement.is_back(v)) continue;
    ++counted;
    CHECK(plc::length(mesh.velocity.at(v)) == 0);
    CHECK(mesh.turns[v] == 1);
    // The table has it where it is now.
    bool found = false;
    movement.hash().visit_box(mesh, mesh.at(v), mesh.at(v),
                              [&](uint32_t w, Vec3) { found = found || w == v; });
    CHECK(found);
  }
  CHECK(counted == back);
  CHECK(back > 0);
  CHECK(back < 100);  // the far sides stay moved
  CHECK(plc::broken_invariant(mesh) == "");
}

TEST_CASE("a vertex pushed through the far side goes back", "[motion_guard]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), kDelta);
  Movement movement(mesh);
  movement.move(100, mesh.at(100) * -2.1F);
  REQUIRE(samples::meeting_count(mesh) > 0);
  CHECK(movement.guard() == 1);
  CHECK(movement.is_back(100));
  CHECK(samples::meeting_count(mesh) == 0);
}

TEST_CASE("after any movement within the bound nothing meets", "[motion_guard]") {
  int64_t meeting = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    samples::Random random(seed);
    Soup soup = seed % 2 == 0 ? spheres(random.uniform(0.02, 0.2)) : samples::torus(28, 8, 1, 0.25);
    if (seed % 3 == 0) {
      // Flat: both sides of it near.
      for (size_t i = 2; i < soup.xyz.size(); i += 3) soup.xyz[i] *= 0.3;
    }
    Mesh mesh;
    samples::fill_mesh(mesh, soup, kDelta);
    if (samples::meeting_count(mesh) != 0) continue;
    Movement movement(mesh);
    const double most = random.uniform(0.1, 0.8) * kDelta;
    const Vec3 drift{0, 0, static_cast<float>(random.uniform(-1, 1) * most)};
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      const auto part = [&] { return static_cast<float>(random.uniform(-0.5, 0.5) * most); };
      movement.move(v, Vec3{part(), part(), part()} + (v % 2 == 0 ? drift : drift * -1));
    }
    meeting += static_cast<int64_t>(samples::meeting_count(mesh));
    movement.guard();
    CAPTURE(seed);
    CHECK(samples::meeting_count(mesh) == 0);
  }
  CHECK(meeting > 1000);
}

TEST_CASE("in the worst case all are back where they started", "[motion_guard]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), kDelta);
  Movement movement(mesh);
  samples::Random random(21);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const auto part = [&] { return static_cast<float>(random.uniform(-0.5, 0.5)); };
    movement.move(v, {part(), part(), part()});
  }
  movement.guard();
  CHECK(samples::meeting_count(mesh) == 0);
  for (uint32_t v = 0; v < mesh.slots(); ++v) CHECK(movement.is_back(v));
}

TEST_CASE("what is taken back does not depend on the executor", "[motion_guard]") {
  Mesh one, other;
  for (Mesh* mesh : {&one, &other}) {
    samples::fill_mesh(*mesh, spheres(0.05), kDelta);
    Movement movement(*mesh);
    samples::Random random(22);
    for (uint32_t v = 0; v < mesh->slots(); ++v) {
      const auto part = [&] { return static_cast<float>(random.uniform(-0.06, 0.06)); };
      movement.move(v, {part(), part(), part()});
    }
    if (mesh == &one) {
      CHECK(movement.guard() > 0);
    } else {
      movement.guard(fixtures::ThreadExecutor(3));
    }
  }
  for (uint32_t v = 0; v < one.slots(); ++v) {
    CHECK(plc::squared_distance(one.at(v), other.at(v)) == 0);
  }
}

// All normals of a crumpled sheet may agree: that of a vertex with three neighbours tells nothing
// of where it is, and the faces that are turned over have no vertex that is.
TEST_CASE("a sheet that lies over itself in a fold does not go through itself", "[motion_guard]") {
  Soup soup = samples::sphere(3);
  for (size_t i = 0; i < soup.xyz.size(); i += 3) {  // an octahedron
    const double norm =
        std::abs(soup.xyz[i]) + std::abs(soup.xyz[i + 1]) + std::abs(soup.xyz[i + 2]);
    for (size_t k = 0; k < 3; ++k) soup.xyz[i + k] /= norm;
  }
  const Vec3 middle{1 / 3.0F, 1 / 3.0F, 1 / 3.0F};
  const auto at = [&soup](uint32_t v) {
    const double* p = soup.xyz.data() + size_t{3} * v;
    return Vec3{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  };
  size_t central = 0;
  const auto distance = [&](size_t f) {
    return plc::length((at(soup.abc[3 * f]) + at(soup.abc[3 * f + 1]) + at(soup.abc[3 * f + 2])) *
                           (1 / 3.0F) -
                       middle);
  };
  for (size_t f = 1; f < soup.face_count(); ++f) {
    if (distance(f) < distance(central)) central = f;
  }
  // The face in the middle gets a vertex, which is drawn over another one of the same plane.
  const uint32_t a = soup.abc[3 * central], b = soup.abc[3 * central + 1],
                 c = soup.abc[3 * central + 2];
  uint32_t under = 0;
  const auto off = [&](uint32_t v) { return std::abs(plc::length(at(v) - middle) - 0.36F); };
  for (uint32_t v = 1; v < soup.vertex_count(); ++v) {
    const Vec3 p = at(v);
    if (p.x > 0 && p.y > 0 && p.z > 0 && off(v) < off(under)) under = v;
  }
  const Vec3 up = middle * std::sqrt(3.0F);
  const Vec3 drawn = at(under) + up * 0.02F;
  const uint32_t over = soup.vertex(drawn.x, drawn.y, drawn.z);
  soup.abc[3 * central + 2] = over;
  soup.face(b, c, over);
  soup.face(c, a, over);
  Mesh mesh;
  samples::fill_mesh(mesh, soup, kDelta);
  REQUIRE(samples::meeting_count(mesh) == 0);
  Movement movement(mesh);
  CHECK(plc::dot(mesh.normal.at(over), mesh.normal.at(under)) > plc::kRiskDot);
  movement.move(under, up * 0.04F);
  REQUIRE(samples::meeting_count(mesh) > 0);
  CHECK(movement.guard(samples::kSerial, GENERATE(false, true)) == 1);
  CHECK(movement.is_back(under));
  CHECK(samples::meeting_count(mesh) == 0);
}

TEST_CASE("only the risk of vertices that are due is looked at again", "[motion_guard]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), kDelta);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    mesh.normal.set(v, plc::vertex_normal(mesh, v));
  }
  plc::MotionGuard guard(mesh, samples::kSerial);
  plc::SpatialHash hash;
  hash.build(mesh, plc::kMinApart * static_cast<float>(kDelta), samples::kSerial);
  plc::Surroundings around(mesh, samples::kSerial);
  around.search({3, 50}, hash);
  guard.assess({3, 50}, around.at_risk());
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    CHECK(guard.risk()[v] == (v == 3 || v == 50 ? 0 : 1));
  }
}

#include "engine/motion/user_constraints.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/motion/dynamics.h"
#include "tests/motion/reference_dynamics.h"

namespace {

using plc::Attachment;
using plc::Streams3;
using plc::UserConstraints;
using plc::Vec3;
using namespace reference;  // operators

constexpr float kMass = 1.5F, kDamping = 0.8F;

// Position positions and unit normals around the origin, not in any order of space.
struct Vertices {
  std::vector<plc::Float4> at;
  Streams3 velocity, normal, force;

  explicit Vertices(uint32_t count) : at(count) {
    samples::Random random(7);
    for (Streams3* s : {&velocity, &normal, &force}) s->resize(count);
    for (uint32_t v = 0; v < count; ++v) {
      const auto part = [&](double most) {
        return static_cast<float>(random.uniform(-most, most));
      };
      at[v] = {part(10), part(10), part(10), 0};
      const Vec3 n{part(1), part(1), part(1)};
      normal.set(v, n * (1 / plc::length(n)));
      force.set(v, {part(1), part(1), part(1)});
      velocity.set(v, {part(0.5), part(0.5), part(0.5)});
    }
  }
  void attach(const UserConstraints& user, uint32_t begin, uint32_t end) {
    plc::attach(user, {velocity, kMass, kDamping}, at.data(), normal, begin, end, force);
  }
  uint32_t count() const { return static_cast<uint32_t>(at.size()); }
};

UserConstraints random_attachments(int count, double largest) {
  samples::Random random(99);
  UserConstraints user;
  for (int i = 0; i < count; ++i) {
    const auto c = [&] { return static_cast<float>(random.uniform(-12, 12)); };
    user.attachments.push_back({{c(), c(), c()},
                                static_cast<float>(random.uniform(0.5, largest)),
                                static_cast<float>(random.uniform(0, 3))});
  }
  return user;
}

// The formula of the header, in double.
Point expected_pull(const UserConstraints& user, Vec3 position, Vec3 velocity, Vec3 normal) {
  const Point x = to_point(position), n = to_point(normal);
  double weights = 0, stiffness = 0, pull = 0;
  for (const Attachment& a : user.attachments) {
    const Point way = to_point(a.place) - x;
    double squared = 0;
    for (size_t k = 0; k < 3; ++k) {
      squared += std::pow(way[k] * static_cast<double>(user.millimetres[k]), 2);
    }
    const double r = static_cast<double>(a.radius);
    if (squared >= r * r) continue;
    const double w = std::pow(1 - squared / (r * r), 2);
    weights += w;
    stiffness += w * static_cast<double>(a.strength);
    pull += w * static_cast<double>(a.strength) * reference::dot(way, n);
  }
  const double most = std::max(1.0, weights);
  const double critical = 2 * std::sqrt(stiffness / most * static_cast<double>(kMass));
  const double damping = std::max(0.0, critical - static_cast<double>(kDamping));
  return n * (pull / most - damping * reference::dot(to_point(velocity), n));
}

Vec3 at(const plc::Float4& p) {
  return {p.x, p.y, p.z};
}

// The pull on one vertex at p with normal n.
Vec3 pull_at(const UserConstraints& user, Vec3 p, Vec3 n) {
  Vertices one(1);
  one.at[0] = {p.x, p.y, p.z, 0};
  one.normal.set(0, n);
  one.force.set(0, {});
  one.velocity.set(0, {});
  one.attach(user, 0, 1);
  return one.force.at(0);
}

constexpr Vec3 kUp{0, 0, 1};
constexpr uint32_t kTop = 4;  // of the sphere below: at (0, 0, 6)

// A sphere at rest that the curvature force alone would shrink.
void fill_sphere(Mesh& mesh) {
  samples::fill_mesh(mesh, samples::moved(samples::sphere(3), 0, 0, 0, 6), 1);
}

plc::Model shrinking() {
  plc::Model model;
  model.attraction = 0;
  model.curvature = 0;
  model.spring = 0.05F;
  model.rest_length = plc::RestLength::kZero;
  return model;
}

// Threads do not matter: the meshes are small.
plc::Status step(Mesh& mesh, const plc::Model& model, const UserConstraints& user, int count = 1) {
  const plc::Schedule schedule(1);
  plc::Dynamics dynamics(mesh, schedule, model);
  plc::Guide guide;
  guide.user = &user;
  for (int i = 0; i < count; ++i) {
    plc::Seconds seconds;
    if (plc::Status s = dynamics.step(guide, seconds); !s.ok()) return s;
  }
  return {};
}

}  // namespace

TEST_CASE("attachments add the pull of the formula to what is there", "[user_constraints]") {
  for (const std::array<float, 3>& mm :
       {std::array{1.0F, 1.0F, 1.0F}, std::array{0.5F, 1.5F, 3.0F}}) {
    UserConstraints user = random_attachments(25, 9);
    user.millimetres = mm;
    Vertices vertices(500);
    const Vertices before(500);
    vertices.attach(user, 0, vertices.count());
    int pulled = 0;
    for (uint32_t v = 0; v < vertices.count(); ++v) {
      const Point pull =
          expected_pull(user, at(before.at[v]), before.velocity.at(v), before.normal.at(v));
      const Point force = to_point(vertices.force.at(v)) - to_point(before.force.at(v));
      if (reference::distance(force, pull) > 1e-5) FAIL("vertex " << v);
      pulled += reference::length(pull) > 0.01 ? 1 : 0;
    }
    CHECK(pulled > 50);
  }
}

TEST_CASE(
    "blocks that no attachment reaches into are left as they were, and rejecting them "
    "changes no bit of the rest",
    "[user_constraints]") {
  UserConstraints user = random_attachments(25, 4);
  user.millimetres = {0.7F, 1, 2};
  Vertices whole(512), blocks(512), single(512);
  whole.attach(user, 0, 512);
  for (uint32_t b = 0; b < 512; b += 16) {
    blocks.attach(user, b, b + 16);
  }
  // Boxes of one vertex: all that do not reach it are rejected.
  for (uint32_t v = 0; v < 512; ++v) {
    single.attach(user, v, v + 1);
  }
  const Vertices untouched(512);
  int same = 0;
  for (uint32_t v = 0; v < 512; ++v) {
    CHECK(plc::squared(whole.force.at(v) - blocks.force.at(v)) == 0);
    CHECK(plc::squared(whole.force.at(v) - single.force.at(v)) == 0);
    same += plc::squared(whole.force.at(v) - untouched.force.at(v)) == 0 ? 1 : 0;
  }
  CHECK(same > 50);
  CHECK(same < 480);
  whole.attach(user, 5, 5);  // nothing to do
}

TEST_CASE("only the part along the normal pulls, towards the place from either side",
          "[user_constraints]") {
  UserConstraints user;
  user.attachments.push_back({{1, 0, 2}, 10, 2});
  const Vec3 below = pull_at(user, {0, 0, 0}, kUp);
  CHECK(below.x == 0);
  CHECK(below.y == 0);
  CHECK(below.z == Approx(2 * 2 * std::pow(1 - 0.05, 2)));
  CHECK(pull_at(user, {0, 0, 4}, kUp).z == Approx(-below.z));
  CHECK(pull_at(user, {0, 0, 2}, kUp).z == 0);
}

TEST_CASE("the pull fades to 0 at the radius, in millimetres, and stays 0", "[user_constraints]") {
  UserConstraints user;
  user.attachments.push_back({{0, 0, 6}, 6, 1});
  user.millimetres = {1, 1, 2};  // 3 mesh units along z
  float before = pull_at(user, {0, 0, 4.5F}, kUp).z;
  CHECK(before > 0.5F);
  for (const float z : {3.3F, 3.1F, 3.03F, 3.01F}) {
    const float pull = pull_at(user, {0, 0, z}, kUp).z;
    CHECK(pull < before);
    CHECK(pull > 0);
    before = pull;
  }
  CHECK(before < 1e-3F);
  for (const float z : {3.0F, 2.9F, 0.0F, -50.0F}) CHECK(pull_at(user, {0, 0, z}, kUp).z == 0);
  // Across, a mesh unit is one millimetre.
  CHECK(pull_at(user, {5.9F, 0, 5.9F}, kUp).z > 0);
  CHECK(pull_at(user, {6.0F, 0, 5.9F}, kUp).z == 0);
}

TEST_CASE("radii are lengths in mm where the axes of the image lean, too", "[user_constraints]") {
  UserConstraints user;
  user.millimetres = {1, 1, 2};
  user.cosines = {0.5F, 0, 0};  // 60 degrees between x and y
  user.pins.push_back({{0, 0, 0}, 1});
  // Both axes on: sqrt 3 times as far as one of them. One on, the other back: as far as one.
  CHECK(plc::pinned(user, {0.99F, 0, 0}));
  CHECK(plc::pinned(user, {0.57F, 0.57F, 0}));
  CHECK_FALSE(plc::pinned(user, {0.59F, 0.59F, 0}));
  CHECK(plc::pinned(user, {0.99F, -0.99F, 0}));
  CHECK_FALSE(plc::pinned(user, {1.01F, -1.01F, 0}));
  // A place is felt from there, too, though the box of the vertex is farther by its sides.
  user.attachments.push_back({{0.9F, -0.9F, 0}, 1, 1});
  CHECK(pull_at(user, {0, 0, 0}, {1, 0, 0}).x > 0);
  user.cosines = {};
  CHECK(pull_at(user, {0, 0, 0}, {1, 0, 0}).x == 0);
}

TEST_CASE("many attachments on one spot are no stiffer than the strongest", "[user_constraints]") {
  UserConstraints user;
  for (int i = 0; i < 50; ++i) user.attachments.push_back({{0, 0, 1}, 100, i == 7 ? 3.0F : 1.0F});
  CHECK(user.stiffness() == 3);
  const float pull = pull_at(user, {0, 0, 0}, kUp).z;
  CHECK(pull == Approx(52.0 / 50));
  CHECK(UserConstraints().stiffness() == 0);
}

TEST_CASE("the strongest attachment shortens the time step", "[user_constraints]") {
  Mesh mesh;
  fill_sphere(mesh);
  UserConstraints user;
  for (const float strength : {1.0F, 20.0F})
    user.attachments.push_back({{0, 0, 6.1F}, 1, strength});
  user.attachments[0].place = {0, 0, -50};
  plc::Model model = shrinking();
  model.spring = 0;
  const auto dt = static_cast<double>(plc::stable_time_step(model, 20));
  CHECK(dt == Approx(2.2 / std::sqrt(20.0)));
  REQUIRE(step(mesh, model, user).ok());
  // The top vertex is an oscillator along z: one step of Runge-Kutta 4.
  const auto acceleration = [](double z, double speed) {
    const double w = std::pow(1 - (6.1 - z) * (6.1 - z), 2);
    return w * 20 * (6.1 - z) - 2 * std::sqrt(20 * w) * speed;  // with gamma: critical
  };
  const double z = 6;
  const double k1 = acceleration(z, 0), v2 = dt / 2 * k1;
  const double k2 = acceleration(z, v2), v3 = dt / 2 * k2;
  const double k3 = acceleration(z + dt / 2 * v2, v3), v4 = dt * k3;
  CHECK(mesh.displacement.z[kTop] == Approx(dt / 6 * (2 * v2 + 2 * v3 + v4)).epsilon(1e-3));
  CHECK(mesh.displacement.z[kTop] > 0.05F);
}

TEST_CASE("an attachment draws the surface through its place", "[user_constraints]") {
  Mesh mesh;
  fill_sphere(mesh);
  UserConstraints user;
  user.attachments.push_back({{0, 0, 7}, 3, 1});
  plc::Model model = shrinking();
  model.spring = 0;
  model.curvature = 0.1F;
  REQUIRE(step(mesh, model, user, 200).ok());
  const Vec3 top = mesh.at(kTop);
  CAPTURE(top.x, top.y, top.z);
  CHECK(plc::length(top - Vec3{0, 0, 7}) < 0.1F);
  CHECK(plc::length(mesh.displacement.at(kTop)) < 1e-3F);
}

TEST_CASE("vertices that strong attachments pull come to rest", "[user_constraints]") {
  for (const float damping : {0.1F, 0.5F, 2.0F}) {
    Mesh mesh;
    fill_sphere(mesh);
    UserConstraints user;
    user.attachments.push_back({{0, 0, 7}, 3, 20});
    plc::Model model = shrinking();
    model.spring = 0;
    model.curvature = 0.4F;
    model.damping = damping;
    REQUIRE(step(mesh, model, user, 400).ok());
    float fastest = 0;
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      fastest = std::max(fastest, plc::length(mesh.displacement.at(v)));
    }
    CAPTURE(damping);
    CHECK(fastest < 0.02F);
    CHECK(plc::length(mesh.at(kTop) - Vec3{0, 0, 7}) < 0.1F);
  }
}

TEST_CASE("pins hold what lies in their ball where it is, and nothing else", "[user_constraints]") {
  for (const plc::Bound bound : {plc::Bound::kClamp, plc::Bound::kScale}) {
    Mesh mesh;
    fill_sphere(mesh);
    for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.velocity.set(v, {0.05F, 0.02F, -0.1F});
    std::vector<Vec3> before;
    for (uint32_t v = 0; v < mesh.slots(); ++v) before.push_back(mesh.at(v));
    UserConstraints user;
    user.pins.push_back({{0, 0, 6}, 5});
    user.pins.push_back({{-6, 0, 0}, 1.5F});
    user.millimetres = {1, 1, 2};  // 2.5 mesh units along z
    plc::Model model = shrinking();
    model.bound = bound;
    REQUIRE(step(mesh, model, user, 5).ok());
    int held = 0, moved = 0;
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      const Vec3 p = before[v];
      const bool in_first = p.x * p.x + p.y * p.y + 4 * (p.z - 6) * (p.z - 6) < 25;
      const bool in_second = (p.x + 6) * (p.x + 6) + p.y * p.y + 4 * p.z * p.z < 1.5F * 1.5F;
      CHECK(plc::pinned(user, p) == (in_first || in_second));
      const float way = plc::length(mesh.at(v) - p);
      if (in_first || in_second) {
        CHECK(way == 0);
        CHECK(plc::length(mesh.velocity.at(v)) == 0);
        ++held;
      } else if (way > 0.01F) {
        ++moved;
      }
    }
    CHECK(held > 20);
    CHECK(moved > 100);
  }
}

TEST_CASE("the user's force is asked at every stage and added to the others",
          "[user_constraints]") {
  const plc::Model model = shrinking();
  Mesh plain, pushed;
  fill_sphere(plain);
  fill_sphere(pushed);
  UserConstraints none, user;
  int calls = 0;
  std::vector<float> heights;
  user.force = [&](const Mesh& mesh, const plc::Float4* position, Streams3& force) {
    ++calls;
    heights.push_back(position[0].z);
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      CHECK(plc::length(force.at(v)) == 0);
      force.set(v, {0.25F, 0, -0.125F});
    }
    return plc::Status();
  };
  REQUIRE(step(plain, model, none).ok());
  REQUIRE(step(pushed, model, user).ok());
  CHECK(calls == 4);
  // The stages are at different times: the vertex has moved between them.
  CHECK(heights[0] != heights[3]);
  // A uniform force moves all alike and leaves the springs as they are: x'' = f - 0.5 x', by RK4.
  const double dt = static_cast<double>(plc::stable_time_step(model));
  const double h = -0.5 * dt;
  const double expected = (dt * dt) * (0.5 + h / 6 + h * h / 24);
  for (uint32_t v = 0; v < plain.slots(); ++v) {
    const Point way = to_point(pushed.displacement.at(v)) - to_point(plain.displacement.at(v));
    CHECK(way[0] == Approx(0.25 * expected).epsilon(1e-3));
    CHECK(way[1] == Approx(0).margin(1e-5));
    CHECK(way[2] == Approx(-0.125 * expected).epsilon(1e-3));
  }
}

TEST_CASE("the error of the user's force ends the step, and it is not asked again",
          "[user_constraints]") {
  Mesh mesh;
  fill_sphere(mesh);
  UserConstraints user;
  int calls = 0;
  user.force = [&](const Mesh&, const plc::Float4*, Streams3&) {
    ++calls;
    return plc::Status(plc::ErrorCode::kCancelled, "enough");
  };
  const plc::Status status = step(mesh, shrinking(), user, 3);
  CHECK(status.code() == plc::ErrorCode::kCancelled);
  CHECK(status.message() == "enough");
  CHECK(calls == 1);
}

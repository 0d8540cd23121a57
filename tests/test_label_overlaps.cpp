#include "tools/label_overlaps.h"

#include <catch2/catch.hpp>

#include "tools/engine_handles.h"

namespace {

using plc::tools::ContextHandle;
using plc::tools::disjoint;
using plc::tools::find_overlaps;
using plc::tools::Overlap;
using plc::tools::TriangleMesh;

// With faces outward, or inward as those of a cavity.
void add_octahedron(TriangleMesh& mesh, double x, double radius, bool inward = false) {
  const auto first = static_cast<uint32_t>(mesh.xyz.size() / 3);
  for (uint32_t axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      double p[3] = {x, 0, 0};
      p[axis] += sign * radius;
      mesh.xyz.insert(mesh.xyz.end(), p, p + 3);
    }
  }
  for (uint32_t corner = 0; corner < 8; ++corner) {
    const uint32_t a = corner & 1U;
    const uint32_t b = 2 + (corner >> 1U & 1U);
    const uint32_t c = 4 + (corner >> 2U);
    const bool turned = ((a + b + c) % 2 == 0) != inward;
    for (const uint32_t v : {a, turned ? c : b, turned ? b : c}) mesh.abc.push_back(first + v);
  }
}

TriangleMesh octahedron(double x, double radius) {
  TriangleMesh mesh;
  add_octahedron(mesh, x, radius);
  return mesh;
}

TriangleMesh shell(double x, double radius, double inner) {
  TriangleMesh mesh = octahedron(x, radius);
  add_octahedron(mesh, x, inner, true);
  return mesh;
}

struct Case {
  explicit Case(std::vector<TriangleMesh> list) : owned(std::move(list)) {
    for (const TriangleMesh& mesh : owned) meshes.push_back(&mesh);
    plc_context_options options;
    plc_context_options_defaults(&options);
    options.threads = 1;
    context = plc::tools::make_context(options);
  }
  std::vector<Overlap> overlaps() const { return overlaps(std::vector<char>(owned.size(), 1)); }
  std::vector<Overlap> overlaps(const std::vector<char>& changed) const {
    return find_overlaps(context.get(), meshes, changed);
  }
  bool apart() const { return disjoint(context.get(), meshes); }

  std::vector<TriangleMesh> owned;
  std::vector<const TriangleMesh*> meshes;
  ContextHandle context;
};

}  // namespace

TEST_CASE("Surfaces beside each other do not overlap", "[label_overlaps]") {
  const Case c({octahedron(0, 1), octahedron(2.1, 1), {}, octahedron(9, 1)});
  CHECK(c.apart());
  CHECK(c.overlaps().empty());
}

TEST_CASE("A surface in another's cavity does not overlap it", "[label_overlaps]") {
  const Case c({octahedron(0, 1), shell(0, 3, 1.1)});
  CHECK(c.apart());
  CHECK(c.overlaps().empty());
}

TEST_CASE("Surfaces that meet overlap, be it in one point", "[label_overlaps]") {
  for (const double x : {1.5, 2.0}) {
    const Case c({octahedron(9, 1), octahedron(0, 1), octahedron(x, 1)});
    CHECK_FALSE(c.apart());
    const auto overlaps = c.overlaps();
    REQUIRE(overlaps.size() == 1);
    CHECK(overlaps[0].first == 1);
    CHECK(overlaps[0].second == 2);
    CHECK_FALSE(overlaps[0].nested);
  }
}

TEST_CASE("A surface inside another without a cavity overlaps it", "[label_overlaps]") {
  const Case c({octahedron(0, 1), octahedron(0, 3), shell(20, 3, 1), octahedron(20, 2)});
  CHECK_FALSE(c.apart());
  const auto overlaps = c.overlaps();
  REQUIRE(overlaps.size() == 2);
  CHECK(overlaps[0].nested);
  CHECK(overlaps[0].outer == 1);
  CHECK(overlaps[1].first == 2);  // whose cavity lies inside the other: that is nested wrongly too
  CHECK(overlaps[1].outer == 2);
}

TEST_CASE("A surface that meets itself is found by itself", "[label_overlaps]") {
  TriangleMesh twice = octahedron(0, 1);
  add_octahedron(twice, 1, 1);
  const Case c({octahedron(9, 1), twice});
  CHECK_FALSE(c.apart());
  const auto overlaps = c.overlaps();
  REQUIRE(overlaps.size() == 1);
  CHECK(overlaps[0].first == 1);
  CHECK(overlaps[0].second == 1);
}

TEST_CASE("Pairs of which nothing has changed are not looked at again", "[label_overlaps]") {
  const Case c({octahedron(0, 1), octahedron(1, 1), octahedron(9, 1), octahedron(10, 1)});
  CHECK(c.overlaps().size() == 2);
  const auto overlaps = c.overlaps({0, 0, 0, 1});
  REQUIRE(overlaps.size() == 1);
  CHECK(overlaps[0].first == 2);
  CHECK(c.overlaps({0, 0, 0, 0}).empty());
}

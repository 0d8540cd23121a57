#include "tools/command/label_overlaps.h"

#include <catch2/catch.hpp>

#include "tools/command/engine_handles.h"

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
  bool apart() const { return disjoint(context.get(), meshes, false); }

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

TEST_CASE("Of surfaces of several parts, one part inside another's overlaps it",
          "[label_overlaps]") {
  TriangleMesh parts = octahedron(0, 1);
  add_octahedron(parts, 20, 1);
  const Case c({parts, octahedron(0, 3)});  // neither box lies within the other
  CHECK_FALSE(c.apart());
  const auto overlaps = c.overlaps();
  REQUIRE(overlaps.size() == 1);
  CHECK(overlaps[0].nested);
}

TEST_CASE("Of many surfaces those that meet are found, in ascending order", "[label_overlaps]") {
  // A grid in which the neighbours on the first axis meet in every third row only.
  std::vector<TriangleMesh> grid;
  std::vector<std::pair<size_t, size_t>> expected;
  for (size_t row = 0; row < 6; ++row) {
    for (size_t column = 0; column < 5; ++column) {
      TriangleMesh mesh =
          octahedron((row % 3 == 0 ? 1.9 : 2.1) * static_cast<double>(4 - column), 1);
      for (size_t i = 1; i < mesh.xyz.size(); i += 3) mesh.xyz[i] += 1.5 * static_cast<double>(row);
      if (row % 3 == 0 && column > 0) expected.emplace_back(grid.size() - 1, grid.size());
      grid.push_back(std::move(mesh));
    }
  }
  // Rows whose boxes overlap, but not what is in them.
  for (size_t i = 0; i < grid.size(); ++i) {
    for (size_t k = 2; k < grid[i].xyz.size(); k += 3) {
      grid[i].xyz[k] += 1.2 * static_cast<double>(i / 5 % 2);
    }
  }
  const auto overlaps = Case(grid).overlaps();
  REQUIRE(overlaps.size() == expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    CHECK(std::pair(overlaps[i].first, overlaps[i].second) == expected[i]);
    CHECK_FALSE(overlaps[i].nested);
  }
}

TEST_CASE("Surfaces that meet only as floats are apart in doubles", "[label_overlaps]") {
  TriangleMesh left = octahedron(0, 1);
  TriangleMesh right = octahedron(2 + 1e-9, 1);
  for (size_t i = 0; i < left.xyz.size(); ++i) {
    left.xyz[i] += 1e4;
    right.xyz[i] += 1e4;
  }
  const Case c({left, right});
  CHECK(disjoint(c.context.get(), c.meshes, false));
  CHECK_FALSE(disjoint(c.context.get(), c.meshes, true));
}

#include "engine/measure/mesh_check.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "tests/samples/sample_meshes.h"

namespace {

using samples::Soup;

class ReverseExecutor final : public plc::Executor {
 public:
  void run(size_t tasks, const std::function<void(size_t)>& body) const override {
    for (size_t i = tasks; i-- > 0;) body(i);
  }
};

plc::MeshCheck check(const Soup& m, const plc::Executor& executor = plc::SerialExecutor()) {
  plc::MeshCheck c;
  const plc::Status status = plc::check_mesh(m.arrays(), executor, c);
  REQUIRE(status.ok());
  return c;
}

std::string complaint(const Soup& m) {
  plc::MeshCheck c;
  const plc::Status status = plc::check_mesh(m.arrays(), plc::SerialExecutor(), c);
  CHECK(status.code() == plc::ErrorCode::kInvalidData);
  return status.message();
}

// closed, manifold, oriented, outward in this order.
std::string facts(const plc::MeshCheck& c) {
  std::string text;
  for (const int fact : {c.closed, c.manifold, c.oriented, c.outward}) {
    text += fact < 0 ? '-' : (fact == 0 ? '0' : '1');
  }
  return text;
}

Soup tetrahedron() {
  Soup m;
  m.xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  m.abc = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return m;
}

}  // namespace

TEST_CASE("simple closed surfaces are valid", "[mesh_check]") {
  for (const Soup& m :
       {tetrahedron(), samples::cube(), samples::sphere(3), samples::torus(24, 12, 2, 0.7),
        samples::moved(samples::cube(), 0.1, 7, 3)}) {
    const plc::MeshCheck c = check(m);
    CHECK(c.valid == 1);
    CHECK(facts(c) == "1111");
    CHECK(c.self_intersections == 0);
    CHECK(c.first_intersection[0] == -1);
    CHECK(c.first_intersection[1] == -1);
    CHECK(c.degenerate_faces == 0);
  }
}

TEST_CASE("edges, angles and valences of the cube are its own", "[mesh_check]") {
  const plc::MeshCheck c = check(samples::cube());
  CHECK(c.edge_min == 1);
  CHECK(c.edge_max == Approx(std::sqrt(2.0)));
  CHECK(c.edge_mean == Approx((12 + 6 * std::sqrt(2.0)) / 18));
  CHECK(c.min_angle == Approx(45));
  CHECK(c.max_angle == Approx(90));
  CHECK(c.valence_min == 4);
  CHECK(c.valence_max == 6);
  CHECK(c.measures.euler == 2);
}

TEST_CASE("a missing face leaves a border", "[mesh_check]") {
  Soup m = samples::sphere(2);
  m.abc.resize(m.abc.size() - 3);
  const plc::MeshCheck c = check(m);
  CHECK(c.valid == 0);
  CHECK(facts(c) == "011-");
  CHECK(c.border_edges == 3);
  CHECK(c.measures.genus == -1);
}

TEST_CASE("a face more than the surface makes edges of three faces", "[mesh_check]") {
  Soup m = tetrahedron();
  const uint32_t v = m.vertex(2, 2, 2);
  m.face(1, 2, v);
  const plc::MeshCheck c = check(m);
  CHECK(facts(c) == "000-");
  CHECK(c.non_manifold_edges == 1);
  CHECK(c.border_edges == 2);
  CHECK(c.non_manifold_vertices == 2);
  CHECK(c.self_intersections == 0);
}

TEST_CASE("two tetrahedra with a common edge are closed but not manifold", "[mesh_check]") {
  Soup m;
  m.xyz = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0};
  m.abc = {0, 3, 2, 0, 2, 1, 2, 3, 1, 3, 0, 1, 0, 5, 4, 0, 4, 1, 4, 5, 1, 5, 0, 1};
  const plc::MeshCheck c = check(m);
  CHECK(facts(c) == "100-");
  CHECK(c.non_manifold_edges == 1);
  CHECK(c.non_manifold_vertices == 2);
  CHECK(c.inconsistent_edges == 0);
  CHECK(c.self_intersections == 0);
  CHECK(c.valid == 0);
}

TEST_CASE("two tetrahedra with a common vertex differ from a valid mesh in that vertex only",
          "[mesh_check]") {
  Soup m = tetrahedron();
  m.xyz.insert(m.xyz.end(), {-1, 0, 0, 0, -1, 0, 0, 0, -1});
  m.abc.insert(m.abc.end(), {0, 4, 5, 0, 6, 4, 0, 5, 6, 4, 6, 5});
  const plc::MeshCheck c = check(m);
  CHECK(facts(c) == "1011");
  CHECK(c.non_manifold_vertices == 1);
  CHECK(c.non_manifold_edges == 0);
  CHECK(c.self_intersections == 0);
  CHECK(c.measures.components == 2);
  CHECK(c.valid == 0);
}

TEST_CASE("a face turned over is inconsistent with its neighbours", "[mesh_check]") {
  Soup m = samples::sphere(2);
  std::swap(m.abc[0], m.abc[1]);
  const plc::MeshCheck c = check(m);
  CHECK(facts(c) == "110-");
  CHECK(c.inconsistent_edges == 3);
  CHECK(c.self_intersections == 0);
  CHECK(c.valid == 0);
}

TEST_CASE("a surface turned inside out is wrongly oriented", "[mesh_check]") {
  const plc::MeshCheck c = check(samples::flipped(samples::torus(20, 10, 2, 0.7)));
  CHECK(facts(c) == "1110");
  CHECK(c.wrongly_oriented_components == 1);
  CHECK(c.measures.volume < 0);
  CHECK(c.valid == 0);
}

TEST_CASE("the wall of a cavity must face inward, and what is in the cavity outward",
          "[mesh_check]") {
  const Soup outer = samples::moved(samples::sphere(3), 0, 0, 0, 4);
  const Soup wall = samples::moved(samples::sphere(2), 0.5, 0, 0, 2);
  const Soup island = samples::moved(samples::sphere(1), 0.5, 0.2, 0, 0.5);
  const auto nested = [&](bool wall_inward, bool island_outward) {
    Soup m = island_outward ? island : samples::flipped(island);
    m.append(wall_inward ? samples::flipped(wall) : wall);
    m.append(outer);
    m.append(samples::moved(samples::cube(), 10, 0, 0));
    return check(m);
  };
  CHECK(nested(true, true).valid == 1);
  CHECK(facts(nested(false, true)) == "1110");
  CHECK(nested(false, true).wrongly_oriented_components == 1);
  CHECK(nested(true, false).wrongly_oriented_components == 1);
  CHECK(nested(false, false).wrongly_oriented_components == 2);
}

TEST_CASE("spheres that cross intersect themselves and are right in all else", "[mesh_check]") {
  Soup m = samples::sphere(3);
  m.append(samples::moved(samples::sphere(3), 1.7, 0.1, 0.05));
  const plc::MeshCheck c = check(m);
  CHECK(c.closed == 1);
  CHECK(c.manifold == 1);
  CHECK(c.oriented == 1);
  CHECK(c.self_intersections > 10);
  CHECK(c.first_intersection[0] >= 0);
  CHECK(c.first_intersection[1] > c.first_intersection[0]);
  CHECK(c.valid == 0);
}

TEST_CASE("a flat face is degenerate, and its neighbours touch", "[mesh_check]") {
  // Vertex 4 divides the edge 0-1 of one face; the flat face 0-1-4 closes the gap.
  Soup m = tetrahedron();
  const uint32_t v = m.vertex(0.5, 0, 0);
  m.abc = {0, 2, v, v, 2, 1, 0, v, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const plc::MeshCheck c = check(m);
  CHECK(facts(c) == "1111");
  CHECK(c.degenerate_faces == 1);
  CHECK(c.self_intersections == 2);
  CHECK(c.min_angle == 0);
  CHECK(c.max_angle == 180);
  CHECK(c.valid == 0);
}

TEST_CASE("a face that repeats a vertex is degenerate, not closed and not manifold",
          "[mesh_check]") {
  Soup m = samples::sphere(1);
  m.face(0, 4, 4);
  const plc::MeshCheck c = check(m);
  CHECK(facts(c) == "000-");
  CHECK(c.degenerate_faces == 1);
  CHECK(c.border_edges == 0);
  CHECK(c.measures.components == 2);
  CHECK(c.measures.euler == 2);
  CHECK(c.valid == 0);
}

TEST_CASE("duplicate and isolated points are counted and do no harm", "[mesh_check]") {
  Soup m = samples::octahedron();
  m.vertex(1, 0, -0.0);
  m.vertex(1, 0, 0);
  m.vertex(7, 7, 7);
  const plc::MeshCheck c = check(m);
  CHECK(c.duplicate_points == 2);
  CHECK(c.isolated_vertices == 3);
  CHECK(c.measures.euler == 2);
  CHECK(c.valence_min == 4);
  CHECK(c.valid == 1);
}

TEST_CASE("a doubled surface has duplicate points and intersects itself", "[mesh_check]") {
  Soup m = samples::octahedron();
  m.append(samples::octahedron());
  const plc::MeshCheck c = check(m);
  CHECK(c.duplicate_points == 6);
  CHECK(c.self_intersections >= 8);
  CHECK(c.valid == 0);
}

TEST_CASE("an empty mesh has no fault but is not valid", "[mesh_check]") {
  for (const bool with_vertices : {false, true}) {
    Soup m;
    if (with_vertices) m.vertex(1, 2, 3);
    const plc::MeshCheck c = check(m);
    CHECK(facts(c) == "111-");
    CHECK(c.valid == 0);
    CHECK(c.measures.faces == 0);
    CHECK(c.isolated_vertices == (with_vertices ? 1 : 0));
    CHECK(c.edge_max == 0);
    CHECK(c.max_angle == 0);
  }
}

TEST_CASE("impossible indices and values are refused by name", "[mesh_check]") {
  Soup m = samples::cube();
  m.abc[17] = 8;
  CHECK(complaint(m) == "face 5: corner 2 is vertex 8, expected an index below 8");
  m = samples::cube();
  m.xyz[7] = std::numeric_limits<double>::quiet_NaN();
  CHECK(complaint(m) == "vertex 2: y is nan, expected a finite number");
  m.xyz[7] = -std::numeric_limits<double>::infinity();
  CHECK(complaint(m) == "vertex 2: y is -inf, expected a finite number");
  m.xyz[7] = 1e200;
  CHECK(complaint(m) ==
        "vertex 2: y is 9.9999999999999997e+199, expected 0 or a magnitude from 1e-70 to 1e+70");
  m.xyz[7] = 1e-200;
  CHECK(complaint(m).find("expected 0 or a magnitude") != std::string::npos);
  m.xyz[7] = -0.0;
  CHECK(check(m).measures.vertices == 8);
}

TEST_CASE("impossible counts are refused and leave the result alone", "[mesh_check]") {
  plc::MeshCheck c;
  c.valid = 77;
  const plc::SerialExecutor serial;
  const double xyz[3] = {0, 0, 0};
  CHECK(plc::check_mesh({xyz, static_cast<size_t>(-1), nullptr, 0}, serial, c).message() ==
        "the mesh has -1 vertices, expected 0 to 4294967296");
  CHECK(plc::check_mesh({xyz, 1, nullptr, size_t{1} << 40U}, serial, c).code() ==
        plc::ErrorCode::kInvalidArgument);
  CHECK_FALSE(plc::check_mesh({nullptr, 1, nullptr, 0}, serial, c).ok());
  CHECK_FALSE(plc::check_mesh({xyz, 1, nullptr, 1}, serial, c).ok());
  CHECK(c.valid == 77);
}

TEST_CASE("a check is the same bits for any order of tasks", "[mesh_check]") {
  Soup m = samples::torus(120, 60, 2, 0.7);
  m.append(samples::moved(samples::sphere(4), 1.8, 0.3, 0.2));
  m.append(samples::moved(samples::sphere(2), 9, 0, 0));
  const plc::MeshCheck a = check(m), b = check(m, ReverseExecutor());
  CHECK(a.measures.area == b.measures.area);
  CHECK(a.measures.volume == b.measures.volume);
  CHECK(a.measures.components == 3);
  CHECK(a.measures.genus == 1);
  CHECK(a.measures.genus == b.measures.genus);
  CHECK(a.edge_mean == b.edge_mean);
  CHECK(a.min_angle == b.min_angle);
  CHECK(a.self_intersections == b.self_intersections);
  CHECK(a.first_intersection[0] == b.first_intersection[0]);
  CHECK(a.first_intersection[1] == b.first_intersection[1]);
  CHECK(a.wrongly_oriented_components == b.wrongly_oriented_components);
  CHECK(a.self_intersections > 0);
}

TEST_CASE("tiny and huge meshes are judged like others", "[mesh_check]") {
  for (const double size : {1e-60, 1e60}) {
    const plc::MeshCheck c = check(samples::moved(samples::octahedron(), 0, 0, 0, size));
    CHECK(c.valid == 1);
    CHECK(c.measures.volume / size / size / size == Approx(4.0 / 3));
  }
}

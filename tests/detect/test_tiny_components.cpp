#include "engine/detect/tiny_components.h"

#include <catch2/catch.hpp>
#include <vector>

#include "engine/base/constants.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Mesh;
using plc::TinyComponents;
using samples::Soup;

// Turned inside out by a reflection.
void mirror(Mesh& mesh, uint32_t first, uint32_t end) {
  for (uint32_t v = first; v < end; ++v) {
    const plc::Vec3 p = mesh.at(v);
    mesh.place(v, {-p.x, p.y, p.z});
  }
}

Soup large_and_small() {
  Soup soup = samples::sphere(2);  // 66 vertices
  soup.append(samples::moved(samples::octahedron(), 10, 0, 0, 2));
  return soup;
}

constexpr uint32_t kLarge = 66;

}  // namespace

TEST_CASE("a tetrahedron is told from other vertices of valence 3", "[tiny_components]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tetrahedron(), 1);
  for (uint32_t v = 0; v < 4; ++v) CHECK(plc::is_tetrahedron(mesh, v));
  samples::fill_mesh(mesh, samples::bipyramid(3, 1), 1);
  for (uint32_t v = 0; v < 5; ++v) CHECK_FALSE(plc::is_tetrahedron(mesh, v));
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  CHECK_FALSE(plc::is_tetrahedron(mesh, 0));
}

TEST_CASE("deleting a tetrahedron lowers Euler's number by two and nothing else",
          "[tiny_components]") {
  Soup soup = samples::sphere(1);
  soup.append(samples::moved(samples::tetrahedron(), 9, 0, 0));
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  REQUIRE(samples::euler(mesh) == 4);
  plc::delete_tetrahedron(mesh, 20);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(samples::euler(mesh) == 2);
  CHECK(mesh.vertex_count() == 18);
}

TEST_CASE("a small component that turns inside out is deleted, a large one is not",
          "[tiny_components]") {
  const bool by_movement = GENERATE(false, true);
  Mesh mesh;
  samples::fill_mesh(mesh, large_and_small(), 1);
  TinyComponents tiny;
  tiny.start(mesh);
  CHECK(tiny.delete_turned_over(mesh) == 0);
  CHECK(tiny.update(mesh, {}) == 0);
  mirror(mesh, 0, kLarge);
  CHECK(tiny.update(mesh, {}) == 0);
  mirror(mesh, kLarge, mesh.slots());
  CHECK((by_movement ? tiny.delete_turned_over(mesh) : tiny.update(mesh, {})) == 1);
  CHECK(mesh.vertex_count() == kLarge);
  CHECK(plc::broken_invariant(mesh) == "");
}

TEST_CASE("a small component that shrinks under half a cubic delta is deleted",
          "[tiny_components]") {
  // Octahedra have 4/3 r^3.
  for (const auto& [radius, deleted] : {std::pair{0.73, 0}, std::pair{0.71, 1}}) {
    Mesh mesh;
    samples::fill_mesh(mesh, large_and_small(), 1);
    TinyComponents tiny;
    tiny.start(mesh);
    for (uint32_t v = kLarge; v < mesh.slots(); ++v) {
      const plc::Vec3 middle{10, 0, 0};
      mesh.place(v, middle + (mesh.at(v) - middle) * static_cast<float>(radius / 2));
    }
    CHECK(tiny.update(mesh, {}) == deleted);
  }
}

TEST_CASE("the threshold grows with the cube of delta", "[tiny_components]") {
  Mesh mesh;
  samples::fill_mesh(mesh, large_and_small(), 2.5);
  TinyComponents tiny;
  tiny.start(mesh);
  CHECK(tiny.update(mesh, {}) == 0);  // 10.7 against 7.8
  mesh.delta = 2.9;
  CHECK(tiny.update(mesh, {}) == 1);  // 12.2
}

TEST_CASE("walls of a cavity are followed as they are: negative", "[tiny_components]") {
  Soup soup = samples::sphere(2);
  soup.append(samples::moved(samples::flipped(samples::octahedron()), 10, 0, 0, 2));
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  TinyComponents tiny;
  tiny.start(mesh);
  CHECK(tiny.update(mesh, {}) == 0);
  mirror(mesh, kLarge, mesh.slots());
  CHECK(tiny.update(mesh, {}) == 1);
}

TEST_CASE("a component is followed up to forty vertices", "[tiny_components]") {
  for (const uint32_t n : {38U, 39U}) {
    Mesh mesh;
    samples::fill_mesh(mesh, samples::bipyramid(n, 3), 1);
    REQUIRE((mesh.vertex_count() <= plc::kTinyComponent) == (n == 38));
    TinyComponents tiny;
    tiny.start(mesh);
    mirror(mesh, 0, mesh.slots());
    CHECK(tiny.update(mesh, {}) == (n == 38 ? 1 : 0));
  }
}

TEST_CASE("a component that becomes small is followed from then on", "[tiny_components]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  TinyComponents tiny;
  tiny.start(mesh);
  Mesh small;
  samples::fill_mesh(mesh, samples::moved(samples::octahedron(), 0, 0, 0, 2), 1);
  CHECK(tiny.update(mesh, {3}) == 0);
  mirror(mesh, 0, 6);
  CHECK(tiny.update(mesh, {}) == 1);
  CHECK(mesh.vertex_count() == 0);
}

TEST_CASE("a forged state that follows what is no small component does no harm",
          "[tiny_components]") {
  Mesh mesh;
  samples::fill_mesh(mesh, large_and_small(), 1);
  const uint32_t gone = mesh.create({}, {});
  // Number, then vertex and sign: of the large one, of none, of none yet, of the small one, twice.
  std::vector<uint32_t> forged{6, 0};
  for (const uint32_t v : {uint32_t{0}, gone, mesh.slots(), ~0U, kLarge, kLarge + 1}) {
    forged.insert(forged.end(), {v, 0});
  }
  plc::StateReader from(reinterpret_cast<const uint8_t*>(forged.data()), forged.size() * 4);
  TinyComponents tiny;
  tiny.restore(from, mesh.slots());
  REQUIRE(from.ok());
  CHECK(tiny.delete_turned_over(mesh) == 1);
  CHECK(tiny.update(mesh, {}) == 0);
  CHECK(mesh.vertex_count() == kLarge);
}

TEST_CASE("a component named by several changed vertices is looked at once", "[tiny_components]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::moved(samples::octahedron(), 0, 0, 0, 0.1), 1);
  TinyComponents tiny;
  tiny.start(mesh);
  CHECK(tiny.update(mesh, {0, 1, 2, 3, 4, 5, 5, 77}) == 1);
  CHECK(mesh.vertex_count() == 0);
  CHECK(tiny.update(mesh, {}) == 0);
}

TEST_CASE("small components side by side are each found", "[tiny_components]") {
  Soup soup;
  for (int i = 0; i < 30; ++i) {
    soup.append(samples::moved(i % 2 == 0 ? samples::octahedron() : samples::bipyramid(9, 1),
                               5.0 * i, 0, 0, i % 3 == 0 ? 0.2 : 2));
  }
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  TinyComponents tiny;
  tiny.start(mesh);
  CHECK(tiny.update(mesh, {}) == 10);
  CHECK(samples::component_count(mesh) == 20);
  CHECK(plc::broken_invariant(mesh) == "");
}

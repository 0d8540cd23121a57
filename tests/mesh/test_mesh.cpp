#include "engine/mesh/mesh.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/base/constants.h"
#include "engine/base/state_io.h"
#include "engine/resolve/refinement.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_sizing.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Mesh;
using plc::Neighbors;
using plc::Vec3;

Neighbors ring_of(std::initializer_list<uint32_t> ids) {
  Neighbors ring;
  for (const uint32_t id : ids) ring.push_back(id);
  return ring;
}

plc::Vector<uint32_t> listed(const Neighbors& ring) {
  return {ring.begin(), ring.end()};
}

plc::Vector<uint32_t> ids(uint32_t first, uint32_t count) {
  plc::Vector<uint32_t> all(count);
  std::iota(all.begin(), all.end(), first);
  return all;
}

Neighbors ring_of(const plc::Vector<uint32_t>& all) {
  Neighbors ring;
  for (const uint32_t id : all) ring.push_back(id);
  return ring;
}

// Vertices without rings.
void add_vertices(Mesh& mesh, uint32_t count) {
  for (uint32_t v = 0; v < count; ++v) mesh.create({static_cast<float>(v), 0, 0}, {});
}

// What the kernels rely on: slots at and past the valence hold the vertex itself.
bool slots_are_filled(const Mesh& mesh) {
  for (uint32_t v = 0; v < mesh.padded(); ++v) {
    for (uint32_t k = mesh.rings().valence[v]; k < plc::kRingSlots; ++k) {
      if (mesh.rings().column(v, k) != v) return false;
    }
  }
  return true;
}

// What Mesh::restore() says of a sphere whose save was altered.
template <typename Alter>
bool restored(const Alter& alter) {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 0.5);
  alter(mesh);
  plc::StateWriter count;
  mesh.save(count);
  std::vector<uint8_t> bytes(count.size());
  plc::StateWriter writer(bytes.data());
  mesh.save(writer);
  REQUIRE(writer.size() == bytes.size());
  plc::StateReader reader(bytes.data(), bytes.size());
  Mesh other;
  return other.restore(reader) && reader.left() == 0;
}

}  // namespace

TEST_CASE("a new vertex has its position and no ring", "[mesh]") {
  Mesh mesh;
  const uint32_t v = mesh.create({1, 2, 3}, {4, 5, 6});
  CHECK(v == 0);
  CHECK(mesh.slots() == 1);
  CHECK(mesh.padded() == plc::kRingLanes);
  CHECK(mesh.vertex_count() == 0);
  CHECK_FALSE(mesh.alive(v));
  CHECK(mesh.at(v).y == 2);
  CHECK(mesh.at(v).z == 3);
  CHECK(mesh.velocity.at(v).x == 4);
  mesh.set_ring(v, ring_of({1, 2, 3}));
  CHECK(mesh.alive(v));
  CHECK(mesh.vertex_count() == 1);
}

TEST_CASE("every stream is padded to whole blocks and starts at zero", "[mesh]") {
  Mesh mesh;
  add_vertices(mesh, 17);
  CHECK(mesh.padded() == 32);
  for (const auto* stream : {&mesh.velocity, &mesh.normal, &mesh.displacement}) {
    CHECK(stream->x.size() == 32);
    CHECK(stream->y.size() == 32);
    CHECK(stream->z.size() == 32);
    CHECK(reinterpret_cast<uintptr_t>(stream->x.data()) % 64 == 0);
    CHECK(stream->x[31] == 0);
  }
  CHECK(mesh.position.size() == 32);
  CHECK(mesh.path.size() == 32);
  CHECK(slots_are_filled(mesh));
}

TEST_CASE("deleted ids are used again, the last one first", "[mesh]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  mesh.destroy(3);
  mesh.destroy(7);
  CHECK(mesh.vertex_count() == 16);
  CHECK(mesh.slots() == 18);
  CHECK_FALSE(mesh.alive(7));
  mesh.path[7] = 9;
  mesh.cut_id[7] = 5;
  CHECK(mesh.create({}, {}) == 7);
  CHECK(mesh.path[7] == 0);
  CHECK(mesh.cut_id[7] == 0);
  CHECK(mesh.create({}, {}) == 3);
  CHECK(mesh.create({}, {}) == 18);
}

TEST_CASE("a deleted vertex stands still and its slots hold itself", "[mesh]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  mesh.velocity.set(4, {1, 1, 1});
  mesh.displacement.set(4, {1, 1, 1});
  mesh.destroy(4);
  CHECK(plc::length(mesh.velocity.at(4)) == 0);
  CHECK(plc::length(mesh.displacement.at(4)) == 0);
  CHECK(slots_are_filled(mesh));
}

TEST_CASE("rings of any length come back as they were set", "[mesh]") {
  Mesh mesh;
  add_vertices(mesh, 200);
  for (uint32_t length = 3; length <= 150; ++length) {
    const auto ring = ids(10, length);
    mesh.set_ring(5, ring_of(ring));
    CHECK(mesh.valence(5) == length);
    CHECK(listed(mesh.ring(5)) == ring);
    CHECK(mesh.neighbor(5, length - 1) == 9 + length);
    CHECK(slots_are_filled(mesh));
  }
  for (uint32_t length = 150; length-- > 3;) {
    mesh.set_ring(5, ring_of(ids(10, length)));
    CHECK(listed(mesh.ring(5)) == ids(10, length));
    CHECK(slots_are_filled(mesh));
  }
}

TEST_CASE("a ring grows and shrinks by one across every boundary of the tail arena", "[mesh]") {
  Mesh mesh;
  add_vertices(mesh, 100);
  plc::Vector<uint32_t> ring = ids(1, 9);
  mesh.set_ring(0, ring_of(ring));
  // 11 slots are inline; tails hold 16, 32, 64: the boundaries are 11, 27, 43.
  for (uint32_t added = 10; added < 90; ++added) {
    const size_t after = added % ring.size();
    mesh.insert_after(0, ring[after], added);
    ring.insert(ring.begin() + static_cast<ptrdiff_t>(after) + 1, added);
    REQUIRE(listed(mesh.ring(0)) == ring);
  }
  samples::Random random(1);
  while (ring.size() > 3) {
    const auto k = static_cast<size_t>(random.integer(0, static_cast<int64_t>(ring.size()) - 1));
    mesh.remove(0, ring[k]);
    ring.erase(ring.begin() + static_cast<ptrdiff_t>(k));
    REQUIRE(listed(mesh.ring(0)) == ring);
    REQUIRE(slots_are_filled(mesh));
  }
}

TEST_CASE("long rings side by side do not overwrite each other", "[mesh]") {
  Mesh mesh;
  constexpr uint32_t kCount = 60;
  add_vertices(mesh, 400);
  std::vector<plc::Vector<uint32_t>> expected(kCount);
  samples::Random random(2);
  for (int step = 0; step < 3000; ++step) {
    const auto v = static_cast<uint32_t>(random.integer(0, kCount - 1));
    if (!expected[v].empty() && random.integer(0, 9) == 0) {
      mesh.destroy(v);
      expected[v].clear();
      REQUIRE(mesh.create({}, {}) == v);
      continue;
    }
    expected[v] = ids(static_cast<uint32_t>(random.integer(100, 300)),
                      static_cast<uint32_t>(random.integer(3, 60)));
    mesh.set_ring(v, ring_of(expected[v]));
    const auto w = static_cast<uint32_t>(random.integer(0, kCount - 1));
    REQUIRE(listed(mesh.ring(w)) == expected[w]);
  }
  for (uint32_t v = 0; v < kCount; ++v) CHECK(listed(mesh.ring(v)) == expected[v]);
}

TEST_CASE("tails are used again: churn does not grow the arena for ever", "[mesh]") {
  Mesh mesh;
  add_vertices(mesh, 200);
  const auto churn = [&] {
    for (uint32_t length = 3; length < 100; ++length) mesh.set_ring(0, ring_of(ids(1, length)));
  };
  churn();
  const uint64_t after_one = mesh.bytes();
  for (int i = 0; i < 100; ++i) churn();
  CHECK(mesh.bytes() == after_one);
}

TEST_CASE("a neighbour is replaced by one or by two in its place", "[mesh]") {
  Mesh mesh;
  add_vertices(mesh, 60);
  for (const uint32_t length : {5U, 11U, 12U, 26U, 27U}) {
    for (const uint32_t k : {0U, length / 2, length - 1}) {
      mesh.set_ring(0, ring_of(ids(1, length)));
      mesh.replace(0, 1 + k, 50);
      CHECK(mesh.neighbor(0, k) == 50);
      CHECK(mesh.valence(0) == length);
      mesh.replace(0, 50, 51, 52);
      CHECK(mesh.neighbor(0, k) == 51);
      CHECK(mesh.neighbor(0, k + 1) == 52);
      CHECK(mesh.valence(0) == length + 1);
    }
  }
}

TEST_CASE("neighbours are adjacent, in both directions, and others are not", "[mesh]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  for (uint32_t u = 0; u < 6; ++u) {
    for (uint32_t v = 0; v < 6; ++v) {
      CHECK(mesh.adjacent(u, v) == (u != v && u / 2 != v / 2));
    }
  }
}

TEST_CASE("faces are those of the rings, each once, from its smallest vertex", "[mesh]") {
  Mesh mesh;
  const samples::Soup soup = samples::torus(8, 5, 3, 1);
  samples::fill_mesh(mesh, soup, 1);
  const plc::Vector<uint32_t> faces = mesh.faces();
  REQUIRE(faces.size() == soup.abc.size());
  plc::Vector<std::array<uint32_t, 3>> expected;
  for (size_t i = 0; i < soup.abc.size(); i += 3) {
    std::array<uint32_t, 3> f{soup.abc[i], soup.abc[i + 1], soup.abc[i + 2]};
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    expected.push_back(f);
  }
  std::sort(expected.begin(), expected.end());
  plc::Vector<std::array<uint32_t, 3>> found;
  for (size_t i = 0; i < faces.size(); i += 3) {
    CHECK(faces[i] < std::min(faces[i + 1], faces[i + 2]));
    CHECK((i == 0 || faces[i - 3] <= faces[i]));
    found.push_back({faces[i], faces[i + 1], faces[i + 2]});
  }
  std::sort(found.begin(), found.end());
  CHECK(found == expected);
}

TEST_CASE("renumbering changes nothing but the ids", "[mesh]") {
  Mesh mesh;
  samples::Soup soup = samples::torus(9, 5, 3, 1);
  samples::fill_mesh(mesh, soup, 0.5);
  // A vertex of a long ring and gaps in the ids.
  mesh.create({}, {});
  mesh.create({}, {});
  const uint32_t count = mesh.vertex_count();
  for (uint32_t v = 0; v < count; ++v) {
    const auto f = static_cast<float>(v);
    mesh.velocity.set(v, {f, 1, 2});
    mesh.normal.set(v, {f, 3, 4});
    mesh.displacement.set(v, {f, 5, 6});
    mesh.path[v] = f;
    mesh.cut_id[v] = v + 2;
    mesh.cut_iteration[v] = v + 3;
  }
  plc::Vector<uint32_t> order = ids(0, count);
  samples::Random random(3);
  for (size_t i = order.size(); i-- > 1;) {
    std::swap(order[i], order[static_cast<size_t>(random.integer(0, static_cast<int64_t>(i)))]);
  }
  std::vector<Vec3> places;
  std::vector<plc::Vector<uint32_t>> rings;
  for (uint32_t v = 0; v < count; ++v) {
    places.push_back(mesh.at(v));
    rings.push_back(listed(mesh.ring(v)));
  }
  mesh.renumber(order);
  CHECK(mesh.slots() == count);
  CHECK(mesh.delta == 0.5);
  CHECK(mesh.created() == 0);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(slots_are_filled(mesh));
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t v = order[i];
    const auto f = static_cast<float>(v);
    CHECK(plc::squared_distance(mesh.at(i), places[v]) == 0);
    CHECK(mesh.velocity.at(i).x == f);
    CHECK(mesh.normal.at(i).x == f);
    CHECK(mesh.displacement.at(i).x == f);
    CHECK(mesh.path[i] == f);
    CHECK(mesh.cut_id[i] == v + 2);
    CHECK(mesh.cut_iteration[i] == v + 3);
    REQUIRE(mesh.valence(i) == rings[v].size());
    for (uint32_t k = 0; k < mesh.valence(i); ++k) CHECK(order[mesh.neighbor(i, k)] == rings[v][k]);
  }
  CHECK(mesh.create({}, {}) == count);
}

TEST_CASE("a moved mesh keeps its rings, the original's place may be used again", "[mesh]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  Mesh other = std::move(mesh);
  CHECK(plc::broken_invariant(other) == "");
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(plc::broken_invariant(other) == "");
  CHECK(other.vertex_count() == 66);
}

TEST_CASE("a cleared mesh is empty and can be filled again", "[mesh]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  mesh.destroy(5);
  mesh.clear();
  CHECK(mesh.slots() == 0);
  CHECK(mesh.vertex_count() == 0);
  CHECK(mesh.faces().empty());
  CHECK(plc::broken_invariant(mesh) == "");
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(slots_are_filled(mesh));
}

TEST_CASE("a mesh that is filled again has nothing of its past in the padding", "[mesh]") {
  // A speed left there would count as the fastest vertex.
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.velocity.set(v, {1, 2, 3});
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  for (uint32_t v = 0; v < mesh.padded(); ++v) CHECK(plc::length(mesh.velocity.at(v)) == 0);
}

TEST_CASE("reserving makes room without adding vertices", "[mesh]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  mesh.reserve(1000);
  CHECK(mesh.slots() == 6);
  CHECK(mesh.create({}, {}) == 6);
  CHECK(mesh.position.size() >= 1000);
}

TEST_CASE("no id is made beyond the limit, and nothing has changed then", "[mesh]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  CHECK(mesh.most_vertices == plc::kMaxMeshVertices);
  mesh.most_vertices = 6;
  CHECK_THROWS_AS(mesh.create({}, {}), plc::TooManyVertices);
  CHECK_THROWS_AS(mesh.create_many(
                      1, [](uint32_t) { return 6U; }, samples::kSerial),
                  plc::TooManyVertices);
  CHECK_THROWS_AS(mesh.create_many(
                      ~0U - 3, [](uint32_t) { return 6U; }, samples::kSerial),
                  plc::TooManyVertices);
  CHECK_THROWS_AS(mesh.reserve(7), plc::TooManyVertices);
  CHECK_THROWS_AS(mesh.reserve(uint64_t{3} << 31), plc::TooManyVertices);
  CHECK(mesh.slots() == 6);
  CHECK(plc::broken_invariant(mesh) == "");
  Mesh copy = mesh.copy();
  copy.renumber(plc::living_order(copy));
  CHECK_THROWS_AS(copy.create({}, {}), plc::TooManyVertices);
  copy.clear();
  CHECK(copy.most_vertices == 6);
}

TEST_CASE("a ring that 16 bits do not count is told, not cut off", "[mesh]") {
  Mesh mesh;
  for (uint32_t v = 0; v < plc::kMaxValence + 2; ++v) mesh.create({}, {});
  plc::Neighbors ring;
  ring.resize(plc::kMaxValence);
  for (uint32_t k = 0; k < ring.size(); ++k) ring[k] = k + 1;
  mesh.set_ring(0, ring);
  CHECK(mesh.valence(0) == plc::kMaxValence);
  ring.push_back(plc::kMaxValence + 1);
  CHECK_THROWS_WITH(mesh.set_ring(0, ring), Catch::Contains("65536 neighbours"));
  CHECK(mesh.valence(0) == plc::kMaxValence);
}

TEST_CASE("each broken invariant is named", "[mesh]") {
  const auto broken = [](const auto& damage) {
    Mesh mesh;
    samples::fill_mesh(mesh, samples::sphere(1), 1);
    REQUIRE(plc::broken_invariant(mesh) == "");
    damage(mesh);
    return plc::broken_invariant(mesh);
  };
  using Catch::Matchers::Contains;
  CHECK_THAT(broken([](Mesh& m) { m.destroy(4); }), Contains("no living other vertex"));
  CHECK_THAT(broken([](Mesh& m) { m.set_ring(0, ring_of({1, 2})); }), Contains("valence 2"));
  CHECK_THAT(broken([](Mesh& m) { m.replace(0, m.neighbor(0, 0), 0); }), Contains("vertex 0"));
  CHECK_THAT(broken([](Mesh& m) { m.replace(0, m.neighbor(0, 0), m.neighbor(0, 1)); }),
             Contains("twice"));
  CHECK_THAT(broken([](Mesh& m) { m.replace(0, m.neighbor(0, 0), 1); }), Contains("not seen from"));
  CHECK_THAT(broken([](Mesh& m) {
               m.place(3, {std::numeric_limits<float>::quiet_NaN(), 0, 0});
             }),
             Contains("vertex 3: its position is not finite"));
  CHECK_THAT(broken([](Mesh& m) {
               Neighbors ring = m.ring(9);
               std::reverse(ring.data(), ring.data() + ring.size());
               m.set_ring(9, ring);
             }),
             Contains("not seen from"));
}

TEST_CASE("a saved mesh is restored unless it has values that no mesh has", "[mesh]") {
  const float beyond = 2 * plc::kReach;
  CHECK(restored([](Mesh&) {}));
  CHECK_FALSE(restored([&](Mesh& m) { m.place(7, {0, beyond, 0}); }));
  CHECK(restored([](Mesh& m) { m.position[7].w = 1; }));
  for (const float size : {-1.0F, 8.0F, NAN}) {
    CHECK_FALSE(restored([=](Mesh& m) { m.position[7].w = size; }));
  }
  CHECK_FALSE(restored([&](Mesh& m) { m.velocity.set(7, {-beyond, 0, 0}); }));
  CHECK_FALSE(restored([&](Mesh& m) { m.displacement.set(7, {0, 0, beyond}); }));
  CHECK_FALSE(restored([&](Mesh& m) { m.normal.set(7, {NAN, 0, 0}); }));
  CHECK_FALSE(restored([&](Mesh& m) { m.path[7] = HUGE_VALF; }));
  CHECK_FALSE(restored([](Mesh& m) { m.delta = 0; }));
}

TEST_CASE("a renumbered mesh has room for what is created before the next renumbering", "[mesh]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(4), 0.1);
  plc::Vector<uint32_t> order(mesh.slots());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = mesh.slots() - 1 - i;
  mesh.renumber(order);
  const plc::Float4* const position = mesh.position.data();
  const float* const speeds = mesh.velocity.x.data();
  CHECK(mesh.room() >= mesh.slots() + mesh.slots() / 40);
  while (mesh.slots() < mesh.room()) mesh.create({1, 2, 3}, {});
  CHECK(mesh.position.data() == position);
  CHECK(mesh.velocity.x.data() == speeds);
  mesh.create({1, 2, 3}, {});
  CHECK(mesh.room() > mesh.slots());
}

TEST_CASE("vertices that are created at once are as those created one by one", "[mesh]") {
  Mesh one, many;
  for (Mesh* mesh : {&one, &many}) samples::fill_mesh(*mesh, samples::sphere(2), 0.4);
  const auto valence = [](uint32_t i) { return 6 + i % 50; };  // of some more than a ring has slots
  const uint32_t first = many.create_many(300, valence, fixtures::ThreadExecutor(3));
  CHECK(first == one.slots());
  for (uint32_t i = 0; i < 300; ++i) {
    const uint32_t v = one.create({}, {});
    plc::Neighbors ring;
    for (uint32_t w = 0; w < valence(i); ++w) ring.push_back(w);
    one.set_ring(v, ring);
    many.exchange_ring(v, ring);
  }
  CHECK(many.vertex_count() == one.vertex_count());
  CHECK(many.created() == one.created());
  for (uint32_t v = 0; v < one.slots(); ++v) {
    REQUIRE(many.valence(v) == one.valence(v));
    for (uint32_t k = 0; k < one.valence(v); ++k) CHECK(many.neighbor(v, k) == one.neighbor(v, k));
    CHECK(plc::squared_distance(many.at(v), one.at(v)) == 0);
  }
}

TEST_CASE("what is near where sizes grow is looked for as far as they may have grown", "[mesh]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  CHECK(mesh.far_reach(2, 1.5F) == 3);  // uniform
  const samples::FullImage image(true);
  mesh.sizing = &image.sizing;
  plc::measure_edges(mesh);
  CHECK(mesh.stretch == plc::kSizedStretch);
  // Edges of sqrt 2, of sizes of a quarter delta, may be longer than (2) has it.
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.position[v].w = -0.75F;
  plc::measure_edges(mesh);
  CHECK(mesh.stretch == Approx(std::sqrt(2.0) / (2.5 * 0.25)));
  CHECK(mesh.longest_edge == Approx(2.5 * 1.05));
  CHECK(mesh.far_reach(2, 0.1F) == Approx(2 * 0.1 * std::sqrt(2.0) / (2.5 * 0.25)));
  CHECK(mesh.far_reach(2, 100) == Approx(2 * 1.05));  // no edge is longer
}

#include "engine/resolve/resolution.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/detect/edge_constraints.h"
#include "engine/mesh/state_hash.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_sizing.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Mesh;
using plc::OperationCounts;
using plc::Resolution;
using samples::Soup;

struct Resolver {
  explicit Resolver(Mesh& mesh, const plc::Executor& executor = samples::kSerial)
      : detection(mesh, executor), resolution(mesh, executor, detection) {
    resolution.restart();
  }
  const plc::Vector<uint32_t>& search_due() {
    detection.list_due();
    return search();
  }
  const plc::Vector<uint32_t>& search_all() {
    detection.list_all();
    return search();
  }
  OperationCounts run(uint32_t iteration) {
    OperationCounts counts;
    resolution.run(iteration, {}, counts);
    return counts;
  }

  plc::Detection detection;
  Resolution resolution;

 private:
  const plc::Vector<uint32_t>& search() {
    detection.update_hash();
    detection.search();
    return detection.due();
  }
};

// One pass over all vertices.
OperationCounts resolve(Mesh& mesh, const plc::Executor& executor = samples::kSerial,
                        uint32_t iteration = 100) {
  Resolver resolver(mesh, executor);
  resolver.search_all();
  return resolver.run(iteration);
}

int64_t operations(const OperationCounts& n) {
  return n.creation + n.inversion + n.deletion + n.annular + n.axial + n.tetrahedron;
}

int64_t violated_edges(const Mesh& mesh) {
  int64_t count = 0;
  samples::for_each_edge(
      mesh, [&](uint32_t u, uint32_t k) { count += plc::edge_candidate(mesh, u, k) ? 1 : 0; });
  return count;
}

// Creations and annular cuts add to V - E + F and axial transformations take from it as theory
// says.
int64_t expected_euler(int64_t before, const OperationCounts& n) {
  return before + 2 * n.annular - 2 * n.axial - 2 * n.tetrahedron;
}

Soup spheres(double gap) {
  Soup soup = samples::sphere(3);
  soup.append(samples::moved(samples::sphere(3), 0, 0, 2 + gap));
  return soup;
}
constexpr double kDelta = 0.17;  // edges of sphere(3) are 0.19 .. 0.28

}  // namespace

TEST_CASE("a mesh that follows the constraints is left alone", "[resolution]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.5), kDelta);
  const uint64_t before = plc::state_hash(mesh);
  CHECK(operations(resolve(mesh)) == 0);
  CHECK(plc::state_hash(mesh) == before);
}

TEST_CASE("edges that are too short or too long are gone after one pass", "[resolution]") {
  for (const double delta : {0.05, 0.08, 0.3, 0.5}) {
    Mesh mesh;
    samples::fill_mesh(mesh, samples::sphere(3), delta);
    const auto counts = resolve(mesh);
    CAPTURE(delta, counts.creation, counts.deletion, counts.refused);
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(samples::meeting_count(mesh) == 0);
    CHECK(violated_edges(mesh) == 0);
    CHECK((delta < kDelta ? counts.creation : counts.deletion) > 20);
    CHECK(samples::euler(mesh) == 2);
    CHECK(samples::volume(mesh) > 2.5);
  }
}

TEST_CASE("a component with no room for edges of delta vanishes", "[resolution]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), 4);
  const auto counts = resolve(mesh);
  CHECK(mesh.vertex_count() == 0);
  CHECK(counts.tetrahedron >= 1);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(operations(resolve(mesh)) == 0);
}

TEST_CASE("parts that face each other too near are joined", "[resolution]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.2), kDelta);
  const auto counts = resolve(mesh);
  REQUIRE(plc::broken_invariant(mesh) == "");
  CHECK(counts.axial >= 1);
  CHECK(samples::component_count(mesh) == 1);
  CHECK(samples::euler(mesh) == expected_euler(4, counts));
  CHECK(samples::meeting_count(mesh) == 0);
}

TEST_CASE("parts of an adaptive mesh on the full image are joined from the ninth iteration on",
          "[resolution]") {
  samples::FullImage object(true);
  plc::SizeSpec same;
  same.finest = same.coarsest = 1;
  REQUIRE(
      object.sizing.field.build(object.sizing.object.image, 0.5F, kDelta, same, samples::kSerial)
          .ok());
  const auto axial = [&](bool full_image, uint32_t iteration) {
    Mesh mesh;
    samples::fill_mesh(mesh, spheres(0.2), kDelta);
    object.sizing.full_image = full_image;
    mesh.sizing = &object.sizing;
    for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.resize(v);
    plc::measure_edges(mesh);
    return resolve(mesh, samples::kSerial, iteration).axial;
  };
  CHECK(axial(true, plc::kFirstPairs - 1) == 0);
  CHECK(axial(true, plc::kFirstPairs) >= 1);
  CHECK(axial(false, 1) >= 1);
}

TEST_CASE("a narrow tube is cut", "[resolution]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tube(3, 9, 0.55), 1);
  const auto counts = resolve(mesh);
  REQUIRE(plc::broken_invariant(mesh) == "");
  CHECK(counts.annular >= 1);
  CHECK(samples::meeting_count(mesh) == 0);
  CHECK(samples::euler(mesh) == expected_euler(2, counts));
}

TEST_CASE("whatever the mesh, a pass leaves it closed, embedded and of the counted topology",
          "[resolution]") {
  int64_t done = 0, refused = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    samples::Random random(seed);
    Soup soup = seed % 3 == 0   ? spheres(random.uniform(0.05, 0.3))
                : seed % 3 == 1 ? samples::torus(20, 7, 1, random.uniform(0.15, 0.5))
                                : samples::tube(3 + seed % 4, 12, 0.5);
    for (double& c : soup.xyz) c += random.uniform(-0.04, 0.04);
    Mesh mesh;
    samples::fill_mesh(mesh, soup, random.uniform(0.1, 0.6));
    if (samples::meeting_count(mesh) != 0) continue;
    int64_t euler = samples::euler(mesh);
    for (uint32_t pass = 1; pass <= 4; ++pass) {
      const auto counts = resolve(mesh, samples::kSerial, pass);
      done += operations(counts);
      refused += counts.refused;
      CAPTURE(seed, pass);
      REQUIRE(plc::broken_invariant(mesh) == "");
      CHECK(samples::meeting_count(mesh) == 0);
      euler = expected_euler(euler, counts);
      CHECK(samples::euler(mesh) == euler);
    }
  }
  CHECK(done > 2000);
  CHECK(refused > 0);
}

TEST_CASE("a pass has the same result for any executor and SIMD target", "[resolution]") {
  for (const double delta : {0.06, 0.3}) {
    std::vector<uint64_t> hashes;
    for (const plc::SimdTarget simd : plc::available_simd_targets()) {
      const plc::SerialExecutor serial(simd);
      const fixtures::ThreadExecutor threads(3, simd);
      for (const plc::Executor* executor : {static_cast<const plc::Executor*>(&serial),
                                            static_cast<const plc::Executor*>(&threads)}) {
        Mesh mesh;
        samples::fill_mesh(mesh, spheres(0.12), delta);
        Resolver resolver(mesh, *executor);
        for (uint32_t iteration = 1; iteration <= 3; ++iteration) {
          resolver.search_all();
          resolver.run(iteration);
        }
        hashes.push_back(plc::state_hash(mesh));
      }
    }
    for (const uint64_t hash : hashes) CHECK(hash == hashes[0]);
  }
}

TEST_CASE("vertices are due when they have moved far, waited long or are awake", "[resolution]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), kDelta);
  Resolver resolver(mesh);
  CHECK(resolver.search_due().size() == mesh.slots());  // new ones are awake
  CHECK(resolver.search_due().empty());
  const auto far = plc::kCheckPath * static_cast<float>(kDelta);
  mesh.path[7] = far;
  mesh.path[8] = std::nextafter(far, 0.0F);
  mesh.wake(90);
  CHECK(resolver.search_due() == plc::Vector<uint32_t>{7, 90});
  CHECK(mesh.path[7] == 0);
  CHECK(mesh.path[8] > 0);
  CHECK(resolver.detection.idle()[90] == 0);
  CHECK(resolver.search_all().size() == mesh.slots());
  for (int i = 0; i < plc::kCheckPeriod; ++i) CHECK(resolver.search_due().empty());
  CHECK(resolver.search_due().size() == mesh.slots());
}

TEST_CASE("deleted vertices are never due", "[resolution]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.5), kDelta);
  for (uint32_t v = 0; v < 258; ++v) mesh.destroy(v);
  Resolver resolver(mesh);
  const auto& due = resolver.search_all();
  CHECK(due.size() == 258);
  CHECK(due.front() == 258);
}

TEST_CASE("violations of vertices that are not due wait", "[resolution]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), kDelta);
  Resolver resolver(mesh);
  resolver.search_all();
  mesh.place(5, mesh.at(mesh.neighbor(5, 0)) * 1.01F);
  CHECK(resolver.search_due().empty());
  CHECK(operations(resolver.run(1)) == 0);
  mesh.wake(5);
  CHECK(resolver.search_due().size() == 1);
  CHECK(operations(resolver.run(2)) > 0);
  CHECK(plc::broken_invariant(mesh) == "");
}

TEST_CASE("long edges are not split where the halves would meet the surface", "[resolution]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::flat_tetrahedron(), 0.8);
  Resolver resolver(mesh);
  resolver.search_all();
  const OperationCounts counts = resolver.run(1);
  CHECK(counts.refused > 0);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(samples::meeting_count(mesh) == 0);
}

TEST_CASE("what the guard refuses is counted, left as it was and stays due", "[resolution]") {
  int64_t refusals = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    Soup soup = spheres(0.06);
    samples::Random random(seed);
    for (double& c : soup.xyz) c += random.uniform(-0.05, 0.05);
    Mesh mesh;
    samples::fill_mesh(mesh, soup, 0.2);
    if (samples::meeting_count(mesh) != 0) continue;
    Resolver resolver(mesh);
    resolver.search_all();
    const OperationCounts counts = resolver.run(1);
    if (counts.refused == 0) continue;
    refusals += counts.refused;
    // The next iteration looks at some of them again.
    CHECK_FALSE(resolver.search_due().empty());
  }
  CHECK(refusals > 0);
}

TEST_CASE("no vertex gets more neighbours than it may have", "[resolution]") {
  for (const bool limited : {false, true}) {
    uint32_t most = 0;
    int64_t refused = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
      samples::Random random(seed);
      Soup soup =
          seed % 2 == 0 ? spheres(random.uniform(0.05, 0.3)) : samples::torus(20, 7, 1, 0.4);
      for (double& c : soup.xyz) c += random.uniform(-0.03, 0.03);
      Mesh mesh;
      samples::fill_mesh(mesh, soup, random.uniform(0.1, 0.4));
      if (samples::meeting_count(mesh) != 0) continue;
      if (limited) mesh.most_neighbors = 8;
      for (uint32_t pass = 1; pass <= 3; ++pass) {
        refused += resolve(mesh, samples::kSerial, pass).refused;
        REQUIRE(plc::broken_invariant(mesh) == "");
        for (uint32_t v = 0; v < mesh.slots(); ++v) most = std::max(most, mesh.valence(v));
      }
    }
    CHECK((limited ? most <= 8 : most > 8));
    CHECK((!limited || refused > 0));
  }
}

TEST_CASE("whether neighbours fit is asked for every vertex that gets more", "[resolution]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  const plc::Edge edge = plc::edge_at(mesh, 0, 0);
  const auto fits = [&](plc::Operation operation, uint32_t most) {
    mesh.most_neighbors = most;
    return plc::fits_neighbors(mesh, {operation, 1, edge});
  };
  // Every vertex has four neighbours.
  for (const auto operation : {plc::Operation::kInversion, plc::Operation::kCreation}) {
    CHECK(fits(operation, 5));
    CHECK_FALSE(fits(operation, 4));
  }
  CHECK(fits(plc::Operation::kDeletion, 4));
  CHECK_FALSE(fits(plc::Operation::kDeletion, 3));
  CHECK(fits(plc::Operation::kAxial, 12));
  CHECK_FALSE(fits(plc::Operation::kAxial, 11));
  CHECK(fits(plc::Operation::kAnnular, 4));
}

TEST_CASE("what a movement turns inside out is gone, though it is cut in two in the same pass",
          "[resolution]") {
  for (const float side : {1.0F, -1.0F}) {
    Soup waist = samples::tube(3, 5, 1.2);
    for (uint32_t v = 0; v < waist.vertex_count(); ++v) {
      const double narrow = v / 3 == 2 ? 0.4 : 1;
      waist.xyz[3 * v] *= narrow;
      waist.xyz[3 * v + 1] *= narrow;
      waist.xyz[3 * v + 2] *= 1.5;
    }
    Mesh mesh;
    samples::fill_mesh(mesh, waist, 1);
    Resolver resolver(mesh);
    for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.place(v, mesh.at(v) * side);
    resolver.search_all();
    const OperationCounts counts = resolver.run(1);
    CAPTURE(side);
    CHECK((counts.annular > 0) == (side > 0));
    CHECK((mesh.vertex_count() > 0) == (side > 0));
  }
}

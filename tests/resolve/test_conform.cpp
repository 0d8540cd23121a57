#include "engine/resolve/conform.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/mesh/state_hash.h"
#include "engine/start/iso_surface.h"
#include "engine/start/mesh_import.h"
#include "tests/samples/sample_sizing.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"
#include "tests/samples/sample_woken.h"

namespace {

using plc::Mesh;
using plc::OperationCounts;
using samples::Soup;
using samples::Volume;

constexpr double kPi = 3.14159265358979323846;

void import(Mesh& mesh, const Soup& m) {
  REQUIRE(plc::import_mesh(m.arrays(), samples::kSerial, mesh).message() == "");
}

plc::ImageView view_of(const Volume& v) {
  plc::ImageView view;
  view.data = v.values.data();
  for (size_t a = 0; a < 3; ++a) view.dims[a] = static_cast<int32_t>(v.dims[a]);
  return view;
}

plc::Status try_conform(Mesh& mesh, double delta, OperationCounts& counts, int threads = 1) {
  const plc::Schedule schedule(threads);
  return plc::conform(mesh, delta, schedule, counts);
}

struct Violations {
  int64_t edges = 0, shorter = 0, longer = 0;
};

Violations violations(const Mesh& mesh) {
  Violations found;
  const auto delta = static_cast<float>(mesh.delta);
  samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
    const float l2 = plc::squared_distance(mesh.at(u), mesh.at(mesh.neighbor(u, k)));
    ++found.edges;
    found.shorter += l2 <= delta * delta ? 1 : 0;
    found.longer += l2 >= plc::kMaxEdge * plc::kMaxEdge * delta * delta ? 1 : 0;
  });
  return found;
}

// Conforms, and checks what is always so.
OperationCounts conformed(Mesh& mesh, double delta) {
  OperationCounts counts;
  const samples::Woken woken(mesh);
  REQUIRE(try_conform(mesh, delta, counts).message() == "");
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(samples::meeting_count(mesh) == 0);
  CHECK(mesh.delta == delta);
  CHECK(mesh.slots() == mesh.vertex_count());
  const Violations found = violations(mesh);
  CAPTURE(found.edges);
  CHECK(found.shorter == 0);
  CHECK(found.longer == 0);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (!woken[v] || mesh.cut_id[v] != 0 || mesh.velocity.x[v] != 0) {
      FAIL("vertex " << v << " is not at rest and due");
    }
  }
  return counts;
}

// A tube along z of n flat sides of one quadrilateral each.
Soup prism(uint32_t n, double radius, double height) {
  Soup m;
  for (const double z : {0.0, height}) {
    for (uint32_t i = 0; i < n; ++i) {
      m.vertex(radius * std::cos(2 * kPi * i / n), radius * std::sin(2 * kPi * i / n), z);
    }
  }
  const uint32_t bottom = m.vertex(0, 0, 0), top = m.vertex(0, 0, height);
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t j = (i + 1) % n;
    m.face(i, j, n + i);
    m.face(j, n + j, n + i);
    m.face(bottom, j, i);
    m.face(top, n + i, n + j);
  }
  return m;
}

// Slanted, of the thickness of two steps of floats at 1000.
Soup thin_plate(double half) {
  Soup plate = samples::cube();
  for (size_t i = 0; i < plate.xyz.size(); i += 3) {
    const double x = plate.xyz[i] * half, y = plate.xyz[i + 1] * half * 0.92;
    plate.xyz[i] = 1000 + x;
    plate.xyz[i + 1] = 1000 + y;
    plate.xyz[i + 2] = 1000 + 0.37 * x + 0.21 * y + plate.xyz[i + 2] * 2e-4;
  }
  return plate;
}

}  // namespace

TEST_CASE("a sphere ten times too fine becomes one of the right density", "[conform]") {
  Mesh mesh;
  import(mesh, samples::moved(samples::sphere(6), 50, 50, 50, 10));
  const OperationCounts counts = conformed(mesh, 2);
  CHECK(samples::euler(mesh) == 2);
  CHECK(samples::component_count(mesh) == 1);
  CHECK(samples::volume(mesh) == Approx(4000 * kPi / 3).epsilon(0.06));
  // Edges of about 1.5 delta.
  CHECK(mesh.vertex_count() > 4 * kPi * 100 / (3 * 3 * 0.866) * 0.8);
  CHECK(mesh.vertex_count() < 4 * kPi * 100 / (3 * 3 * 0.866) * 1.4);
  CHECK(counts.deletion > 15000);
}

TEST_CASE("a cube of few huge faces keeps its shape", "[conform]") {
  Mesh mesh;
  import(mesh, samples::moved(samples::cube(), -20, 5, 5, 60));
  const OperationCounts counts = conformed(mesh, 1 / plc::kUnitPerDelta);
  CHECK(samples::euler(mesh) == 2);
  CHECK(samples::volume(mesh) == Approx(60 * 60 * 60).epsilon(0.001));
  CHECK(counts.creation > 10000);
  CHECK(counts.creation < 40000);
  plc::Vec3 low = mesh.at(0);
  for (uint32_t v = 0; v < mesh.slots(); ++v) low.x = std::min(low.x, mesh.at(v).x);
  CHECK(low.x == -20);
}

TEST_CASE("a long cylinder of needles is cut up and its needles merged", "[conform]") {
  Mesh mesh;
  import(mesh, prism(24, 4, 80));
  conformed(mesh, 1);
  CHECK(samples::euler(mesh) == 2);
  CHECK(samples::volume(mesh) == Approx(kPi * 16 * 80).epsilon(0.04));
}

TEST_CASE("fine and coarse parts, cavities and handles conform together", "[conform]") {
  Soup m = samples::moved(samples::sphere(5), 0, 0, 0, 12);
  m.append(samples::flipped(samples::moved(samples::sphere(2), 1, 0, 0, 7)));
  m.append(samples::moved(samples::cube(), 20, 0, 0, 50));
  m.append(samples::moved(samples::torus(60, 24, 14, 4), 0, 60, 0));
  Mesh mesh;
  import(mesh, m);
  conformed(mesh, 1);
  CHECK(samples::component_count(mesh) == 4);
  CHECK(samples::euler(mesh) == 6);
}

TEST_CASE("what is within the constraints stays", "[conform]") {
  Mesh mesh;
  import(mesh, samples::moved(samples::sphere(4), 0, 0, 0, 10));
  conformed(mesh, 1.2);
  const uint64_t hash = plc::state_hash(mesh);
  const OperationCounts again = conformed(mesh, 1.2);
  CHECK(again.creation + again.deletion + again.inversion + again.axial + again.annular == 0);
  CHECK(plc::state_hash(mesh) == hash);
}

TEST_CASE("iso-surfaces of noisy images conform", "[conform]") {
  const Volume shape = samples::empty_volume({18, 18, 18});
  Volume chain = samples::chain_potential(samples::empty_volume({40, 40, 40}));
  samples::add_noise(chain, 0.2, 3);
  Volume ball = samples::sphere_potential(shape, 0.3);
  samples::add_noise(ball, 0.8, 5);
  for (const Volume& v : {chain, ball, samples::noise(shape, 5, 3)}) {
    Mesh mesh;
    REQUIRE(plc::iso_surface({view_of(v), 0.5F, true}, samples::kSerial, mesh).ok());
    conformed(mesh, 1 / plc::kUnitPerDelta);
  }
}

TEST_CASE("components too small for delta vanish, and a surface of nothing else is an error",
          "[conform]") {
  Soup m = samples::moved(samples::sphere(2), 0, 0, 0, 10);
  m.append(samples::moved(samples::octahedron(), 30, 0, 0, 0.3));
  Mesh mesh;
  import(mesh, m);
  conformed(mesh, 1);
  CHECK(samples::component_count(mesh) == 1);
  import(mesh, samples::moved(samples::sphere(3), 0, 0, 0, 0.3));
  OperationCounts counts;
  const plc::Status status = try_conform(mesh, 1, counts);
  CHECK(status.code() == plc::ErrorCode::kInvalidData);
  CHECK_THAT(status.message(), Catch::Matchers::Contains("nothing is left of the surface"));
}

TEST_CASE(
    "sheets so near that dividing them makes them meet are left to the guards, and all else "
    "conforms",
    "[conform]") {
  const bool adaptive = GENERATE(false, true);
  const samples::FullImage image(true);
  const plc::Schedule schedule(1);
  plc::Sizing sizing = image.sizing;
  plc::SizeSpec same;
  same.finest = same.coarsest = 1;
  REQUIRE(sizing.field.build(sizing.object.image, 0.5F, 1, same, schedule).ok());
  Soup both = thin_plate(6);
  both.append(samples::moved(samples::cube(), 1000, 1000, 1040, 5));
  Mesh mesh;
  import(mesh, both);
  if (adaptive) mesh.sizing = &sizing;
  OperationCounts counts;
  CHECK(try_conform(mesh, 1, counts).message() == "");
  if (!adaptive) CHECK(mesh.stretch == 1);
  CHECK(samples::meeting_count(mesh) == 0);
  CHECK(samples::volume(mesh) == Approx(125).epsilon(0.1));
}

TEST_CASE("a surface that would need more vertices than there are ids is refused at once",
          "[conform]") {
  Mesh mesh;
  import(mesh, samples::moved(samples::cube(), 0, 0, 0, 1e5));
  OperationCounts counts;
  const plc::Status status = try_conform(mesh, 0.5, counts);
  CHECK(status.code() == plc::ErrorCode::kOutOfMemory);
  CHECK_THAT(status.message(), Catch::Matchers::Contains("vertices at this resolution"));
  CHECK(counts.creation == 0);
}

TEST_CASE("a surface conforms to the same bits with any number of threads", "[conform]") {
  const Volume v = samples::noise(samples::empty_volume({20, 20, 20}), 5, 11);
  std::vector<uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    Mesh mesh;
    REQUIRE(plc::iso_surface({view_of(v), 0.5F, true}, samples::kSerial, mesh).ok());
    OperationCounts counts;
    REQUIRE(try_conform(mesh, 0.8, counts, threads).ok());
    hashes.push_back(plc::state_hash(mesh));
  }
  CHECK(hashes[0] == hashes[1]);
  CHECK(hashes[0] == hashes[2]);
}

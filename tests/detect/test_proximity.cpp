#include "engine/detect/proximity.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/transform/inversion.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_sizing.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Candidate;
using plc::Mesh;
using plc::Operation;
using samples::Soup;

// What all pairs ask for, each once; every vertex pending.
plc::Vector<Candidate> candidates_of(const Mesh& mesh, uint32_t iteration = 100) {
  plc::SpatialHash hash;
  hash.build(mesh, plc::kMinApart * static_cast<float>(mesh.delta), samples::kSerial);
  const plc::Vector<uint32_t> pending(mesh.slots(), 1);
  plc::Vector<Candidate> candidates;
  for (uint32_t u = 0; u < mesh.slots(); ++u) {
    if (mesh.alive(u)) plc::proximity_candidates(mesh, hash, u, pending, 1, iteration, candidates);
  }
  std::sort(candidates.begin(), candidates.end());
  const auto same = [](const Candidate& l, const Candidate& r) { return !(l < r) && !(r < l); };
  candidates.erase(std::unique(candidates.begin(), candidates.end(), same), candidates.end());
  return candidates;
}

// Two unit spheres one above the other; vertices 4 and kLower are the poles that face.
constexpr double kDelta = 0.2;
Soup spheres(double gap) {
  Soup soup = samples::sphere(2);
  soup.append(samples::moved(samples::sphere(2), 0, 0, 2 + gap));
  return soup;
}
constexpr uint32_t kPole = 4, kOther = 66 + 5;

}  // namespace

TEST_CASE("parts that face each other too near ask for an axial transformation", "[proximity]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.25), kDelta);
  const auto candidates = candidates_of(mesh);
  REQUIRE(candidates.size() == 1);
  CHECK(candidates[0].operation == Operation::kAxial);
  CHECK(candidates[0].edge.u == kPole);
  CHECK(candidates[0].edge.v == kOther);
  CHECK(candidates[0].key == Approx(0.0625).epsilon(1e-4));
}

TEST_CASE("sheets between which the image has what the surface says stay apart", "[proximity]") {
  const samples::FullImage object(true), other(false);
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.25), kDelta);
  mesh.sizing = &other.sizing;
  plc::measure_edges(mesh);
  CHECK(candidates_of(mesh).empty());
  mesh.sizing = &object.sizing;
  CHECK(candidates_of(mesh).size() == 1);
  // Two cavities, before they are turned inside out.
  mesh.inside_out = true;
  CHECK(candidates_of(mesh).empty());
  mesh.sizing = &other.sizing;
  CHECK(candidates_of(mesh).size() == 1);
  // The wall between a cavity and what is around.
  Soup soup = samples::flipped(samples::sphere(2));
  soup.append(samples::moved(samples::sphere(2), 0, 0, 0, 1.1));
  Mesh wall;
  samples::fill_mesh(wall, soup, kDelta);
  wall.sizing = &object.sizing;
  plc::measure_edges(wall);
  CHECK(candidates_of(wall).empty());
  wall.sizing = &other.sizing;
  CHECK(candidates_of(wall).size() == 66);
}

TEST_CASE("a pair at the distance of (3) is far enough", "[proximity]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(1), kDelta);
  const auto reach = plc::kMinApart * static_cast<float>(kDelta);
  mesh.place(kPole, {0, 0, 0});
  mesh.place(kOther, {0, 0, reach});
  CHECK(candidates_of(mesh).empty());
  mesh.place(kOther, {0, 0, std::nextafter(reach, 0.0F)});
  CHECK(candidates_of(mesh).size() == 1);
}

TEST_CASE("a pair is taken once, from whichever of its ends is pending", "[proximity]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.2), kDelta);
  plc::SpatialHash hash;
  hash.build(mesh, plc::kMinApart * static_cast<float>(kDelta), samples::kSerial);
  const auto found_from = [&](std::initializer_list<uint32_t> queue) {
    plc::Vector<uint32_t> pending(mesh.slots(), 6);
    for (const uint32_t u : queue) pending[u] = 7;
    plc::Vector<Candidate> candidates;
    for (const uint32_t u : queue) {
      plc::proximity_candidates(mesh, hash, u, pending, 7, 1, candidates);
    }
    return candidates.size();
  };
  CHECK(found_from({kPole}) == 1);
  CHECK(found_from({kOther}) == 1);
  CHECK(found_from({kPole, kOther}) == 1);
  CHECK(found_from({kOther, kPole}) == 1);
  CHECK(found_from({0, 1, 2}) == 0);
}

TEST_CASE("neighbours are never a pair", "[proximity]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tetrahedron(), 10);
  CHECK(candidates_of(mesh).empty());
}

TEST_CASE("parts whose normals agree are one sheet", "[proximity]") {
  // A sphere in a slightly larger one: both outward.
  Soup soup = samples::sphere(2);
  soup.append(samples::moved(samples::sphere(2), 0, 0, 0, 1.1));
  Mesh mesh;
  samples::fill_mesh(mesh, soup, kDelta);
  CHECK(candidates_of(mesh).empty());
  // The inner one as the wall of a cavity: every vertex faces its image.
  soup = samples::flipped(samples::sphere(2));
  soup.append(samples::moved(samples::sphere(2), 0, 0, 0, 1.1));
  samples::fill_mesh(mesh, soup, kDelta);
  const auto candidates = candidates_of(mesh);
  CHECK(candidates.size() == 66);
  for (const Candidate& c : candidates) CHECK(c.edge.v == c.edge.u + 66);
}

TEST_CASE("pairs of a fresh cut are left alone while they do not approach", "[proximity]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.25), kDelta);
  const auto cut = [&](uint32_t v, uint32_t id, uint32_t iteration) {
    mesh.cut_id[v] = id;
    mesh.cut_iteration[v] = iteration;
  };
  cut(kPole, 9, 100);
  cut(kOther, 9, 100);
  CHECK(candidates_of(mesh, 100).empty());
  CHECK(candidates_of(mesh, 104).empty());
  CHECK(candidates_of(mesh, 105).size() == 1);
  mesh.velocity.set(kPole, {1, 0, -0.1F});  // away
  CHECK(candidates_of(mesh, 102).empty());
  mesh.velocity.set(kOther, {1, 0, -0.2F});  // after it, faster
  CHECK(candidates_of(mesh, 102).size() == 1);
  mesh.velocity.set(kOther, {0, 0, 0});
  cut(kOther, 8, 100);
  CHECK(candidates_of(mesh, 100).size() == 1);
  cut(kPole, 0, 0);
  cut(kOther, 0, 0);
  CHECK(candidates_of(mesh, 1).size() == 1);
}

TEST_CASE("vertices across an edge that is longer than their distance ask for its inversion",
          "[proximity]") {
  // The poles of a flat octahedron lie across each of its four equatorial edges.
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  mesh.place(4, {0, 0, 0.2F});
  mesh.place(5, {0, 0, -0.2F});
  bool poles = false;
  for (const Candidate& c : candidates_of(mesh)) {
    CHECK(c.operation == Operation::kInversion);
    CHECK(plc::can_invert(mesh, c.edge));
    const bool here = c.edge.a + c.edge.b == 9 && c.edge.a / 4 == 1;
    poles = poles || here;
    const float across = plc::squared_distance(mesh.at(c.edge.a), mesh.at(c.edge.b));
    CHECK(c.key == across);
    CHECK(across < plc::squared_distance(mesh.at(c.edge.u), mesh.at(c.edge.v)));
    // The edge as it is in the mesh.
    const plc::Edge e = plc::edge_between(mesh, c.edge.u, c.edge.v);
    CHECK(e.a == c.edge.a);
    CHECK(e.b == c.edge.b);
  }
  CHECK(poles);
}

TEST_CASE("vertices across an edge that is shorter are a crease and no collision", "[proximity]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  for (uint32_t v = 0; v < 4; ++v) mesh.place(v, mesh.at(v) * 0.3F);
  for (uint32_t v = 4; v < 6; ++v) mesh.place(v, mesh.at(v) * 0.5F);
  for (const Candidate& c : candidates_of(mesh)) {
    CHECK_FALSE((c.edge.u >= 4 && c.edge.v >= 4));
    CHECK_FALSE((c.edge.a >= 4 && c.edge.b >= 4));
    CHECK(c.operation != Operation::kAxial);
  }
}

TEST_CASE("deleted vertices and places they have left are no pairs", "[proximity]") {
  Mesh mesh;
  samples::fill_mesh(mesh, spheres(0.25), kDelta);
  plc::SpatialHash hash;
  hash.build(mesh, plc::kMinApart * static_cast<float>(kDelta), samples::kSerial);
  const plc::Vector<uint32_t> pending(mesh.slots(), 0);
  plc::Vector<Candidate> candidates;
  mesh.place(kOther, {0, 0, 1.9F});
  plc::proximity_candidates(mesh, hash, kPole, pending, 1, 1, candidates);
  CHECK(candidates.empty());
  hash.insert(kOther, mesh.at(kOther));
  mesh.place(kOther, {0, 0, 1.25F});
  hash.insert(kOther, mesh.at(kOther));
  plc::proximity_candidates(mesh, hash, kPole, pending, 1, 1, candidates);
  CHECK(candidates.size() >= 1);
}

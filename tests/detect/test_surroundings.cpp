#include "engine/detect/surroundings.h"

#include <catch2/catch.hpp>
#include <set>

#include "engine/base/constants.h"
#include "engine/detect/risk.h"
#include "engine/resolve/refinement.h"
#include "engine/transform/edge.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Mesh;
using plc::Surroundings;
using plc::VertexPair;
using samples::Soup;

constexpr double kDelta = 0.2;

// A ball, another near it, and a thin shell that is inside out: pairs of every kind.
void fill_scene(Mesh& mesh) {
  Soup soup = samples::sphere(4);
  soup.append(samples::moved(samples::sphere(4), 0.05, 0, 2.15));
  soup.append(samples::flipped(samples::moved(samples::sphere(4), 0, 0, 0, 0.95)));
  samples::fill_mesh(mesh, soup, kDelta);
  mesh.renumber(plc::morton_order(mesh));
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.normal.set(v, plc::vertex_normal(mesh, v));
}

struct Found {
  plc::Vector<VertexPair> too_near;
  std::set<uint32_t> at_risk;
};

// Every due vertex with every other.
Found expected(const Mesh& mesh, const plc::Vector<uint32_t>& due) {
  const auto near = plc::kMinApart * static_cast<float>(mesh.delta);
  const auto far = plc::kRiskReach * static_cast<float>(mesh.delta);
  Found found;
  for (const uint32_t v : due) {
    const plc::Neighbors ring = mesh.ring(v);
    for (uint32_t w = 0; w < mesh.slots(); ++w) {
      const float squared = plc::squared_distance(mesh.at(v), mesh.at(w));
      if (w == v || !mesh.alive(w) || ring.contains(w) || squared > far * far) continue;
      if (squared < near * near) found.too_near.push_back({std::min(v, w), std::max(v, w)});
      const bool turned = plc::dot(mesh.normal.at(v), mesh.normal.at(w)) <= plc::kRiskDot;
      if (turned && plc::Risk(mesh, v).may_meet(w)) found.at_risk.insert({v, w});
    }
  }
  std::sort(found.too_near.begin(), found.too_near.end());
  found.too_near.erase(std::unique(found.too_near.begin(), found.too_near.end()),
                       found.too_near.end());
  return found;
}

Found searched(Surroundings& around, const Mesh& mesh, const plc::Vector<uint32_t>& due) {
  plc::SpatialHash hash;
  hash.build(mesh, plc::kHashCell * static_cast<float>(mesh.delta), samples::kSerial);
  around.search(due, hash);
  return {around.too_near(), {around.at_risk().begin(), around.at_risk().end()}};
}

plc::Vector<uint32_t> every(const Mesh& mesh, uint32_t step) {
  plc::Vector<uint32_t> due;
  for (uint32_t v = 0; v < mesh.slots(); v += step) {
    if (mesh.alive(v)) due.push_back(v);
  }
  return due;
}

}  // namespace

TEST_CASE("what is too near and what is at risk is found around all, many and few vertices",
          "[surroundings]") {
  Mesh mesh;
  fill_scene(mesh);
  Surroundings around(mesh, samples::kSerial);
  for (const uint32_t step : {1U, 7U, 400U, 1U}) {  // again: buffers are kept
    const auto due = every(mesh, step);
    const Found found = searched(around, mesh, due), all = expected(mesh, due);
    CAPTURE(step);
    CHECK(found.too_near == all.too_near);
    CHECK(found.at_risk == all.at_risk);
    if (step != 1) continue;
    CHECK(found.too_near.size() > 100);
    CHECK(found.at_risk.size() > 20);
    CHECK(found.at_risk.size() < mesh.slots());
  }
  CHECK(searched(around, mesh, {}).too_near.empty());
  CHECK(searched(around, mesh, {}).at_risk.empty());
}

TEST_CASE("where everything is too near, so many pairs of a vertex are listed and no more",
          "[surroundings]") {
  Mesh mesh;
  fill_scene(mesh);
  mesh.delta = 10;
  Surroundings around(mesh, samples::kSerial);
  const auto due = every(mesh, 1);
  const size_t pairs = searched(around, mesh, due).too_near.size();
  CHECK(pairs >= mesh.slots());
  CHECK(pairs <= plc::kMostNear * mesh.slots());
  CHECK(expected(mesh, due).too_near.size() > plc::kMostNear * mesh.slots());
}

TEST_CASE("a search for what is too near finds that alone", "[surroundings]") {
  Mesh mesh;
  fill_scene(mesh);
  const auto due = every(mesh, 1);
  plc::SpatialHash hash;
  hash.build(mesh, plc::kHashCell * static_cast<float>(mesh.delta), samples::kSerial);
  Surroundings around(mesh, samples::kSerial);
  around.search_near(due, hash);
  CHECK(around.too_near() == expected(mesh, due).too_near);
  CHECK(around.at_risk().empty());
}

TEST_CASE("deleted vertices are near nothing", "[surroundings]") {
  Mesh mesh;
  fill_scene(mesh);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (mesh.at(v).z > 1.1F) mesh.destroy(v);  // the second ball
  }
  Surroundings around(mesh, samples::kSerial);
  const auto due = every(mesh, 1);
  const Found found = searched(around, mesh, due);
  for (const VertexPair& pair : found.too_near) {
    CHECK(mesh.alive(pair.u));
    CHECK(mesh.alive(pair.w));
  }
  CHECK(found.too_near == expected(mesh, due).too_near);
}

TEST_CASE("what is found depends neither on threads nor on the SIMD target", "[surroundings]") {
  Mesh mesh;
  fill_scene(mesh);
  const auto due = every(mesh, 2);
  const plc::SerialExecutor scalar(plc::SimdTarget::kScalar);
  Surroundings one(mesh, scalar);
  const Found first = searched(one, mesh, due);
  const plc::Vector<uint32_t> in_order = one.at_risk();
  for (const plc::SimdTarget simd : plc::available_simd_targets()) {
    const fixtures::ThreadExecutor threads(3, simd);
    Surroundings other(mesh, threads);
    CHECK(searched(other, mesh, due).too_near == first.too_near);
    CHECK(other.at_risk() == in_order);
  }
}

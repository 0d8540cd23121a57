#include "engine/detect/risk.h"

#include <catch2/catch.hpp>

#include "engine/base/constants.h"
#include "engine/transform/edge.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Mesh;
using plc::Vec3;

constexpr double kDelta = 0.2;
constexpr uint32_t kPole = 4, kOther = 66 + 5;  // those that face each other

// Two unit spheres one above the other.
void fill_spheres(Mesh& mesh, double gap) {
  samples::Soup soup = samples::sphere(2);
  soup.append(samples::moved(samples::sphere(2), 0, 0, 2 + gap));
  samples::fill_mesh(mesh, soup, kDelta);
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.normal.set(v, plc::vertex_normal(mesh, v));
}

bool may_meet(const Mesh& mesh, uint32_t v, uint32_t w) {
  return plc::Risk(mesh, v).may_meet(w);
}

}  // namespace

TEST_CASE("parts that face each other may meet when less than the gap is between them", "[risk]") {
  const double gap = static_cast<double>(plc::kRiskGap) * kDelta;
  for (const double factor : {0.2, 0.8, 0.99, 1.01, 1.5, 4.0}) {
    Mesh mesh;
    fill_spheres(mesh, factor * gap);
    CAPTURE(factor);
    CHECK(may_meet(mesh, kPole, kOther) == (factor < 1));
    CHECK(may_meet(mesh, kOther, kPole) == (factor < 1));
  }
}

TEST_CASE("faces around a sharp rim may not meet, though no plane parts the stars", "[risk]") {
  // A double cone with a flat rim: a vertex above the rim and one below it share neighbours there.
  Mesh mesh;
  samples::Soup soup = samples::sphere(3);
  for (size_t i = 2; i < soup.xyz.size(); i += 3) soup.xyz[i] *= 0.6;
  samples::fill_mesh(mesh, soup, 0.1);
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.normal.set(v, plc::vertex_normal(mesh, v));
  int across = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    for (uint32_t w = 0; w < mesh.slots(); ++w) {
      const bool near = plc::squared_distance(mesh.at(v), mesh.at(w)) < 0.3F;
      if (v == w || mesh.adjacent(v, w) || !near) continue;
      if (plc::dot(mesh.normal.at(v), mesh.normal.at(w)) > plc::kRiskDot) continue;
      ++across;
      CHECK_FALSE(may_meet(mesh, v, w));
    }
  }
  CHECK(across > 20);
}

TEST_CASE("wherever faces without a common vertex meet, their stars may", "[risk]") {
  samples::Random random(5);
  int meeting = 0;
  for (int i = 0; i < 60; ++i) {
    Mesh mesh;
    fill_spheres(mesh, random.uniform(-0.4, 0.1));
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      const auto part = [&] { return static_cast<float>(random.uniform(-0.05, 0.05)); };
      mesh.place(v, mesh.at(v) + Vec3{part(), part(), part()});
    }
    for (const auto& [f, g] : samples::meeting_pairs(mesh)) {
      for (const uint32_t v : f) {
        for (const uint32_t w : g) {
          if (v == w || mesh.adjacent(v, w)) continue;
          ++meeting;
          CHECK(may_meet(mesh, v, w));
        }
      }
    }
  }
  CHECK(meeting > 100);
}

#include "engine/exact/face_tree.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "engine/exact/self_intersection.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_meshes.h"

namespace {

using samples::Soup;

struct Bounds {
  double low[3], high[3];
};

Bounds bounds(const Soup& m, uint32_t f) {
  Bounds b{};
  for (size_t k = 0; k < 3; ++k) {
    const auto at = [&](size_t c) { return m.xyz[3 * m.abc[3 * f + c] + k]; };
    b.low[k] = std::min({at(0), at(1), at(2)});
    b.high[k] = std::max({at(0), at(1), at(2)});
  }
  return b;
}

bool overlap(const Bounds& a, const Bounds& b) {
  for (size_t k = 0; k < 3; ++k) {
    if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
  }
  return true;
}

Soup random_soup(unsigned seed, size_t faces, double spread) {
  std::mt19937 bits(seed);
  std::normal_distribution<double> normal;
  Soup m;
  for (size_t f = 0; f < faces; ++f) {
    const double x = normal(bits), y = normal(bits), z = normal(bits);
    const double size = std::exp(spread * normal(bits)) * 0.1;
    for (int k = 0; k < 3; ++k) {
      m.vertex(x + size * normal(bits), y + size * normal(bits), z + size * normal(bits));
    }
    const auto v = static_cast<uint32_t>(3 * f);
    m.face(v, v + 1, v + 2);
  }
  return m;
}

plc::FaceTree tree_of(const Soup& m) {
  plc::Vector<uint32_t> ids(m.face_count());
  std::iota(ids.begin(), ids.end(), 0U);
  plc::FaceTree tree;
  tree.build(m.xyz.data(), m.abc.data(), ids.data(), ids.size(), plc::SerialExecutor());
  return tree;
}

}  // namespace

TEST_CASE("the tree pairs every two faces whose boxes overlap exactly once", "[face_tree]") {
  for (const size_t faces : {1U, 7U, 8U, 9U, 64U, 65U, 500U}) {
    const Soup m = random_soup(static_cast<unsigned>(faces), faces, faces % 2 == 0 ? 2 : 0.1);
    plc::Vector<plc::FacePair> want, got;
    for (uint32_t f = 0; f < faces; ++f) {
      for (uint32_t g = f + 1; g < faces; ++g) {
        if (overlap(bounds(m, f), bounds(m, g))) want.emplace_back(f, g);
      }
    }
    const plc::FaceTree tree = tree_of(m);
    CHECK(tree.face_count() == faces);
    for (size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
      tree.overlapping_pairs(
          leaf, [&](uint32_t f, uint32_t g) { got.emplace_back(std::min(f, g), std::max(f, g)); });
    }
    std::sort(got.begin(), got.end());
    CHECK(got == want);
  }
}

TEST_CASE("a segment visits every face whose box it passes through, each once", "[face_tree]") {
  const Soup m = random_soup(5, 400, 1);
  const plc::FaceTree tree = tree_of(m);
  std::mt19937 bits(6);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    plc::Point3 s{normal(bits), normal(bits), normal(bits)};
    plc::Point3 e{3 * normal(bits), 3 * normal(bits), 3 * normal(bits)};
    if (i % 4 == 0) e.x = s.x;
    if (i % 8 == 0) e.y = s.y;
    std::vector<int> visits(m.face_count(), 0);
    tree.along_segment(s, e, [&](uint32_t f) { ++visits[f]; });
    for (uint32_t f = 0; f < m.face_count(); ++f) {
      bool inside = false;  // some point of a fine sampling lies in the box
      const Bounds b = bounds(m, f);
      for (int k = 0; k <= 300 && !inside; ++k) {
        const double t = k / 300.0;
        const Bounds p = {{s.x + t * (e.x - s.x), s.y + t * (e.y - s.y), s.z + t * (e.z - s.z)},
                          {s.x + t * (e.x - s.x), s.y + t * (e.y - s.y), s.z + t * (e.z - s.z)}};
        inside = overlap(p, b);
      }
      REQUIRE(visits[f] <= 1);
      REQUIRE((!inside || visits[f] == 1));
    }
  }
}

TEST_CASE("the nearest of all faces is found, and few are asked for", "[face_tree]") {
  const Soup m = random_soup(9, 3000, 0.5);
  const plc::FaceTree tree = tree_of(m);
  std::mt19937 bits(10);
  std::normal_distribution<double> normal;
  size_t asked = 0;
  for (int i = 0; i < 200; ++i) {
    const plc::Point3 p{2 * normal(bits), 2 * normal(bits), 2 * normal(bits)};
    const auto squared = [&](uint32_t f) {  // to the first corner
      const double* q = m.xyz.data() + 9 * static_cast<size_t>(f);
      return (q[0] - p.x) * (q[0] - p.x) + (q[1] - p.y) * (q[1] - p.y) +
             (q[2] - p.z) * (q[2] - p.z);
    };
    double least = 1e300;
    for (uint32_t f = 0; f < m.face_count(); ++f) least = std::min(least, squared(f));
    CHECK(tree.nearest(p, 1e300, [&](uint32_t f) {
      ++asked;
      return squared(f);
    }) == least);
    CHECK(tree.nearest(p, least / 2, squared) == least / 2);
  }
  CHECK(asked < 200 * m.face_count() / 10);
}

TEST_CASE("an empty tree pairs and visits nothing", "[face_tree]") {
  const plc::FaceTree tree = tree_of(Soup());
  CHECK(tree.leaf_count() == 0);
  int visits = 0;
  tree.along_segment({0, 0, 0}, {1, 1, 1}, [&](uint32_t) { ++visits; });
  CHECK(visits == 0);
  CHECK(tree.nearest({0, 0, 0}, 7, [](uint32_t) { return 0.0; }) == 7);
}

#include "engine/exact/self_intersection.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <thread>

#include "engine/exact/triangle_intersection.h"
#include "tests/samples/sample_meshes.h"

namespace {

using plc::FacePair;
using samples::Soup;

class ReverseExecutor final : public plc::Executor {
 public:
  void run(size_t tasks, const std::function<void(size_t)>& body) const override {
    for (size_t i = tasks; i-- > 0;) body(i);
  }
};

class ThreadExecutor final : public plc::Executor {
 public:
  explicit ThreadExecutor(size_t threads) : threads_(threads) {}
  void run(size_t tasks, const std::function<void(size_t)>& body) const override {
    std::vector<std::thread> threads;
    for (size_t t = 0; t < threads_; ++t) {
      threads.emplace_back([&, t] {
        for (size_t i = t; i < tasks; i += threads_) body(i);
      });
    }
    for (std::thread& thread : threads) thread.join();
  }

 private:
  size_t threads_;
};

plc::Vector<FacePair> pairs_of(const Soup& m) {
  return plc::self_intersections(m.arrays(), plc::SerialExecutor());
}

plc::Vector<FacePair> every_pair_tested(const Soup& m) {
  plc::Vector<FacePair> pairs;
  const auto faces = static_cast<uint32_t>(m.face_count());
  for (uint32_t f = 0; f < faces; ++f) {
    const plc::Triangle a = plc::make_triangle(m.xyz.data(), m.abc.data() + 3 * f);
    for (uint32_t g = f + 1; g < faces; ++g) {
      const plc::Triangle b = plc::make_triangle(m.xyz.data(), m.abc.data() + 3 * g);
      if (plc::triangles_intersect(a, b)) pairs.emplace_back(f, g);
    }
  }
  return pairs;
}

Soup random_faces(unsigned seed, size_t count, double smallest, double largest) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<double> unit(-1, 1), size(std::log(smallest), std::log(largest));
  Soup m;
  for (size_t i = 0; i < count; ++i) {
    const double r = std::exp(size(bits));
    const double x = unit(bits), y = unit(bits), z = unit(bits);
    const auto corner = [&] {
      return m.vertex(x + r * unit(bits), y + r * unit(bits), z + r * unit(bits));
    };
    const uint32_t a = corner(), b = corner(), c = corner();
    m.face(a, b, c);
  }
  return m;
}

Soup shaken(Soup m, unsigned seed, double amount) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<double> unit(-amount, amount);
  for (double& x : m.xyz) x += unit(bits);
  return m;
}

}  // namespace

TEST_CASE("simple closed surfaces do not intersect themselves", "[self_intersection]") {
  CHECK(pairs_of(samples::cube()).empty());
  CHECK(pairs_of(samples::sphere(4)).empty());
  CHECK(pairs_of(samples::torus(60, 30, 2, 0.7)).empty());
  CHECK(pairs_of(Soup()).empty());
}

TEST_CASE("two overlapping spheres intersect where a test of every pair says so",
          "[self_intersection]") {
  Soup m = samples::sphere(3);
  m.append(samples::moved(samples::sphere(3), 0.7, 0.31, 0.2));
  const auto pairs = pairs_of(m);
  CHECK(pairs.size() > 50);
  CHECK(pairs == every_pair_tested(m));
}

TEST_CASE("a face folded over an edge intersects its neighbour", "[self_intersection]") {
  Soup m;
  m.xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.2, 0.5, 0};
  m.abc = {0, 1, 2, 1, 0, 3};
  CHECK(pairs_of(m) == plc::Vector<FacePair>{{0, 1}});
  m.xyz[11] = 1e-12;
  CHECK(pairs_of(m).empty());
}

TEST_CASE("two cubes that touch in a vertex, an edge or a face intersect", "[self_intersection]") {
  const auto beside = [](double x, double y, double z) {
    Soup m = samples::cube();
    m.append(samples::moved(samples::cube(), x, y, z));
    const auto pairs = pairs_of(m);
    CHECK(pairs == every_pair_tested(m));
    return pairs.size();
  };
  CHECK(beside(1, 1, 1) > 0);
  CHECK(beside(1, 1, 0.5) > 0);
  CHECK(beside(1, 0.25, 0.5) > 0);
  CHECK(beside(1, 0, 0) > 0);
  CHECK(beside(0, 0, 0) > 12);
  CHECK(beside(1 + 1e-9, 0, 0) == 0);
}

TEST_CASE("coplanar faces that overlap intersect", "[self_intersection]") {
  Soup m;
  m.xyz = {0, 0, 0.1, 3, 0, 0.1, 0, 3, 0.1, 1, 1, 0.1, 4, 1, 0.1, 1, 4, 0.1, 5, 5, 0.1};
  m.abc = {0, 1, 2, 3, 4, 5, 4, 6, 5};
  CHECK(pairs_of(m) == plc::Vector<FacePair>{{0, 1}});
}

TEST_CASE("faces of zero area are left out of the search", "[self_intersection]") {
  Soup m = samples::sphere(1);
  m.face(0, 0, 1);
  const uint32_t v = m.vertex(0, 0, 0);
  m.face(0, v, 1);  // through the middle
  CHECK(pairs_of(m).empty());
  CHECK(plc::proper_faces(m.arrays(), plc::SerialExecutor()).size() == m.face_count() - 2);
}

TEST_CASE("faces of all sizes intersect where a test of every pair says so",
          "[self_intersection]") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Soup m = random_faces(seed, 700, 1e-5, 2);
    const auto pairs = pairs_of(m);
    CHECK(pairs.size() > 100);
    CHECK(pairs == every_pair_tested(m));
  }
}

TEST_CASE("a vertex far away does not hide intersections", "[self_intersection]") {
  Soup m = shaken(samples::sphere(3), 5, 0.15);
  m.xyz[0] = 1e60;
  const auto pairs = pairs_of(m);
  CHECK(!pairs.empty());
  CHECK(pairs == every_pair_tested(m));
}

TEST_CASE("the pairs are the same for every executor", "[self_intersection]") {
  const Soup m = shaken(samples::torus(150, 80, 2, 0.7), 3, 0.05);
  const auto pairs = pairs_of(m);
  CHECK(pairs.size() > 1000);
  CHECK(std::is_sorted(pairs.begin(), pairs.end()));
  const auto by = [&](const plc::Executor& executor, size_t limit) {
    return plc::self_intersections(m.arrays(), executor, limit);
  };
  constexpr auto kAll = std::numeric_limits<size_t>::max();
  CHECK(by(ReverseExecutor(), kAll) == pairs);
  CHECK(by(ThreadExecutor(3), kAll) == pairs);
  CHECK(by(ThreadExecutor(2), 100) == by(ReverseExecutor(), 100));
}

TEST_CASE("a limit returns so many true pairs, or all when there are fewer",
          "[self_intersection]") {
  const Soup m = shaken(samples::torus(100, 60, 2, 0.7), 4, 0.05);
  const auto all = pairs_of(m);
  for (const size_t limit : {size_t{0}, size_t{1}, size_t{7}, all.size(), all.size() + 1}) {
    const auto some = plc::self_intersections(m.arrays(), plc::SerialExecutor(), limit);
    CHECK(some.size() == std::min(limit, all.size()));
    CHECK(std::includes(all.begin(), all.end(), some.begin(), some.end()));
  }
}

#include "engine/guard/meeting_search.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "engine/exact/self_intersection.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_rings.h"

namespace {

using plc::FacePair;
using samples::Soup;

class ReverseExecutor final : public plc::Executor {
 public:
  void run(size_t tasks, const std::function<void(size_t)>& body) const override {
    for (size_t i = tasks; i-- > 0;) body(i);
  }
};

Soup shaken(Soup m, unsigned seed, double amount) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<double> unit(-amount, amount);
  for (double& x : m.xyz) x += unit(bits);
  return m;
}

bool share_vertex(const plc::MeetingSearch& search, const FacePair& pair) {
  const uint32_t* f = search.face(pair.first);
  const uint32_t* g = search.face(pair.second);
  return std::any_of(f, f + 3, [g](uint32_t v) { return std::find(g, g + 3, v) != g + 3; });
}

// The pairs that a search of all faces finds, of those that both have a marked vertex, or share one
// and have one.
plc::Vector<FacePair> expected(const plc::MeetingSearch& search, const samples::Rings& r,
                               const plc::Vector<uint8_t>& marked) {
  std::vector<double> xyz;
  for (const plc::Float4& p : r.positions) xyz.insert(xyz.end(), {p.x, p.y, p.z});
  plc::Vector<FacePair> pairs;
  const auto is_marked = [&](uint32_t f) {
    const uint32_t* abc = search.face(f);
    return marked[abc[0]] != 0 || marked[abc[1]] != 0 || marked[abc[2]] != 0;
  };
  for (const FacePair& pair : plc::self_intersections(
           {xyz.data(), r.positions.size(), search.face(0), search.face_count()},
           plc::SerialExecutor())) {
    const bool f = is_marked(pair.first);
    const bool g = is_marked(pair.second);
    if ((f && g) || ((f || g) && share_vertex(search, pair))) pairs.push_back(pair);
  }
  return pairs;
}

plc::Vector<uint8_t> random_vertices(uint32_t count, unsigned seed, unsigned percent) {
  std::mt19937 bits(seed);
  plc::Vector<uint8_t> chosen(count);
  for (uint8_t& c : chosen) c = bits() % 100 < percent ? 1 : 0;
  return chosen;
}

}  // namespace

TEST_CASE("faces are listed by their smallest vertex, then around it", "[meeting_search]") {
  const samples::Rings r = samples::rings_of(samples::octahedron());
  plc::MeetingSearch search;
  const auto& pairs =
      search.find(r.view(), r.slots(), r.positions.data(), nullptr, plc::SerialExecutor());
  CHECK(pairs.empty());
  REQUIRE(search.face_count() == 8);
  uint32_t last = 0;
  for (uint32_t f = 0; f < 8; ++f) {
    const uint32_t* abc = search.face(f);
    CHECK(abc[0] >= last);
    CHECK(abc[1] > abc[0]);
    CHECK(abc[2] > abc[0]);
    last = abc[0];
  }
}

TEST_CASE("with all vertices marked every pair of the mesh is found", "[meeting_search]") {
  plc::MeetingSearch search;
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    Soup m = shaken(samples::torus(40, 24, 2, 0.7), seed, 0.02 + 0.06 * seed);
    m.append(shaken(samples::sphere(3), seed, 0.01 * seed));
    m.append(samples::moved(samples::sphere(2), 1.9, 0.2, 0.1));
    const samples::Rings r = samples::rings_of(m);
    const auto pairs =
        search.find(r.view(), r.slots(), r.positions.data(), nullptr, plc::SerialExecutor());
    CHECK(pairs.size() > 50);
    CHECK(pairs == expected(search, r, plc::Vector<uint8_t>(r.slots(), 1)));
  }
}

TEST_CASE("with some vertices marked the pairs that they have part in are found",
          "[meeting_search]") {
  plc::MeetingSearch search;
  for (const unsigned percent : {1U, 10U, 50U, 95U}) {
    Soup m = shaken(samples::torus(60, 30, 2, 0.7), percent, 0.12);
    m.append(samples::moved(samples::sphere(3), 1.9, 0.2, 0.1));
    const samples::Rings r = samples::rings_of(m);
    for (unsigned seed = 0; seed < 4; ++seed) {
      auto marked = random_vertices(r.slots(), seed, percent);
      if (seed % 2 == 1) {  // whole runs of ids, so that whole nodes move
        std::fill(marked.begin(), marked.begin() + static_cast<int>(marked.size() * percent / 100),
                  1);
      }
      const auto pairs = search.find(r.view(), r.slots(), r.positions.data(), marked.data(),
                                     plc::SerialExecutor());
      CHECK(pairs == expected(search, r, marked));
    }
  }
}

TEST_CASE("rounded meshes with flat and coincident faces are searched exactly",
          "[meeting_search]") {
  plc::MeetingSearch search;
  for (const double step : {0.5, 0.25, 0.1}) {
    Soup m = samples::torus(30, 20, 2, 0.7);
    m.append(samples::moved(samples::sphere(3), 0.6, 0, 0));
    for (double& x : m.xyz) x = std::round(x / step) * step;
    const samples::Rings r = samples::rings_of(m);
    const auto pairs =
        search.find(r.view(), r.slots(), r.positions.data(), nullptr, plc::SerialExecutor());
    CHECK(pairs.size() > 10);
    CHECK(pairs == expected(search, r, plc::Vector<uint8_t>(r.slots(), 1)));
  }
}

TEST_CASE("the pairs are the same for any order of tasks and of ids", "[meeting_search]") {
  Soup m = shaken(samples::torus(90, 40, 2, 0.7), 9, 0.09);
  plc::MeetingSearch search;
  const auto count_by = [&](const Soup& mesh, const plc::Executor& executor) {
    const samples::Rings r = samples::rings_of(mesh);
    return search.find(r.view(), r.slots(), r.positions.data(), nullptr, executor);
  };
  const auto pairs = count_by(m, plc::SerialExecutor());
  CHECK(pairs.size() > 100);
  CHECK(count_by(m, ReverseExecutor()) == pairs);
  plc::Vector<uint32_t> id(m.vertex_count());
  for (uint32_t v = 0; v < id.size(); ++v) id[v] = v;
  std::shuffle(id.begin(), id.end(), std::mt19937(3));
  Soup mixed = m;
  for (uint32_t v = 0; v < id.size(); ++v) {
    std::copy_n(m.xyz.begin() + 3 * v, 3, mixed.xyz.begin() + 3 * id[v]);
  }
  for (uint32_t& v : mixed.abc) v = id[v];
  CHECK(count_by(mixed, plc::SerialExecutor()).size() == pairs.size());
}

TEST_CASE("where nothing is marked nothing is listed or found", "[meeting_search]") {
  const samples::Rings r = samples::rings_of(shaken(samples::sphere(2), 1, 0.5));
  const plc::Vector<uint8_t> marked(r.slots(), 0);
  plc::MeetingSearch search;
  const plc::SerialExecutor serial;
  CHECK(!search.find(r.view(), r.slots(), r.positions.data(), nullptr, serial).empty());
  CHECK(search.find(r.view(), r.slots(), r.positions.data(), marked.data(), serial).empty());
  CHECK(search.face_count() == 0);
}

TEST_CASE("the faces around marked vertices are listed, and no others", "[meeting_search]") {
  const samples::Rings r = samples::rings_of(samples::torus(60, 30, 2, 0.7));
  plc::Vector<uint8_t> marked(r.slots(), 0);
  marked[5] = marked[900] = 1;
  plc::MeetingSearch search;
  search.find(r.view(), r.slots(), r.positions.data(), marked.data(), plc::SerialExecutor());
  CHECK(search.face_count() == r.valence[5] + r.valence[900]);
  for (uint32_t f = 0; f < search.face_count(); ++f) CHECK(marked[search.face(f)[0]] != 0);
}

TEST_CASE("deleted vertices and an empty mesh are no obstacle", "[meeting_search]") {
  plc::MeetingSearch search;
  samples::Rings none;
  none.valence.assign(plc::kRingLanes, 0);
  none.columns.assign(plc::kRingColumns * plc::kRingLanes, 0);
  none.positions.resize(5);
  CHECK(search.find(none.view(), 5, none.positions.data(), nullptr, plc::SerialExecutor()).empty());
  CHECK(search.find(none.view(), 0, none.positions.data(), nullptr, plc::SerialExecutor()).empty());
  Soup m;
  m.vertex(9, 9, 9);
  m.append(samples::octahedron());
  m.vertex(0, 0, 0);
  m.append(samples::moved(samples::octahedron(), 0.5, 0.1, 0.2));
  const samples::Rings r = samples::rings_of(m);
  const auto pairs =
      search.find(r.view(), r.slots(), r.positions.data(), nullptr, plc::SerialExecutor());
  CHECK(search.face_count() == 16);
  CHECK(!pairs.empty());
  CHECK(pairs == expected(search, r, plc::Vector<uint8_t>(r.slots(), 1)));
}

TEST_CASE("of pairs that meet those are found of which a face has moved", "[meeting_search]") {
  plc::MeetingSearch search;
  const auto soup = [](double amount) {
    Soup m = shaken(samples::torus(60, 30, 2, 0.7), 5, amount);
    m.append(samples::moved(samples::sphere(3), 1.9, 0.2, 0.1));
    return m;
  };
  const samples::Rings r = samples::rings_of(soup(0.12));
  for (const unsigned percent : {0U, 2U, 40U, 100U}) {
    const auto marked = random_vertices(r.slots(), 3, 80);
    const auto moved = random_vertices(r.slots(), 7, percent);
    samples::Rings before = r;
    for (uint32_t v = 0; v < r.slots(); ++v) {
      if (moved[v] != 0) before.positions[v].z += 0.01F;
    }
    const auto pairs = search.find(r.view(), r.slots(), r.positions.data(), marked.data(),
                                   plc::SerialExecutor(), before.positions.data());
    auto wanted = expected(search, r, marked);
    const size_t meeting = wanted.size();
    const auto has_moved = [&](uint32_t f) {
      const uint32_t* abc = search.face(f);
      return moved[abc[0]] != 0 || moved[abc[1]] != 0 || moved[abc[2]] != 0;
    };
    wanted.erase(std::remove_if(wanted.begin(), wanted.end(),
                                [&](const FacePair& pair) {
                                  return !has_moved(pair.first) && !has_moved(pair.second);
                                }),
                 wanted.end());
    CHECK(pairs == wanted);
    if (percent == 0) CHECK(wanted.empty());
    if (percent == 2) CHECK(wanted.size() < meeting / 2);
    if (percent == 40) CHECK(wanted.size() > 10);
    if (percent == 100) CHECK(wanted.size() == meeting);
  }
}

TEST_CASE("strays are listed beside their neighbours; the pairs and their order stay",
          "[meeting_search]") {
  Soup m = shaken(samples::torus(60, 30, 2, 0.7), 5, 0.12);
  m.append(samples::moved(samples::sphere(3), 1.9, 0.2, 0.1));
  const samples::Rings r = samples::rings_of(m);
  const plc::SerialExecutor serial;
  // The corners of each pair, the lowest id in front.
  const auto corners_of = [](const plc::MeetingSearch& search, const plc::Vector<FacePair>& pairs) {
    std::vector<uint32_t> corners;
    for (const auto& [f, g] : pairs) {
      for (const uint32_t face : {f, g}) {
        std::array<uint32_t, 3> abc{};
        std::copy_n(search.face(face), 3, abc.begin());
        std::rotate(abc.begin(), std::min_element(abc.begin(), abc.end()), abc.end());
        corners.insert(corners.end(), abc.begin(), abc.end());
      }
    }
    return corners;
  };
  for (const unsigned percent : {3U, 30U, 100U}) {
    const auto marked = random_vertices(r.slots(), 11, 90);
    const auto strays = random_vertices(r.slots(), 13, percent);
    plc::MeetingSearch search, plain;
    const auto find = [&](plc::MeetingSearch& by, const uint8_t* apart) {
      return by.find(r.view(), r.slots(), r.positions.data(), marked.data(), serial, nullptr,
                     nullptr, apart);
    };
    const auto pairs = find(search, strays.data());
    CHECK(pairs.size() > 100);
    CHECK(corners_of(search, pairs) == corners_of(plain, find(plain, nullptr)));
    const auto changed = [&](plc::MeetingSearch& by) {
      plc::Vector<uint32_t> all;
      for (uint32_t v = 0; v < r.slots(); v += 7) all.push_back(v);
      return corners_of(by, by.find_changed(all.data(), all.size(), serial));
    };
    CHECK(changed(search) == changed(plain));
    // What is no stray and marked is listed where its id says.
    uint32_t last = 0;
    for (uint32_t f = 0; f < search.face_count(); ++f) {
      const uint32_t v = search.face(f)[0];
      if (strays[v] != 0) continue;
      CHECK(v >= last);
      last = v;
    }
    CHECK(find(search, plc::Vector<uint8_t>(r.slots(), 0).data()) == find(plain, nullptr));
  }
}

TEST_CASE("when a few vertices have moved on, what meets now is found around them alone",
          "[meeting_search]") {
  Soup m = shaken(samples::torus(60, 30, 2, 0.7), 5, 0.02);
  m.append(samples::moved(samples::sphere(3), 1.9, 0.2, 0.1));
  samples::Rings r = samples::rings_of(m);
  for (const unsigned percent : {30U, 100U}) {
    const auto marked = random_vertices(r.slots(), 11, percent);
    plc::MeetingSearch search, anew;
    search.find(r.view(), r.slots(), r.positions.data(), marked.data(), plc::SerialExecutor());
    size_t meeting = 0;
    for (unsigned seed = 0; seed < 6; ++seed) {
      const samples::Rings before = r;
      const auto chosen = random_vertices(r.slots(), seed, seed == 0 ? 40 : 2);
      plc::Vector<uint32_t> changed;
      std::mt19937 bits(seed);
      std::normal_distribution<float> step(0, 0.15F);
      for (uint32_t v = 0; v < r.slots(); ++v) {
        if (chosen[v] == 0) continue;
        r.positions[v].x += step(bits);
        r.positions[v].y += step(bits);
        changed.insert(changed.end(), {v, v});
      }
      const auto pairs = search.find_changed(changed.data(), changed.size(), plc::SerialExecutor());
      CHECK(pairs == anew.find(r.view(), r.slots(), r.positions.data(), marked.data(),
                               plc::SerialExecutor(), before.positions.data()));
      meeting += pairs.size();
    }
    CHECK(meeting > 100);
    CHECK(search.find_changed(nullptr, 0, plc::SerialExecutor()).empty());
  }
}

TEST_CASE("every SIMD target finds the same pairs", "[meeting_search]") {
  const samples::Rings r = samples::rings_of(shaken(samples::torus(90, 40, 2, 0.7), 9, 0.09));
  plc::MeetingSearch search;
  const auto twin = search.find(r.view(), r.slots(), r.positions.data(), nullptr,
                                plc::SerialExecutor(plc::SimdTarget::kScalar));
  CHECK(twin.size() > 100);
  for (const plc::SimdTarget simd : plc::available_simd_targets()) {
    CHECK(search.find(r.view(), r.slots(), r.positions.data(), nullptr,
                      plc::SerialExecutor(simd)) == twin);
  }
}

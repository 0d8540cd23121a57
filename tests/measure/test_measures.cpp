#include "engine/base/mesh_arrays.h"
#include "engine/measure/measures.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/samples/sample_meshes.h"

namespace {

using samples::Soup;
constexpr double kPi = 3.14159265358979323846;

class ReverseExecutor final : public plc::Executor {
 public:
  void run(size_t tasks, const std::function<void(size_t)>& body) const override {
    for (size_t i = tasks; i-- > 0;) body(i);
  }
};

plc::SurfaceMeasures measure(const Soup& m) {
  return plc::surface_measures(m.arrays(), plc::SerialExecutor());
}

plc::Vector<plc::ComponentMeasures> components(const Soup& m) {
  return plc::component_measures(m.arrays(), plc::SerialExecutor());
}

// Two tori joined by a triangular tube in place of a face of each.
Soup double_torus() {
  Soup m = samples::torus(12, 8, 2, 0.7);
  const auto second = static_cast<uint32_t>(m.abc.size());
  m.append(samples::moved(samples::torus(12, 8, 2, 0.7), 0, 0, 3));
  const uint32_t a = m.abc[0], b = m.abc[1], c = m.abc[2];
  const uint32_t d = m.abc[second], e = m.abc[second + 1], f = m.abc[second + 2];
  m.abc.erase(m.abc.begin() + second, m.abc.begin() + second + 3);
  m.abc.erase(m.abc.begin(), m.abc.begin() + 3);
  for (const auto& t :
       {std::array<uint32_t, 3>{a, b, f}, {a, f, d}, {b, c, e}, {b, e, f}, {c, a, d}, {c, d, e}}) {
    m.face(t[0], t[1], t[2]);
  }
  return m;
}

}  // namespace

TEST_CASE("area and volume of finer spheres converge with order two", "[measures]") {
  double area_error[3], volume_error[3];
  for (int i = 0; i < 3; ++i) {
    const plc::SurfaceMeasures m = measure(samples::sphere(3 + i));
    CHECK(m.euler == 2);
    CHECK(m.genus == 0);
    CHECK(m.components == 1);
    area_error[i] = 4 * kPi - m.area;
    volume_error[i] = 4 * kPi / 3 - m.volume;
  }
  for (int i = 0; i < 2; ++i) {
    CHECK(area_error[i] / area_error[i + 1] == Approx(4).epsilon(0.02));
    CHECK(volume_error[i] / volume_error[i + 1] == Approx(4).epsilon(0.02));
  }
  CHECK(volume_error[2] < 0.007);
}

TEST_CASE("the cube has area 6 and volume 1, turned inside out volume -1", "[measures]") {
  const plc::SurfaceMeasures m = measure(samples::cube());
  CHECK(m.area == Approx(6).epsilon(1e-14));
  CHECK(m.volume == Approx(1).epsilon(1e-14));
  CHECK(m.vertices == 8);
  CHECK(m.faces == 12);
  CHECK(measure(samples::flipped(samples::cube())).volume == Approx(-1).epsilon(1e-14));
}

TEST_CASE("a torus has genus 1, a double torus genus 2", "[measures]") {
  const plc::SurfaceMeasures one = measure(samples::torus(60, 40, 2, 0.7));
  CHECK(one.euler == 0);
  CHECK(one.genus == 1);
  CHECK(one.area == Approx(4 * kPi * kPi * 2 * 0.7).epsilon(0.01));
  CHECK(one.volume == Approx(2 * kPi * kPi * 2 * 0.49).epsilon(0.01));
  const plc::SurfaceMeasures two = measure(double_torus());
  CHECK(two.components == 1);
  CHECK(two.euler == -2);
  CHECK(two.genus == 2);
}

TEST_CASE("components come with their own measures, the largest area first", "[measures]") {
  Soup m = samples::sphere(2);
  m.append(samples::moved(samples::torus(20, 10, 2, 0.5), 9, 0, 0));
  m.append(samples::flipped(samples::moved(samples::cube(), 20, 0, 0)));
  const auto parts = components(m);
  REQUIRE(parts.size() == 3);
  CHECK(parts[0].genus == 1);
  CHECK(parts[0].component == 1);
  CHECK(parts[0].faces == 400);
  CHECK(parts[0].vertices == 200);
  CHECK(parts[0].first_face == 128);
  CHECK(parts[1].component == 0);
  CHECK(parts[2].area == Approx(6).epsilon(1e-13));
  CHECK(parts[2].volume == Approx(-1).epsilon(1e-13));
  const plc::SurfaceMeasures all = measure(m);
  CHECK(all.components == 3);
  CHECK(all.genus == 1);
  CHECK(all.euler == 4);
  CHECK(all.area == parts[0].area + parts[1].area + parts[2].area);
  CHECK(all.volume == parts[0].volume + parts[1].volume + parts[2].volume);
}

TEST_CASE("an open or inconsistently oriented surface has no genus", "[measures]") {
  Soup open = samples::torus(20, 10, 2, 0.5);
  open.abc.resize(open.abc.size() - 3);
  CHECK(measure(open).genus == -1);
  CHECK(measure(open).components == 1);
  Soup turned = samples::sphere(1);
  std::swap(turned.abc[0], turned.abc[1]);
  CHECK(measure(turned).genus == -1);
}

TEST_CASE("two tetrahedra with a common vertex are two components without handles", "[measures]") {
  Soup m;
  m.xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1};
  m.abc = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 0, 4, 5, 0, 6, 4, 0, 5, 6, 4, 6, 5};
  const plc::SurfaceMeasures measures = measure(m);
  CHECK(measures.components == 2);
  CHECK(measures.euler == 3);
  CHECK(measures.genus == 0);
}

TEST_CASE("a sphere far from the origin, or tiny beside a large one, keeps its volume",
          "[measures]") {
  const double volume = measure(samples::sphere(3)).volume;
  const Soup far = samples::moved(samples::sphere(3), 1 << 20, -(1 << 20), 1 << 19);
  CHECK(measure(far).volume == Approx(volume).epsilon(1e-9));
  Soup both = samples::sphere(3);
  both.append(samples::moved(samples::sphere(3), 5, 5, 5, 1.0 / 65536));
  const auto parts = components(both);
  REQUIRE(parts.size() == 2);
  CHECK(parts[1].volume * std::pow(65536, 3) == Approx(volume).epsilon(1e-8));
}

TEST_CASE("float and double positions of the same values measure the same", "[measures]") {
  Soup m = samples::torus(33, 21, 2, 0.6);
  std::vector<float> narrow;
  for (double& x : m.xyz) {
    narrow.push_back(static_cast<float>(x));
    x = narrow.back();
  }
  const plc::SurfaceMeasures a = measure(m);
  const plc::SurfaceMeasures b =
      plc::surface_measures(plc::arrays_of(narrow, m.abc), plc::SerialExecutor());
  CHECK(a.area == b.area);
  CHECK(a.volume == b.volume);
}

TEST_CASE("measures are the same bits for any order of tasks", "[measures]") {
  const Soup m = samples::torus(150, 70, 2, 0.6);
  const plc::SurfaceMeasures a = measure(m);
  const plc::SurfaceMeasures b = plc::surface_measures(m.arrays(), ReverseExecutor());
  CHECK(a.area == b.area);
  CHECK(a.volume == b.volume);
}

TEST_CASE("an empty mesh measures nothing", "[measures]") {
  const plc::SurfaceMeasures m = measure(Soup());
  CHECK(m.components == 0);
  CHECK(m.genus == 0);
  CHECK(m.area == 0);
}

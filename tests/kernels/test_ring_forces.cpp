#include "kernels/ring_forces.h"

#include <array>
#include <catch2/catch.hpp>
#include <string>

#include "kernels/lane_sum.h"
#include "kernels/scalar.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::Float4;
using plc::RingView;
using plc::SimdTarget;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

using Vector = std::array<double, 3>;

Vector at(const RandomRings& rings, uint32_t v) {
  const Float4& p = rings.position[v];
  return {double{p.x}, double{p.y}, double{p.z}};
}
Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
void add(Vector& sum, const Vector& a, double factor = 1.0) {
  for (size_t i = 0; i < 3; ++i) sum[i] += factor * a[i];
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vector& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

// Mean of the ring minus the vertex, straight from the text under (5).
Vector mean_minus_own(const RandomRings& rings, uint32_t v) {
  Vector mean{};
  for (const uint32_t u : rings.rings[v]) {
    add(mean, at(rings, u), 1.0 / static_cast<double>(rings.rings[v].size()));
  }
  return rings.rings[v].empty() ? Vector{} : mean - at(rings, v);
}

// Three force streams, untouched outside [begin, end).
struct Streams {
  std::vector<float> x, y, z;
  Streams(uint32_t count, float value) : x(count, value), y(count, value), z(count, value) {}
  std::vector<float> all() const {
    std::vector<float> values = x;
    values.insert(values.end(), y.begin(), y.end());
    values.insert(values.end(), z.begin(), z.end());
    return values;
  }
  kernels::Float3s out() { return {x.data(), y.data(), z.data()}; }
};

// Within `tolerance` of the reference on [begin, end), not written elsewhere.
void require_near(const Streams& got, const std::vector<Vector>& expected, uint32_t begin,
                  uint32_t end, double tolerance) {
  for (uint32_t v = 0; v < got.x.size(); ++v) {
    const Vector own{double{got.x[v]}, double{got.y[v]}, double{got.z[v]}};
    CAPTURE(v);
    if (v < begin || v >= end) {
      REQUIRE(own == Vector{double{kUntouched}, double{kUntouched}, double{kUntouched}});
    } else {
      REQUIRE(length(own - expected[v]) <= tolerance);
    }
  }
}

// The length of a vector in a metric, and its axes times those of the metric.
Vector scaled(const Vector& a, const plc::Metric& m) {
  return {a[0] * double{m.x}, a[1] * double{m.y}, a[2] * double{m.z}};
}
constexpr plc::Metric kMetrics[] = {{1, 1, 1}, {1, 1.25F, 4.7F}};

// Ranges of 160 vertices: whole, inner blocks, one block, none.
const std::vector<std::array<uint32_t, 2>> kRanges = {{0, 160}, {16, 112}, {144, 160}, {32, 32}};

}  // namespace

TEST_CASE("the Laplacian is the mean of the ring minus the vertex", "[kernels]") {
  const RandomRings rings = mixed_rings(10, 1);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const auto& [begin, end] : kRanges) {
      CAPTURE(plc::simd_target_name(simd), begin, end);
      const Float4 untouched{kUntouched, kUntouched, kUntouched, kUntouched};
      std::vector<Float4> got(rings.count(), untouched);
      std::vector<Float4> twin = got;
      const auto blocks = plc::Blocks::range(begin, end);
      kernels::laplacian(simd, rings.view(), rings.position.data(), blocks, got.data());
      scalar::laplacian(rings.view(), rings.position.data(), blocks, twin.data());
      REQUIRE(first_difference(flatten(got), flatten(twin)) == -1);
      for (uint32_t v = 0; v < rings.count(); ++v) {
        CAPTURE(v);
        if (v < begin || v >= end) {
          REQUIRE(got[v].w == kUntouched);
          continue;
        }
        const Vector own{double{got[v].x}, double{got[v].y}, double{got[v].z}};
        REQUIRE(length(own - mean_minus_own(rings, v)) < 1e-4);
        REQUIRE(got[v].w == 0.0F);
      }
    }
  }
}

TEST_CASE("the curvature force is equation (5)", "[kernels]") {
  const RandomRings rings = mixed_rings(10, 2);
  const float alpha = -0.7F;  // a negative factor would turn the 0 of dead vertices into -0
  std::vector<Float4> laplacian(rings.count());
  scalar::laplacian(rings.view(), rings.position.data(), plc::Blocks::range(0, rings.count()),
                    laplacian.data());
  std::vector<Vector> expected(rings.count());
  for (uint32_t v = 0; v < rings.count(); ++v) {
    const auto valence = static_cast<double>(rings.rings[v].size());
    add(expected[v], mean_minus_own(rings, v), double{alpha});
    for (const uint32_t u : rings.rings[v]) {
      add(expected[v], mean_minus_own(rings, u), -double{alpha} / valence);
    }
  }
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const auto& [begin, end] : kRanges) {
      CAPTURE(plc::simd_target_name(simd), begin, end);
      Streams got(rings.count(), kUntouched);
      Streams twin(rings.count(), kUntouched);
      kernels::curvature_force(simd, rings.view(), laplacian.data(), alpha, begin, end, got.out());
      scalar::curvature_force(rings.view(), laplacian.data(), alpha, begin, end, twin.out());
      REQUIRE(first_difference(got.all(), twin.all()) == -1);
      require_near(got, expected, begin, end, 1e-4);
    }
  }
}

TEST_CASE("the spring force is equation (6), added to what is there", "[kernels]") {
  RandomRings rings = mixed_rings(10, 3);
  rings.position[rings.rings[20][0]] = rings.position[20];  // coincident neighbours add nothing
  const float alpha = 0.3F;
  for (const plc::Metric& metric : kMetrics) {
    const float rest = metric.z == 1 ? 0.0F : 120.0F;
    std::vector<Vector> expected(rings.count());
    for (uint32_t v = 0; v < rings.count(); ++v) {
      expected[v] = {double{kUntouched}, double{kUntouched}, double{kUntouched}};
      for (const uint32_t u : rings.rings[v]) {
        const Vector edge = at(rings, u) - at(rings, v);
        if (length(edge) == 0) continue;
        const double measured = length(scaled(edge, metric));
        add(expected[v], edge, double{alpha} * (measured - double{rest}) / measured);
      }
    }
    for (const SimdTarget simd : plc::available_simd_targets()) {
      for (const auto& [begin, end] : kRanges) {
        CAPTURE(plc::simd_target_name(simd), begin, end, rest);
        Streams got(rings.count(), kUntouched);
        Streams twin(rings.count(), kUntouched);
        kernels::spring_force(simd, rings.view(), rings.position.data(), {alpha, rest, metric},
                              begin, end, got.out());
        scalar::spring_force(rings.view(), rings.position.data(), {alpha, rest, metric}, begin, end,
                             twin.out());
        REQUIRE(first_difference(got.all(), twin.all()) == -1);
        require_near(got, expected, begin, end, 2e-3);
      }
    }
  }
}

TEST_CASE("normals are the sum of the cross products around the ring, of length 1", "[kernels]") {
  RandomRings rings = mixed_rings(10, 4);
  for (const uint32_t u : rings.rings[33]) rings.position[u] = rings.position[33];  // a sum of 0
  std::vector<Vector> expected(rings.count());
  for (uint32_t v = 0; v < rings.count(); ++v) {
    const plc::Vector<uint32_t>& ring = rings.rings[v];
    Vector sum{};
    for (size_t k = 0; k < ring.size(); ++k) {
      add(sum, cross(at(rings, ring[k]) - at(rings, v),
                     at(rings, ring[(k + 1) % ring.size()]) - at(rings, v)));
    }
    if (length(sum) > 0) add(expected[v], sum, 1.0 / length(sum));
  }
  REQUIRE(length(expected[33]) == 0.0);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const auto& [begin, end] : kRanges) {
      CAPTURE(plc::simd_target_name(simd), begin, end);
      Streams got(rings.count(), kUntouched);
      Streams twin(rings.count(), kUntouched);
      const auto blocks = plc::Blocks::range(begin, end);
      kernels::normals(simd, rings.view(), rings.position.data(), blocks, got.out());
      scalar::normals(rings.view(), rings.position.data(), blocks, twin.out());
      REQUIRE(first_difference(got.all(), twin.all()) == -1);
      require_near(got, expected, begin, end, 1e-4);
    }
  }
}

TEST_CASE("normals and Laplacians of one walk have the bits of two, on the listed blocks only",
          "[kernels]") {
  const RandomRings rings = mixed_rings(10, 12);
  const plc::Vector<uint32_t> list = {0, 3, 4, 5, 9};
  const plc::Blocks blocks{list.data(), list.size()};
  const Float4 untouched{kUntouched, kUntouched, kUntouched, kUntouched};
  std::vector<Float4> expected(rings.count(), untouched);
  Streams normal(rings.count(), kUntouched);
  scalar::laplacian(rings.view(), rings.position.data(), blocks, expected.data());
  scalar::normals(rings.view(), rings.position.data(), blocks, normal.out());
  REQUIRE(expected[3 * plc::kRingLanes].w == 0);
  REQUIRE(expected[2 * plc::kRingLanes].w == kUntouched);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    std::vector<Float4> laplacian(rings.count(), untouched);
    Streams got(rings.count(), kUntouched);
    kernels::normals_and_laplacian(simd, rings.view(), rings.position.data(), blocks, got.out(),
                                   laplacian.data());
    CHECK(first_difference(flatten(laplacian), flatten(expected)) == -1);
    CHECK(first_difference(got.all(), normal.all()) == -1);
  }
}

TEST_CASE("the normal of a vertex seen with its ring counter-clockwise points at the viewer",
          "[kernels]") {
  // Vertex 0 at the origin, its ring in the plane z = 0 counter-clockwise seen from +z.
  plc::Vector<uint32_t> columns(plc::kRingColumns * plc::kRingLanes, 0);
  for (uint32_t k = 0; k < 4; ++k) columns[k * plc::kRingLanes] = k + 1;
  std::vector<uint16_t> valence(plc::kRingLanes, 0);
  valence[0] = 4;
  std::vector<Float4> position(plc::kRingLanes, Float4{0, 0, 0, 0});
  position[1] = {1, 0, 0, 0};
  position[2] = {0, 1, 0, 0};
  position[3] = {-1, 0, 0, 0};
  position[4] = {0, -1, 0, 0};
  const RingView view{columns.data(), valence.data(), nullptr};
  for (const SimdTarget simd : plc::available_simd_targets()) {
    Streams got(plc::kRingLanes, kUntouched);
    kernels::normals(simd, view, position.data(), plc::Blocks{nullptr, 1, 0}, got.out());
    REQUIRE(got.x[0] == 0.0F);
    REQUIRE(got.y[0] == 0.0F);
    REQUIRE(got.z[0] == 1.0F);
  }
}

TEST_CASE("an edge as long as a limit violates it", "[kernels]") {
  // Every edge of the first ring has length 5: constraint (1) asks for more, (2) for less.
  RandomRings rings = mixed_rings(10, 6);
  rings.position[0] = {0, 0, 0, 0};
  for (const uint32_t u : rings.rings[0]) rings.position[u] = {3, 4, 0, 0};
  const auto flags_at_0 = [&](SimdTarget simd, float min_squared, float max_squared) {
    plc::Vector<uint8_t> flags(rings.count(), 9);
    kernels::edge_violations(simd, rings.view(), rings.position.data(), min_squared, max_squared,
                             plc::Blocks::range(0, 16), flags.data());
    return static_cast<int>(flags[0]);
  };
  for (const SimdTarget simd : plc::available_simd_targets()) {
    REQUIRE(flags_at_0(simd, 25.0F, 26.0F) == 1);
    REQUIRE(flags_at_0(simd, 24.0F, 25.0F) == 2);
    REQUIRE(flags_at_0(simd, 24.0F, 26.0F) == 0);
    REQUIRE(flags_at_0(simd, 25.0F, 25.0F) == 3);
  }
}

TEST_CASE("limits of edges are those of the sizes at their ends", "[kernels]") {
  RandomRings rings = mixed_rings(1, 6);
  rings.position[0] = {0, 0, 0, 1};
  for (const uint32_t u : rings.rings[0]) rings.position[u] = {3, 4, 0, 0.5F};
  const float size = 1.75F * 1.75F;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const auto flags = [&](float min_squared, float max_squared) {
      plc::Vector<uint8_t> all(rings.count(), 9);
      kernels::edge_violations(simd, rings.view(), rings.position.data(), min_squared, max_squared,
                               plc::Blocks::range(0, 16), all.data());
      return static_cast<int>(all[0]);
    };
    CHECK(flags(24 / size, 26 / size) == 0);
    CHECK(flags(25.01F / size, 26 / size) == 1);
    CHECK(flags(24 / size, 24.99F / size) == 2);
  }
}

TEST_CASE("edge violations are found in columns and tails alike", "[kernels]") {
  RandomRings rings = mixed_rings(10, 7);
  const float min_squared = 25.0F * 25.0F, max_squared = 370.0F * 370.0F;
  for (uint32_t v = 5; v < rings.count(); v += 16) {  // a short edge in every tail
    if (rings.rings[v].empty()) continue;
    rings.position[rings.rings[v].back()] = rings.position[v];
  }
  int tails_alone = 0;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const auto& [begin, end] : kRanges) {
      CAPTURE(plc::simd_target_name(simd), begin, end);
      plc::Vector<uint8_t> flags(rings.count(), 9);
      kernels::edge_violations(simd, rings.view(), rings.position.data(), min_squared, max_squared,
                               plc::Blocks::range(begin, end), flags.data());
      for (uint32_t v = 0; v < rings.count(); ++v) {
        CAPTURE(v);
        int expected = 0, columns_only = 0;
        for (size_t k = 0; k < rings.rings[v].size(); ++k) {
          const double edge = length(at(rings, rings.rings[v][k]) - at(rings, v));
          expected |= edge <= 25.0 ? 1 : 0;
          expected |= edge >= 370.0 ? 2 : 0;
          if (k < plc::kRingSlots) columns_only = expected;
        }
        if (v < begin || v >= end) expected = 9;
        REQUIRE(static_cast<int>(flags[v]) == expected);
        tails_alone += expected != 9 && expected != columns_only ? 1 : 0;
      }
    }
  }
  REQUIRE(tails_alone > 0);
}

TEST_CASE("a face that is turned against the normal is found, in columns and tails alike",
          "[kernels]") {
  // Random rings turn every which way: with `most` below the least of them none is turned but those
  // at right angles or more.
  const RandomRings rings = mixed_rings(10, 8);
  const auto normals = fixtures::random_floats(3 * rings.count(), -1, 1, 3);
  const float* n = normals.data();
  const uint32_t count = rings.count();
  const plc::Blocks all = plc::Blocks::range(0, count);
  int turned = 0, plain = 0;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const float most : {0.0F, 0.3F}) {
      plc::Vector<uint8_t> flags(count, 9);
      kernels::turned_faces(simd, rings.view(), rings.position.data(), all,
                            {n, n + count, n + 2 * count}, most, flags.data());
      for (uint32_t v = 0; v < count; ++v) {
        const auto& ring = rings.rings[v];
        int expected = 0;
        for (size_t k = 0; k < ring.size(); ++k) {
          const auto a = at(rings, ring[k]) - at(rings, v);
          const auto b = at(rings, ring[(k + 1) % ring.size()]) - at(rings, v);
          const auto area = cross(a, b);
          const double along = area[0] * double{n[v]} + area[1] * double{n[count + v]} +
                               area[2] * double{n[2 * count + v]};
          if (along <= 0 || along <= static_cast<double>(most) * length(area)) expected = 1;
        }
        CAPTURE(plc::simd_target_name(simd), v, most);
        REQUIRE(static_cast<int>(flags[v]) == expected);
        (expected == 1 ? turned : plain) += 1;
      }
    }
  }
  CHECK(turned > 0);
  CHECK(plain > 0);
}

TEST_CASE("edge lengths add up to the same bits for every target", "[kernels]") {
  const RandomRings rings = mixed_rings(10, 8);
  for (const auto& [begin, end] : kRanges) {
    for (const plc::Metric& metric : kMetrics) {
      double expected = 0;
      for (uint32_t v = begin; v < end; ++v) {
        for (const uint32_t u : rings.rings[v]) {
          expected += length(scaled(at(rings, u) - at(rings, v), metric));
        }
      }
      const Float4* position = rings.position.data();
      const double twin = scalar::edge_length_sum(rings.view(), position, metric, begin, end);
      REQUIRE(twin == Approx(expected).epsilon(1e-6));
      for (const SimdTarget simd : plc::available_simd_targets()) {
        CAPTURE(plc::simd_target_name(simd), begin, end);
        REQUIRE(kernels::edge_length_sum(simd, rings.view(), position, metric, begin, end) == twin);
      }
    }
  }
}

TEST_CASE("normals of a metric are those of the surface with its axes stretched", "[kernels]") {
  RandomRings rings = mixed_rings(10, 9);
  const uint32_t n = rings.count();
  const plc::Metric metric = kMetrics[1];
  Streams normal(n, 0), stretched(n, 0);
  const auto measure = [&](Streams& to) {
    scalar::normals(rings.view(), rings.position.data(), plc::Blocks::range(0, n), to.out());
  };
  measure(normal);
  for (Float4& p : rings.position) p = {p.x * metric.x, p.y * metric.y, p.z * metric.z, 0};
  measure(stretched);
  std::vector<Vector> expected(n), step(n);
  for (uint32_t v = 0; v < n; ++v) {
    expected[v] = {double{stretched.x[v]}, double{stretched.y[v]}, double{stretched.z[v]}};
    step[v] = scaled(expected[v], {1 / metric.x, 1 / metric.y, 1 / metric.z});
  }
  const auto run = [&](const auto& kernel) {
    std::array<Streams, 2> to{Streams(n, 0), Streams(n, 0)};
    kernel(metric, normal.out(), uint32_t{0}, n, to[0].out(), to[1].out());
    return to;
  };
  const auto twin = run(scalar::metric_normals);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    const auto got = run([&](auto... arguments) { kernels::metric_normals(simd, arguments...); });
    REQUIRE(first_difference(got[0].all(), twin[0].all()) == -1);
    REQUIRE(first_difference(got[1].all(), twin[1].all()) == -1);
    require_near(got[0], expected, 0, n, 2e-5);
    require_near(got[1], step, 0, n, 2e-5);
  }
}

TEST_CASE("lane sums are added pairwise", "[kernels]") {
  // 2^53 + 1 loses the 1 unless the ones meet each other first.
  double lanes[plc::kRingLanes] = {9007199254740992.0, 1, 0, 0, 0, 0, 0, 0, 0, 1};
  REQUIRE(kernels::add_lanes(lanes) == 9007199254740994.0);
}

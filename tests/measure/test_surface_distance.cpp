#include "engine/base/mesh_arrays.h"
#include "engine/measure/surface_distance.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/samples/sample_shapes.h"

namespace {

using samples::Soup;

struct Result {
  plc::SurfaceDistances summary;
  std::vector<double> at_vertices;
};

plc::MeshArrays arrays(const Soup& m) {
  return {m.xyz.data(), m.vertex_count(), m.abc.data(), m.face_count()};
}

Result distances(const Soup& from, const Soup& to,
                 const plc::Executor& executor = plc::SerialExecutor()) {
  Result r{{}, std::vector<double>(from.vertex_count(), -1)};
  r.summary = plc::surface_distances(arrays(from), arrays(to), executor, r.at_vertices.data());
  return r;
}

Soup scaled(const Soup& m, double scale) {
  return samples::moved(m, 0, 0, 0, scale);
}

}  // namespace

TEST_CASE("concentric spheres are the difference of their radii apart, with order two",
          "[surface_distance]") {
  std::vector<double> sizes, means, worst, inward;
  for (int level = 2; level < 6; ++level) {
    const Soup small = samples::sphere(level), large = scaled(samples::sphere(level), 1.5);
    const Result out = distances(small, large), in = distances(large, small);
    sizes.push_back(std::pow(2, -level));
    means.push_back(std::abs(out.summary.mean - 0.5));
    worst.push_back(std::abs(out.summary.max - 0.5));
    inward.push_back(std::abs(in.summary.rms - 0.5));
    CHECK(out.summary.rms >= out.summary.mean);
    CHECK(out.summary.max >= out.summary.rms);
  }
  CHECK(samples::order_of(sizes, means) > 1.8);
  CHECK(samples::order_of(sizes, worst) > 1.8);
  CHECK(samples::order_of(sizes, inward) > 1.8);
  CHECK(means.back() < 0.001);
}

TEST_CASE("a sheet moved along its normal is that far away everywhere", "[surface_distance]") {
  const Soup low = samples::turned(samples::sheet(9, 0)),
             high = samples::turned(samples::sheet(4, 0.375));
  const Result r = distances(low, high);
  for (const double d : r.at_vertices) CHECK(d == Approx(0.375).epsilon(1e-14));
  CHECK(r.summary.mean == Approx(0.375).epsilon(1e-14));
  CHECK(r.summary.rms == Approx(0.375).epsilon(1e-14));
  CHECK(r.summary.max == Approx(0.375).epsilon(1e-14));
  CHECK(r.summary.vertex_mean == Approx(0.375).epsilon(1e-14));
}

TEST_CASE("means are over the area, whatever the density of the vertices", "[surface_distance]") {
  // Heights 0 .. 1 over [0, 1]: the distance to the plane below is linear, its square a parabola.
  Soup slope = samples::sheet(8, 0);
  for (size_t i = 0; i < slope.xyz.size(); i += 3) {
    const double x = std::pow(slope.xyz[i], 3);  // most vertices are near 0
    slope.xyz[i] = x;
    slope.xyz[i + 2] = x;
  }
  const Soup plane = samples::moved(samples::sheet(1, 0), -5, -5, 0, 11);
  const Result r = distances(slope, plane);
  CHECK(r.summary.mean == Approx(0.5).epsilon(1e-13));
  CHECK(r.summary.rms == Approx(std::sqrt(1.0 / 3)).epsilon(1e-13));
  CHECK(r.summary.max == Approx(1).epsilon(1e-14));
  CHECK(r.summary.vertex_mean < 0.3);
}

TEST_CASE("the farthest point may be inside a face", "[surface_distance]") {
  Soup square;  // two large faces above a plane with a pit
  square.xyz = {-3, -3, 0, 3, -3, 0, 3, 3, 0, -3, 3, 0};
  square.abc = {0, 1, 2, 0, 2, 3};
  Soup frame = samples::moved(samples::sheet(6, 0), -3, -3, 0, 6);
  // Faces around the middle vertex are gone: a hole of 2 x 2.
  Soup pit;
  pit.xyz = frame.xyz;
  for (size_t i = 0; i < frame.abc.size(); i += 3) {
    double x = 0, y = 0;
    for (size_t k = 0; k < 3; ++k) {
      x += frame.xyz[3 * frame.abc[i + k]] / 3;
      y += frame.xyz[3 * frame.abc[i + k] + 1] / 3;
    }
    if (std::abs(x) < 1 && std::abs(y) < 1) continue;
    pit.face(frame.abc[i], frame.abc[i + 1], frame.abc[i + 2]);
  }
  const Result r = distances(square, pit);
  CHECK(r.summary.vertex_max == 0);
  CHECK(r.summary.max == Approx(1).epsilon(1e-14));  // the middle of the diagonal
  CHECK(distances(pit, square).summary.max == 0);
}

TEST_CASE("distances are to corners, edges and insides of faces alike", "[surface_distance]") {
  Soup points;
  const double want[][4] = {{0.2, 0.3, 2, 1},      // a face
                            {0.5, -3, 5, 5},       // an edge
                            {2, 3, 3, 3},          // a corner: 1, 2, 2
                            {0.5, 0.5, 0.5, 0.5},  // from inside
                            {1, 1, 0.25, 0}};
  for (const auto& p : want) points.vertex(p[0], p[1], p[2]);
  points.face(0, 1, 2);
  const Result r = distances(points, samples::cube());
  for (size_t i = 0; i < 5; ++i) CHECK(r.at_vertices[i] == Approx(want[i][3]).margin(1e-15));
}

TEST_CASE("the nearest point is found among all faces, of any size", "[surface_distance]") {
  const Soup from = samples::moved(samples::torus(17, 9, 2, 0.7), 0.3, 0.2, 0.1);
  Soup to = samples::turned(samples::torus(23, 12, 2, 0.5));
  to.append(samples::moved(samples::cube(), 3, 3, 3, 0.01));
  to.append(samples::moved(samples::sheet(1, 0), -40, -40, -5, 80));
  to.face(0, 0, 1);  // faces without area are points and segments
  const Result r = distances(from, to);
  for (size_t v = 0; v < from.vertex_count(); ++v) {
    double least = 1e300;
    for (uint32_t f = 0; f < to.face_count(); ++f) {
      Soup one;
      one.xyz = to.xyz;
      one.abc.assign(to.abc.begin() + 3 * f, to.abc.begin() + 3 * f + 3);
      Soup vertex;
      vertex.vertex(from.xyz[3 * v], from.xyz[3 * v + 1], from.xyz[3 * v + 2]);
      if (v % 40 == 0) least = std::min(least, distances(vertex, one).at_vertices[0]);
    }
    if (v % 40 == 0) CHECK(r.at_vertices[v] == least);
  }
}

TEST_CASE("a mesh is nowhere away from itself, far from the origin too", "[surface_distance]") {
  const Soup m = samples::moved(samples::torus(30, 20, 2, 0.7), 1048576, 0, -1048576);
  const Result r = distances(m, m);
  CHECK(r.summary.vertex_max == 0);
  CHECK(r.summary.max < 1e-9);
}

TEST_CASE("what has no area has no mean, what has no vertex no distance", "[surface_distance]") {
  Soup points;
  points.vertex(0.5, 0.5, 3);
  const Result r = distances(points, samples::cube());
  CHECK(std::isnan(r.summary.mean));
  CHECK(r.summary.max == 2);
  CHECK(std::isnan(distances(Soup(), samples::cube()).summary.max));
}

TEST_CASE("distances are the same bits for any order of tasks", "[surface_distance]") {
  const Soup a = samples::torus(70, 30, 2, 0.6),
             b = samples::turned(samples::torus(50, 40, 2, 0.6));
  const Result x = distances(a, b), y = distances(a, b, samples::ReverseExecutor());
  CHECK(x.at_vertices == y.at_vertices);
  CHECK(samples::bytes_of(x.summary) == samples::bytes_of(y.summary));
}

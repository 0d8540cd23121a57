// The C API: measuring of any mesh.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"
#include "tests/samples/sample_shapes.h"

namespace {

using Catch::Matchers::Contains;
using samples::Context;
using samples::Soup;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

int64_t vertices(const Soup& m) {
  return static_cast<int64_t>(m.vertex_count());
}
int64_t faces(const Soup& m) {
  return static_cast<int64_t>(m.face_count());
}

Soup two_spheres() {
  Soup m = samples::sphere(2);
  m.append(samples::moved(samples::sphere(2), 3, 0, 0, 1.25));
  return m;
}

struct Measured {
  plc_component_measures whole{};
  std::vector<plc_component_measures> components;
  int64_t count = -1;
};

Measured measured(plc_context* context, const Soup& m, int64_t capacity) {
  Measured r;
  r.whole.struct_size = sizeof r.whole;
  r.components.resize(static_cast<size_t>(capacity));
  REQUIRE(plc_mesh_component_measures(context, m.xyz.data(), vertices(m), m.abc.data(), faces(m),
                                      &r.whole, capacity == 0 ? nullptr : r.components.data(),
                                      capacity, &r.count) == PLC_OK);
  return r;
}

}  // namespace

TEST_CASE("components are counted, then copied, the largest first", "[pellicle_measure]") {
  const Context context = samples::make_context();
  const Soup m = two_spheres();
  CHECK(measured(context.get(), m, 0).count == 2);
  const Measured one = measured(context.get(), m, 1), more = measured(context.get(), m, 3);
  CHECK(one.count == 2);
  CHECK(more.components[0].struct_size == sizeof(plc_component_measures));
  CHECK(samples::bytes_of(more.components[0]) == samples::bytes_of(one.components[0]));
  CHECK(more.components[0].centroid[0] == Approx(3).epsilon(1e-12));
  CHECK(more.components[1].first_face == 0);
  CHECK(more.components[2].struct_size == 0);  // untouched
  CHECK(more.whole.faces == 256);
  CHECK(more.whole.volume ==
        Approx(more.components[0].volume + more.components[1].volume).epsilon(1e-15));
}

TEST_CASE("measures of the C API are the same bits for any number of threads",
          "[pellicle_measure]") {
  const Soup a = samples::torus(150, 60, 2, 0.6), b = samples::turned(samples::sphere(4));
  std::vector<double> first;
  for (const int threads : {1, 2, 5}) {
    const Context context = samples::make_context(threads);
    const size_t n = a.vertex_count();
    std::vector<double> all(5 * n);
    plc_distances summary{};
    summary.struct_size = sizeof summary;
    REQUIRE(plc_mesh_curvature(context.get(), a.xyz.data(), vertices(a), a.abc.data(), faces(a),
                               all.data(), all.data() + n, all.data() + 2 * n) == PLC_OK);
    REQUIRE(plc_mesh_geodesic(context.get(), a.xyz.data(), vertices(a), a.abc.data(), faces(a), 7,
                              all.data() + 3 * n) == PLC_OK);
    REQUIRE(plc_mesh_distance(context.get(), a.xyz.data(), vertices(a), a.abc.data(), faces(a),
                              b.xyz.data(), vertices(b), b.abc.data(), faces(b), all.data() + 4 * n,
                              &summary) == PLC_OK);
    const Measured m = measured(context.get(), a, 0);
    all.insert(all.end(), {summary.mean, summary.rms, summary.max});
    all.insert(all.end(), m.whole.moments, m.whole.moments + 6);
    if (first.empty()) first = all;
    CHECK(all == first);
  }
}

TEST_CASE("outputs that are not wanted may be NULL", "[pellicle_measure]") {
  const Context context = samples::make_context();
  const Soup m = samples::cube();
  int64_t count = 0;
  CHECK(plc_mesh_component_measures(context.get(), m.xyz.data(), 8, m.abc.data(), 12, nullptr,
                                    nullptr, 0, &count) == PLC_OK);
  CHECK(plc_mesh_curvature(context.get(), m.xyz.data(), 8, m.abc.data(), 12, nullptr, nullptr,
                           nullptr) == PLC_OK);
  CHECK(plc_mesh_distance(context.get(), m.xyz.data(), 8, m.abc.data(), 12, m.xyz.data(), 8,
                          m.abc.data(), 12, nullptr, nullptr) == PLC_OK);
}

TEST_CASE("an empty mesh has no components, curvatures or nearest vertex", "[pellicle_measure]") {
  const Context context = samples::make_context();
  const Measured m = measured(context.get(), Soup(), 1);
  CHECK(m.count == 0);
  CHECK(m.whole.area == 0);
  CHECK(plc_mesh_curvature(context.get(), nullptr, 0, nullptr, 0, nullptr, nullptr, nullptr) ==
        PLC_OK);
  const double origin[3] = {0, 0, 0};
  int64_t vertex = 5;
  CHECK(plc_mesh_nearest_vertex(context.get(), origin, 1, nullptr, 0, origin, &vertex) == PLC_OK);
  CHECK(vertex == -1);
}

TEST_CASE("arguments that cannot be used are refused and named", "[pellicle_measure]") {
  const Context owner = samples::make_context();
  plc_context* context = owner.get();
  const Soup m = samples::cube();
  const double* xyz = m.xyz.data();
  const uint32_t* abc = m.abc.data();
  std::vector<double> out(8);
  plc_component_measures whole{};  // without its size
  plc_distances summary{};
  int64_t count = 0;
  const double bad_point[3] = {0, kNan, 0};
  const auto refused = [&](plc_status status, const char* word) {
    CHECK(status == PLC_INVALID_ARGUMENT);
    CHECK_THAT(plc_context_message(context), Contains(word));
  };
  refused(plc_mesh_component_measures(context, xyz, 8, abc, 12, &whole, nullptr, 0, &count),
          "whole");
  refused(plc_mesh_component_measures(context, xyz, 8, abc, 12, nullptr, nullptr, 1, &count),
          "components");
  refused(plc_mesh_component_measures(context, xyz, 8, abc, 12, nullptr, nullptr, -1, &count),
          "capacity");
  refused(plc_mesh_component_measures(context, xyz, 8, abc, 12, nullptr, nullptr, 0, nullptr),
          "count");
  refused(plc_mesh_curvature(context, xyz, -1, abc, 12, nullptr, nullptr, nullptr), "vertices");
  refused(plc_mesh_geodesic(context, xyz, 8, abc, 12, 8, out.data()), "source");
  refused(plc_mesh_geodesic(context, xyz, 8, abc, 12, -1, out.data()), "source");
  refused(plc_mesh_geodesic(context, xyz, 8, abc, 12, 0, nullptr), "distance");
  refused(plc_mesh_nearest_vertex(context, xyz, 8, abc, 12, nullptr, &count), "point");
  refused(plc_mesh_nearest_vertex(context, xyz, 8, abc, 12, bad_point, &count), "point");
  refused(plc_mesh_distance(context, xyz, 8, abc, 12, xyz, 8, abc, 12, nullptr, &summary),
          "summary");
  CHECK(plc_mesh_curvature(nullptr, xyz, 8, abc, 12, nullptr, nullptr, nullptr) ==
        PLC_INVALID_ARGUMENT);
}

TEST_CASE("meshes with values or indices out of range are refused and the place is named",
          "[pellicle_measure]") {
  const Context owner = samples::make_context();
  plc_context* context = owner.get();
  const Soup good = samples::cube();
  Soup nan = good, index = good;
  nan.xyz[7] = kNan;
  index.abc[4] = 8;
  std::vector<double> out(8, 5);
  const auto bad = [&](plc_status status, const char* words) {
    CHECK(status == PLC_INVALID_DATA);
    CHECK_THAT(plc_context_message(context), Contains(words));
  };
  int64_t count = 5;
  bad(plc_mesh_component_measures(context, nan.xyz.data(), 8, nan.abc.data(), 12, nullptr, nullptr,
                                  0, &count),
      "vertex 2: y");
  bad(plc_mesh_curvature(context, index.xyz.data(), 8, index.abc.data(), 12, out.data(), nullptr,
                         nullptr),
      "face 1: corner 1");
  bad(plc_mesh_geodesic(context, nan.xyz.data(), 8, nan.abc.data(), 12, 0, out.data()), "vertex 2");
  bad(plc_mesh_distance(context, good.xyz.data(), 8, good.abc.data(), 12, nan.xyz.data(), 8,
                        nan.abc.data(), 12, out.data(), nullptr),
      "the other mesh: vertex 2");
  bad(plc_mesh_distance(context, good.xyz.data(), 8, good.abc.data(), 12, good.xyz.data(), 8,
                        nullptr, 0, out.data(), nullptr),
      "no face");
  CHECK(count == 5);
  CHECK(out == std::vector<double>(8, 5));
}

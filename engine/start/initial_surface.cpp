#include "engine/start/initial_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/constants.h"
#include "engine/mesh/face_rings.h"
#include "engine/mesh/mesh_append.h"
#include "engine/resolve/refinement.h"

namespace plc {

namespace {

// Edge length of the icosahedron of circumradius 1.
constexpr double kIcosahedronEdge = 1.0514622242382672;

// Adds an icosahedron on the unit sphere.
void add_icosahedron(Mesh& mesh) {
  constexpr float kA = 0.5257311121191336F;
  constexpr float kB = 0.8506508083520399F;
  constexpr Vec3 kCorners[12] = {{-kA, 0, kB}, {kA, 0, kB},  {-kA, 0, -kB}, {kA, 0, -kB},
                                 {0, kB, kA},  {0, kB, -kA}, {0, -kB, kA},  {0, -kB, -kA},
                                 {kB, kA, 0},  {-kB, kA, 0}, {kB, -kA, 0},  {-kB, -kA, 0}};
  // Neighbours, counter-clockwise seen from outside.
  constexpr uint32_t kRings[12][5] = {{1, 4, 9, 11, 6},  {0, 6, 10, 8, 4},  {3, 7, 11, 9, 5},
                                      {2, 5, 8, 10, 7},  {0, 1, 8, 5, 9},   {2, 9, 4, 8, 3},
                                      {0, 11, 7, 10, 1}, {2, 3, 10, 6, 11}, {1, 10, 3, 5, 4},
                                      {0, 4, 5, 2, 11},  {1, 6, 7, 3, 8},   {0, 9, 2, 7, 6}};
  uint32_t id[12];
  for (uint32_t v = 0; v < 12; ++v) id[v] = mesh.create(kCorners[v], {});
  for (uint32_t v = 0; v < 12; ++v) {
    Neighbors ring;
    for (const uint32_t w : kRings[v]) ring.push_back(id[w]);
    mesh.set_ring(id[v], ring);
  }
}

// A sphere of radius 1 whose mean edge is at most `edge`; `copies` of it have to fit.
Status make_sphere(Mesh& mesh, double edge, double copies, const Executor& executor) {
  int refinements = 0;
  double vertices = 12;
  double mean = kIcosahedronEdge;
  for (; mean > edge; ++refinements) {
    mean /= kRefinement;
    vertices = 3 * vertices - 4;
    if (vertices * copies > static_cast<double>(kMaxMeshVertices)) return too_many_vertices();
  }
  mesh.clear();
  add_icosahedron(mesh);
  mesh.delta = kIcosahedronEdge / 1.5;
  for (; refinements > 0; --refinements) {
    refine(mesh, executor);
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      mesh.place(v, mesh.at(v) * (1.0F / length(mesh.at(v))));
    }
  }
  return {};
}

// Adds a unit sphere, stretched and moved.
void append_sphere(Mesh& mesh, const Mesh& sphere, Vec3 centre, Vec3 radii) {
  append_mesh(mesh, sphere, false, [&](Vec3 p) {
    return centre + Vec3{p.x * radii.x, p.y * radii.y, p.z * radii.z};
  });
}

// Edges of initial surfaces, in delta: under (2) with room for uneven spacing.
constexpr double kInitialEdge = 2.0;

}  // namespace

std::array<double, 3> bubble_half(const Extent& box, double delta) {
  // The corner of the box lies on the surface: 3 (1/r)^4 = 1.
  const double reach = std::sqrt(std::sqrt(3.0));
  std::array<double, 3> half{};
  for (size_t i = 0; i < 3; ++i) {
    half[i] = std::max((box.high[i] - box.low[i]) / 2 * reach, 2 * delta);
  }
  return half;
}

Status make_bubble(Mesh& mesh, const Extent& box, double delta, const Executor& executor) {
  const std::array<double, 3> half = bubble_half(box, delta);
  const std::array<double, 3> middle = box.middle();
  const double longest = *std::max_element(half.begin(), half.end());
  if (Status s = make_sphere(mesh, kInitialEdge * delta / longest, 1, executor); !s.ok()) return s;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const Vec3 n = mesh.at(v);
    const double x = n.x, y = n.y, z = n.z;
    const double bulge = 1 / std::sqrt(std::sqrt(x * x * x * x + y * y * y * y + z * z * z * z));
    mesh.place(v, {static_cast<float>(middle[0] + half[0] * bulge * x),
                   static_cast<float>(middle[1] + half[1] * bulge * y),
                   static_cast<float>(middle[2] + half[2] * bulge * z)});
    mesh.wake(v);
  }
  mesh.delta = delta;
  return {};
}

Status append_bubble(Mesh& mesh, Vec3 centre, Vec3 radii, const Executor& executor) {
  const double radius = static_cast<double>(std::max({radii.x, radii.y, radii.z}));
  Mesh sphere;
  if (Status s = make_sphere(sphere, kInitialEdge * mesh.delta / radius, 1, executor); !s.ok()) {
    return s;
  }
  if (uint64_t{mesh.slots()} + sphere.slots() > mesh.most_vertices) return too_many_vertices();
  append_sphere(mesh, sphere, centre, radii);
  return {};
}

Status make_bubbles(Mesh& mesh, const Extent& box, const std::array<int, 3>& counts, double delta,
                    const Executor& executor) {
  double pitch[3];
  double radius = 1e300;
  for (size_t i = 0; i < 3; ++i) {
    pitch[i] = (box.high[i] - box.low[i]) / counts[i];
    // Half the gap that (3) asks for on each side, and a little.
    radius = std::min(radius, pitch[i] / 2 - 0.75 * delta);
  }
  if (radius * kIcosahedronEdge < 1.2 * delta) {
    char line[160];
    std::snprintf(line, sizeof line,
                  "bubbles %d x %d x %d: too small for the coarsest level (delta %.3g voxels); use "
                  "fewer bubbles or fewer levels",
                  counts[0], counts[1], counts[2], delta);
    return {ErrorCode::kInvalidArgument, line};
  }
  Mesh sphere;
  const double copies = static_cast<double>(counts[0]) * counts[1] * counts[2];
  if (Status s = make_sphere(sphere, kInitialEdge * delta / radius, copies, executor); !s.ok()) {
    return s;
  }
  mesh.clear();
  const auto r = static_cast<float>(radius);
  for (int k = 0; k < counts[2]; ++k) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        const Vec3 centre{static_cast<float>(box.low[0] + (i + 0.5) * pitch[0]),
                          static_cast<float>(box.low[1] + (j + 0.5) * pitch[1]),
                          static_cast<float>(box.low[2] + (k + 0.5) * pitch[2])};
        append_sphere(mesh, sphere, centre, {r, r, r});
      }
    }
  }
  mesh.delta = delta;
  return {};
}

}  // namespace plc

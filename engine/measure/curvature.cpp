#include "engine/measure/curvature.h"

#include <cmath>
#include <limits>

#include "engine/base/blocks.h"
#include "engine/base/double3.h"
#include "engine/measure/mesh_topology.h"
#include "engine/measure/vertex_corners.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kVertexBlock = 2048;
constexpr double kTwoPi = 6.283185307179586;

// Sums over the faces around a vertex.
struct Star {
  Double3 normal;     // of the faces, weighted by their angles
  Double3 laplacian;  // sum of (cot alpha + cot beta) (x - x_j)
  double angle = 0;
  double area = 0;  // mixed
};

// The face a, b, c at its corner a.
void add_face(const double* a, const double* b, const double* c, Star& star) {
  const Double3 ab = difference(b, a), ac = difference(c, a), bc = difference(c, b);
  const Double3 normal = cross(ab, ac);
  const double twice = length(normal), at_a = dot(ab, ac);
  const double angle = std::atan2(twice, at_a);
  star.angle += angle;
  if (!(twice > 0)) return;
  star.normal = star.normal + normal * (angle / twice);
  const double at_b = -dot(ab, bc), at_c = dot(ac, bc);
  const double cot_b = at_b / twice, cot_c = at_c / twice;
  star.laplacian = star.laplacian - ab * cot_c - ac * cot_b;
  if (at_a < 0) {
    star.area += twice / 4;
  } else if (at_b < 0 || at_c < 0) {
    star.area += twice / 8;
  } else {
    star.area += (dot(ab, ab) * cot_c + dot(ac, ac) * cot_b) / 8;
  }
}

// Vertices of edges that have not two faces: those are all 1.
Vector<uint8_t> border_vertices(const MeshArrays& mesh, const Executor& executor) {
  Vector<uint8_t> border(mesh.vertex_count, 0);
  const EdgeTable edges(mesh.abc, mesh.face_count, mesh.vertex_count, executor);
  edges.visit(0, mesh.vertex_count,
              [&](uint32_t low, uint32_t high, const EdgeUse* use, const EdgeUse* end) {
                if (end - use != 2) border[low] = border[high] = 1;
              });
  return border;
}

}  // namespace

void vertex_curvature(const MeshArrays& mesh, const Executor& executor, double* mean,
                      double* gaussian, double* area) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const VertexCorners corners(mesh.abc, mesh.face_count, mesh.vertex_count);
  const Vector<uint8_t> border = border_vertices(mesh, executor);
  run_blocks(executor, mesh.vertex_count, kVertexBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      Star star;
      for (const uint32_t c : corners.of(v)) {
        add_face(mesh.corner(c), mesh.corner(next_corner(c)), mesh.corner(previous_corner(c)),
                 star);
      }
      const double size = length(star.normal);
      const bool defined = border[v] == 0 && star.area > 0 && size > 0;
      if (mean != nullptr) {
        mean[v] = defined ? dot(star.laplacian, star.normal) / size / (4 * star.area) : kNan;
      }
      if (gaussian != nullptr) gaussian[v] = defined ? (kTwoPi - star.angle) / star.area : kNan;
      if (area != nullptr) area[v] = star.area;
    }
  });
}

}  // namespace plc

#include "engine/measure/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/base/blocks.h"
#include "engine/base/double3.h"
#include "engine/measure/mesh_target.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kBlock = 512;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double distance_to(const MeshTarget& other, const double* p) {
  uint32_t face = kNoFace;
  return std::sqrt(other.nearest_within({p[0], p[1], p[2]}, kInfinity, face));
}

// Integrals over faces.
struct Sums {
  double area = 0, distance = 0, squared = 0, max = 0;
  void add(const Sums& part) {
    area += part.area;
    distance += part.distance;
    squared += part.squared;
    max = std::max(max, part.max);
  }
};

// The rule of seven points that is exact for cubics: corners 1/20, middles 2/15, centre 9/20.
Sums face_sums(const MeshTarget& other, const double* const (&p)[3], const double (&corner)[3]) {
  Sums sums;
  sums.area = length(cross(difference(p[1], p[0]), difference(p[2], p[0]))) / 2;
  const auto add = [&](double weight, double d) {
    sums.distance += weight * d;
    sums.squared += weight * d * d;
    sums.max = std::max(sums.max, d);
  };
  double centre[3];
  for (size_t k = 0; k < 3; ++k) centre[k] = (p[0][k] + p[1][k] + p[2][k]) / 3;
  add(9.0 / 20, distance_to(other, centre));
  for (size_t i = 0; i < 3; ++i) {
    add(1.0 / 20, corner[i]);
    const double *a = p[i], *b = p[(i + 1) % 3];
    const double middle[3] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    add(2.0 / 15, distance_to(other, middle));
  }
  sums.distance *= sums.area;
  sums.squared *= sums.area;
  return sums;
}

Sums surface_sums(const MeshArrays& mesh, const MeshTarget& other, const double* at_vertices,
                  const Executor& executor) {
  Vector<Sums> parts(block_count(mesh.face_count, kBlock));
  run_blocks(executor, mesh.face_count, kBlock, [&](size_t block, size_t begin, size_t end) {
    for (size_t f = begin; f < end; ++f) {
      const double* p[3];
      double corner[3];
      for (size_t k = 0; k < 3; ++k) {
        p[k] = mesh.corner(3 * f + k);
        corner[k] = at_vertices[mesh.abc[3 * f + k]];
      }
      parts[block].add(face_sums(other, p, corner));
    }
  });
  Sums all;
  for (const Sums& part : parts) all.add(part);
  return all;
}

}  // namespace

SurfaceDistances surface_distances(const MeshArrays& mesh, const MeshArrays& other,
                                   const Executor& executor, double* distance) {
  const MeshTarget target(other, executor);
  Vector<double> at(mesh.vertex_count);
  run_blocks(executor, mesh.vertex_count, kBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) at[v] = distance_to(target, mesh.point(v));
  });
  const Sums sums = surface_sums(mesh, target, at.data(), executor);
  SurfaceDistances d{kNan, kNan, kNan, kNan, kNan};
  if (mesh.vertex_count > 0) {
    d.vertex_mean =
        std::accumulate(at.begin(), at.end(), 0.0) / static_cast<double>(mesh.vertex_count);
    d.vertex_max = *std::max_element(at.begin(), at.end());
    d.max = std::max(d.vertex_max, sums.max);
  }
  if (sums.area > 0) {
    d.mean = sums.distance / sums.area;
    d.rms = std::sqrt(sums.squared / sums.area);
  }
  if (distance != nullptr) std::copy(at.begin(), at.end(), distance);
  return d;
}

}  // namespace plc

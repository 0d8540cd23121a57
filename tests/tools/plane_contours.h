// Where a mesh meets a slice of an image, written apart from the page of `pellicle view`, whose
// contours are compared with it.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "tools/mesh/mesh_io.h"
#include "tools/volume/volume_frame.h"

namespace samples {

using Segment = std::array<plc::tools::Place, 2>;

inline plc::tools::Place point_of(const plc::tools::TriangleMesh& mesh, uint32_t vertex) {
  const double* p = &mesh.xyz[size_t{3} * vertex];
  return {p[0], p[1], p[2]};
}

// Of a mesh in LPS with the slice `k` along an axis of the image, in the order of the faces.
// Corners at or beyond the slice are on one side, all others on the other.
inline std::vector<Segment> plane_contours(const plc::tools::TriangleMesh& mesh,
                                           const plc_image& image, size_t axis, double k) {
  std::vector<Segment> segments;
  for (size_t f = 0; f + 2 < mesh.abc.size(); f += 3) {
    std::array<plc::tools::Place, 3> p;
    std::array<double, 3> above{};
    for (size_t i = 0; i < 3; ++i) {
      p[i] = point_of(mesh, mesh.abc[f + i]);
      above[i] = plc::tools::voxel_of(image, p[i])[axis] - k;
    }
    std::vector<plc::tools::Place> ends;
    for (size_t i = 0; i < 3; ++i) {
      const size_t j = (i + 1) % 3;
      if ((above[i] >= 0) == (above[j] >= 0)) continue;
      const double t = above[i] / (above[i] - above[j]);
      plc::tools::Place& end = ends.emplace_back();
      for (size_t c = 0; c < 3; ++c) end[c] = p[i][c] + t * (p[j][c] - p[i][c]);
    }
    if (ends.size() == 2) segments.push_back({ends[0], ends[1]});
  }
  return segments;
}

inline double length_of(const std::vector<Segment>& segments) {
  double sum = 0;
  for (const auto& [a, b] : segments) sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  return sum;
}

}  // namespace samples

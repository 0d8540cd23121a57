#include "engine/self_meeting.h"

#include <algorithm>

#include "engine/self_intersection.h"

namespace plc {

std::vector<std::array<uint32_t, 3>> meeting_faces(const Mesh& mesh, const Executor& executor) {
  const std::vector<uint32_t> abc = mesh.faces();
  std::vector<double> xyz(static_cast<size_t>(mesh.slots()) * 3);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const Packed& p = mesh.packed[v];
    const size_t at = static_cast<size_t>(v) * 3;
    xyz[at] = p.x, xyz[at + 1] = p.y, xyz[at + 2] = p.z;
  }
  std::vector<uint32_t> faces;
  for (const auto& [f, g] : self_intersections(xyz.data(), abc.data(), abc.size() / 3, executor)) {
    faces.push_back(f);
    faces.push_back(g);
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  std::vector<std::array<uint32_t, 3>> corners;
  for (const uint32_t f : faces) {
    const size_t at = static_cast<size_t>(f) * 3;
    corners.push_back({abc[at], abc[at + 1], abc[at + 2]});
  }
  return corners;
}

}  // namespace plc

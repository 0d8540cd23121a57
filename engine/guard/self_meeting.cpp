#include "engine/guard/self_meeting.h"

#include <algorithm>

#include "engine/guard/meeting_search.h"
#include "pyramid/memory.h"

namespace plc {

Vector<std::array<uint32_t, 3>> meeting_faces(const Mesh& mesh, const Executor& executor) {
  MeetingSearch search;
  Vector<uint32_t> faces;
  for (const auto& [f, g] : search.find(mesh.rings(), mesh.slots(), mesh.position.data(), nullptr,
                                        executor, nullptr, mesh.held_ids())) {
    faces.push_back(f);
    faces.push_back(g);
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  Vector<std::array<uint32_t, 3>> corners;
  for (const uint32_t f : faces) {
    const uint32_t* abc = search.face(f);
    corners.push_back({abc[0], abc[1], abc[2]});
  }
  return corners;
}

}  // namespace plc

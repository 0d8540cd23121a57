// What of a mesh can be drawn: in numbers that the ray tracer's floats hold.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/mesh/mesh_io.h"
#include "tools/render/render_camera.h"

namespace plc::tools {

struct DrawnMesh {
  std::vector<Vec3f> points;  // within -1 .. 1: moved and scaled, the same on all axes
  std::vector<uint32_t> abc;  // the faces that have an area then
};

// Throws Failure, which names `path`, where a coordinate is not finite or no face has an area.
DrawnMesh drawn_mesh(const std::string& path, const TriangleMesh& mesh);

}  // namespace plc::tools

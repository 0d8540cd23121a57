// Meshes from one space of coordinates to another.
#pragma once
#include <optional>
#include <string>

#include "engine/pellicle.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

// Whether the axes of its voxels are those of a left hand in LPS.
bool mirrors(const plc_image& image);

// As files name it, and back; nothing for "".
const char* space_name(plc_space space);
std::optional<plc_space> space_named(const std::string& name);

// Brings the mesh to `space`; where its file names none it is taken to be in `assumed`. Voxels need
// the image whose they are, which may be NULL where none are met: else Failure, which names `path`.
// LPS and RAS differ by signs:
// nothing is rounded, and normals go along. Between mm and voxels normals are left out.
void bring_to(TriangleMesh& mesh, plc_space space, plc_space assumed, const plc_image* image,
              const std::string& path);

}  // namespace plc::tools

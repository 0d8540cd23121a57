// InVesalius projects (.inv3).
#pragma once
#include <string>

#include "tools/volume/volume_io.h"

namespace plc::tools {

// A project is a tar, perhaps compressed, of main.plist (the type, shape and spacing of the volume)
// and matrix.dat (its voxels, little endian, shape [z][y][x]).
//
// Orientation. The project says nothing of the patient's position, but InVesalius keeps every
// volume the same way: x towards the patient's left, y towards the front (rows bottom up), z
// towards the head. It mirrors y when it makes a surface. So does the direction given here, diag(1,
// -1, 1): origin (0, 0, 0) and this direction are LPS, and surfaces lie where InVesalius' own lie.
//
// Throws Failure.
LoadedVolume read_inv3(const std::string& path);

}  // namespace plc::tools

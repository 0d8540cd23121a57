// From plc_extras to what the engine runs with: places in voxels, initial surfaces.
#pragma once

#include "engine/api/frame.h"
#include "engine/base/mesh_arrays.h"
#include "engine/pellicle.h"
#include "engine/recover/recovery.h"
#include "pyramid/memory.h"
#include "pyramid/status.h"
#include "pyramid/volume.h"

namespace plc {

// What the host has given, or NULL, in the structs of this version, and checked for the init of the
// parameters: all that can be told without the image's voxels. frame: where
// the image lies; places outside it are refused. `mask` is the place of the mask that
// `extras` then points to.
Status check_extras(const plc_extras* given, const plc_parameters& parameters,
                    const VolumeView& image, const Frame& frame, plc_extras& extras,
                    plc_image& mask);

// Seeds, mesh, attachments and pins; not the mask, which needs the pyramid's spec.
void take_extras(const plc_extras& extras, const Frame& frame, RecoverySpec& spec);

// A mesh of one of the spaces in voxel indices: coordinates, and faces that stay outward.
struct VoxelMesh {
  Vector<double> xyz;
  Vector<uint32_t> abc;
};
VoxelMesh in_voxels(const Affine& to_space, const MeshArrays& mesh);

}  // namespace plc

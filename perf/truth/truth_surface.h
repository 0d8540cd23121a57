// Fine meshes of the two truths: the object, and the iso-surface of its image without noise.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/base/mesh_arrays.h"
#include "engine/measure/surface_distance.h"
#include "perf/truth/fine_field.h"
#include "perf/truth/scene.h"

namespace truth {

// Places of the volume, mm; faces outward.
struct Surface {
  std::vector<double> xyz;
  std::vector<uint32_t> abc;
  plc::MeshArrays arrays() const {
    return {xyz.data(), xyz.size() / 3, abc.data(), abc.size() / 3};
  }
};

// By marching tetrahedra over the nodes of the field, a quarter of a voxel apart; each vertex is
// then brought to the surface along its normal: of the signed distance, or of the image where it is
// one half, within 1e-4 voxels as the interpolated image has it. The faces are chords: where the
// radius of curvature is R they lie up to 0.02 / R voxels inside, half of that in the mean.
Surface object_surface(const Scene& scene, const FineField& field, const plc::Executor& executor);

// Empty where the image reaches one half nowhere: thin parts are lost in the blur.
Surface iso_surface(const FineField& field, const plc::Executor& executor);

// The unit normal of the object at p, outward: the gradient of the signed distance.
plc::Double3 object_normal(const Scene& scene, const plc::Double3& p);

}  // namespace truth

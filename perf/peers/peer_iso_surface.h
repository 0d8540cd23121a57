// The closed iso-surface that results are measured against: VTK's FlyingEdges of the parts of the
// object that are no crumbs. And places of a mesh in the same coordinates.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "perf/peers/peer_vtk.h"
#include "tools/file/failure.h"
#include "tools/mesh/mesh_io.h"

namespace peer {

// What the object is.
struct Side {
  double iso = 0;
  bool above = true;  // the object is where the image is above iso, else below
  // Voxels of the value itself are above, as FlyingEdges has it.
  bool inside(float value) const { return (value >= iso) == above; }
};

// Parts of fewer voxels are crumbs: 3^3, what hardly a face of the mesh fits into.
constexpr size_t kCrumb = 27;

struct IsoSurface {
  vtkSmartPointer<vtkPolyData> surface;  // voxel indices of the volume times its spacing: mm
  size_t parts = 0;                      // components of the object, by faces of voxels
  size_t crumbs = 0;                     // of fewer than kCrumb voxels, left out
};

// Sets crumbs to `outside`. The outermost voxels of `padded` are not of the object.
inline void drop_crumbs(Volume& padded, const Side& side, float outside, IsoSurface& counts) {
  const std::ptrdiff_t row = padded.dims[0];
  const std::array<std::ptrdiff_t, 6> steps{
      -1, 1, -row, row, -row * padded.dims[1], row * padded.dims[1]};
  std::vector<uint8_t> seen(padded.values.size());
  std::vector<size_t> part;  // its voxels, also those whose neighbours are still to be looked at
  for (size_t seed = 0; seed < seen.size(); ++seed) {
    if (seen[seed] != 0 || !side.inside(padded.values[seed])) continue;
    part.assign(1, seed);
    seen[seed] = 1;
    for (size_t i = 0; i < part.size(); ++i) {
      for (const std::ptrdiff_t step : steps) {
        const size_t next = part[i] + static_cast<size_t>(step);
        if (seen[next] != 0 || !side.inside(padded.values[next])) continue;
        seen[next] = 1;
        part.push_back(next);
      }
    }
    ++counts.parts;
    if (part.size() >= kCrumb) continue;
    ++counts.crumbs;
    for (const size_t voxel : part) padded.values[voxel] = outside;
  }
}

// outside: the value around the volume, not on the object's side. Throws Failure.
inline IsoSurface iso_surface(const Volume& volume, const Side& side, float outside) {
  for (const float value : volume.values) {
    if (!std::isfinite(value)) throw plc::tools::Failure{"has voxels that are no numbers"};
  }
  if (side.inside(outside)) {
    throw plc::tools::Failure{"pad " + std::to_string(outside) +
                              " is on the object's side of iso " + std::to_string(side.iso)};
  }
  IsoSurface result;
  Volume closed = padded(volume, 1, outside);
  drop_crumbs(closed, side, outside, result);
  const auto image = vtk_image(closed);
  image->SetOrigin(-volume.spacing[0], -volume.spacing[1], -volume.spacing[2]);
  result.surface = flying_edges(image, side.iso);
  if (result.surface->GetNumberOfCells() == 0) {
    throw plc::tools::Failure{"no object of " + std::to_string(kCrumb) + " voxels at iso " +
                              std::to_string(side.iso)};
  }
  return result;
}

// LPS to voxel indices of the volume.
inline std::array<double, 3> voxel_of(const Volume& volume, const std::array<double, 3>& lps) {
  const auto& d = volume.direction;
  std::array<double, 3> p{};
  for (size_t a = 0; a < 3; ++a) p[a] = lps[a] - volume.origin[a];
  // Cramer's rule: directions may be sheared. Axis a is column a of d.
  const auto determinant = [](double a, double b, double c, double e, double f, double g, double h,
                              double i, double j) {
    return a * (f * j - g * i) - b * (e * j - g * h) + c * (e * i - f * h);
  };
  const double whole = determinant(d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7], d[8]);
  return {
      determinant(p[0], d[1], d[2], p[1], d[4], d[5], p[2], d[7], d[8]) / whole / volume.spacing[0],
      determinant(d[0], p[0], d[2], d[3], p[1], d[5], d[6], p[2], d[8]) / whole / volume.spacing[1],
      determinant(d[0], d[1], p[0], d[3], d[4], p[1], d[6], d[7], p[2]) / whole /
          volume.spacing[2]};
}

}  // namespace peer

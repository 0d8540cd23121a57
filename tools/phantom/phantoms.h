// The paper's test images and more, computed. The same bits on every machine: only + - * / and
// square roots of doubles, and a random generator of our own.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/volume/volume_io.h"

namespace plc::tools {

// What is not set has the phantom's own default.
struct PhantomOptions {
  std::optional<int64_t> size[3];      // voxels, each >= 2
  double spacing[3] = {1, 1, 1};       // mm, > 0; the shapes are round in mm
  std::optional<double> noise;         // sigma of added noise, in units of full scale, >= 0
  uint64_t seed = 1;                   // of shapes and noise
  std::optional<plc_voxel_type> type;  // see full_scale()
  std::optional<int> count;            // blobs, labels: how many; vessels: trees; 1 .. 10000
  std::optional<int> depth;            // sierpinski: of recursion; vessels: of branching; 1 .. 12
  // Where it is set, it is given the voxels, some planes at a time from the first on, and the
  // volume that is returned has none: for volumes that no memory holds. Of vessels and sierpinski a
  // value per voxel is held all the same. whole: what the volume is, without its voxels.
  std::function<void(const plc_image& whole, std::span<const std::byte> planes)> take_planes;
};

// The voxel value that stands for 1: 255 in u8, 1000 in the other integer types, 1 in f32.
double full_scale(plc_voxel_type type);

// All throw Failure where an option is out of range or the memory is not there. The origin is 0,
// the direction the identity. Values below are in units of full scale.

// Section 3.9: two linked rings, max(0, 1 - d / (2 r)) at distance d from the nearer ring's circle,
// so 0.5 on the surface of tori of radii 14 and 3.57, at 64^3 (f32); one lies in the plane xy, the
// other in xz, centres 14 apart along x. Scaled to the smallest extent of another size.
LoadedVolume chain_phantom(const PhantomOptions& options);

// Section 5.1: a Menger sponge of 3^depth voxels a side, 0 and 1; 81^3 (u8), depth 4. Another size
// stretches it.
LoadedVolume sierpinski_phantom(const PhantomOptions& options);

// A fluorescent membrane: brightest (1) on a sphere of radius 0.36 of the smallest extent, falling
// to 0 at 0.05 of it on both sides as (1 - t^2)^2; 80^3 (u8), noise 0.1.
LoadedVolume shell_phantom(const PhantomOptions& options);

// Random trees of tapering bright tubes (0.8, full width at half height is the tube) on a darker
// background (0.2); 256 x 256 x 124 (i16), noise 0.04, four trees, depth 7.
LoadedVolume vessels_phantom(const PhantomOptions& options);

// Random metaballs: the sum of (1 - d^2 / R^2)^2 within the balls of radii R, at most 1; 64^3
// (f32), 8 balls.
LoadedVolume blobs_phantom(const PhantomOptions& options);

// A label image, of values that are not in units of full scale: a ball of radius 0.45 of the
// smallest extent in `count` Voronoi cells of random sites, labelled 1 .. count, around it 0; a
// ball labelled count + 1 lies inside the cell that has most room around its site and reaches 0.55
// as far as the cell's nearest wall; 64^3 (u8), 8 cells (at most 254 in u8). Noise mixes the
// labels.
LoadedVolume labels_phantom(const PhantomOptions& options);

// By name: chain, sierpinski, shell, vessels, blobs, labels.
const std::vector<std::string>& phantom_names();
LoadedVolume make_phantom(const std::string& name, const PhantomOptions& options);

}  // namespace plc::tools

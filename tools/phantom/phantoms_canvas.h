// What the phantoms share: options filled in, a field of doubles, and its conversion to voxels.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "tools/phantom/phantoms.h"

namespace plc::tools {

struct Point {
  double x, y, z;
};

// A phantom's options with its defaults filled in and everything checked. Throws Failure.
struct Canvas {
  int64_t size[3];
  double spacing[3];  // mm
  double noise;
  uint64_t seed;
  plc_voxel_type type;

  struct Defaults {
    int64_t size[3];
    plc_voxel_type type;
    double noise;
  };
  Canvas(const char* name, const PhantomOptions& options, const Defaults& defaults);

  // Between the centres of the outermost voxels, half a voxel added on both sides; mm.
  double extent(int axis) const { return static_cast<double>(size[axis]) * spacing[axis]; }
  double smallest_extent() const;
  Point centre() const;
  std::vector<double> field(double value) const;  // one value per voxel, x fastest

  // The volume with the field's values and the noise, in units of full scale.
  LoadedVolume volume(const std::vector<double>& field) const;
  // The same of a function of position (mm from the centre of the first voxel), called once for
  // every voxel, x fastest; no field is held.
  LoadedVolume volume(const std::function<double(const Point&)>& value) const;
  std::string name;

 private:
  decltype(PhantomOptions::take_planes) take_planes_;
  // Of next(voxel), called for every voxel, x fastest.
  LoadedVolume made(const std::function<double(size_t)>& next) const;
};

// options.count or options.depth, checked.
int checked_count(const char* name, const char* what, const std::optional<int>& value, int fallback,
                  int limit);

}  // namespace plc::tools

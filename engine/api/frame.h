// Where an image lies in patient space, and the maps between the spaces of the API.
#pragma once
#include <array>

#include "engine/pellicle.h"

namespace plc {

// p -> m p + t, m row-major.
struct Affine {
  std::array<double, 9> m{};
  std::array<double, 3> t{};

  std::array<double, 3> point(const std::array<double, 3>& p) const;
  std::array<double, 3> vector(const std::array<double, 3>& v) const;  // without t
  // Turns a mesh inside out: the winding of faces is to be reversed.
  bool mirrors() const;
  double volume() const;  // of what was of volume 1
  Affine inverse() const;
};

// See plc_image.
struct Frame {
  std::array<double, 3> spacing{1, 1, 1};
  std::array<double, 3> origin{};
  std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};

  // From voxel indices to a space.
  Affine to(plc_space space) const;
};

}  // namespace plc

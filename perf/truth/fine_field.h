// The image of a scene without noise, on a lattice several times as fine as its voxels.
//
// The image is what a scanner sees: the part of each voxel that is inside the object, blurred by a
// Gaussian. Its point spread is the voxel's box convolved with the Gaussian, sigma^2 + 1/12
// voxels^2 along each axis, and the half level of a ball lies about (sigma^2 + 1/12) / R inside it.
//
// How exact it is. Parts inside are those of leaves of an eighth of a voxel or less, in which the
// surface is taken for its tangent plane: off by about (1/8)^2 / (24 R) of a voxel where its radius
// of curvature is R, and by a leaf at edges. Without a blur the image is the sum of the leaves, and
// that is all. The blur is a sum over fine cells with the samples of the Gaussian: its mean and
// variance are those of the integral but for 1e-30; what the sum is off by is a ripple, below 0.004
// of the contrast at sigma = 0.5 and 0.0013 at 1, that a plane's half level does not feel.
// tests/perf/test_truth.cpp compares the image of a ball with its exact integral.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "engine/base/double3.h"
#include "perf/truth/scene.h"
#include "pyramid/executor.h"

namespace truth {

// Fine cells to a voxel along each axis: even, at least 4, and at most 0.27 mm long.
std::array<int, 3> fineness(const Scene& scene);

class FineField {
 public:
  FineField(const Scene& scene, const plc::Executor& executor);

  // Nodes are the corners of fine cells: node n of axis a lies at voxel coordinate
  // n / fine[a] - 1/2, and voxel i at node fine[a] * i + fine[a] / 2.
  const std::array<int, 3>& fine() const { return fine_; }
  const std::array<size_t, 3>& nodes() const { return nodes_; }
  float node(size_t x, size_t y, size_t z) const {
    return values_[(z * nodes_[1] + y) * nodes_[0] + x];
  }
  const float* row(size_t y, size_t z) const {
    return values_.data() + (z * nodes_[1] + y) * nodes_[0];
  }

  // Place of the volume, mm, of a place in nodes.
  plc::Double3 place(const plc::Double3& node) const;
  // By cubics through four nodes along each axis: off by the fourth power of the nodes' distance. 0
  // outside the volume.
  double at(const plc::Double3& place) const;
  plc::Double3 gradient(const plc::Double3& place) const;

  // The image: one value per voxel, x fastest.
  std::vector<float> voxels() const;

 private:
  std::array<int, 3> dims_, fine_;
  std::array<double, 3> spacing_;
  std::array<size_t, 3> nodes_;
  std::vector<float> values_;
};

}  // namespace truth

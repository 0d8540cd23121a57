// Convolution of an image with a Gaussian (paper, 3.8).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "pyramid/executor.h"

namespace plc {

// Voxels on either side that a Gaussian of standard deviation `sigma` voxels reaches: ceil(3
// sigma). sigma >= 0, 3 sigma below 2^31.
int64_t gaussian_radius(double sigma);

// The 2 radius + 1 samples at whole voxels, computed in double, divided by their sum, rounded.
std::vector<float> gaussian_weights(double sigma);

// image (x fastest) convolved along X, Y and Z with Gaussians of `sigma` voxels per axis, borders
// replicated, into `blurred`. `image` serves as the place of what lies between: its values are
// lost. Returns false when memory for a slice could not be had. The same bits for any executor and
// target.
bool convolve_gaussian(float* image, const std::array<int64_t, 3>& dims,
                       const std::array<double, 3>& sigma, const Executor& executor,
                       float* blurred);

}  // namespace plc

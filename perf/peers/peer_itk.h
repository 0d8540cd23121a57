// ITK images of a volume, and the pyramid that ITK makes of one.
#pragma once
// As in tools/volume/volume_io_itk.cpp: Debian's ITK turns every compiler but GCC away.
#ifdef __clang__
#define ITK_COMPILER_DETECTION_H
#define ITK_NOEXCEPT noexcept
#define VXL_COMPILER_DETECTION_H
#define VXL_DEPRECATED_MSG(text)
#endif

#include <itkImage.h>
#include <itkResampleImageFilter.h>
#include <itkSmoothingRecursiveGaussianImageFilter.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "perf/peers/peer.h"

namespace peer {

using Image = itk::Image<float, 3>;

// Values are mapped from [low, high] to [0, 1] and clipped.
inline Image::Pointer image_of(const Volume& volume, float low, float high) {
  const auto image = Image::New();
  Image::SizeType size;
  Image::SpacingType spacing;
  for (unsigned a = 0; a < 3; ++a) {
    size[a] = static_cast<itk::SizeValueType>(volume.dims[a]);
    spacing[a] = volume.spacing[a];
  }
  image->SetRegions(size);
  image->SetSpacing(spacing);
  image->Allocate();
  std::transform(volume.values.begin(), volume.values.end(), image->GetBufferPointer(),
                 [=](float v) { return std::clamp((v - low) / (high - low), 0.0F, 1.0F); });
  return image;
}

// `image` with the voxels of `grid`, linear.
inline Image::Pointer resampled(const Image* image, const Image::SizeType& size,
                                const Image::SpacingType& spacing, const Image::PointType& origin) {
  const auto filter = itk::ResampleImageFilter<Image, Image>::New();
  filter->SetInput(image);
  filter->SetSize(size);
  filter->SetOutputSpacing(spacing);
  filter->SetOutputOrigin(origin);
  filter->SetOutputDirection(image->GetDirection());
  filter->SetDefaultPixelValue(0);
  filter->Update();
  return filter->GetOutput();
}

// sqrt 3 times coarser: a recursive Gaussian of half a voxel of the result, then linear samples.
inline Image::Pointer reduced(const Image* image) {
  const double rho = std::sqrt(3.0);
  const auto& old_size = image->GetLargestPossibleRegion().GetSize();
  Image::SizeType size;
  Image::SpacingType spacing;
  Image::PointType origin;
  itk::SmoothingRecursiveGaussianImageFilter<Image, Image>::SigmaArrayType sigma;
  for (unsigned a = 0; a < 3; ++a) {
    size[a] = static_cast<itk::SizeValueType>(std::floor(static_cast<double>(old_size[a]) / rho));
    const double extent = image->GetSpacing()[a] * static_cast<double>(old_size[a]);
    spacing[a] = extent / static_cast<double>(size[a]);
    origin[a] = image->GetOrigin()[a] + (spacing[a] - image->GetSpacing()[a]) / 2;
    sigma[a] = spacing[a] / 2;
  }
  const auto filter = itk::SmoothingRecursiveGaussianImageFilter<Image, Image>::New();
  filter->SetInput(image);
  filter->SetSigmaArray(sigma);
  filter->Update();
  return resampled(filter->GetOutput(), size, spacing, origin);
}

// I_0 to I_levels.
inline std::vector<Image::Pointer> pyramid_of(const Image::Pointer& image, int levels) {
  std::vector<Image::Pointer> pyramid{image};
  for (int h = 1; h <= levels; ++h) pyramid.push_back(reduced(pyramid.back()));
  return pyramid;
}

}  // namespace peer

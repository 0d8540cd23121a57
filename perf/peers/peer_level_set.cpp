// The threshold level set of ITK, from a box around the image, on the full image or through a
// pyramid:
//   peer_level_set VOLUME [LEVELS]    levels above the full image, 3 by default
// Values are those of `pellicle extract` for bone of the head CT: its window, 226 HU. A level ends
// when the mean change of the level set falls under 0.005, or after 2000 iterations.
#include "perf/peers/peer_itk.h"
// Behind what peer_itk.h defines.
#include <itkThresholdSegmentationLevelSetImageFilter.h>

#include <cstdlib>

namespace {

using peer::Image;

constexpr float kLow = -105.5F, kHigh = 1418.9F, kIso = 226;
constexpr int kIterations = 2000;
constexpr double kChange = 0.005;

// Negative inside a box that leaves two voxels of the image outside.
Image::Pointer box_around(const Image* image) {
  const auto region = image->GetLargestPossibleRegion();
  const auto phi = Image::New();
  phi->CopyInformation(image);
  phi->SetRegions(region);
  phi->Allocate();
  const auto& size = region.GetSize();
  float* value = phi->GetBufferPointer();
  for (itk::SizeValueType z = 0; z < size[2]; ++z) {
    for (itk::SizeValueType y = 0; y < size[1]; ++y) {
      for (itk::SizeValueType x = 0; x < size[0]; ++x) {
        const itk::SizeValueType at[3] = {x, y, z};
        float depth = 1e9F;
        for (unsigned a = 0; a < 3; ++a) {
          const auto near = std::min(at[a], size[a] - 1 - at[a]);
          depth = std::min(depth, static_cast<float>(near) - 1.5F);
        }
        *value++ = -depth;
      }
    }
  }
  return phi;
}

// From the object of a coarser level.
Image::Pointer refined(const Image* coarse, const Image* image) {
  return peer::resampled(coarse, image->GetLargestPossibleRegion().GetSize(), image->GetSpacing(),
                         image->GetOrigin());
}

struct Result {
  Image::Pointer phi;
  unsigned long iterations = 0;
};

Result evolve(const Image* image, const Image* start) {
  const auto filter = itk::ThresholdSegmentationLevelSetImageFilter<Image, Image>::New();
  filter->SetInput(start);
  filter->SetFeatureImage(image);
  const float threshold = (kIso - kLow) / (kHigh - kLow);
  filter->SetLowerThreshold(threshold);
  filter->SetUpperThreshold(2);  // beyond the window: no object is too bright
  filter->SetPropagationScaling(1);
  filter->SetCurvatureScaling(0.2F);
  filter->SetIsoSurfaceValue(0);
  filter->SetMaximumRMSError(kChange);
  filter->SetNumberOfIterations(kIterations);
  filter->Update();
  return {filter->GetOutput(), static_cast<unsigned long>(filter->GetElapsedIterations())};
}

// Of what is inside, mm3.
double volume_of(const Image* phi) {
  const auto count = phi->GetLargestPossibleRegion().GetNumberOfPixels();
  const float* value = phi->GetBufferPointer();
  const auto inside = std::count_if(value, value + count, [](float v) { return v <= 0; });
  const auto& s = phi->GetSpacing();
  return static_cast<double>(inside) * s[0] * s[1] * s[2];
}

}  // namespace

int main(int argc, char** argv) {
  const int levels = argc > 2 ? std::atoi(argv[2]) : 3;
  return peer::run_peer(argc, argv, [levels](const peer::Volume& volume) {
    Result result;
    std::string iterations;
    const peer::Volume closed = peer::padded(volume, 6, kLow);
    const double seconds = peer::timed([&] {
      const auto pyramid = peer::pyramid_of(peer::image_of(closed, kLow, kHigh), levels);
      for (size_t h = pyramid.size(); h-- > 0;) {
        const Image* image = pyramid[h];
        const Image::Pointer start =
            h + 1 == pyramid.size() ? box_around(image) : refined(result.phi, image);
        result = evolve(image, start);
        iterations += (iterations.empty() ? "" : ", ") + std::to_string(result.iterations);
      }
    });
    // A sixth of a voxel at most is what it moves in an iteration.
    const std::string stopped =
        result.iterations < kIterations ? "" : ", stopped after " + std::to_string(kIterations);
    const std::string how = levels == 0 ? "direct" : std::to_string(levels) + " levels";
    std::printf(
        "{\"title\": \"ITK threshold level set, %s%s\", \"seconds\": %.3f, "
        "\"iterations\": [%s], \"volume\": %.0f}\n",
        how.c_str(), stopped.c_str(), seconds, iterations.c_str(), volume_of(result.phi));
  });
}

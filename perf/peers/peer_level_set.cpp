// The threshold level set of ITK, from a box around the image, on the full image or through a
// pyramid:
//   peer_level_set VOLUME [LEVELS]    levels above the full image, 3 by default
// A level ends
// when the mean change of the level set falls under 0.005, or after 2000 iterations.
#include "engine/base/mesh_arrays.h"
#include "perf/peers/peer_itk.h"
// Behind what peer_itk.h defines.
#include <itkThresholdSegmentationLevelSetImageFilter.h>

#include <cstdlib>

#include "perf/peers/peer_task.h"
#include "perf/peers/peer_vtk.h"

namespace {

using peer::Image;

constexpr int kPad = 6;  // voxels
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

// threshold: in the window, [0, 1].
Result evolve(const Image* image, const Image* start, float threshold) {
  const auto filter = itk::ThresholdSegmentationLevelSetImageFilter<Image, Image>::New();
  filter->SetInput(start);
  filter->SetFeatureImage(image);
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

// Where the level set is 0.
void write(const peer::Task& task, const peer::Volume& volume, const Image* phi) {
  if (task.mesh.empty()) return;
  peer::Volume inside = peer::padded(volume, kPad, 0);
  const float* value = phi->GetBufferPointer();
  for (float& v : inside.values) v = -*value++;
  std::vector<double> xyz;
  std::vector<uint32_t> abc;
  peer::arrays_of(peer::flying_edges(peer::vtk_image(inside), 0), xyz, abc);
  for (size_t i = 0; i < xyz.size(); ++i) xyz[i] -= kPad * volume.spacing[i % 3];
  peer::write_result(task, volume, std::move(xyz), std::move(abc));
}

}  // namespace

int main(int argc, char** argv) {
  return peer::run_peer(argc, argv, [](const peer::Volume& volume, const peer::Task& task) {
    const int levels = task.words.size() > 1 ? std::atoi(task.words[1].c_str()) : 3;
    const float threshold = (static_cast<float>(task.iso) - task.low) / (task.high - task.low);
    Result result;
    std::string iterations;
    const peer::Volume closed = peer::padded(volume, kPad, task.low);
    const double seconds = peer::timed([&] {
      const auto pyramid = peer::pyramid_of(peer::image_of(closed, task.low, task.high), levels);
      for (size_t h = pyramid.size(); h-- > 0;) {
        const Image* image = pyramid[h];
        const Image::Pointer start =
            h + 1 == pyramid.size() ? box_around(image) : refined(result.phi, image);
        result = evolve(image, start, threshold);
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
    write(task, volume, result.phi);
  });
}

// The pyramid by ITK: a recursive Gaussian and linear resampling to a size 1 / sqrt 3, three times.
#include "perf/peers/peer_itk.h"
// Behind what peer_itk.h defines.
#include "perf/peers/peer_task.h"

int main(int argc, char** argv) {
  return peer::run_peer(argc, argv, [](const peer::Volume& volume, const peer::Task& task) {
    std::vector<peer::Image::Pointer> pyramid;
    const double seconds = peer::timed(
        [&] { pyramid = peer::pyramid_of(peer::image_of(volume, task.low, task.high), 3); });
    const auto size = pyramid.back()->GetLargestPossibleRegion().GetSize();
    std::printf(
        "{\"title\": \"ITK recursive Gaussian and resampling, 3 levels\", \"pyramid\": true, "
        "\"seconds\": %.6f, \"coarsest\": [%lu, %lu, %lu]}\n",
        seconds, size[0], size[1], size[2]);
  });
}

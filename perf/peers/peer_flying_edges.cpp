// The iso-surface, by default of bone, 226 HU, by VTK's FlyingEdges: no triangles of a size. With
// --smooth its windowed sinc, as VTK's defaults have it, makes it smooth.
#include <vtkWindowedSincPolyDataFilter.h>

#include "engine/base/mesh_arrays.h"
#include "perf/peers/peer_task.h"
#include "perf/peers/peer_vtk.h"

namespace {

constexpr int kPad = 6;  // voxels

vtkSmartPointer<vtkPolyData> smoothed(vtkPolyData* surface) {
  const vtkNew<vtkWindowedSincPolyDataFilter> filter;
  filter->SetInputData(surface);
  // Without it the defaults distort what is far from the origin.
  filter->NormalizeCoordinatesOn();
  filter->Update();
  return filter->GetOutput();
}

void write(const peer::Task& task, const peer::Volume& volume, vtkPolyData* surface) {
  std::vector<double> xyz;
  std::vector<uint32_t> abc;
  peer::arrays_of(surface, xyz, abc);
  for (size_t i = 0; i < xyz.size(); ++i) xyz[i] -= kPad * volume.spacing[i % 3];
  peer::write_result(task, volume, std::move(xyz), std::move(abc));
}

}  // namespace

int main(int argc, char** argv) {
  return peer::run_peer(argc, argv, [](const peer::Volume& volume, const peer::Task& task) {
    const auto image = peer::vtk_image(peer::padded(volume, kPad, task.low));
    vtkSmartPointer<vtkPolyData> surface;
    const double seconds = peer::timed([&] {
      surface = peer::flying_edges(image, task.iso);
      if (task.smooth) surface = smoothed(surface);
    });
    std::printf(
        "{\"title\": \"VTK FlyingEdges (%s)\", \"seconds\": %.6f, "
        "\"vertices\": %lld, \"faces\": %lld}\n",
        task.smooth ? "windowed sinc" : "iso-surface only", seconds,
        static_cast<long long>(surface->GetNumberOfPoints()),
        static_cast<long long>(surface->GetNumberOfCells()));
    write(task, volume, surface);
  });
}

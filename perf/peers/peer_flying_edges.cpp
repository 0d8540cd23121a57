// The iso-surface of bone, 226 HU, by VTK's FlyingEdges: no smoothing, no triangles of a size.
#include "perf/peers/peer_vtk.h"

int main(int argc, char** argv) {
  return peer::run_peer(argc, argv, [](const peer::Volume& volume) {
    const auto image = peer::vtk_image(peer::padded(volume, 6, -105.5F));
    vtkSmartPointer<vtkPolyData> surface;
    const double seconds = peer::timed([&] { surface = peer::flying_edges(image, 226); });
    std::printf(
        "{\"title\": \"VTK FlyingEdges (iso-surface only)\", \"seconds\": %.6f, "
        "\"vertices\": %lld, \"faces\": %lld}\n",
        seconds, static_cast<long long>(surface->GetNumberOfPoints()),
        static_cast<long long>(surface->GetNumberOfCells()));
  });
}

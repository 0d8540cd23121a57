// The iso-surface of bone, 226 HU, by VTK's FlyingEdges, and CGAL's isotropic remeshing of it to
// the edges that `pellicle extract` ends with, 1.5 mm; counts the faces that meet in the result.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <vtkCellArray.h>
#include <vtkIdList.h>

#include "perf/peers/peer_task.h"
#include "perf/peers/peer_vtk.h"

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

constexpr double kEdge = 1.5;  // mm

Mesh mesh_of(vtkPolyData* surface) {
  std::vector<Kernel::Point_3> points;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i) {
    const double* p = surface->GetPoint(i);
    points.emplace_back(p[0], p[1], p[2]);
  }
  std::vector<std::vector<size_t>> faces;
  const vtkNew<vtkIdList> ids;
  vtkCellArray* cells = surface->GetPolys();
  for (cells->InitTraversal(); cells->GetNextCell(ids) != 0;) {
    faces.push_back({static_cast<size_t>(ids->GetId(0)), static_cast<size_t>(ids->GetId(1)),
                     static_cast<size_t>(ids->GetId(2))});
  }
  // The table of marching cubes leaves edges of four faces and faces of no area.
  pmp::repair_polygon_soup(points, faces);
  pmp::orient_polygon_soup(points, faces);
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, faces, mesh);
  return mesh;
}

size_t self_intersections(const Mesh& mesh) {
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  pmp::self_intersections(mesh, std::back_inserter(pairs));
  return pairs.size();
}

}  // namespace

int main(int argc, char** argv) {
  return peer::run_peer(argc, argv, [](const peer::Volume& volume, const peer::Task& task) {
    const auto image = peer::vtk_image(peer::padded(volume, 6, task.low));
    Mesh mesh;
    const double seconds = peer::timed([&] {
      mesh = mesh_of(peer::flying_edges(image, task.iso));
      pmp::isotropic_remeshing(faces(mesh), kEdge, mesh, pmp::parameters::number_of_iterations(3));
    });
    mesh.collect_garbage();
    std::printf(
        "{\"title\": \"VTK FlyingEdges and CGAL isotropic remeshing to 1.5 mm\", "
        "\"seconds\": %.3f, \"vertices\": %zu, \"self_intersections\": %zu}\n",
        seconds, static_cast<size_t>(mesh.number_of_vertices()), self_intersections(mesh));
  });
}

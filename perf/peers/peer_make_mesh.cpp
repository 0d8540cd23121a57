// Bone, 226 HU, by CGAL's Delaunay refinement: make_mesh_3 with facets of 1 mm. It fills the bone
// with tetrahedra, too; these are as large as the facets let them be.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Image_3.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h>

#include <set>

#include "perf/peers/peer.h"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
namespace parameters = CGAL::parameters;

constexpr float kOutside = -105.5F;

CGAL::Image_3 image_of(const peer::Volume& volume) {
  const auto size = [&](size_t a) { return static_cast<size_t>(volume.dims[a]); };
  _image* image = _createImage(size(0), size(1), size(2), 1, volume.spacing[0], volume.spacing[1],
                               volume.spacing[2], sizeof(float), WK_FLOAT, SGN_SIGNED);
  std::copy(volume.values.begin(), volume.values.end(), static_cast<float*>(image->data));
  return CGAL::Image_3(image);
}

size_t surface_vertices(const Complex& complex) {
  std::set<Triangulation::Vertex_handle> vertices;
  for (auto f = complex.facets_in_complex_begin(); f != complex.facets_in_complex_end(); ++f) {
    for (int k = 0; k < 4; ++k) {
      if (k != f->second) vertices.insert(f->first->vertex(k));
    }
  }
  return vertices.size();
}

}  // namespace

int main(int argc, char** argv) {
  return peer::run_peer(argc, argv, [](const peer::Volume& volume) {
    const CGAL::Image_3 image = image_of(peer::padded(volume, 6, kOutside));
    Complex complex;
    const double seconds = peer::timed([&] {
      const Domain domain = Domain::create_gray_image_mesh_domain(
          image, parameters::iso_value = 226, parameters::value_outside = kOutside);
      const Criteria criteria(parameters::facet_angle = 25, parameters::facet_size = 1);
      complex = CGAL::make_mesh_3<Complex>(domain, criteria, parameters::no_perturb(),
                                           parameters::no_exude());
    });
    std::printf(
        "{\"title\": \"CGAL make_mesh_3, facets of 1 mm\", \"seconds\": %.3f, "
        "\"vertices\": %zu}\n",
        seconds, surface_vertices(complex));
  });
}

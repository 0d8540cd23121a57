// The iso-surface, by default of bone, 226 HU, by CGAL's Delaunay refinement: make_mesh_3 with
// facets of 1 mm. It fills the bone with tetrahedra, too; these are as large as the facets let them
// be.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Image_3.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h>

#include <map>

#include "perf/peers/peer_task.h"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
namespace parameters = CGAL::parameters;

constexpr int kPad = 6;  // voxels

CGAL::Image_3 image_of(const peer::Volume& volume) {
  const auto size = [&](size_t a) { return static_cast<size_t>(volume.dims[a]); };
  _image* image = _createImage(size(0), size(1), size(2), 1, volume.spacing[0], volume.spacing[1],
                               volume.spacing[2], sizeof(float), WK_FLOAT, SGN_SIGNED);
  std::copy(volume.values.begin(), volume.values.end(), static_cast<float*>(image->data));
  return CGAL::Image_3(image);
}

struct Facets {
  std::vector<double> xyz;
  std::vector<uint32_t> abc;
};

// Outward, in voxels of the volume times its spacing.
Facets facets_of(const Complex& complex, const peer::Volume& volume) {
  Facets facets;
  std::map<Triangulation::Vertex_handle, uint32_t> ids;
  for (auto f = complex.facets_in_complex_begin(); f != complex.facets_in_complex_end(); ++f) {
    Triangulation::Facet facet = *f;
    if (!complex.is_in_complex(facet.first)) facet = complex.triangulation().mirror_facet(facet);
    for (int k = 0; k < 3; ++k) {
      const auto vertex = facet.first->vertex(Triangulation::vertex_triple_index(facet.second, k));
      const auto [entry, is_new] = ids.try_emplace(vertex, static_cast<uint32_t>(ids.size()));
      facets.abc.push_back(entry->second);
      if (!is_new) continue;
      const double p[3] = {vertex->point().x(), vertex->point().y(), vertex->point().z()};
      for (size_t a = 0; a < 3; ++a) facets.xyz.push_back(p[a] - kPad * volume.spacing[a]);
    }
  }
  return facets;
}

}  // namespace

int main(int argc, char** argv) {
  return peer::run_peer(argc, argv, [](const peer::Volume& volume, const peer::Task& task) {
    const auto above = [&](float value) { return static_cast<double>(value) > task.iso; };
    if (std::none_of(volume.values.begin(), volume.values.end(), above)) {
      throw plc::tools::Failure{"no voxel is above the value"};  // it would search without end
    }
    const CGAL::Image_3 image = image_of(peer::padded(volume, kPad, task.low));
    Complex complex;
    const double seconds = peer::timed([&] {
      const Domain domain = Domain::create_gray_image_mesh_domain(
          image, parameters::iso_value = task.iso, parameters::value_outside = task.low);
      const Criteria criteria(parameters::facet_angle = 25, parameters::facet_size = 1);
      complex = CGAL::make_mesh_3<Complex>(domain, criteria, parameters::no_perturb(),
                                           parameters::no_exude());
    });
    const Facets facets = facets_of(complex, volume);
    std::printf(
        "{\"title\": \"CGAL make_mesh_3, facets of 1 mm\", \"seconds\": %.3f, "
        "\"vertices\": %zu}\n",
        seconds, facets.xyz.size() / 3);
    peer::write_result(task, volume, facets.xyz, facets.abc);
  });
}

// How far meshes in LPS are from what is true of a scene, as JSON:
//   truth_measure SCENE [MESH...]
// Distances in voxels (mm: the geometric mean of the spacing is 1), see deviations.h; null where
// there is none. Of a mesh without faces that is all that is told.
#include <cmath>

#include "engine/base/mesh_arrays.h"
#include "engine/base/schedule.h"
#include "engine/measure/measures.h"
#include "perf/truth/deviations.h"
#include "perf/truth/program.h"
#include "tools/mesh/mesh_io.h"

namespace {

using plc::tools::Failure;
using truth::Surface;

Surface surface_of(const truth::Scene& scene, const std::string& path) {
  const plc::tools::TriangleMesh mesh = plc::tools::read_mesh(path);
  Surface surface{mesh.xyz, mesh.abc};
  for (size_t i = 0; i < surface.xyz.size(); i += 3) {
    double* xyz = surface.xyz.data() + i;
    const plc::Double3 p = scene.from_lps({xyz[0], xyz[1], xyz[2]});
    xyz[0] = p.x, xyz[1] = p.y, xyz[2] = p.z;
  }
  return surface;
}

void print(const char* name, double value) {
  if (std::isfinite(value)) {
    std::printf("\"%s\": %.9g", name, value);
  } else {
    std::printf("\"%s\": null", name);
  }
}

void print(const char* name, const truth::Spread& s) {
  std::printf(
      "\"%s\": {\"bias\": %.6f, \"rms\": %.6f, \"p95\": %.6f, \"max\": %.6f, \"far\": %.6f}", name,
      s.bias, s.rms, s.p95, s.max, s.far);
}

void print(const char* name, const truth::Deviation& d) {
  std::printf("\"%s\": {", name);
  print("to_truth", d.to_truth);
  std::printf(", ");
  print("from_truth", d.from_truth);
  std::printf("}");
}

void print(const std::string& path, const truth::Measured& m) {
  std::printf("{\"mesh\": \"%s\", \"vertices\": %zu, \"faces\": %zu", path.c_str(), m.vertices,
              m.faces);
  std::printf(", \"components\": %lld, \"genus\": %lld, ", static_cast<long long>(m.components),
              static_cast<long long>(m.genus));
  print("area", m.area);
  std::printf(", ");
  print("volume", m.volume);
  std::printf(", ");
  print("curvature", m.curvature);
  std::printf(", ");
  print("object", m.object);
  if (m.iso) {
    std::printf(", ");
    print("iso", *m.iso);
  } else {
    std::printf(", \"iso\": null");
  }
  std::printf("}");
}

void print_truth(const truth::Scene& scene, const truth::Truth& truth,
                 const plc::Schedule& schedule) {
  const auto measures = [&](const Surface& s) {
    return plc::surface_measures(plc::arrays_of(s.xyz, s.abc), schedule);
  };
  const plc::SurfaceMeasures object = measures(truth.object());
  const truth::Shape& shape = scene.shape;
  std::printf("{\"object\": {\"components\": %d, \"genus\": %d, ", shape.components, shape.genus);
  print("area", std::isfinite(shape.area) ? shape.area : object.area);
  std::printf(", ");
  print("volume", std::isfinite(shape.volume) ? shape.volume : object.volume);
  std::printf("}, \"iso\": ");
  if (truth.iso().abc.empty()) {
    std::printf("null");
    return;
  }
  const plc::SurfaceMeasures iso = measures(truth.iso());
  std::printf("{\"components\": %lld, \"genus\": %lld, ", static_cast<long long>(iso.components),
              static_cast<long long>(iso.genus));
  print("area", iso.area);
  std::printf(", ");
  print("volume", iso.volume);
  std::printf("}");
}

void measure(std::vector<std::string> words) {
  const truth::Scene scene = truth::take_scene(words);
  for (const std::string& word : words) {
    if (word.rfind('-', 0) == 0) throw Failure{word + ": not known"};
  }
  std::vector<Surface> meshes;
  meshes.reserve(words.size());
  for (const std::string& path : words) meshes.push_back(surface_of(scene, path));
  const plc::Schedule schedule(truth::threads());
  const truth::Truth truth(scene, schedule);
  std::printf("{\"voxels\": [%d, %d, %d], \"truth\": ", scene.dims[0], scene.dims[1],
              scene.dims[2]);
  print_truth(scene, truth, schedule);
  std::printf("}, \"meshes\": [");
  for (size_t i = 0; i < meshes.size(); ++i) {
    if (i > 0) std::printf(",\n");
    if (meshes[i].abc.empty()) {
      std::printf("{\"mesh\": \"%s\", \"faces\": 0}", words[i].c_str());
    } else {
      print(words[i], truth.measure(std::move(meshes[i])));
    }
  }
  std::printf("]}\n");
}

}  // namespace

int main(int argc, char** argv) {
  return truth::run_program(argc, argv, "truth_measure", "truth_measure SCENE [MESH...]", measure);
}

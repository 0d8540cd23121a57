// How far a mesh is from the iso-surface of a volume, and the iso-surface from the mesh:
//   peer_distances VOLUME ISO MESH [--inside above|below] [--pad VALUE] [--space lps|ras|voxel]
// The iso-surface is that of VTK's FlyingEdges of the volume with VALUE around it (by default the
// end of the volume's values that is outside), without parts of the object of fewer than 27 voxels.
// Distances are to the nearest point of the other surface, from places that are spread evenly over
// the area, in voxels: mm divided by the geometric mean of the spacing. --space: what the
// coordinates of MESH are, lps by default. Prints a JSON object.
#include <vtkCellArray.h>
#include <vtkGenericCell.h>
#include <vtkPoints.h>
#include <vtkStaticCellLocator.h>

#include <cstdlib>
#include <cstring>
#include <optional>

#include "perf/peers/peer_iso_surface.h"
#include "perf/truth/even_samples.h"

namespace {

using plc::tools::Failure;

constexpr size_t kSamples = 200'000;  // of each surface

struct Options {
  std::string volume, mesh, space = "lps";
  peer::Side side;
  std::optional<float> pad;
};

double number(const char* name, const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end == text || *end != '\0' || !std::isfinite(value)) {
    throw Failure{std::string(name) + " " + text + ": a number is expected"};
  }
  return value;
}

Options parse(int argc, char** argv) {
  Options options;
  std::vector<const char*> files;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name.size() < 3 || name.compare(0, 2, "--") != 0) {
      files.push_back(argv[i]);
      continue;
    }
    if (i + 1 == argc) throw Failure{name + ": a value is expected"};
    const std::string value = argv[++i];
    if (name == "--inside" && (value == "above" || value == "below")) {
      options.side.above = value == "above";
    } else if (name == "--space" && (value == "lps" || value == "ras" || value == "voxel")) {
      options.space = value;
    } else if (name == "--pad") {
      options.pad = static_cast<float>(number("--pad", value.c_str()));
    } else {
      throw Failure{std::string(name).append(" ").append(value).append(": not known")};
    }
  }
  if (files.size() != 3) throw Failure{"VOLUME, ISO and MESH are expected"};
  options.volume = files[0];
  options.side.iso = number("ISO", files[1]);
  options.mesh = files[2];
  return options;
}

// In the coordinates of IsoSurface.
vtkSmartPointer<vtkPolyData> surface_of(const Options& options, const peer::Volume& volume) {
  const plc::tools::TriangleMesh mesh = plc::tools::read_mesh(options.mesh);
  if (mesh.abc.empty()) throw Failure{options.mesh + ": has no faces"};
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (size_t i = 0; i < mesh.xyz.size(); i += 3) {
    std::array<double, 3> p{mesh.xyz[i], mesh.xyz[i + 1], mesh.xyz[i + 2]};
    if (options.space == "ras") p = {-p[0], -p[1], p[2]};
    if (options.space != "voxel") p = voxel_of(volume, p);
    points->InsertNextPoint(p[0] * volume.spacing[0], p[1] * volume.spacing[1],
                            p[2] * volume.spacing[2]);
  }
  const vtkNew<vtkCellArray> faces;
  for (size_t i = 0; i < mesh.abc.size(); i += 3) {
    faces->InsertNextCell({static_cast<vtkIdType>(mesh.abc[i]),
                           static_cast<vtkIdType>(mesh.abc[i + 1]),
                           static_cast<vtkIdType>(mesh.abc[i + 2])});
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(faces);
  return surface;
}

std::vector<std::array<double, 3>> samples_of(vtkPolyData* surface) {
  const auto corners = [&](size_t face) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    surface->GetCellPoints(static_cast<vtkIdType>(face), count, ids);
    truth::Corners p{};
    for (size_t k = 0; k < 3; ++k) surface->GetPoint(ids[k], p[k].data());
    return p;
  };
  return truth::even_samples(static_cast<size_t>(surface->GetNumberOfCells()), corners, kSamples);
}

struct Distances {
  double mean = 0, p95 = 0, max = 0;
};

// In units of `voxel` mm.
Distances distances(vtkPolyData* from, vtkPolyData* to, double voxel) {
  const vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(to);
  locator->BuildLocator();
  const vtkNew<vtkGenericCell> cell;
  std::vector<double> all;
  Distances result;
  for (const std::array<double, 3>& place : samples_of(from)) {
    double nearest[3], squared = 0;
    vtkIdType face = -1;
    int part = 0;
    locator->FindClosestPoint(place.data(), nearest, cell, face, part, squared);
    if (face < 0) throw Failure{"a surface has no nearest point"};
    all.push_back(std::sqrt(squared) / voxel);
    result.mean += all.back() / kSamples;
  }
  std::sort(all.begin(), all.end());
  result.p95 = all[kSamples * 95 / 100];
  result.max = all.back();
  return result;
}

void print(const char* name, const Distances& d) {
  std::printf(", \"%s\": {\"mean\": %.6f, \"p95\": %.6f, \"max\": %.6f}", name, d.mean, d.p95,
              d.max);
}

void run(const Options& options) {
  const peer::Volume volume = peer::read(options.volume);
  const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
  const float outside = options.pad.value_or(options.side.above ? *low : *high);
  const peer::IsoSurface reference = peer::iso_surface(volume, options.side, outside);
  const auto mesh = surface_of(options, volume);
  const double voxel = std::cbrt(volume.spacing[0] * volume.spacing[1] * volume.spacing[2]);
  std::printf("{\"voxel_mm\": %.9g, \"samples\": %zu, \"parts\": %zu, \"crumbs\": %zu", voxel,
              kSamples, reference.parts, reference.crumbs);
  std::printf(", \"reference_faces\": %lld, \"mesh_faces\": %lld",
              static_cast<long long>(reference.surface->GetNumberOfCells()),
              static_cast<long long>(mesh->GetNumberOfCells()));
  print("reference_to_mesh", distances(reference.surface, mesh, voxel));
  print("mesh_to_reference", distances(mesh, reference.surface, voxel));
  std::printf("}\n");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(parse(argc, argv));
    return 0;
  } catch (const Failure& failure) {
    std::fprintf(stderr, "peer_distances: %s\n", failure.message.c_str());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "peer_distances: %s\n", e.what());
  }
  return 2;
}

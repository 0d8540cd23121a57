#include "tools/command/command_measure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "engine/pellicle.h"
#include "tools/command/engine_handles.h"
#include "tools/command/measure_report.h"
#include "tools/command/mesh_precision.h"
#include "tools/command/option_values.h"
#include "tools/command/report.h"
#include "tools/file/failure.h"
#include "tools/mesh/mesh_io.h"
#include "tools/volume/mesh_spaces.h"

namespace plc::tools {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

int64_t vertices_of(const TriangleMesh& mesh) {
  return static_cast<int64_t>(mesh.xyz.size() / 3);
}

int64_t faces_of(const TriangleMesh& mesh) {
  return static_cast<int64_t>(mesh.abc.size() / 3);
}

void require(plc_context* context, plc_status status) {
  if (status != PLC_OK) throw failure_of(context);
}

// Values that are not finite become NaN: viewers leave these out.
void add_scalars(TriangleMesh& mesh, const std::string& name, const std::vector<double>& values) {
  Scalars scalars{name, {}};
  scalars.values.reserve(values.size());
  for (const double value : values) {
    scalars.values.push_back(static_cast<float>(std::isfinite(value) ? value : kNan));
  }
  std::erase_if(mesh.scalars, [&](const Scalars& s) { return s.name == name; });  // of the file
  mesh.scalars.push_back(std::move(scalars));
}

struct Range {
  double low = kNan, high = kNan;
  void add(double value) {
    low = std::fmin(low, value);
    high = std::fmax(high, value);
  }
};

CurvatureSummary measure_curvature(plc_context* context, TriangleMesh& mesh) {
  const size_t count = mesh.xyz.size() / 3;
  std::vector<double> mean(count), gaussian(count), area(count);
  require(context, plc_mesh_curvature(context, mesh.xyz.data(), vertices_of(mesh), mesh.abc.data(),
                                      faces_of(mesh), mean.data(), gaussian.data(), area.data()));
  Range means, gaussians;
  double sum = 0, integral = 0, total = 0;
  for (size_t v = 0; v < count; ++v) {
    if (std::isnan(mean[v])) continue;
    means.add(mean[v]);
    gaussians.add(gaussian[v]);
    sum += mean[v] * area[v];
    integral += gaussian[v] * area[v];
    total += area[v];
  }
  add_scalars(mesh, "MeanCurvature", mean);
  add_scalars(mesh, "GaussianCurvature", gaussian);
  return {means.low,     means.high,     total > 0 ? sum / total : kNan,
          gaussians.low, gaussians.high, integral};
}

int64_t source_of(plc_context* context, const TriangleMesh& mesh, const MeasureOptions& options) {
  if (options.geodesic_vertex) {
    const int64_t vertex = *options.geodesic_vertex;
    if (vertex >= vertices_of(mesh)) {
      throw Failure{"--geodesic-vertex: " + options.mesh + " has no vertex " +
                    std::to_string(vertex) + ", its last is " +
                    std::to_string(vertices_of(mesh) - 1)};
    }
    return vertex;
  }
  int64_t vertex = -1;
  require(context,
          plc_mesh_nearest_vertex(context, mesh.xyz.data(), vertices_of(mesh), mesh.abc.data(),
                                  faces_of(mesh), options.geodesic_point->data(), &vertex));
  if (vertex < 0) throw Failure{"--geodesic: " + options.mesh + " has no face"};
  return vertex;
}

GeodesicSummary measure_geodesic(plc_context* context, TriangleMesh& mesh, int64_t source) {
  const size_t count = mesh.xyz.size() / 3;
  std::vector<double> distance(count);
  require(context, plc_mesh_geodesic(context, mesh.xyz.data(), vertices_of(mesh), mesh.abc.data(),
                                     faces_of(mesh), source, distance.data()));
  GeodesicSummary summary{source, {}, 0, source, 0};
  std::copy_n(mesh.xyz.begin() + 3 * source, 3, summary.position.begin());
  for (size_t v = 0; v < count; ++v) {
    if (!std::isfinite(distance[v])) continue;
    ++summary.reached;
    if (distance[v] <= summary.max) continue;
    summary.max = distance[v];
    summary.farthest = static_cast<int64_t>(v);
  }
  add_scalars(mesh, "Geodesic", distance);
  return summary;
}

plc_distances distances(plc_context* context, const TriangleMesh& from, const TriangleMesh& to,
                        double* at_vertices) {
  plc_distances result{};
  result.struct_size = sizeof result;
  require(context, plc_mesh_distance(context, from.xyz.data(), vertices_of(from), from.abc.data(),
                                     faces_of(from), to.xyz.data(), vertices_of(to), to.abc.data(),
                                     faces_of(to), at_vertices, &result));
  return result;
}

DistanceSummary measure_distance(plc_context* context, TriangleMesh& mesh,
                                 const MeasureOptions& options) {
  TriangleMesh other = read_mesh(options.other);
  const plc_space space = space_named(mesh.space).value_or(PLC_SPACE_LPS);
  bring_to(other, space, PLC_SPACE_LPS, nullptr, options.other);
  if (mesh.abc.empty()) throw Failure{options.mesh + ": has no faces"};
  if (other.abc.empty()) throw Failure{options.other + ": has no faces"};
  std::vector<double> distance(mesh.xyz.size() / 3);
  DistanceSummary summary{options.other, distances(context, mesh, other, distance.data()),
                          distances(context, other, mesh, nullptr)};
  add_scalars(mesh, "Distance", distance);
  return summary;
}

Measured measure(plc_context* context, TriangleMesh& mesh, const MeasureOptions& options) {
  Measured m{};
  m.mesh = options.mesh;
  m.whole.struct_size = sizeof m.whole;
  const int64_t capacity = std::min<int64_t>(options.components, faces_of(mesh));
  m.components.resize(static_cast<size_t>(capacity));
  require(context, plc_mesh_component_measures(context, mesh.xyz.data(), vertices_of(mesh),
                                               mesh.abc.data(), faces_of(mesh), &m.whole,
                                               m.components.data(), capacity, &m.component_count));
  m.components.resize(static_cast<size_t>(std::min(capacity, m.component_count)));
  if (options.curvature) m.curvature = measure_curvature(context, mesh);
  if (options.geodesic_point || options.geodesic_vertex) {
    m.geodesic = measure_geodesic(context, mesh, source_of(context, mesh, options));
  }
  if (!options.other.empty()) m.distance = measure_distance(context, mesh, options);
  return m;
}

void check_outputs(const MeasureOptions& options) {
  if (!options.output.empty()) {
    const bool any = options.curvature || options.geodesic_point || options.geodesic_vertex ||
                     !options.other.empty();
    if (!any) {
      throw Failure{"-o: nothing to write: ask for --curvature, --geodesic or --distance"};
    }
    check_mesh_path(options.output, true);
  }
  if (options.json.empty()) return;
  if (options.json == options.output) throw Failure{options.json + ": both mesh and JSON"};
  check_report_path(options.json);
}

}  // namespace

void add_measure_options(CLI::App& command, MeasureOptions& options) {
  command.add_option("MESH", options.mesh, mesh_suffixes(MeshUse::kRead) + ", in mm")
      ->required()
      ->type_name("");
  const auto text = [&](const std::string& name, const std::string& type,
                        const std::string& meaning, auto read) {
    return command.add_option_function<std::string>(name, read, meaning)->type_name(type);
  };
  text("--components", "N", "How many components to list, the largest first",
       [&](const std::string& s) {
         options.components = to_integer("--components", s);
         if (options.components < 0) refuse_value("--components", s, "0 or more");
       })
      ->default_str(std::to_string(options.components));
  command.add_flag("--curvature", options.curvature, "Mean and Gaussian curvature of each vertex");
  auto* point =
      text("--geodesic", "X,Y,Z", "Distances over the surface from the vertex nearest to a point",
           [&](const std::string& s) {
             const std::vector<double> x = to_numbers("--geodesic", s, 3);
             options.geodesic_point = {x[0], x[1], x[2]};
           });
  text("--geodesic-vertex", "ID", "... from a vertex, counted from 0", [&](const std::string& s) {
    options.geodesic_vertex = to_integer("--geodesic-vertex", s);
    if (*options.geodesic_vertex < 0) refuse_value("--geodesic-vertex", s, "0 or more");
  })->excludes(point);
  command
      .add_option("--distance", options.other, "Distances to the nearest points of another mesh")
      ->type_name("OTHER");
  command
      .add_option("-o,--output", options.output,
                  "Mesh with MeanCurvature, GaussianCurvature, Geodesic and Distance at its "
                  "vertices, NaN where there is none: " +
                      mesh_suffixes(MeshUse::kWrittenWithScalars))
      ->type_name("FILE");
  command.add_option("--json", options.json, "All numbers as JSON")->type_name("FILE");
}

int run_measure(const MeasureOptions& options) {
  check_outputs(options);
  plc_context_options context_options;
  plc_context_options_defaults(&context_options);
  const ContextHandle context = make_context(context_options);
  TriangleMesh mesh = read_mesh(options.mesh);
  mesh.scalars.clear();  // those that are written are those that have been asked for
  const Measured measured = measure(context.get(), mesh, options);
  if (!options.output.empty()) {
    settle_precision(context.get(), mesh);
    write_mesh(options.output, mesh);
    tell_precision(mesh.doubles, options.output);
  }
  if (!options.json.empty()) write_report(options.json, measured_json(measured));
  print_measured(measured);
  return 0;
}

}  // namespace plc::tools

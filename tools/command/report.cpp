#include "tools/command/report.h"

#include <sys/resource.h>
#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "tools/command/engine_handles.h"

namespace plc::tools {

namespace {

using Json = nlohmann::ordered_json;

Json parameters_json(const plc_parameters& p, ExtractOptions options) {
  options.parameters = p;
  const std::vector<double> isos(p.level_iso, p.level_iso + p.level_iso_count);
  return {{"iso", std::isnan(p.iso) ? Json() : Json(p.iso)},
          {"inside", name_of(p.inside_below, kInsides)},
          {"level_iso", isos},
          {"window", {p.window_low, p.window_high}},
          {"pad", p.pad_value},
          {"feature", name_of(p.feature, kFeatures)},
          {"sigma", p.feature_sigma},
          {"levels", p.levels},
          {"reduction", p.reduction},
          {"anisotropy", name_of(p.anisotropy, kAnisotropies)},
          {"init", init_text(options)},
          {"mesh", name_of(p.mesh, kMeshes)},
          {"edge", p.edge},
          {"tolerance", p.tolerance},
          {"edge_range", {p.edge_min, p.edge_max}},
          {"curvature", p.curvature},
          {"spring", p.spring},
          {"rest_length", rest_length_text(p)},
          {"force", name_of(p.force, kForces)},
          {"attraction", p.attraction},
          {"gradient", p.gradient},
          {"gradient_tangent", p.gradient_tangent},
          {"gradient_bound", p.gradient_bound},
          {"mass", p.mass},
          {"damping", p.damping},
          {"time_step", p.time_step},
          {"max_move", p.max_move},
          {"bound", name_of(p.bound, kBounds)},
          {"epsilon", p.epsilon},
          {"calm_speed", p.calm_speed},
          {"max_iterations", p.max_iterations},
          {"late_bubbles", p.late_bubbles != 0},
          {"sleeping", p.sleeping != 0},
          {"space", name_of(options.space, kSpaces)},
          {"nifti_frame", name_of(options.nifti_frame, kNiftiFrames)}};
}

plc_level_report level_of(plc_context* context, const plc_surface* surface, int index) {
  plc_level_report level{};
  level.struct_size = sizeof level;
  demand(context, plc_surface_level(context, surface, index, &level));
  return level;
}

Json level_json(const plc_level_report& level) {
  return {{"level", level.level},
          {"dims", level.dims},
          {"unit", level.unit},
          {"delta", level.delta},
          {"iso", level.iso},
          {"iterations", level.iterations},
          {"vertices", level.vertices},
          {"converged", level.converged != 0},
          {"energy", level.energy},
          {"speed", level.speed},
          {"seconds",
           {{"topology", level.seconds_topology},
            {"normals", level.seconds_normals},
            {"dynamics", level.seconds_dynamics},
            {"total", level.seconds_total}}},
          {"operations",
           {{"creation", level.creations},
            {"inversion", level.inversions},
            {"deletion", level.deletions},
            {"annular", level.annular},
            {"axial", level.axial},
            {"tetrahedron", level.tetrahedra},
            {"refinement", level.refinements}}},
          {"deferred", level.deferred},
          {"moves", level.moves},
          {"checks", level.checks},
          {"late",
           {{"bubbles", level.late_bubbles},
            {"cavities", level.late_cavities},
            {"volume", level.late_volume}}},
          {"frozen", {{"sites", level.frozen_sites}, {"vertices", level.frozen_vertices}}}};
}

Json sites_json(plc_context* context, const plc_surface* surface, plc_space space) {
  int64_t count = 0;
  demand(context, plc_surface_frozen_sites(context, surface, space, nullptr, nullptr, 0, &count));
  std::vector<double> xyz(3 * static_cast<size_t>(count));
  std::vector<int64_t> vertices(static_cast<size_t>(count));
  demand(context, plc_surface_frozen_sites(context, surface, space, xyz.data(), vertices.data(),
                                           count, &count));
  Json sites = Json::array();
  for (size_t i = 0; i < vertices.size(); ++i) {
    sites.push_back(
        {{"place", {xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}}, {"vertices", vertices[i]}});
  }
  return sites;
}

Json input_json(plc_context* context, const plc_image& image, const plc_surface* surface,
                const ExtractOptions& options) {
  double low = 0;
  double high = 0;
  demand(context, plc_surface_input_range(context, surface, &low, &high));
  return {{"file", options.labels.empty() ? options.input : options.labels},
          {"dims", image.dims},
          {"spacing", image.spacing},
          {"origin", image.origin},
          {"direction", image.direction},
          {"range", {low, high}}};
}

Json surface_json(const plc_measures& m) {
  return {{"vertices", m.vertices}, {"faces", m.faces}, {"components", m.components},
          {"euler", m.euler},       {"genus", m.genus}, {"area", m.area},
          {"volume", m.volume}};
}

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 512> line{};
  std::snprintf(line.data(), line.size(), pattern, values...);
  return line.data();
}

std::string late_text(const plc_level_report& level) {
  if (level.late_bubbles + level.late_cavities == 0) return "";
  return format(", %" PRId64 " late bubbles and %" PRId64 " cavities of %.0f mm3",
                level.late_bubbles, level.late_cavities, level.late_volume);
}

std::string frozen_text(const plc_level_report& level) {
  if (level.frozen_sites == 0) return "";
  return format(", %" PRId64 " sites of %" PRId64 " vertices frozen", level.frozen_sites,
                level.frozen_vertices);
}

}  // namespace

int64_t peak_rss_bytes() {
  rusage own{};
  rusage readers{};  // child processes
  getrusage(RUSAGE_SELF, &own);
  getrusage(RUSAGE_CHILDREN, &readers);
  return int64_t{1024} * std::max(own.ru_maxrss, readers.ru_maxrss);  // Linux counts in KiB
}

std::string hash_text(uint64_t hash) {
  return format("%016" PRIx64, hash);
}

Json make_report(plc_context* context, const plc_image& image, const plc_surface* surface,
                 const plc_measures& measures, const Timings& timings,
                 const ExtractOptions& options) {
  plc_parameters parameters{};
  parameters.struct_size = sizeof parameters;
  demand(context, plc_surface_parameters(context, surface, &parameters));
  plc_seconds seconds{};
  seconds.struct_size = sizeof seconds;
  demand(context, plc_surface_seconds(context, surface, &seconds));
  Json levels = Json::array();
  for (int i = 0; i < plc_surface_level_count(surface); ++i) {
    levels.push_back(level_json(level_of(context, surface, i)));
  }
  return {{"pellicle", plc_version_string()},
          {"input", input_json(context, image, surface, options)},
          {"parameters", parameters_json(parameters, options)},
          {"levels", levels},
          {"surface", surface_json(measures)},
          {"sites", sites_json(context, surface, options.space)},
          {"seconds",
           {{"read", timings.read},
            {"pyramid", seconds.preparation},
            {"images", seconds.images},
            {"evolution", seconds.evolution},
            {"write", timings.write},
            {"total", timings.total}}},
          {"peak_rss_bytes", peak_rss_bytes()},
          {"hash", hash_text(plc_surface_hash(surface))},
          {"threads", plc_context_threads(context)},
          {"simd", plc_context_simd(context)}};
}

void check_report_path(const std::string& path) {
  const AtomicFile probe(path);
}

void write_report(const std::string& path, const Json& report) {
  AtomicFiles files;
  write_report(path, report, files);
  files.commit();
}

void write_report(const std::string& path, const Json& report, AtomicFiles& files) {
  files.add(path).write(report.dump(2) + "\n");
}

std::string summary(plc_context* context, const plc_image& image, const plc_surface* surface,
                    const plc_measures& m, const Timings& timings, const std::string& output) {
  std::string text =
      format("image    %" PRId64 " x %" PRId64 " x %" PRId64 " voxels of %.4g x %.4g x %.4g mm\n",
             image.dims[0], image.dims[1], image.dims[2], image.spacing[0], image.spacing[1],
             image.spacing[2]);
  for (int i = 0; i < plc_surface_level_count(surface); ++i) {
    const plc_level_report level = level_of(context, surface, i);
    text += format("level %d  %" PRId64 " x %" PRId64 " x %" PRId64 "%s: %" PRId64
                   " iterations, %" PRId64 " vertices, %.2f s%s%s%s\n",
                   level.level, level.dims[0], level.dims[1], level.dims[2],
                   std::isnan(level.iso) ? "" : format(", iso %.5g", level.iso).c_str(),
                   level.iterations, level.vertices, level.seconds_total, late_text(level).c_str(),
                   frozen_text(level).c_str(),
                   level.converged != 0  ? ""
                   : level.vertices == 0 ? ", holds no surface"
                                         : ", stopped at the most iterations");
  }
  text += format("surface  %" PRId64 " vertices, %" PRId64 " faces, components %" PRId64
                 ", genus %" PRId64 ", area %.1f mm2, volume %.1f mm3\n",
                 m.vertices, m.faces, m.components, m.genus, m.area, m.volume);
  text += format("time     %.2f s, peak memory %.0f MiB\n", timings.total,
                 std::ceil(static_cast<double>(peak_rss_bytes()) / (1024.0 * 1024.0)));
  return text + "written  " + output + "\n";
}

std::vector<std::string> unfinished_levels(plc_context* context, const plc_surface* surface,
                                           int max_iterations) {
  std::vector<std::string> lines;
  for (int i = 0; i < plc_surface_level_count(surface); ++i) {
    const plc_level_report level = level_of(context, surface, i);
    if (level.converged != 0 || level.vertices == 0) continue;
    lines.push_back(format("level %d did not come to rest within --max-iterations %d", level.level,
                           max_iterations));
  }
  return lines;
}

}  // namespace plc::tools

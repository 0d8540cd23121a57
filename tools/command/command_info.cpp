#include "tools/command/command_info.h"

#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/command/command_check.h"
#include "tools/command/engine_handles.h"
#include "tools/command/extract_options.h"
#include "tools/command/rounded_text.h"
#include "tools/mesh/mesh_io.h"
#include "tools/volume/volume_frame.h"
#include "tools/volume/volume_io.h"
#include "tools/volume/volume_statistics.h"

namespace plc::tools {

namespace {

using Json = nlohmann::ordered_json;

template <typename Triple>
std::string box(const Triple& low, const Triple& high) {
  return rounded_triple(low) + " .. " + rounded_triple(high);
}

// ---- images ---------------------------------------------------------------------------------

const std::vector<double> kPercents = {1, 5, 25, 50, 75, 95, 99};

struct ImageFacts {
  VolumeRange range;
  std::vector<double> percentiles;
  double otsu;
  Bounds lps, ras;
};

ImageFacts facts_of(const plc_image& image) {
  ImageFacts facts{range_of(image), percentiles_of(image, kPercents), otsu_of(image),
                   bounds_of(image), bounds_of(image)};
  for (size_t k = 0; k < 2; ++k) {  // from 0, as -0 is no place
    facts.ras.low[k] = 0 - facts.lps.high[k];
    facts.ras.high[k] = 0 - facts.lps.low[k];
  }
  return facts;
}

Json bounds_json(const Bounds& bounds) {
  return {{"low", bounds.low}, {"high", bounds.high}};
}

Json image_json(const std::string& path, const LoadedVolume& volume) {
  const plc_image& image = volume.image;
  const ImageFacts facts = facts_of(image);
  const Bounds voxels{
      {0, 0, 0},
      {static_cast<double>(image.dims[0] - 1), static_cast<double>(image.dims[1] - 1),
       static_cast<double>(image.dims[2] - 1)}};
  Json percentiles;
  for (size_t i = 0; i < kPercents.size(); ++i) {
    percentiles["p" + text_of(kPercents[i])] = facts.percentiles[i];
  }
  return {{"image", path},
          {"dims", image.dims},
          {"type", voxel_type_name(image.type)},
          {"axes", axis_letters(image)},
          {"obliquity", obliquity(image)},
          {"spacing", image.spacing},
          {"origin", image.origin},
          {"direction", image.direction},
          {"bounds",
           {{"lps", bounds_json(facts.lps)},
            {"ras", bounds_json(facts.ras)},
            {"voxel", bounds_json(voxels)}}},
          {"range", {facts.range.low, facts.range.high}},
          {"not_finite", facts.range.not_finite},
          {"percentiles", percentiles},
          {"otsu", facts.otsu},
          {"warnings", volume.warnings}};
}

// "x to the left, y to the back, z to the head"
std::string axes_text(const plc_image& image) {
  static constexpr std::array<std::pair<char, const char*>, 6> kWays = {{{'L', "to the left"},
                                                                         {'R', "to the right"},
                                                                         {'P', "to the back"},
                                                                         {'A', "to the front"},
                                                                         {'S', "to the head"},
                                                                         {'I', "to the feet"}}};
  const std::string letters = axis_letters(image);
  std::string text = letters + " (";
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const auto& [letter, way] : kWays) {
      if (letter != letters[axis]) continue;
      text += std::string(axis > 0 ? ", " : "") + "xyz"[axis] + " " + way;
    }
  }
  constexpr double kTold = 0.05;  // degrees
  const double angle = obliquity(image);
  return text + ")" + (angle > kTold ? ", oblique by " + rounded(angle) + " degrees" : "");
}

void row(const char* name, const std::string& value) {
  std::printf("%-12s %s\n", name, value.c_str());
}

void print_image(const std::string& path, const LoadedVolume& volume) {
  const plc_image& image = volume.image;
  const ImageFacts facts = facts_of(image);
  const auto last = [&](size_t axis) { return static_cast<double>(image.dims[axis] - 1); };
  row("image", path);
  row("voxels", std::to_string(image.dims[0]) + " x " + std::to_string(image.dims[1]) + " x " +
                    std::to_string(image.dims[2]) + " of " + voxel_type_name(image.type));
  row("axes", axes_text(image));
  row("spacing", rounded(image.spacing[0]) + " x " + rounded(image.spacing[1]) + " x " +
                     rounded(image.spacing[2]) + " mm");
  row("origin", rounded_triple(image.origin) + " mm (LPS)");
  row("bounds", "of the centres of the voxels");
  row("  lps", box(facts.lps.low, facts.lps.high) + " mm");
  row("  ras", box(facts.ras.low, facts.ras.high) + " mm");
  row("  voxel", box(Place{0, 0, 0}, Place{last(0), last(1), last(2)}));
  row("range", rounded_range(facts.range.low, facts.range.high));
  if (facts.range.not_finite > 0) {
    row("not finite", std::to_string(facts.range.not_finite) + " voxels");
  }
  std::string percentiles;
  for (size_t i = 0; i < kPercents.size(); ++i) {
    percentiles +=
        (i > 0 ? ", p" : "p") + text_of(kPercents[i]) + " " + rounded(facts.percentiles[i]);
  }
  row("percentiles", percentiles);
  row("otsu", rounded(facts.otsu));
}

int run_image(const InfoOptions& options) {
  const LoadedVolume volume = read_volume_apart(options.input, options.nifti_frame);
  print_warnings(volume.warnings);
  if (options.json) {
    std::puts(image_json(options.input, volume).dump(2).c_str());
  } else {
    print_image(options.input, volume);
  }
  return 0;
}

// ---- meshes ---------------------------------------------------------------------------------

struct MeshFacts {
  plc_check check;
  plc_component_measures whole;
  std::vector<std::string> values;
};

MeshFacts facts_of(plc_context* context, const TriangleMesh& mesh) {
  MeshFacts facts{check_of(context, mesh), {}, {}};
  facts.whole.struct_size = sizeof facts.whole;
  int64_t count = 0;
  demand(context,
         plc_mesh_component_measures(
             context, mesh.xyz.data(), static_cast<int64_t>(mesh.xyz.size() / 3), mesh.abc.data(),
             static_cast<int64_t>(mesh.abc.size() / 3), &facts.whole, nullptr, 0, &count));
  for (const Scalars& scalars : mesh.scalars) facts.values.push_back(scalars.name);
  return facts;
}

// What keeps a mesh from being valid, or "".
std::string faults_of(const plc_check& c) {
  std::string text;
  const auto add = [&](int64_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(c.border_edges, "border edges");
  add(c.non_manifold_edges, "non-manifold edges");
  add(c.non_manifold_vertices, "non-manifold vertices");
  add(c.inconsistent_edges, "inconsistent edges");
  add(c.wrongly_oriented_components, "components turned inside out");
  add(c.degenerate_faces, "degenerate faces");
  add(c.duplicate_points, "duplicate points");
  add(c.isolated_vertices, "isolated vertices");
  add(c.self_intersections, "self-intersections");
  return text;
}

Json mesh_json(const std::string& path, const TriangleMesh& mesh, const MeshFacts& facts) {
  const plc_measures& m = facts.check.measures;
  const auto corner = [](const double* x) { return Json{x[0], x[1], x[2]}; };
  return {{"mesh", path},
          {"space", mesh.space.empty() ? Json() : Json(mesh.space)},
          {"vertices", m.vertices},
          {"faces", m.faces},
          {"valid", facts.check.valid != 0},
          {"faults", faults_of(facts.check)},
          {"components", m.components},
          {"genus", m.genus < 0 ? Json() : Json(m.genus)},
          {"area", m.area},
          {"volume", facts.whole.volume},
          {"bounds", {{"low", corner(facts.whole.low)}, {"high", corner(facts.whole.high)}}},
          {"edge",
           {{"min", facts.check.edge_min},
            {"mean", facts.check.edge_mean},
            {"max", facts.check.edge_max}}},
          {"values", facts.values}};
}

void print_mesh(const std::string& path, const TriangleMesh& mesh, const MeshFacts& facts) {
  const plc_measures& m = facts.check.measures;
  std::string first = path + ": " + std::to_string(m.vertices) + " vertices, " +
                      std::to_string(m.faces) + " faces, " +
                      (mesh.space.empty() ? "space not named" : "in " + mesh.space);
  for (const std::string& name : facts.values) first += ", " + name;
  row("mesh", first);
  const std::string faults = faults_of(facts.check);
  row("valid", facts.check.valid != 0 ? "yes" : "no" + (faults.empty() ? "" : ": " + faults));
  row("shape", std::to_string(m.components) + (m.components == 1 ? " component" : " components") +
                   ", genus " + (m.genus < 0 ? "not defined" : std::to_string(m.genus)) +
                   ", area " + rounded(m.area) + ", volume " + rounded(facts.whole.volume));
  row("bounds", box(facts.whole.low, facts.whole.high));
  row("edges", rounded_range(facts.check.edge_min, facts.check.edge_max) + ", mean " +
                   rounded(facts.check.edge_mean));
}

int run_mesh_file(const InfoOptions& options) {
  plc_context_options context_options;
  plc_context_options_defaults(&context_options);
  const ContextHandle context = make_context(context_options);
  const TriangleMesh mesh = read_mesh(options.input);
  const MeshFacts facts = facts_of(context.get(), mesh);
  if (options.json) {
    std::puts(mesh_json(options.input, mesh, facts).dump(2).c_str());
  } else {
    print_mesh(options.input, mesh, facts);
  }
  return 0;
}

}  // namespace

void add_info_options(CLI::App& command, InfoOptions& options) {
  command
      .add_option("FILE", options.input,
                  "An image as extract reads it, or a mesh (" + mesh_suffixes(MeshUse::kRead) + ")")
      ->required()
      ->type_name("");
  command
      .add_option_function<std::string>(
          "--nifti-frame",
          [&options](const std::string& s) {
            options.nifti_frame = to_choice("--nifti-frame", s, kNiftiFrames);
          },
          "Where NIfTI files lie: as in extract")
      ->type_name("auto|sform|qform")
      ->default_str("auto");
  command.add_flag("--json", options.json, "JSON instead of a table");
}

int run_info(const InfoOptions& options) {
  return is_mesh_path(options.input) ? run_mesh_file(options) : run_image(options);
}

}  // namespace plc::tools

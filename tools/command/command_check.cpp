#include "tools/command/command_check.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "tools/command/engine_handles.h"
#include "tools/command/rounded_text.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

namespace {

using Json = nlohmann::ordered_json;

Json outward_json(const plc_check& c) {
  if (c.outward < 0) return nullptr;  // not defined: not closed, manifold and oriented
  return c.outward != 0;
}

Json check_json(const std::string& path, const plc_check& c) {
  const plc_measures& m = c.measures;
  return {{"mesh", path},
          {"valid", c.valid != 0},
          {"closed", c.closed != 0},
          {"manifold", c.manifold != 0},
          {"oriented", c.oriented != 0},
          {"outward", outward_json(c)},
          {"vertices", m.vertices},
          {"faces", m.faces},
          {"components", m.components},
          {"euler", m.euler},
          {"genus", m.genus < 0 ? Json(nullptr) : Json(m.genus)},
          {"area", m.area},
          {"volume", m.volume},
          {"self_intersections", c.self_intersections},
          {"first_intersection", c.first_intersection},
          {"border_edges", c.border_edges},
          {"non_manifold_edges", c.non_manifold_edges},
          {"non_manifold_vertices", c.non_manifold_vertices},
          {"inconsistent_edges", c.inconsistent_edges},
          {"wrongly_oriented_components", c.wrongly_oriented_components},
          {"degenerate_faces", c.degenerate_faces},
          {"duplicate_points", c.duplicate_points},
          {"isolated_vertices", c.isolated_vertices},
          {"edge", {{"min", c.edge_min}, {"mean", c.edge_mean}, {"max", c.edge_max}}},
          {"angle", {{"min", c.min_angle}, {"max", c.max_angle}}},
          {"valence", {{"min", c.valence_min}, {"max", c.valence_max}}}};
}

std::string yes_no(int value) {
  return value < 0 ? "not defined" : value != 0 ? "yes" : "no";
}

std::string count(int64_t value) {
  return std::to_string(value);
}

std::string intersections(const plc_check& c) {
  std::string text = count(c.self_intersections);
  if (c.self_intersections > 0) {
    text += ", first: faces " + count(c.first_intersection[0]) + " and " +
            count(c.first_intersection[1]);
  }
  return text;
}

void print_table(const plc_check& c) {
  const plc_measures& m = c.measures;
  const std::vector<std::pair<const char*, std::string>> rows = {
      {"vertices", count(m.vertices)},
      {"faces", count(m.faces)},
      {"components", count(m.components)},
      {"Euler characteristic", count(m.euler)},
      {"genus", m.genus < 0 ? "not defined" : count(m.genus)},
      {"area", rounded(m.area)},
      {"volume", rounded(m.volume)},
      {"closed", yes_no(c.closed)},
      {"manifold", yes_no(c.manifold)},
      {"oriented", yes_no(c.oriented)},
      {"outward", yes_no(c.outward)},
      {"self-intersections", intersections(c)},
      {"border edges", count(c.border_edges)},
      {"non-manifold edges", count(c.non_manifold_edges)},
      {"non-manifold vertices", count(c.non_manifold_vertices)},
      {"inconsistent edges", count(c.inconsistent_edges)},
      {"components turned inside out", count(c.wrongly_oriented_components)},
      {"degenerate faces", count(c.degenerate_faces)},
      {"duplicate points", count(c.duplicate_points)},
      {"isolated vertices", count(c.isolated_vertices)},
      {"edge lengths", rounded_range(c.edge_min, c.edge_max) + ", mean " + rounded(c.edge_mean)},
      {"angles (degrees)", rounded_range(c.min_angle, c.max_angle)},
      {"valences", rounded_range(c.valence_min, c.valence_max)},
      {"valid", yes_no(c.valid)}};
  for (const auto& [name, value] : rows) std::printf("%-29s %s\n", name, value.c_str());
}

}  // namespace

plc_check check_of(plc_context* context, const TriangleMesh& mesh) {
  plc_check check{};
  check.struct_size = sizeof check;
  const plc_status status =
      plc_check_mesh(context, mesh.xyz.data(), static_cast<int64_t>(mesh.xyz.size() / 3),
                     mesh.abc.data(), static_cast<int64_t>(mesh.abc.size() / 3), &check);
  if (status != PLC_OK) throw failure_of(context);
  return check;
}

void add_check_options(CLI::App& command, CheckOptions& options) {
  command.add_option("MESH", options.mesh, mesh_suffixes(MeshUse::kRead))
      ->required()
      ->type_name("");
  command.add_flag("--json", options.json, "JSON instead of a table");
}

int run_check(const CheckOptions& options) {
  plc_context_options context_options;
  plc_context_options_defaults(&context_options);
  const ContextHandle context = make_context(context_options);
  const plc_check check = check_of(context.get(), read_mesh(options.mesh));
  if (options.json) {
    std::puts(check_json(options.mesh, check).dump(2).c_str());
  } else {
    print_table(check);
  }
  return check.valid != 0 ? 0 : 1;
}

}  // namespace plc::tools

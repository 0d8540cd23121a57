#include "tools/command/measure_report.h"

#include <cinttypes>
#include <cmath>
#include <cstddef>
#include <cstdio>

#include "tools/command/rounded_text.h"

namespace plc::tools {

namespace {

using Json = nlohmann::ordered_json;

// ---- JSON -----------------------------------------------------------------------------------

Json vector_json(const double* x) {
  return {x[0], x[1], x[2]};  // the library writes what is not finite as null
}

Json component_json(const plc_component_measures& c) {
  Json axes = Json::array();
  for (size_t i = 0; i < 3; ++i) axes.push_back(vector_json(c.principal_axes + 3 * i));
  const double* m = c.moments;
  return {{"vertices", c.vertices},
          {"faces", c.faces},
          {"euler", c.euler},
          {"genus", c.genus < 0 ? Json(nullptr) : Json(c.genus)},
          {"area", c.area},
          {"volume", c.volume},
          {"low", vector_json(c.low)},
          {"high", vector_json(c.high)},
          {"centroid", vector_json(c.centroid)},
          {"second_moments",
           {{"xx", m[0]}, {"yy", m[1]}, {"zz", m[2]}, {"xy", m[3]}, {"yz", m[4]}, {"zx", m[5]}}},
          {"principal_moments", vector_json(c.principal_moments)},
          {"principal_axes", axes}};
}

Json distances_json(const plc_distances& d) {
  return {{"mean", d.mean},
          {"rms", d.rms},
          {"max", d.max},
          {"vertex_mean", d.vertex_mean},
          {"vertex_max", d.vertex_max}};
}

// ---- table ----------------------------------------------------------------------------------

void row(const char* name, const std::string& value, const char* unit = "") {
  const bool defined = value != "not defined";
  std::printf("%-24s %s%s%s\n", name, value.c_str(), defined && *unit != '\0' ? " " : "",
              defined ? unit : "");
}

void print_shape(const plc_component_measures& c) {
  row("vertices", std::to_string(c.vertices));
  row("faces", std::to_string(c.faces));
  row("Euler characteristic", std::to_string(c.euler));
  row("genus", c.genus < 0 ? "not defined" : std::to_string(c.genus));
  row("area", rounded(c.area), "mm2");
  row("volume", rounded(c.volume), "mm3");
  row("bounding box", rounded_triple(c.low) + " .. " + rounded_triple(c.high), "mm");
  row("centroid", rounded_triple(c.centroid), "mm");
  row("second moments xx yy zz", rounded_triple(c.moments), "mm5");
  row("second moments xy yz zx", rounded_triple(c.moments + 3), "mm5");
  for (size_t i = 0; i < 3; ++i) {
    if (std::isnan(c.principal_moments[i])) continue;
    std::printf("principal axis %zu         %s mm5 along %s\n", i + 1,
                rounded(c.principal_moments[i]).c_str(),
                rounded_triple(c.principal_axes + 3 * i).c_str());
  }
}

void print_components(const Measured& m) {
  if (m.component_count < 2 || m.components.empty()) return;
  std::printf("\n%9s %10s %10s %6s %12s %12s  %s\n", "component", "vertices", "faces", "genus",
              "area", "volume", "centroid");
  int64_t number = 0;
  for (const plc_component_measures& c : m.components) {
    std::printf("%9" PRId64 " %10" PRId64 " %10" PRId64 " %6s %12s %12s  %s\n", ++number,
                c.vertices, c.faces, c.genus < 0 ? "-" : std::to_string(c.genus).c_str(),
                rounded(c.area).c_str(), std::isnan(c.volume) ? "-" : rounded(c.volume).c_str(),
                rounded_triple(c.centroid).c_str());
  }
  const int64_t more = m.component_count - number;
  if (more > 0) std::printf("%9s %" PRId64 " more\n", "and", more);
}

void print_distances(const char* title, const plc_distances& d) {
  row(title, "mean " + rounded(d.mean) + ", RMS " + rounded(d.rms) + ", max " + rounded(d.max),
      "mm");
}

}  // namespace

Json measured_json(const Measured& m) {
  Json json = {{"mesh", m.mesh},
               {"unit", "mm"},
               {"whole", component_json(m.whole)},
               {"component_count", m.component_count},
               {"components", Json::array()}};
  for (const plc_component_measures& c : m.components) {
    Json component = component_json(c);
    component["first_face"] = c.first_face;
    json["components"].push_back(component);
  }
  if (m.curvature) {
    const CurvatureSummary& c = *m.curvature;
    json["curvature"] = {
        {"mean", {{"min", c.mean_low}, {"max", c.mean_high}, {"average", c.mean_average}}},
        {"gaussian",
         {{"min", c.gaussian_low}, {"max", c.gaussian_high}, {"integral", c.gaussian_integral}}}};
  }
  if (m.geodesic) {
    const GeodesicSummary& g = *m.geodesic;
    json["geodesic"] = {{"vertex", g.vertex},
                        {"position", g.position},
                        {"reached", g.reached},
                        {"farthest", g.farthest},
                        {"max", g.max}};
  }
  if (m.distance) {
    json["distance"] = {{"other", m.distance->other},
                        {"to_other", distances_json(m.distance->to)},
                        {"from_other", distances_json(m.distance->from)},
                        {"hausdorff", std::fmax(m.distance->to.max, m.distance->from.max)}};
  }
  return json;
}

void print_measured(const Measured& m) {
  row("components", std::to_string(m.component_count));
  print_shape(m.whole);
  if (m.curvature) {
    const CurvatureSummary& c = *m.curvature;
    row("mean curvature", rounded_range(c.mean_low, c.mean_high), "1/mm");
    row("  average", rounded(c.mean_average), "1/mm");
    row("Gaussian curvature", rounded_range(c.gaussian_low, c.gaussian_high), "1/mm2");
    row("  integral", rounded(c.gaussian_integral));
  }
  if (m.geodesic) {
    const GeodesicSummary& g = *m.geodesic;
    row("geodesic from", "vertex " + std::to_string(g.vertex) + " at " + rounded_triple(g.position),
        "mm");
    row("geodesic distance", "at most " + rounded(g.max) + " mm (vertex " +
                                 std::to_string(g.farthest) + "), " + std::to_string(g.reached) +
                                 " vertices reached");
  }
  if (m.distance) {
    row("distance to", m.distance->other);
    print_distances("  to it", m.distance->to);
    print_distances("  from it", m.distance->from);
    row("  Hausdorff", rounded(std::fmax(m.distance->to.max, m.distance->from.max)), "mm");
  }
  print_components(m);
}

}  // namespace plc::tools

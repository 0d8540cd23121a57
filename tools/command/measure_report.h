// What `pellicle measure` found, as a table and as JSON. Lengths are in mm.
#pragma once
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/pellicle.h"

namespace plc::tools {

// Of the vertices that have a curvature.
struct CurvatureSummary {
  double mean_low, mean_high;  // mean curvature, 1/mm
  double mean_average;         // over the area
  double gaussian_low, gaussian_high;
  double gaussian_integral;  // 2 pi times Euler's number for a closed mesh
};

struct GeodesicSummary {
  int64_t vertex;                  // the source
  std::array<double, 3> position;  // of it
  int64_t reached;                 // vertices, the source among them
  int64_t farthest;                // vertex
  double max;
};

struct DistanceSummary {
  std::string other;
  plc_distances to, from;  // to the other mesh, from it
};

struct Measured {
  std::string mesh;
  plc_component_measures whole;
  int64_t component_count;
  std::vector<plc_component_measures> components;  // the largest ones
  std::optional<CurvatureSummary> curvature;
  std::optional<GeodesicSummary> geodesic;
  std::optional<DistanceSummary> distance;
};

void print_measured(const Measured& measured);
nlohmann::ordered_json measured_json(const Measured& measured);  // null for what is not defined

}  // namespace plc::tools

// `pellicle measure`: areas, volumes, moments, curvatures, geodesics and distances of a mesh.
#pragma once
#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace plc::tools {

struct MeasureOptions {
  std::string mesh, output, json, other;
  int components = 10;
  bool curvature = false;
  std::optional<std::array<double, 3>> geodesic_point;
  std::optional<int> geodesic_vertex;
};

void add_measure_options(CLI::App& command, MeasureOptions& options);

// Returns the exit code: 0. Throws Failure.
int run_measure(const MeasureOptions& options);

}  // namespace plc::tools

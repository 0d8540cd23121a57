// A label of a label image and its surface.
#pragma once
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/pellicle.h"
#include "tools/mesh/mesh_io.h"
#include "tools/volume/label_names.h"
#include "tools/volume/labels.h"

namespace plc::tools {

// A label's surface begins where its indicator is 0.5 and one of these, so that those of two
// neighbours are twice this apart, in voxels. Overlaps are tried again with the next one. From 0.5
// on single voxels vanish.
inline constexpr std::array<double, 3> kLabelMargins = {0.25, 0.35, 0.45};
// The curvature as the user has it, and weaker: it rounds surfaces off and closes small cavities.
inline constexpr std::array<double, 4> kLabelCurvatures = {1, 0.5, 0.25, 0};
// Surfaces grow to 0.5, where those of neighbours would coincide, held apart by this, in delta.
inline constexpr double kLabelGap = 0.02;

// No faces: too small to hold a surface.
struct LabelPiece {
  Label label;
  LabelEntry entry{};    // "" and none where no table has it
  size_t margin = 0;     // of kLabelMargins
  size_t curvature = 0;  // of kLabelCurvatures
  bool grown = false;    // to 0.5
  TriangleMesh mesh{};
  plc_measures measures{};
  nlohmann::ordered_json report{};

  std::string number() const { return std::to_string(label.value); }
  // "label 7 (Left-Putamen)"
  std::string text() const {
    return "label " + number() + (entry.name.empty() ? "" : " (" + entry.name + ")");
  }
};

}  // namespace plc::tools

// A value of --iso: a number, or one that the image tells.
#pragma once
#include <string>
#include <vector>

#include "tools/volume/voxels.h"

namespace plc::tools {

struct IsoChoice {
  enum class Kind { kNumber, kOtsu, kPercentile };

  std::string text;  // as given: "226", "otsu", "p95"
  Kind kind = Kind::kNumber;
  double number = 0;  // the value, or the per cent

  bool is_number() const { return kind == Kind::kNumber; }
};

// Separated by commas, at least one. Throws CLI::ValidationError.
std::vector<IsoChoice> to_iso_choices(const std::string& option, const std::string& text);

// The value. Throws Failure where the image tells none.
double resolved(const IsoChoice& choice, const Voxels& voxels);

}  // namespace plc::tools

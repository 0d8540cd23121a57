// Apart from the reading of options: this needs images.
#include <cmath>

#include "tools/command/iso_choice.h"
#include "tools/file/failure.h"
#include "tools/volume/volume_statistics.h"

namespace plc::tools {

double resolved(const IsoChoice& choice, const Voxels& voxels) {
  if (choice.is_number()) return choice.number;
  const double value = choice.kind == IsoChoice::Kind::kOtsu
                           ? otsu_of(voxels)
                           : percentiles_of(voxels, {choice.number})[0];
  if (std::isnan(value)) {
    throw Failure{"--iso " + choice.text + ": the image tells none: all its voxels are the same"};
  }
  return value;
}

}  // namespace plc::tools

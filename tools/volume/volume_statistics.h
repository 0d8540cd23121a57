// What the values of a volume are like: their range, percentiles, and Otsu's threshold. Voxels that
// are NaN or infinite are left out.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/pellicle.h"
#include "tools/volume/voxels.h"

namespace plc::tools {

// "u8", "i16" ... as the phantoms' --type has them.
const char* voxel_type_name(plc_voxel_type type);

struct VolumeRange {
  double low, high;  // NaN where no voxel is finite
  int64_t finite;    // voxels
  int64_t not_finite;
};

VolumeRange range_of(const Voxels& voxels);

// For each of `percents`, 0 .. 100, the smallest value that no fewer than so many per cent of the
// voxels do not exceed: a value of the image, exactly. NaN where no voxel is finite.
std::vector<double> percentiles_of(const Voxels& voxels, const std::vector<double>& percents);

// The value between two classes of voxels that are as far apart as can be: N. Otsu, "A Threshold
// Selection Method from Gray-Level Histograms", 1979. The histogram has a bin for each value of
// integers within a range of 65,536, else 65,536 bins over the range. The threshold lies between
// two bins, in the middle of those that are equally good: 127.5 for voxels of 0 and 255. NaN where
// all voxels have one value.
double otsu_of(const Voxels& voxels);

}  // namespace plc::tools

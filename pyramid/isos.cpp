// Iso values of the coarse levels that keep the object of I_0 in sight.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "kernels/blend_rows.h"
#include "kernels/image_rows.h"
#include "kernels/image_value.h"
#include "pyramid/pyramid.h"

namespace plc {

namespace {

// Quantiles are linear inside a bin.
constexpr size_t kBins = size_t{1} << 12;
constexpr double kMargin = 0.5 / static_cast<double>(kBins);  // results stay in (0,1)

double within(double iso) {
  return std::clamp(iso, kMargin, 1.0 - kMargin);
}

// Where the voxels of I_0 lie in a level, axis by axis: (10) for both.
struct SeenCells {
  const PyramidLevel& level;
  std::array<std::vector<AxisCell>, 3> axis;

  SeenCells(const PyramidLevel& base, const PyramidLevel& seen) : level(seen) {
    for (size_t a = 0; a < 3; ++a) {
      const double scale = base.voxel[a] / level.voxel[a];
      for (int64_t i = 0; i < base.dims[a]; ++i) {
        axis[a].push_back(axis_cell(static_cast<float>(i), static_cast<float>(scale),
                                    static_cast<float>(0.5 * scale - 0.5),
                                    static_cast<int32_t>(level.dims[a])));
      }
    }
  }
};

// What a level shows at the voxels of I_0, row by row of some slices: the bits of trilinear
// sampling, of which the first third, along x, is shared by the rows between the same rows of the
// level.
class SeenRows {
 public:
  explicit SeenRows(const SeenCells& cells)
      : cells_(cells),
        image_(level_image(cells.level)),
        row_(static_cast<size_t>(cells.level.dims[0])),
        width_(cells.axis[0].size()),
        rows_(static_cast<size_t>(cells.level.dims[1])),
        of_plane_(2 * rows_, -1) {
    along_x_.resize_uninitialized(2 * rows_ * width_);
  }

  // values[x], x = begin .. end-1, at row (y, z) of I_0.
  void read(SimdTarget simd, size_t y, size_t z, size_t begin, size_t end, float* values) {
    const AxisCell at_y = cells_.axis[1][y];
    const AxisCell at_z = cells_.axis[2][z];
    kernels::blend_rows(
        simd,
        {along_x(at_y.index, at_z.index), along_x(at_y.index + 1, at_z.index),
         along_x(at_y.index, at_z.index + 1), along_x(at_y.index + 1, at_z.index + 1)},
        at_y.fraction, at_z.fraction, begin, end, values);
  }

 private:
  // Row (y, z) of the level at every voxel along x.
  const float* along_x(int32_t y, int32_t z) {
    const size_t place = static_cast<size_t>(z & 1) * rows_ + static_cast<size_t>(y);
    float* to = along_x_.data() + place * width_;
    if (of_plane_[place] == z) return to;
    of_plane_[place] = z;
    image_row(image_, y, z, row_.data());
    const float* row = row_.data();
    const AxisCell* cells = cells_.axis[0].data();
    for (size_t x = 0, width = width_; x < width; ++x) {
      const AxisCell at = cells[x];
      const float* cell = row + at.index;
      to[x] = cell[0] + (cell[1] - cell[0]) * at.fraction;
    }
    return to;
  }

  const SeenCells& cells_;
  ImageView image_;
  std::vector<float> row_;  // of the level
  size_t width_, rows_;
  std::vector<int32_t> of_plane_;  // which plane of the level is there
  Buffer<float> along_x_;          // of two successive planes
};

// x of the voxels of a row that belong to the object; how many there are. `inside` is a whole
// number of words, and `places` has room for one more than it.
size_t list_object(const std::vector<float>& row, float iso, bool above,
                   std::vector<uint8_t>& inside, std::vector<uint32_t>& places) {
  constexpr size_t kWord = sizeof(uint64_t);
  const size_t width = row.size();
  // Bytes may alias everything else: through local pointers the compiler makes vector loops.
  const float* value = row.data();
  uint8_t* side = inside.data();
  if (above) {
    for (size_t x = 0; x < width; ++x) side[x] = static_cast<uint8_t>(value[x] >= iso);
  } else {
    for (size_t x = 0; x < width; ++x) side[x] = static_cast<uint8_t>(value[x] <= iso);
  }
  uint32_t* to = places.data();
  for (size_t x = 0; x < inside.size(); x += kWord) {
    uint64_t word = 0;
    std::memcpy(&word, inside.data() + x, kWord);
    if (word == 0) continue;
    for (size_t k = 0; k < kWord; ++k) {
      *to = static_cast<uint32_t>(x + k);
      to += inside[x + k];
    }
  }
  return static_cast<size_t>(to - places.data());
}

// By value, what each level above I_0 shows at the centres of the object's voxels on I_0.
class ObjectHistograms {
 public:
  ObjectHistograms(const Pyramid& pyramid, float iso_0, bool above, const Executor& executor)
      : base_(level_image(pyramid.levels[0])), iso_(iso_0), above_(above), simd_(executor.simd()) {
    for (size_t h = 1; h < pyramid.levels.size(); ++h) {
      cells_.emplace_back(pyramid.levels[0], pyramid.levels[h]);
    }
    const auto slices = static_cast<size_t>(base_.dims[2]);
    parts_.resize((slices + kSlices - 1) / kSlices);
    executor.run(parts_.size(), [&](size_t part) {
      count(part * kSlices, std::min(slices, (part + 1) * kSlices), parts_[part]);
    });
    merge();
  }

  // The value below which `part` of the voxels lie on level h >= 1, linear inside a bin; NAN
  // without voxels.
  double quantile(size_t h, double part) const {
    const double below = part * static_cast<double>(total_);
    double before = 0;
    for (size_t b = 0; b < kBins && total_ != 0; ++b) {
      const auto in_bin = static_cast<double>(bins_[(h - 1) * kBins + b]);
      if (in_bin > 0 && before + in_bin >= below) {
        return (static_cast<double>(b) + std::max(0.0, below - before) / in_bin) /
               static_cast<double>(kBins);
      }
      before += in_bin;
    }
    return NAN;
  }

 private:
  void count(size_t z_begin, size_t z_end, std::vector<uint32_t>& bins) const {
    const auto width = static_cast<size_t>(base_.dims[0]);
    std::vector<float> row(width), seen(width);
    std::vector<uint8_t> inside((width + 7) / 8 * 8, 0);
    std::vector<uint32_t> places(inside.size() + 1);
    std::vector<SeenRows> levels;
    for (size_t z = z_begin; z < z_end; ++z) {
      for (size_t y = 0; y < static_cast<size_t>(base_.dims[1]); ++y) {
        const auto at = static_cast<int64_t>(y);
        kernels::image_rows(simd_, base_, static_cast<int64_t>(z), at, at + 1, row.data());
        const size_t found = list_object(row, iso_, above_, inside, places);
        if (found == 0) continue;
        if (levels.empty()) {
          for (const SeenCells& cells : cells_) levels.emplace_back(cells);
          bins.assign(cells_.size() * kBins, 0);
        }
        for (size_t l = 0; l < levels.size(); ++l) {
          levels[l].read(simd_, y, z, places[0], places[found - 1] + 1, seen.data());
          uint32_t* to = bins.data() + l * kBins;
          const float* value = seen.data();
          const uint32_t* place = places.data();
          for (size_t i = 0; i < found; ++i) {
            const auto bin = static_cast<int32_t>(value[place[i]] * static_cast<float>(kBins));
            ++to[std::min(bin, static_cast<int32_t>(kBins) - 1)];
          }
        }
      }
    }
  }

  void merge() {
    bins_.assign(cells_.size() * kBins, 0);
    for (const auto& part : parts_) {
      for (size_t b = 0; b < part.size(); ++b) bins_[b] += part[b];
    }
    for (size_t b = 0; b < std::min(kBins, bins_.size()); ++b) total_ += bins_[b];
  }

  // Slices of I_0 per task: each prepares anew the rows of the levels that it looks at.
  static constexpr size_t kSlices = 8;

  ImageView base_;
  float iso_;
  bool above_;
  SimdTarget simd_;
  std::vector<SeenCells> cells_;              // of the levels above I_0
  std::vector<std::vector<uint32_t>> parts_;  // bins per task, level by level; none without object
  std::vector<uint64_t> bins_;
  uint64_t total_ = 0;
};

}  // namespace

std::vector<double> covering_isos(const Pyramid& pyramid, double iso_0, bool inside_above,
                                  double bound, const Executor& executor) {
  std::vector<double> isos(pyramid.levels.size(), within(iso_0));
  if (isos.size() < 2) return isos;
  const ObjectHistograms histograms(pyramid, static_cast<float>(iso_0), inside_above, executor);
  for (size_t h = 1; h < isos.size(); ++h) {
    const double least =
        histograms.quantile(h, inside_above ? kUncoveredPart : 1.0 - kUncoveredPart);
    if (std::isnan(least)) continue;  // no object on I_0
    // Never on the far side of iso_0: there the coarse object would lose what shows anyway.
    isos[h] = within(inside_above ? std::min(std::max(least, bound), iso_0)
                                  : std::max(std::min(least, bound), iso_0));
  }
  return isos;
}

}  // namespace plc

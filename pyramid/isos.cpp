// Iso values of the coarse levels that keep the object of I_0 in sight.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/image_force.h"
#include "pyramid/pyramid.h"

namespace plc {

namespace {

// Quantiles are linear inside a bin; one histogram per slice is kept while they are collected.
constexpr size_t kBins = size_t{1} << 12;
constexpr double kMargin = 0.5 / static_cast<double>(kBins);  // results stay in (0,1)

double within(double iso) {
  return std::clamp(iso, kMargin, 1.0 - kMargin);
}

// A level as seen from the voxels of I_0: (10) for both.
ImageView seen_from_base(const PyramidLevel& base, const PyramidLevel& level) {
  ImageView view;
  view.data = level.values.data();
  for (size_t a = 0; a < 3; ++a) {
    const double scale = base.voxel[a] / level.voxel[a];
    view.dims[a] = static_cast<int32_t>(level.dims[a]);
    view.scale[a] = static_cast<float>(scale);
    view.offset[a] = static_cast<float>(0.5 * scale - 0.5);
  }
  return view;
}

// What the level shows at the centres of the object's voxels on I_0, by value.
class ObjectHistogram {
 public:
  ObjectHistogram(const PyramidLevel& base, const PyramidLevel& level, float iso_0,
                  bool inside_above, const Executor& executor, SimdTarget simd)
      : slices_(static_cast<size_t>(base.dims[2]), std::vector<uint32_t>()) {
    const ImageView view = seen_from_base(base, level);
    executor.run(slices_.size(), [&](size_t z) {
      std::vector<uint32_t>& bins = slices_[z];
      std::vector<Packed> inside;
      size_t i = z * static_cast<size_t>(base.dims[0] * base.dims[1]);
      for (int64_t y = 0; y < base.dims[1]; ++y) {
        for (int64_t x = 0; x < base.dims[0]; ++x, ++i) {
          const float v = base.values[i];
          if (inside_above ? v < iso_0 : v > iso_0) continue;
          inside.push_back(
              {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0});
        }
      }
      if (inside.empty()) return;
      std::vector<float> values(inside.size());
      kernels::sample_trilinear(simd, view, inside.data(), 0, static_cast<uint32_t>(inside.size()),
                                values.data());
      bins.assign(kBins, 0);
      for (const float v : values) {
        ++bins[std::min(static_cast<size_t>(v * static_cast<float>(kBins)), kBins - 1)];
      }
    });
    merge();
  }

  // The value below which `part` of the voxels lie, linear inside a bin; NAN without voxels.
  double quantile(double part) const {
    const double below = part * static_cast<double>(total_);
    double before = 0;
    for (size_t b = 0; b < kBins && total_ != 0; ++b) {
      const auto count = static_cast<double>(bins_[b]);
      if (count > 0 && before + count >= below) {
        return (static_cast<double>(b) + std::max(0.0, below - before) / count) /
               static_cast<double>(kBins);
      }
      before += count;
    }
    return NAN;
  }

 private:
  void merge() {
    bins_.assign(kBins, 0);
    for (const auto& slice : slices_) {
      for (size_t b = 0; b < slice.size(); ++b) bins_[b] += slice[b];
    }
    for (const uint64_t n : bins_) total_ += n;
    slices_.clear();
  }

  std::vector<std::vector<uint32_t>> slices_;
  std::vector<uint64_t> bins_;
  uint64_t total_ = 0;
};

}  // namespace

std::vector<double> covering_isos(const Pyramid& pyramid, double iso_0, bool inside_above,
                                  double bound, const Executor& executor, SimdTarget simd) {
  std::vector<double> isos(pyramid.levels.size(), within(iso_0));
  for (size_t h = 1; h < isos.size(); ++h) {
    const ObjectHistogram histogram(pyramid.levels[0], pyramid.levels[h], static_cast<float>(iso_0),
                                    inside_above, executor, simd);
    const double least = histogram.quantile(inside_above ? kUncoveredPart : 1.0 - kUncoveredPart);
    if (std::isnan(least)) continue;  // no object on I_0
    // Never on the far side of iso_0: there the coarse object would lose what shows anyway.
    isos[h] = within(inside_above ? std::min(std::max(least, bound), iso_0)
                                  : std::max(std::min(least, bound), iso_0));
  }
  return isos;
}

}  // namespace plc

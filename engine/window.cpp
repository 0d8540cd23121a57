#include "engine/window.h"

#include <algorithm>
#include <array>
#include <vector>

namespace plc {

namespace {

// Away from the object: 1 would clip half of the voxels that decide where the surface lies. Far
// more would let a bright neighbourhood beside a dark distance (soft tissue, air) fade the object.
constexpr double kReachOut = 2.0;
// Into the object. At 2 the attraction on a head CT is so strong against the curvature force that
// structures below the voxel size open and close for ever; at 5 it converges.
constexpr double kReachIn = 5.0;
constexpr size_t kBins = size_t{1} << 12;

// Histograms of the voxels on both sides of the surface, over the range of the image.
class BoundaryHistogram {
 public:
  BoundaryHistogram(const VolumeView& volume, const VoxelRange& range, double iso, bool above,
                    const Executor& executor)
      : volume_(volume),
        range_(range),
        iso_(iso),
        above_(above),
        slices_(static_cast<size_t>(volume.dims[2])) {
    executor.run(slices_.size(), [&](size_t z) { scan(z); });
    for (auto& side : bins_) side.assign(kBins, 0);
    for (const Slice& slice : slices_) {
      for (size_t side = 0; side < 2; ++side) {
        for (size_t b = 0; b < slice.bins[side].size(); ++b) bins_[side][b] += slice.bins[side][b];
      }
    }
    slices_.clear();
  }

  // Of the object's boundary voxels (side 1) or of those across it (side 0).
  double median(size_t side) const {
    uint64_t total = 0;
    for (const uint64_t n : bins_[side]) total += n;
    uint64_t before = 0;
    for (size_t b = 0; b < kBins; ++b) {
      before += bins_[side][b];
      if (total != 0 && 2 * before >= total) {
        return range_.low + (static_cast<double>(b) + 0.5) * bin_width();
      }
    }
    return iso_;
  }

 private:
  struct Slice {
    std::array<std::vector<uint32_t>, 2> bins;
  };

  double bin_width() const { return (range_.high - range_.low) / static_cast<double>(kBins); }

  void scan(size_t z) {
    switch (volume_.type) {
      case VoxelType::kU8:
        return scan(static_cast<const uint8_t*>(volume_.voxels), z);
      case VoxelType::kI16:
        return scan(static_cast<const int16_t*>(volume_.voxels), z);
      case VoxelType::kU16:
        return scan(static_cast<const uint16_t*>(volume_.voxels), z);
      case VoxelType::kI32:
        return scan(static_cast<const int32_t*>(volume_.voxels), z);
      case VoxelType::kF32:
        return scan(static_cast<const float*>(volume_.voxels), z);
    }
  }

  template <typename Voxel>
  void scan(const Voxel* voxels, size_t slice) {
    const int64_t nx = volume_.dims[0];
    const int64_t ny = volume_.dims[1];
    const int64_t nz = volume_.dims[2];
    const auto z = static_cast<int64_t>(slice);
    for (auto& side : slices_[slice].bins) side.assign(kBins, 0);
    const auto inside = [&](double v) { return above_ ? v >= iso_ : v <= iso_; };
    const int64_t step[3] = {1, nx, nx * ny};
    for (int64_t y = 0; y < ny; ++y) {
      for (int64_t x = 0; x < nx; ++x) {
        const int64_t i = (z * ny + y) * nx + x;
        const auto value = static_cast<double>(voxels[i]);
        const bool here = inside(value);
        const bool first[3] = {x == 0, y == 0, z == 0};
        const bool last[3] = {x == nx - 1, y == ny - 1, z == nz - 1};
        bool boundary = false;
        for (int a = 0; a < 3 && !boundary; ++a) {
          boundary = (!first[a] && inside(static_cast<double>(voxels[i - step[a]])) != here) ||
                     (!last[a] && inside(static_cast<double>(voxels[i + step[a]])) != here);
        }
        if (boundary) count(slices_[slice].bins[here ? 1 : 0], value);
      }
    }
  }

  void count(std::vector<uint32_t>& bins, double value) const {
    const double b = (value - range_.low) / bin_width();
    ++bins[std::min(static_cast<size_t>(b), kBins - 1)];
  }

  const VolumeView& volume_;
  const VoxelRange& range_;
  double iso_;
  bool above_;
  std::vector<Slice> slices_;
  std::array<std::vector<uint64_t>, 2> bins_;
};

}  // namespace

Window derive_window(const VolumeView& volume, const VoxelRange& range, double iso,
                     bool inside_above, const Executor& executor) {
  const BoundaryHistogram histogram(volume, range, iso, inside_above, executor);
  // Never narrower than a thousandth of the range: a step that is no wider is noise.
  const double least = (range.high - range.low) * 1e-3;
  const double sign = inside_above ? 1 : -1;
  const double out = std::max((iso - histogram.median(0)) * sign, least) * kReachOut;
  const double in = std::max((histogram.median(1) - iso) * sign, least) * kReachIn;
  const double below = inside_above ? out : in;
  const double above = inside_above ? in : out;
  Window window{std::max(range.low, iso - below), std::min(range.high, iso + above),
                histogram.median(0)};
  // The iso-value may be an end of the range: keep it inside.
  if (window.low >= iso) window.low = iso - below;
  if (window.high <= iso) window.high = iso + above;
  return window;
}

}  // namespace plc

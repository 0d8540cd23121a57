#include "pyramid/window.h"
#include "pyramid/memory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace plc {

namespace {

// Away from the object: 1 would clip half of the voxels that decide where the surface lies. Far
// more would let a bright neighbourhood beside a dark distance (soft tissue, air) fade the object.
constexpr double kReachOut = 2.0;
// Into the object. At 2 the attraction on a head CT is so strong against the curvature force that
// structures below the voxel size open and close for ever; at 5 it converges.
constexpr double kReachIn = 5.0;
constexpr size_t kBins = size_t{1} << 12;

// Slices per task: each looks at one more on either side.
constexpr size_t kSlices = 8;
constexpr size_t kMostCounted = std::numeric_limits<uint32_t>::max();  // voxels of a task's slices
constexpr size_t kWord = sizeof(uint64_t);

// Whether voxels belong to the object, by a comparison in their own type.
template <typename Voxel>
class InsideTest {
 public:
  InsideTest(double iso, bool above) : above_(above) {
    // The voxel value of the object that is nearest to iso.
    if constexpr (std::is_integral_v<Voxel>) {
      const double end = above ? std::ceil(iso) : std::floor(iso);
      // Where the type has no value beyond iso, no voxel is inside.
      const double least = std::numeric_limits<Voxel>::min();
      const double most = std::numeric_limits<Voxel>::max();
      none_ = above ? end > most : end < least;
      end_ = static_cast<Voxel>(std::clamp(end, least, most));
    } else {
      end_ = static_cast<Voxel>(iso);
      const double end = static_cast<double>(end_);
      const Voxel beyond = above ? HUGE_VALF : -HUGE_VALF;
      if (above ? end < iso : end > iso) end_ = std::nextafter(end_, beyond);
    }
  }

  // inside[i] = 1 where voxel i belongs to the object, else 0.
  void test(const Voxel* voxels, size_t count, uint8_t* inside) const {
    const Voxel end =
        end_;  // a local: bytes may alias members, and the loop would not become a vector one
    if (none_) {
      std::fill_n(inside, count, uint8_t{0});
    } else if (above_) {
      for (size_t i = 0; i < count; ++i) inside[i] = static_cast<uint8_t>(voxels[i] >= end);
    } else {
      for (size_t i = 0; i < count; ++i) inside[i] = static_cast<uint8_t>(voxels[i] <= end);
    }
  }

 private:
  bool above_;
  bool none_ = false;
  Voxel end_{};
};

// Histograms of the voxels on both sides of the surface, over the range of the image.
class BoundaryHistogram {
 public:
  BoundaryHistogram(const VolumeView& volume, const VoxelRange& range, double iso, bool above,
                    const Executor& executor)
      : volume_(volume),
        range_(range),
        iso_(iso),
        above_(above),
        width_(static_cast<size_t>(volume.dims[0])),
        rows_(static_cast<size_t>(volume.dims[1])),
        slices_(static_cast<size_t>(volume.dims[2])),
        slices_per_part_(std::min(kSlices, kMostCounted / (width_ * rows_))),
        parts_((slices_ + slices_per_part_ - 1) / slices_per_part_) {
    executor.run(parts_.size(), [&](size_t part) { scan(part); });
    for (auto& side : bins_) side.assign(kBins, 0);
    for (const Part& part : parts_) {
      for (size_t side = 0; side < 2; ++side) {
        for (size_t b = 0; b < part.bins[side].size(); ++b) bins_[side][b] += part.bins[side][b];
      }
    }
    parts_.clear();
  }

  // Of the object's boundary voxels (side 1) or of those across it (side 0).
  uint64_t count(size_t side) const {
    uint64_t total = 0;
    for (const uint64_t n : bins_[side]) total += n;
    return total;
  }
  double median(size_t side) const {
    const uint64_t total = count(side);
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
  struct Part {
    std::array<Vector<uint32_t>, 2> bins;
  };
  // A slice of the volume, and on which side its voxels are, a byte each.
  template <typename Voxel>
  struct Slice {
    const Voxel* voxels = nullptr;
    Vector<Voxel> own;  // of a volume of bricks
    Vector<uint8_t> inside;
  };

  double bin_width() const { return (range_.high - range_.low) / static_cast<double>(kBins); }

  void scan(size_t part) {
    switch (volume_.type) {
      case VoxelType::kU8:
        return scan<uint8_t>(part);
      case VoxelType::kI16:
        return scan<int16_t>(part);
      case VoxelType::kU16:
        return scan<uint16_t>(part);
      case VoxelType::kI32:
        return scan<int32_t>(part);
      case VoxelType::kF32:
        return scan<float>(part);
    }
  }

  template <typename Voxel>
  void scan(size_t index) {
    const size_t begin = index * slices_per_part_;
    const size_t end = std::min(slices_, begin + slices_per_part_);
    const size_t size = width_ * rows_;
    for (auto& side : parts_[index].bins) side.assign(kBins, 0);
    const InsideTest<Voxel> inside(iso_, above_);
    Slice<Voxel> below, here, above;
    Vector<uint8_t> differ((width_ + kWord - 1) / kWord * kWord, 0);
    // At the ends of the volume a slice is its own neighbour.
    const auto read = [&](size_t z, Slice<Voxel>& slice) {
      const size_t first = std::min(z, slices_ - 1) * size;
      if (volume_.bricks != nullptr) {
        slice.own.resize(size);
        read_voxels(volume_, first, size, slice.own.data());
        slice.voxels = slice.own.data();
      } else {
        slice.voxels = static_cast<const Voxel*>(volume_.voxels) + first;
      }
      slice.inside.resize(size);
      inside.test(slice.voxels, size, slice.inside.data());
    };
    read(begin == 0 ? 0 : begin - 1, below);
    read(begin, here);
    for (size_t z = begin; z < end; ++z) {
      read(z + 1, above);
      for (size_t y = 0; y < rows_; ++y) {
        const size_t row = y * width_;
        const size_t before = y == 0 ? row : row - width_;
        const size_t behind = y + 1 == rows_ ? row : row + width_;
        const uint8_t* sides = here.inside.data();
        compare(
            sides + row,
            {sides + before, sides + behind, below.inside.data() + row, above.inside.data() + row},
            differ.data());
        count(here.voxels + row, sides + row, differ, parts_[index]);
      }
      std::swap(below, here);
      std::swap(here, above);
    }
  }

  // differ[x] is not 0 where a voxel of the row has a neighbour on the other side.
  void compare(const uint8_t* row, const std::array<const uint8_t*, 4>& beside,
               uint8_t* differ) const {
    const size_t width = width_;
    const auto [a, b, c, d] = beside;
    for (size_t x = 0; x < width; ++x) {
      differ[x] = static_cast<uint8_t>((row[x] ^ a[x]) | (row[x] ^ b[x]) | (row[x] ^ c[x]) |
                                       (row[x] ^ d[x]));
    }
    for (size_t x = 1; x < width; ++x) differ[x] |= row[x] ^ row[x - 1];
    for (size_t x = 1; x < width; ++x) differ[x - 1] |= row[x] ^ row[x - 1];
  }

  template <typename Voxel>
  void count(const Voxel* row, const uint8_t* inside, const Vector<uint8_t>& differ,
             Part& part) const {
    for (size_t first = 0; first < differ.size(); first += kWord) {
      uint64_t word = 0;
      std::memcpy(&word, differ.data() + first, kWord);
      if (word == 0) continue;
      for (size_t x = first; x < first + kWord; ++x) {
        if (differ[x] == 0) continue;
        const double b = (static_cast<double>(row[x]) - range_.low) / bin_width();
        ++part.bins[inside[x]][std::min(static_cast<size_t>(b), kBins - 1)];
      }
    }
  }

  const VolumeView& volume_;
  const VoxelRange& range_;
  double iso_;
  bool above_;
  size_t width_, rows_, slices_;
  size_t slices_per_part_;  // at least one: a plane has fewer than 2^31 voxels
  Vector<Part> parts_;
  std::array<Vector<uint64_t>, 2> bins_;
};

}  // namespace

DerivedWindow derive_window(const VolumeView& volume, const VoxelRange& range, double iso,
                            bool inside_above, const Executor& executor) {
  const BoundaryHistogram histogram(volume, range, iso, inside_above, executor);
  // Never narrower than a thousandth of the range: a step that is no wider is noise.
  const double least = (range.high - range.low) * 1e-3;
  const double sign = inside_above ? 1 : -1;
  const double out = std::max((iso - histogram.median(0)) * sign, least) * kReachOut;
  const double in = std::max((histogram.median(1) - iso) * sign, least) * kReachIn;
  const double below = inside_above ? out : in;
  const double above = inside_above ? in : out;
  DerivedWindow window{{std::max(range.low, iso - below), std::min(range.high, iso + above)},
                       histogram.median(0),
                       histogram.count(1)};
  // The iso-value may be an end of the range: keep it inside.
  if (window.low >= iso) window.low = iso - below;
  if (window.high <= iso) window.high = iso + above;
  return window;
}

}  // namespace plc

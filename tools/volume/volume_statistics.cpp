#include "tools/volume/volume_statistics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "tools/volume/voxels.h"

namespace plc::tools {

namespace {

constexpr size_t kBins = 65536;
constexpr uint32_t kSign = 0x80000000U;

template <typename T>
bool is_finite(T value) {
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
  return true;
}

// Keys are in the order of the values, and the values come back from them: floats by the trick of
// radix sorts, where the bits of negative ones are turned over.
template <typename T>
uint32_t key_of(T value) {
  if constexpr (std::is_floating_point_v<T>) {
    const auto bits = std::bit_cast<uint32_t>(value);
    return (bits & kSign) != 0 ? ~bits : bits | kSign;
  } else if constexpr (sizeof(T) == 4) {
    return static_cast<uint32_t>(value) ^ kSign;
  } else {
    return static_cast<uint32_t>(value - int32_t{std::numeric_limits<T>::min()});
  }
}

template <typename T>
double value_of(uint32_t key) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<double>(std::bit_cast<T>((key & kSign) != 0 ? key ^ kSign : ~key));
  } else if constexpr (sizeof(T) == 4) {
    return static_cast<double>(static_cast<T>(key ^ kSign));
  } else {
    return static_cast<double>(key) + std::numeric_limits<T>::min();
  }
}

// The halves of a key: one pass over the voxels counts those of the upper half, another one, for
// each upper half that is asked for, the lower ones.
constexpr int kHalf = 16;

template <typename T>
std::vector<double> order_statistics(const Voxels& voxels, const std::vector<int64_t>& ranks) {
  constexpr bool kOneHalf = sizeof(T) < 4;
  std::vector<int64_t> upper(kBins, 0);
  voxels.visit([&](const auto* first, const auto* last) {
    for (const auto* v = first; v != last; ++v) {
      if (is_finite(*v)) ++upper[kOneHalf ? key_of(*v) : key_of(*v) >> kHalf];
    }
  });
  std::vector<double> values;
  std::vector<int64_t> lower;
  size_t counted = kBins;  // the upper half that `lower` is of
  for (const int64_t rank : ranks) {
    int64_t left = rank;
    size_t bin = 0;
    while (left >= upper[bin]) left -= upper[bin++];
    auto key = static_cast<uint32_t>(bin);
    if constexpr (!kOneHalf) {
      if (bin != counted) {
        lower.assign(kBins, 0);
        voxels.visit([&](const auto* first, const auto* last) {
          for (const auto* v = first; v != last; ++v) {
            const uint32_t k = key_of(*v);
            if (is_finite(*v) && k >> kHalf == bin) ++lower[k & (kBins - 1)];
          }
        });
        counted = bin;
      }
      size_t low = 0;
      while (left >= lower[low]) left -= lower[low++];
      key = static_cast<uint32_t>(bin << kHalf | low);
    }
    values.push_back(value_of<T>(key));
  }
  return values;
}

struct Histogram {
  std::vector<int64_t> counts;
  double first;  // the value between bins b and b + 1 is first + b * width
  double width;
};

Histogram histogram_of(const Voxels& voxels, const VolumeRange& range) {
  const bool whole = voxels.type() != PLC_F32 && range.high - range.low < kBins;
  const size_t bins = whole ? static_cast<size_t>(range.high - range.low) + 1 : kBins;
  const double width = whole ? 1 : (range.high - range.low) / kBins;
  Histogram histogram{std::vector<int64_t>(bins, 0), range.low + (whole ? 0.5 : width), width};
  voxels.visit([&](const auto* first, const auto* last) {
    for (const auto* v = first; v != last; ++v) {
      if (!is_finite(*v)) continue;
      const double place = (static_cast<double>(*v) - range.low) / width;
      ++histogram.counts[std::min(static_cast<size_t>(place), bins - 1)];
    }
  });
  return histogram;
}

}  // namespace

const char* voxel_type_name(plc_voxel_type type) {
  switch (type) {
    case PLC_U8:
      return "u8";
    case PLC_I16:
      return "i16";
    case PLC_U16:
      return "u16";
    case PLC_I32:
      return "i32";
    case PLC_F32:
      return "f32";
  }
  return "?";
}

VolumeRange range_of(const Voxels& voxels) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  VolumeRange range{kNan, kNan, 0, 0};
  voxels.visit([&range](const auto* first, const auto* last) {
    for (const auto* v = first; v != last; ++v) {
      if (!is_finite(*v)) {
        ++range.not_finite;
        continue;
      }
      const auto value = static_cast<double>(*v);
      range.low = std::fmin(range.low, value);
      range.high = std::fmax(range.high, value);
      ++range.finite;
    }
  });
  return range;
}

std::vector<double> percentiles_of(const Voxels& voxels, const std::vector<double>& percents) {
  const int64_t count = range_of(voxels).finite;
  if (count == 0) {
    return std::vector<double>(percents.size(), std::numeric_limits<double>::quiet_NaN());
  }
  std::vector<int64_t> ranks;
  for (const double percent : percents) {
    const auto rank =
        static_cast<int64_t>(std::ceil(percent / 100 * static_cast<double>(count))) - 1;
    ranks.push_back(std::clamp<int64_t>(rank, 0, count - 1));
  }
  switch (voxels.type()) {
    case PLC_U8:
      return order_statistics<uint8_t>(voxels, ranks);
    case PLC_I16:
      return order_statistics<int16_t>(voxels, ranks);
    case PLC_U16:
      return order_statistics<uint16_t>(voxels, ranks);
    case PLC_I32:
      return order_statistics<int32_t>(voxels, ranks);
    case PLC_F32:
      break;
  }
  return order_statistics<float>(voxels, ranks);
}

double otsu_of(const Voxels& voxels) {
  const VolumeRange range = range_of(voxels);
  if (!(range.low < range.high)) return std::numeric_limits<double>::quiet_NaN();
  const Histogram histogram = histogram_of(voxels, range);
  double total = 0;
  for (size_t b = 0; b < histogram.counts.size(); ++b) {
    total += static_cast<double>(b) * static_cast<double>(histogram.counts[b]);
  }
  const auto all = static_cast<double>(range.finite);
  double below = 0;  // voxels, and the sum of their bins
  double sum = 0;
  double best = -1;
  size_t begin = 0;
  size_t end = 0;
  for (size_t b = 0; b + 1 < histogram.counts.size(); ++b) {
    const auto count = static_cast<double>(histogram.counts[b]);
    below += count;
    sum += static_cast<double>(b) * count;
    if (below == 0 || below == all) continue;
    const double apart = sum / below - (total - sum) / (all - below);
    const double between = below * (all - below) * apart * apart;
    if (between > best) begin = b;
    if (between >= best) end = b;  // of bins of no voxels all are equally good
    best = std::max(best, between);
  }
  return histogram.first + histogram.width * static_cast<double>(begin + end) / 2;
}

}  // namespace plc::tools

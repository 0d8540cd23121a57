// Iso values that keep the object's volume on every level.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "pyramid/pyramid.h"

namespace plc {

namespace {

// Fine enough for 16-bit images over their whole range.
constexpr size_t kBins = size_t{1} << 16;
constexpr double kMargin = 0.5 / static_cast<double>(kBins);  // results stay in (0,1)

double within(double iso) {
  return std::clamp(iso, kMargin, 1.0 - kMargin);
}

size_t count_inside(const Buffer<float>& values, float iso, bool inside_above) {
  size_t count = 0;
  if (inside_above) {
    for (const float v : values) count += v >= iso ? 1 : 0;
  } else {
    for (const float v : values) count += v <= iso ? 1 : 0;
  }
  return count;
}

std::vector<uint32_t> histogram(const Buffer<float>& values) {
  std::vector<uint32_t> bins(kBins, 0);
  for (const float v : values) {
    const auto bin = static_cast<size_t>(v * static_cast<float>(kBins));
    ++bins[std::min(bin, kBins - 1)];
  }
  return bins;
}

// The value below which `below` voxels lie, linear inside a bin.
double quantile(const std::vector<uint32_t>& bins, double below) {
  double before = 0;
  for (size_t b = 0; b < kBins; ++b) {
    if (bins[b] == 0) continue;
    const double count = bins[b];
    if (before + count >= below) {
      const double part = std::max(0.0, below - before) / count;
      return (static_cast<double>(b) + part) / static_cast<double>(kBins);
    }
    before += count;
  }
  return 1.0;
}

}  // namespace

std::vector<double> volume_preserving_isos(const Pyramid& pyramid, double iso_0,
                                           bool inside_above) {
  std::vector<double> isos(pyramid.levels.size(), within(iso_0));
  if (isos.empty()) return isos;
  isos[0] = iso_0;
  if (isos.size() == 1) return isos;
  const Buffer<float>& base = pyramid.levels[0].values;
  const size_t inside = count_inside(base, static_cast<float>(iso_0), inside_above);
  if (inside == 0 || inside == base.size()) return isos;  // no surface on I_0: nothing to keep
  const size_t below = inside_above ? base.size() - inside : inside;
  for (size_t h = 1; h < isos.size(); ++h) {
    const Buffer<float>& values = pyramid.levels[h].values;
    const std::vector<uint32_t> bins = histogram(values);
    if (*std::max_element(bins.begin(), bins.end()) == values.size()) continue;  // one value only
    // All values that keep the volume to half a voxel, or to half of what is left of it, are as
    // good: of them the nearest to iso_0 is the steadiest choice where the histogram is empty, as
    // between the two values of a mask.
    const auto voxels = static_cast<double>(values.size());
    const double wanted = static_cast<double>(below) * voxels / static_cast<double>(base.size());
    const double slack = 0.5 * std::min({1.0, wanted, voxels - wanted});
    isos[h] =
        within(std::clamp(iso_0, quantile(bins, wanted - slack), quantile(bins, wanted + slack)));
  }
  return isos;
}

}  // namespace plc

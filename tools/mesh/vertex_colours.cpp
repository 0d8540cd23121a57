#include "tools/mesh/vertex_colours.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plc::tools {

namespace {

constexpr Rgb kGrey = {0.32, 0.32, 0.32};

// Viridis of matplotlib (S. van der Walt & N. Smith) at eighths, made linear.
constexpr std::array<Rgb, 9> kViridis = {{{0.0579, 0.0004, 0.0884},
                                          {0.0633, 0.0258, 0.1986},
                                          {0.0432, 0.0846, 0.2591},
                                          {0.0253, 0.1698, 0.2717},
                                          {0.0149, 0.2814, 0.2643},
                                          {0.0215, 0.4255, 0.2159},
                                          {0.1122, 0.5854, 0.1213},
                                          {0.4173, 0.7180, 0.0301},
                                          {0.9841, 0.7993, 0.0183}}};

double linear(double part) {  // of sRGB
  return part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
}

double srgb_of(double part) {
  return part <= 0.0031308 ? part * 12.92 : 1.055 * std::pow(part, 1 / 2.4) - 0.055;
}

std::array<uint8_t, 3> bytes_of(const Rgb& rgb) {
  std::array<uint8_t, 3> bytes{};
  for (size_t k = 0; k < 3; ++k) {
    bytes[k] = static_cast<uint8_t>(std::lround(255 * std::clamp(srgb_of(rgb[k]), 0.0, 1.0)));
  }
  return bytes;
}

Rgb colour_in(const std::vector<LabelInfo>& table, int32_t label) {
  const auto at =
      std::lower_bound(table.begin(), table.end(), label,
                       [](const LabelInfo& l, int32_t value) { return l.value < value; });
  if (at == table.end() || at->value != label) return label_colour(label);
  return colour_of_bytes(at->rgb);
}

}  // namespace

// As the page has them (tools/view/page/colours.js).
Rgb label_colour(int32_t label) {
  if (label <= 0) return kGrey;
  constexpr double kGolden = 137.508;  // degrees: turns of so much never come near each other
  const double hue = std::fmod(label * kGolden, 360);
  Rgb rgb{};
  for (size_t k = 0; k < 3; ++k) {
    const double turn = std::fmod((k == 0 ? 0.0 : k == 1 ? 8.0 : 4.0) + hue / 30, 12);
    rgb[k] = linear(0.62 - 0.32 * std::clamp(std::min(turn - 3, 9 - turn), -1.0, 1.0));
  }
  return rgb;
}

std::array<uint8_t, 3> label_bytes(int32_t label) {
  return bytes_of(label_colour(label));
}

Rgb colour_of_bytes(const std::array<uint8_t, 3>& srgb) {
  Rgb rgb{};
  for (size_t k = 0; k < 3; ++k) rgb[k] = linear(srgb[k] / 255.0);
  return rgb;
}

Rgb value_colour(double place) {
  if (std::isnan(place)) return kGrey;
  const double at = std::clamp(place, 0.0, 1.0) * (kViridis.size() - 1);
  const auto i = std::min(static_cast<size_t>(at), kViridis.size() - 2);
  const double t = at - static_cast<double>(i);
  Rgb rgb{};
  for (size_t k = 0; k < 3; ++k) rgb[k] = (1 - t) * kViridis[i][k] + t * kViridis[i + 1][k];
  return rgb;
}

ColourRange colour_range(const Scalars& scalars) {
  std::vector<float> sorted;
  std::copy_if(scalars.values.begin(), scalars.values.end(), std::back_inserter(sorted),
               [](float x) { return std::isfinite(x); });
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (sorted.empty()) return {kNan, kNan};
  std::sort(sorted.begin(), sorted.end());
  const size_t last = sorted.size() - 1;
  return {sorted[last / 50], sorted[last - last / 50]};
}

std::vector<Rgb> vertex_colours(const TriangleMesh& mesh) {
  const Scalars& scalars = mesh.scalars[0];
  std::vector<Rgb> colours;
  colours.reserve(scalars.values.size());
  const ColourRange range = colour_range(scalars);
  const double width = range.high > range.low ? range.high - range.low : 1;
  const bool labels = scalars.are_labels();
  for (const float value : scalars.values) {
    if (labels) {
      const int32_t label = std::isfinite(value) ? static_cast<int32_t>(value) : 0;
      colours.push_back(colour_in(mesh.labels, label));
    } else {
      colours.push_back(value_colour((static_cast<double>(value) - range.low) / width));
    }
  }
  return colours;
}

std::vector<uint8_t> vertex_bytes(const TriangleMesh& mesh) {
  std::vector<uint8_t> bytes;
  for (const Rgb& rgb : vertex_colours(mesh)) {
    const std::array<uint8_t, 3> three = bytes_of(rgb);
    bytes.insert(bytes.end(), three.begin(), three.end());
  }
  return bytes;
}

}  // namespace plc::tools

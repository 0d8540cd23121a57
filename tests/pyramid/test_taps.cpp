#include "pyramid/taps.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace {

// The value of output `i` of (12) on one axis: five points `spread` apart around the output's
// centre, linear interpolation, replicated borders.
double expected_output(const std::vector<double>& line, int64_t outputs, double spread, int64_t i) {
  const auto inputs = static_cast<int64_t>(line.size());
  const double kernel[5] = {1, 4, 6, 4, 1};
  double sum = 0;
  for (int m = -2; m <= 2; ++m) {
    const double at = (static_cast<double>(i) + 0.5) * static_cast<double>(inputs) /
                          static_cast<double>(outputs) -
                      0.5 + m * spread;
    const double below = std::floor(at);
    const auto voxel = [&](double index) {
      return line[static_cast<size_t>(std::clamp(index, 0.0, static_cast<double>(inputs - 1)))];
    };
    const double value = voxel(below) + (at - below) * (voxel(below + 1) - voxel(below));
    sum += kernel[m + 2] / 16.0 * value;
  }
  return sum;
}

}  // namespace

TEST_CASE("taps are the five points of (12), interpolated linearly", "[pyramid]") {
  for (const int64_t inputs : {2, 3, 4, 5, 7, 13, 64, 101}) {
    for (const double ratio : {1.0, 1.25, 1.7320508075688772, 2.0}) {
      const auto outputs = static_cast<int64_t>(std::floor(static_cast<double>(inputs) / ratio));
      for (const double spread : {1.0, 0.97, 0.5, 0.21, 0.01}) {
        CAPTURE(inputs, outputs, spread);
        const plc::AxisTaps taps = plc::make_axis_taps(inputs, outputs, spread);
        REQUIRE(taps.taps >= 1);
        REQUIRE(taps.taps <= plc::kernels::kMaxTaps);
        REQUIRE(static_cast<int64_t>(taps.first.size()) == outputs);
        REQUIRE(std::is_sorted(taps.first.begin(), taps.first.end()));
        // One voxel at a time: every single weight is checked.
        for (int64_t lit = 0; lit < inputs; ++lit) {
          std::vector<double> line(static_cast<size_t>(inputs), 0.0);
          line[static_cast<size_t>(lit)] = 1.0;
          for (int64_t i = 0; i < outputs; ++i) {
            const int32_t first = taps.first[static_cast<size_t>(i)];
            REQUIRE(first >= 0);
            REQUIRE(first + taps.taps <= inputs);
            double got = 0;
            for (int32_t k = 0; k < taps.taps; ++k) {
              got += double{taps.weights[static_cast<size_t>(i * taps.taps + k)]} *
                     line[static_cast<size_t>(first + k)];
            }
            CAPTURE(lit, i);
            REQUIRE(got == Approx(expected_output(line, outputs, spread, i)).margin(1e-7));
          }
        }
      }
    }
  }
}

TEST_CASE("a spread of one voxel needs six weights, a coarse axis fewer", "[pyramid]") {
  REQUIRE(plc::make_axis_taps(100, 57, 1.0).taps == 6);
  REQUIRE(plc::make_axis_taps(100, 100, 1.0).taps == 5);  // on the voxels
  REQUIRE(plc::make_axis_taps(100, 57, 0.2).taps == 3);
  REQUIRE(plc::make_axis_taps(100, 50, 0.2).taps == 2);  // half-way between two voxels
}

TEST_CASE("weights of every output add up to one", "[pyramid]") {
  const plc::AxisTaps taps = plc::make_axis_taps(268, 154, 0.83);
  for (size_t i = 0; i < taps.first.size(); ++i) {
    double sum = 0;
    for (int32_t k = 0; k < taps.taps; ++k) {
      const float weight =
          taps.weights[i * static_cast<size_t>(taps.taps) + static_cast<size_t>(k)];
      REQUIRE(weight >= 0.0F);
      sum += double{weight};
    }
    REQUIRE(sum == Approx(1.0).margin(2e-7));
  }
}

TEST_CASE("taps far along a long axis never need a seventh voxel", "[pyramid]") {
  // Near powers of two the sum of a place and a point's offset rounds across a voxel.
  for (const int64_t inputs : {int64_t{65536}, int64_t{100003}, int64_t{262144}}) {
    for (const double ratio : {1.1, 1.7320508075688772, 1.9999}) {
      const auto outputs = static_cast<int64_t>(std::floor(static_cast<double>(inputs) / ratio));
      REQUIRE(plc::make_axis_taps(inputs, outputs, 1.0).taps <= plc::kernels::kMaxTaps);
    }
  }
}

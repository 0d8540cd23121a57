#include "pyramid/structure_tensor.h"

#include <algorithm>
#include <bit>

#include "kernels/image_value.h"
#include "kernels/weighted_rows.h"

namespace plc {

namespace {

// Voxels around a tile: one for smoothing, one for gradients, two for the window, one for
// crossings.
constexpr int32_t kHalo = 5;
constexpr int32_t kSide = TensorTile::kCells * TensorTile::kCell + 2 * kHalo;
constexpr size_t kRow = kSide, kPlane = kRow * kSide, kVolume = kPlane * kSide;
constexpr std::array<float, 3> kNarrow{0.25F, 0.5F, 0.25F};
constexpr std::array<float, 5> kWide{0.0625F, 0.25F, 0.375F, 0.25F, 0.0625F};
// The second difference along z of that along y of that along x vanishes on most shapes; of noise
// of variance 1 it has a variance of 6^3. Half of the values of a normal distribution are
// nearer to 0 than this many standard deviations.
constexpr std::array<float, 3> kSecond{1, -2, 1};
constexpr double kSeenOfNoise = 14.697, kMedian = 0.6745;
// Of noise of variance 1, what is left in the difference of two smoothed voxels with one between.
constexpr double kLeftOfNoise = 0.625 * 0.375 * 0.375;

// The voxels of a tile and its halo that are so far from the border along each axis.
struct Inner {
  size_t x, y, z;
};

// visit(index of the first, how many) for the rows of those voxels.
template <typename Visit>
void visit_rows(const Inner& inner, const Visit& visit) {
  for (size_t z = inner.z; z < kSide - inner.z; ++z) {
    for (size_t y = inner.y; y < kSide - inner.y; ++y) {
      visit(z * kPlane + y * kRow + inner.x, kSide - 2 * inner.x);
    }
  }
}

// Of those voxels, and of some beside them, along the axis of that stride. Those around them are
// read as far as the taps reach.
template <size_t kTaps>
void convolve(SimdTarget simd, const Vector<float>& from, size_t stride,
              const std::array<float, kTaps>& taps, const Inner& inner, Vector<float>& to) {
  const size_t begin = inner.y * kRow + inner.x;
  for (size_t z = inner.z; z < kSide - inner.z; ++z) {
    const size_t first = z * kPlane + begin;  // to the last one of the plane, mirrored
    std::array<const float*, kTaps> rows;
    for (size_t k = 0; k < kTaps; ++k) rows[k] = &from[first + k * stride - kTaps / 2 * stride];
    kernels::weighted_rows(simd, taps.data(), kTaps, rows.data(), 0, kPlane - 2 * begin,
                           to.data() + first);
  }
}

// Of the voxels `inner` from the border, by those that the taps reach from there; others are of no
// use afterwards.
template <size_t kTaps>
void smooth(SimdTarget simd, Vector<float>& values, const std::array<float, kTaps>& taps,
            size_t inner, Vector<float>& scratch) {
  const size_t outer = inner - kTaps / 2;
  convolve(simd, values, 1, taps, {inner, outer, outer}, scratch);
  convolve(simd, scratch, kRow, taps, {inner, inner, outer}, values);
  convolve(simd, values, kPlane, taps, {inner, inner, inner}, scratch);
  values.swap(scratch);
}

}  // namespace

std::array<float, 3> TensorTile::half_differences(const ImageView& image, double delta) {
  std::array<float, 3> half;
  for (size_t a = 0; a < 3; ++a) half[a] = 0.5F * image.scale[a] * static_cast<float>(delta);
  return half;
}

TensorTile::TensorTile(SimdTarget simd) : simd_(simd) {
  for (auto* v : {&value_, &scratch_, &weight_}) v->resize(kVolume);
  for (auto& t : tensor_) t.resize(kVolume);
}

// first: its first voxel.
void TensorTile::read(const ImageView& image, int32_t padding,
                      const std::array<int32_t, 3>& first) {
  const auto within = [&](int32_t i, size_t a) {
    return std::clamp(first[a] - kHalo + i, 0, image.dims[a] - 1);
  };
  for (size_t a = 0; a < 3; ++a) {
    const int32_t begin = padding - first[a] + kHalo;
    measured_[a] = {std::max(begin, 0), std::min(begin + image.dims[a] - 2 * padding, kSide)};
  }
  const int32_t begin = within(0, 0), end = within(kSide - 1, 0) + 1;
  const int32_t before = std::clamp(kHalo - first[0], 0, kSide - 1);
  float* to = value_.data();
  with_voxel_type(image.form.type, [&](auto voxel) {
    for (int32_t z = 0; z < kSide; ++z) {
      for (int32_t y = 0; y < kSide; ++y, to += kSide) {
        float* const row = to + before;
        image_row<decltype(voxel)>(image, within(y, 1), within(z, 2), begin, end, row);
        std::fill(to, row, row[0]);
        std::fill(row + (end - begin), to + kSide, row[end - begin - 1]);
      }
    }
  });
}

// Whether the iso-surface passes through, or next to it.
bool TensorTile::crosses(float iso) const {
  float low = value_[0], high = value_[0];
  for (size_t z = kHalo - 1; z < kSide - kHalo + 1; ++z) {
    for (size_t y = kHalo - 1; y < kSide - kHalo + 1; ++y) {
      const float* row = &value_[z * kPlane + y * kRow];
      for (size_t x = kHalo - 1; x < kSide - kHalo + 1; ++x) {
        low = std::min(low, row[x]);
        high = std::max(high, row[x]);
      }
    }
  }
  return low <= iso && high >= iso;
}

// Of a voxel of the image, in the values' unit, before find_tensors(); 0 where more than half of
// them are even.
double TensorTile::measure_noise() {
  convolve(simd_, value_, 1, kSecond, {1, 0, 0}, tensor_[0]);
  convolve(simd_, tensor_[0], kRow, kSecond, {1, 1, 0}, scratch_);
  convolve(simd_, scratch_, kPlane, kSecond, {1, 1, 1}, tensor_[0]);
  magnitudes_.clear();
  // What is padding, or repeated beyond the image's border, has no noise.
  const auto& [xs, ys, zs] = measured_;
  const auto count = static_cast<size_t>(std::max(xs.second - xs.first - 2, 0));
  for (int32_t z = zs.first + 1; z < zs.second - 1; ++z) {
    for (int32_t y = ys.first + 1; y < ys.second - 1; ++y) {
      const float* row =
          &tensor_[0][static_cast<size_t>(z) * kPlane + static_cast<size_t>(y) * kRow +
                      static_cast<size_t>(xs.first + 1)];
      const size_t before = magnitudes_.size();
      magnitudes_.resize(before + count);
      for (size_t x = 0; x < count; ++x) magnitudes_[before + x] = std::abs(row[x]);
    }
  }
  if (magnitudes_.empty()) return 0;
  return static_cast<double>(median()) / (kMedian * kSeenOfNoise);
}

// half: of a difference over two voxels, per delta.
void TensorTile::find_tensors(const std::array<float, 3>& half, float iso) {
  constexpr size_t kTensors = kHalo - kWide.size() / 2, kValues = kTensors - 1;
  for (float& v : value_) v = std::clamp(v, 0.0F, 1.0F);
  smooth(simd_, value_, kNarrow, kValues, scratch_);
  visit_rows({kTensors, kTensors, kTensors}, [&](size_t first, size_t count) {
    const float* const v = value_.data() + first;
    float* to[6];
    for (size_t k = 0; k < 6; ++k) to[k] = tensor_[k].data() + first;
    float* const weights = weight_.data() + first;
    const auto slope = [&](size_t i, size_t axis, size_t stride) {
      return (v[i + stride] - (v - stride)[i]) * half[axis];
    };
    for (size_t i = 0; i < count; ++i) {
      const float x = slope(i, 0, 1), y = slope(i, 1, kRow), z = slope(i, 2, kPlane);
      const float squared = x * x + y * y + z * z;
      // Within 2 delta of the iso-surface, as far as the gradient tells.
      const float off = v[i] - iso;
      const float near = std::max(0.0F, squared - off * off * 0.25F);
      const float weight = squared > 0 ? near / squared : 0;
      to[0][i] = weight * x * x;
      to[1][i] = weight * y * y;
      to[2][i] = weight * z * z;
      to[3][i] = weight * x * y;
      to[4][i] = weight * x * z;
      to[5][i] = weight * y * z;
      weights[i] = weight;
    }
  });
  for (auto& t : tensor_) smooth(simd_, t, kWide, kHalo, scratch_);
  smooth(simd_, weight_, kWide, kHalo, scratch_);
}

// Over the voxels of a cell.
Tensor TensorTile::tensor(int32_t x, int32_t y, int32_t z) const {
  const auto voxel = [](int32_t cell) {
    return static_cast<size_t>(cell) * kCell + static_cast<size_t>(kHalo);
  };
  const size_t first = voxel(z) * kPlane + voxel(y) * kRow + voxel(x);
  Tensor sum;
  for (const size_t at : {first, first + kRow, first + kPlane, first + kPlane + kRow}) {
    for (size_t k = 0; k < 6; ++k) sum.j[k] += tensor_[k][at] + tensor_[k][at + 1];
    sum.weight += weight_[at] + weight_[at + 1];
  }
  return sum;
}

// Of magnitudes_, which keep no order. Floats of at least 0 are ordered as their bits are: those
// that share the first bits of the median are counted out, and few are left to be put in order.
float TensorTile::median() {
  constexpr uint32_t kShift = 20;
  const auto first_bits = [](float f) { return std::bit_cast<uint32_t>(f) >> kShift; };
  const auto middle = static_cast<uint32_t>(magnitudes_.size() / 2);
  counts_.assign(size_t{1} << (31 - kShift), 0);
  for (const float f : magnitudes_) ++counts_[first_bits(f)];
  uint32_t bits = 0, below = 0;
  for (; below + counts_[bits] <= middle; ++bits) below += counts_[bits];
  const auto end = std::partition(magnitudes_.begin(), magnitudes_.end(),
                                  [&](float f) { return first_bits(f) == bits; });
  const auto at = magnitudes_.begin() + (middle - below);
  std::nth_element(magnitudes_.begin(), at, end);
  return *at;
}

// False where the iso-surface does not pass.
bool TensorTile::measure(const ImageView& image, int32_t padding,
                         const std::array<int32_t, 3>& first, const std::array<float, 3>& half,
                         float iso) {
  read(image, padding, first);
  if (!crosses(iso)) return false;
  noise_ = measure_noise();
  find_tensors(half, iso);
  for (size_t a = 0; a < 3; ++a) {
    const auto h = static_cast<double>(half[a]);
    variance_[a] = static_cast<float>(kLeftOfNoise * h * h * noise_ * noise_);
  }
  return true;
}

}  // namespace plc

#include "pyramid/size_field.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>
#include <utility>

#include "kernels/image_value.h"
#include "kernels/weighted_rows.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

constexpr int32_t kCell = 2;  // voxels on a side
constexpr int32_t kTile = 8;  // cells on a side
// Voxels around a tile: one for smoothing, one for gradients, two for the window, one for
// crossings.
constexpr int32_t kHalo = 5;
constexpr int32_t kSide = kTile * kCell + 2 * kHalo;
constexpr size_t kRow = kSide, kPlane = kRow * kSide, kVolume = kPlane * kSide;
// Variance of the window along an axis, voxels squared: of kWide, and of the two voxels of a cell.
constexpr double kWindow = 1.25;
constexpr std::array<float, 3> kNarrow{0.25F, 0.5F, 0.25F};
constexpr std::array<float, 5> kWide{0.0625F, 0.25F, 0.375F, 0.25F, 0.0625F};
// Facets of edges e lie off a surface of curvature k by about k e^2 / 16 in the mean, once the mean
// of their distances along the normal is 0.
constexpr double kOff = 1.0 / 16;
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

// The structure tensor of a part of the image: xx, yy, zz, xy, xz, yz.
struct Tensor {
  std::array<float, 6> j{};
  float weight = 0;  // of its gradients, summed
  // Takes away what noise has put there: along each axis its variance, of gradients.
  void clear_of(const std::array<float, 3>& variance) {
    for (size_t a = 0; a < 3; ++a) j[a] = std::max(0.0F, j[a] - weight * variance[a]);
  }
  // The part of the turning across the first eigenvector in that along it, r = (l2 + l3) / l1, from
  // the invariants of the tensor; at most 1.
  double turning() const {
    const float trace = j[0] + j[1] + j[2];
    if (!(trace > 1e-12F)) return 0;
    const float minors =
        j[0] * j[1] + j[0] * j[2] + j[1] * j[2] - j[3] * j[3] - j[4] * j[4] - j[5] * j[5];
    // minors / trace^2 = r / (1 + r)^2, but for l2 l3.
    const auto q = std::max(0.0, static_cast<double>(minors / (trace * trace)));
    if (q < 1e-9) return q;
    return q >= 0.25 ? 1.0 : (1 - 2 * q - std::sqrt(1 - 4 * q)) / (2 * q);
  }
};

class Tile {
 public:
  explicit Tile(SimdTarget simd) : simd_(simd) {
    for (auto* v : {&value_, &scratch_, &weight_}) v->resize(kVolume);
    for (auto& t : tensor_) t.resize(kVolume);
  }

  // first: its first voxel.
  void read(const ImageView& image, int32_t padding, const std::array<int32_t, 3>& first) {
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
  bool crosses(float iso) const {
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
  double noise() {
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
  void find_tensors(const std::array<float, 3>& half, float iso) {
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
  Tensor tensor(int32_t x, int32_t y, int32_t z) const {
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

 private:
  // Of magnitudes_, which keep no order. Floats of at least 0 are ordered as their bits are: those
  // that share the first bits of the median are counted out, and few are left to be put in order.
  float median() {
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

  SimdTarget simd_;
  std::array<std::pair<int32_t, int32_t>, 3> measured_{};  // begin and end of what is no padding
  Vector<float> value_, scratch_, magnitudes_;
  Vector<uint32_t> counts_;
  std::array<Vector<float>, 6> tensor_;
  Vector<float> weight_;
};

// Half of a difference over two voxels, per delta.
std::array<float, 3> half_differences(const ImageView& image, double delta) {
  std::array<float, 3> half;
  for (size_t a = 0; a < 3; ++a) half[a] = 0.5F * image.scale[a] * static_cast<float>(delta);
  return half;
}

// Reads the tile from the voxel `first` on; where the iso-surface passes, visit(cell, its tensor
// without noise) for `count` cells from its first on, and what noise moves the surface by goes to
// `noises`. half: as half_differences() has it.
template <typename Visit>
void visit_tensors(const ImageView& image, int32_t padding, const std::array<int32_t, 3>& first,
                   const std::array<int32_t, 3>& count, const std::array<float, 3>& half, float iso,
                   Tile& tile, Vector<float>& noises, const Visit& visit) {
  tile.read(image, padding, first);
  if (!tile.crosses(iso)) return;
  const double noise = tile.noise();
  tile.find_tensors(half, iso);
  std::array<float, 3> variance;
  for (size_t a = 0; a < 3; ++a) {
    const auto h = static_cast<double>(half[a]);
    variance[a] = static_cast<float>(kLeftOfNoise * h * h * noise * noise);
  }
  float weight = 0;
  std::array<float, 3> squares{};
  for (int32_t z = 0; z < count[2]; ++z) {
    for (int32_t y = 0; y < count[1]; ++y) {
      for (int32_t x = 0; x < count[0]; ++x) {
        Tensor tensor = tile.tensor(x, y, z);
        tensor.clear_of(variance);
        weight += tensor.weight;
        for (size_t a = 0; a < 3; ++a) squares[a] += tensor.j[a];
        visit({x, y, z}, tensor);
      }
    }
  }
  const auto squared = static_cast<double>(squares[0] + squares[1] + squares[2]);
  if (!(squared > 0)) return;
  noises.push_back(static_cast<float>(noise * std::sqrt(static_cast<double>(weight) / squared)));
}

// 0 of none.
float median_of(const Vector<Vector<float>>& parts) {
  Vector<float> values;
  for (const Vector<float>& part : parts) values.insert(values.end(), part.begin(), part.end());
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

uint8_t code(double size) {
  return static_cast<uint8_t>(std::clamp(size / static_cast<double>(SizeField::kStep), 1.0, 255.0));
}

}  // namespace

// Of the tiles that the iso-surface passes through.
class SizeField::Builder {
 public:
  Builder(SizeField& field, const ImageView& image, int32_t padding, float iso, double delta,
          const SizeSpec& spec)
      : field_(field),
        image_(image),
        padding_(padding),
        iso_(iso),
        half_(half_differences(image, delta)),
        finest_(code(spec.finest)),
        coarsest_(code(spec.coarsest)) {
    double voxel = 0;  // in delta, in the mean over the axes
    for (size_t a = 0; a < 3; ++a) {
      tiles_[a] = (field.cells_[a] + kTile - 1) / kTile;
      voxel += 1 / (3 * static_cast<double>(image.scale[a]) * delta);
    }
    window_ = kWindow * voxel * voxel;
    factor_ = std::sqrt(spec.tolerance / kOff) / kMeanEdge;
  }

  void run(const Executor& executor) {
    std::fill(field_.sizes_.begin(), field_.sizes_.end(), coarsest_);
    Vector<Vector<float>> noises(static_cast<size_t>(tiles_[2]));
    executor.run(noises.size(), [&](size_t z) {
      Tile tile(executor.simd());
      for (int32_t y = 0; y < tiles_[1]; ++y) {
        for (int32_t x = 0; x < tiles_[0]; ++x) {
          fill({x * kTile, y * kTile, static_cast<int32_t>(z) * kTile}, tile, noises[z]);
        }
      }
    });
    field_.noise_ = median_of(noises);
  }

 private:
  // The sizes of a tile from the cell `begin` on.
  void fill(const std::array<int32_t, 3>& begin, Tile& tile, Vector<float>& noises) {
    const auto& cells = field_.cells_;
    const auto row = static_cast<size_t>(cells[0]), plane = row * static_cast<size_t>(cells[1]);
    std::array<int32_t, 3> first, count;
    for (size_t a = 0; a < 3; ++a) {
      first[a] = (field_.first_[a] + begin[a]) * kCell;
      count[a] = std::min(kTile, cells[a] - begin[a]);
    }
    visit_tensors(image_, padding_, first, count, half_, iso_, tile, noises,
                  [&](const std::array<int32_t, 3>& at, const Tensor& tensor) {
                    field_.sizes_[static_cast<size_t>(begin[2] + at[2]) * plane +
                                  static_cast<size_t>(begin[1] + at[1]) * row +
                                  static_cast<size_t>(begin[0] + at[0])] = size(tensor);
                  });
  }

  uint8_t size(const Tensor& tensor) const {
    const double curvature = std::sqrt(tensor.turning() / window_);
    const double size = factor_ / std::sqrt(std::max(curvature, 1e-6));
    return std::clamp(code(size), finest_, coarsest_);
  }

  SizeField& field_;
  const ImageView& image_;
  int32_t padding_;
  float iso_;
  std::array<float, 3> half_;
  uint8_t finest_, coarsest_;
  std::array<int32_t, 3> tiles_{};
  double window_ = 1, factor_ = 1;
};

float surface_noise(const ImageView& image, float iso, double delta, const Executor& executor) {
  constexpr size_t kSampled = 512;  // tiles
  std::array<size_t, 3> tiles;
  for (size_t a = 0; a < 3; ++a) {
    tiles[a] = (static_cast<size_t>(image.dims[a]) + kTile * kCell - 1) / (kTile * kCell);
  }
  const size_t all = tiles[0] * tiles[1] * tiles[2];
  const size_t step = all / kSampled | 1;  // odd: not the same rows all the time
  const std::array<float, 3> half = half_differences(image, delta);
  const std::array<int32_t, 3> whole{kTile, kTile, kTile};
  constexpr size_t kTogether = 16;
  const size_t count = (all + step - 1) / step;
  Vector<Vector<float>> parts((count + kTogether - 1) / kTogether);
  executor.run(parts.size(), [&](size_t part) {
    Tile tile(executor.simd());
    for (size_t i = part * kTogether; i < std::min(count, (part + 1) * kTogether); ++i) {
      const size_t t = i * step;
      const std::array<size_t, 3> at{t % tiles[0], t / tiles[0] % tiles[1],
                                     t / tiles[0] / tiles[1]};
      std::array<int32_t, 3> first;
      for (size_t a = 0; a < 3; ++a) first[a] = static_cast<int32_t>(at[a]) * kTile * kCell;
      visit_tensors(image, image.form.pad, first, whole, half, iso, tile, parts[part],
                    [](const std::array<int32_t, 3>&, const Tensor&) {});
    }
  });
  return median_of(parts);
}

Status SizeField::build(const ImageView& image, float iso, double delta, const SizeSpec& spec,
                        const Executor& executor, int32_t padding, const VoxelRoom& room) {
  double side = 1e30;  // of a cell, in delta
  size_t count = 1;
  for (size_t a = 0; a < 3; ++a) {
    // By whole tiles, the same whatever the room.
    first_[a] = room.low[a] / (kCell * kTile) * kTile;
    const int32_t end =
        std::min((room.high[a] / (kCell * kTile) + 1) * kCell * kTile, image.dims[a]);
    cells_[a] = (end + kCell - 1) / kCell - first_[a];
    count *= static_cast<size_t>(cells_[a]);
    scale_[a] = image.scale[a] / kCell;
    offset_[a] = (image.offset[a] + 0.5F) / kCell - 0.5F - static_cast<float>(first_[a]);
    side = std::min(side, kCell / static_cast<double>(image.scale[a]) / delta);
  }
  slope_ = static_cast<float>(spec.slope);
  noise_ = 0;
  finest_ = static_cast<float>(code(spec.finest)) * kStep;
  coarsest_ = static_cast<float>(code(spec.coarsest)) * kStep;
  try {
    sizes_.resize_uninitialized(count);
    Builder(*this, image, padding, iso, delta, spec).run(executor);
  } catch (const std::bad_alloc&) {
    return {ErrorCode::kOutOfMemory,
            "sizes of an adaptive mesh, of which a uniform one has none: out of memory"};
  }
  constexpr std::array<double, 4> kAway{0, 1, 1.414, 1.732};
  for (size_t k = 1; k < 4; ++k) {
    steps_[k] =
        std::max(1, static_cast<int>(spec.slope * side * kAway[k] / static_cast<double>(kStep)));
  }
  for (size_t a = 0; a < 3; ++a) {
    low_[a] = 0;
    high_[a] = cells_[a] - 1;
  }
  bound_slope();
  return {};
}

void SizeField::lower(const std::array<int32_t, 3>& voxel, float most, int32_t around) {
  std::array<int32_t, 3> low, high;
  for (size_t a = 0; a < 3; ++a) {
    const int32_t cell = voxel[a] / kCell - first_[a];
    if (cell < 0 || cell >= cells_[a]) return;  // beyond the room
    low[a] = std::max(cell - around, 0);
    high[a] = std::min(cell + around, cells_[a] - 1);
  }
  for (size_t a = 0; a < 3; ++a) {
    low_[a] = std::min(low_[a], low[a]);
    high_[a] = std::max(high_[a], high[a]);
  }
  const uint8_t least = code(static_cast<double>(std::max(most, finest_)));
  for (int32_t z = low[2]; z <= high[2]; ++z) {
    for (int32_t y = low[1]; y <= high[1]; ++y) {
      const size_t row =
          (static_cast<size_t>(z) * static_cast<size_t>(cells_[1]) + static_cast<size_t>(y)) *
          static_cast<size_t>(cells_[0]);
      for (int32_t x = low[0]; x <= high[0]; ++x) {
        uint8_t& own = sizes_[row + static_cast<size_t>(x)];
        own = std::min(own, least);
      }
    }
  }
}

// Chamfer distances, forth and back, as far as what was lowered reaches. A shortest way of steps
// that all go the same way on each axis stays within the box of its ends, and may take its steps of
// the first sweep first: so two sweeps give the least over all ways.
void SizeField::bound_slope() {
  if (low_[0] > high_[0]) return;
  const auto reach = static_cast<int32_t>(coarsest_ / kStep) / steps_[1] + 1;
  for (size_t a = 0; a < 3; ++a) {
    low_[a] = std::max(low_[a] - reach, 0);
    high_[a] = std::min(high_[a] + reach, cells_[a] - 1);
  }
  sweep(1);
  sweep(-1);
  low_ = cells_;
  high_ = {-1, -1, -1};
}

// Every cell of the box from those before it in this direction, row by row: vector code does what
// rows before it ask for.
void SizeField::sweep(int direction) {
  const int64_t nx = cells_[0], ny = cells_[1], nz = cells_[2];
  const int64_t begin = low_[0], end = int64_t{high_[0]} + 1;
  const auto row = [&](int64_t y, int64_t z) {
    return sizes_.data() + static_cast<size_t>((z * ny + y) * nx);
  };
  const auto lower_by_row = [&](uint8_t* own, const uint8_t* other, size_t away) {
    const auto lower = [&](int64_t from, int64_t to, int64_t aside, int step) {
      for (int64_t x = from; x < to; ++x) {
        own[x] = static_cast<uint8_t>(std::min<int>(own[x], other[x + aside] + step));
      }
    };
    lower(begin, end, 0, steps_[away]);
    lower(std::max<int64_t>(begin, 1), end, -1, steps_[away + 1]);
    lower(begin, std::min(end, nx - 1), 1, steps_[away + 1]);
  };
  const auto lower_along = [&](uint8_t* own) {
    const auto lower = [&](int64_t x, int64_t from) {
      own[x] = static_cast<uint8_t>(std::min<int>(own[x], own[from] + steps_[1]));
    };
    if (direction > 0) {
      for (int64_t x = std::max<int64_t>(begin, 1); x < end; ++x) lower(x, x - 1);
    } else {
      for (int64_t x = std::min(end, nx - 1); x-- > begin;) lower(x, x + 1);
    }
  };
  const auto in_turn = [&](int32_t k, size_t a) {
    return int64_t{direction > 0 ? low_[a] + k : high_[a] - k};
  };
  for (int32_t k = 0; k <= high_[2] - low_[2]; ++k) {
    const int64_t z = in_turn(k, 2), before = z - direction;
    for (int32_t i = 0; i <= high_[1] - low_[1]; ++i) {
      const int64_t y = in_turn(i, 1);
      uint8_t* own = row(y, z);
      for (int64_t v = y - 1; v <= y + 1 && before >= 0 && before < nz; ++v) {
        if (v >= 0 && v < ny) lower_by_row(own, row(v, before), v == y ? 1 : 2);
      }
      const int64_t v = y - direction;
      if (v >= 0 && v < ny) lower_by_row(own, row(v, z), 1);
      lower_along(own);
    }
  }
}

float SizeField::above_delta(float px, float py, float pz) const {
  const AxisCell x = axis_cell(px, scale_[0], offset_[0], cells_[0]);
  const AxisCell y = axis_cell(py, scale_[1], offset_[1], cells_[1]);
  const AxisCell z = axis_cell(pz, scale_[2], offset_[2], cells_[2]);
  const auto row = static_cast<size_t>(cells_[0]), plane = row * static_cast<size_t>(cells_[1]);
  const uint8_t* at = sizes_.data() + static_cast<size_t>(z.index) * plane +
                      static_cast<size_t>(y.index) * row + static_cast<size_t>(x.index);
  const auto along_x = [&](const uint8_t* p) {
    const float a = p[0], b = p[1];
    return a + (b - a) * x.fraction;
  };
  const auto along_y = [&](const uint8_t* p) {
    const float a = along_x(p), b = along_x(p + row);
    return a + (b - a) * y.fraction;
  };
  const float a = along_y(at), b = along_y(at + plane);
  return (a + (b - a) * z.fraction) * kStep - 1.0F;
}

}  // namespace plc

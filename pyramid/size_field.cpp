#include "pyramid/size_field.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "kernels/image_value.h"
#include "pyramid/memory.h"
#include "pyramid/structure_tensor.h"

namespace plc {

namespace {

constexpr int32_t kCell = TensorTile::kCell, kTile = TensorTile::kCells;
// Facets of edges e lie off a surface of curvature k by about k e^2 / 16 in the mean, once the mean
// of their distances along the normal is 0.
constexpr double kOff = 1.0 / 16;

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
        half_(TensorTile::half_differences(image, delta)),
        finest_(code(spec.finest)),
        coarsest_(code(spec.coarsest)) {
    double voxel = 0;  // in delta, in the mean over the axes
    for (size_t a = 0; a < 3; ++a) {
      tiles_[a] = (field.cells_[a] + kTile - 1) / kTile;
      voxel += 1 / (3 * static_cast<double>(image.scale[a]) * delta);
    }
    window_ = TensorTile::kWindow * voxel * voxel;
    factor_ = std::sqrt(spec.tolerance / kOff) / kMeanEdge;
  }

  void run(const Executor& executor) {
    std::fill(field_.sizes_.begin(), field_.sizes_.end(), coarsest_);
    Vector<Vector<float>> noises(static_cast<size_t>(tiles_[2]));
    executor.run(noises.size(), [&](size_t z) {
      TensorTile tile(executor.simd());
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
  void fill(const std::array<int32_t, 3>& begin, TensorTile& tile, Vector<float>& noises) {
    const auto& cells = field_.cells_;
    const auto row = static_cast<size_t>(cells[0]), plane = row * static_cast<size_t>(cells[1]);
    std::array<int32_t, 3> first, count;
    for (size_t a = 0; a < 3; ++a) {
      first[a] = (field_.first_[a] + begin[a]) * kCell;
      count[a] = std::min(kTile, cells[a] - begin[a]);
    }
    tile.visit(image_, padding_, first, count, half_, iso_, noises,
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
  const std::array<float, 3> half = TensorTile::half_differences(image, delta);
  const std::array<int32_t, 3> whole{kTile, kTile, kTile};
  constexpr size_t kTogether = 16;
  const size_t count = (all + step - 1) / step;
  Vector<Vector<float>> parts((count + kTogether - 1) / kTogether);
  executor.run(parts.size(), [&](size_t part) {
    TensorTile tile(executor.simd());
    for (size_t i = part * kTogether; i < std::min(count, (part + 1) * kTogether); ++i) {
      const size_t t = i * step;
      const std::array<size_t, 3> at{t % tiles[0], t / tiles[0] % tiles[1],
                                     t / tiles[0] / tiles[1]};
      std::array<int32_t, 3> first;
      for (size_t a = 0; a < 3; ++a) first[a] = static_cast<int32_t>(at[a]) * kTile * kCell;
      tile.visit(image, image.form.pad, first, whole, half, iso, parts[part],
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
  // On an axis of one cell there is none before it, nor a next one.
  const auto first = [](const AxisCell& c) { return static_cast<size_t>(std::max(c.index, 0)); };
  const auto to_next = [&](size_t a, size_t stride) { return cells_[a] > 1 ? stride : 0; };
  const size_t next_x = to_next(0, 1), next_y = to_next(1, row), next_z = to_next(2, plane);
  const uint8_t* at = sizes_.data() + first(z) * plane + first(y) * row + first(x);
  const auto along_x = [&](const uint8_t* p) {
    const float a = p[0], b = p[next_x];
    return a + (b - a) * x.fraction;
  };
  const auto along_y = [&](const uint8_t* p) {
    const float a = along_x(p), b = along_x(p + next_y);
    return a + (b - a) * y.fraction;
  };
  const float a = along_y(at), b = along_y(at + next_z);
  return (a + (b - a) * z.fraction) * kStep - 1.0F;
}

}  // namespace plc

#include "pyramid/reduction.h"

#include <algorithm>
#include <cstddef>

#include "kernels/image_rows.h"
#include "pyramid/buffer.h"
#include "pyramid/guarded_run.h"

namespace plc {

namespace {

// Output planes of a tile. Each tile reduces about 4 input planes that its neighbour reduces too:
// 14 % of the work at 16 planes and a reduction of sqrt 3.
constexpr size_t kTilePlanes = 16;
// Bytes of a tile's window of reduced planes: it should stay in a core's second-level cache
// together with the rows that stream through.
constexpr size_t kWindowBytes = size_t{256} << 10;
constexpr size_t kMinTileRows = 8;
// Rows that are read at a time: as many as reduce_x takes at once, so that they stay in the first
// cache.
constexpr size_t kReadRows = 16;

size_t divide_up(size_t a, size_t b) {
  return (a + b - 1) / b;
}

struct Reduction {
  const ImageView& in;
  std::array<size_t, 3> in_dims;
  std::array<kernels::TapsView, 3> taps;
  std::array<size_t, 3> out_dims;
  SimdTarget simd;
  float* out;
  size_t tile_rows;  // output rows of a tile

  // Input rows or planes [first, last) that outputs [begin, end) of an axis read.
  size_t first_input(size_t axis, size_t begin) const {
    return static_cast<size_t>(taps[axis].first[begin]);
  }
  size_t end_input(size_t axis, size_t end) const {
    return first_input(axis, end - 1) + static_cast<size_t>(taps[axis].taps);
  }
};

// Output rows [row, row_end) of output planes [plane, plane_end).
struct Tile {
  size_t row, row_end, plane, plane_end;
};

// A tile's memory besides its window of planes.
struct Scratch {
  Buffer<float> columns;  // of reduce_x
  Buffer<float> values;   // kReadRows rows of the image; not used where it holds them as they are
  Buffer<float> rows;     // reduced along X
};

// Rows [y, y_end) of input plane z, reduced along X.
void reduce_rows(const Reduction& r, size_t z, size_t y, size_t y_end, Scratch& scratch) {
  const size_t width = r.in_dims[0];
  const auto reduce = [&](const float* from, size_t rows, float* to) {
    kernels::reduce_x(r.simd, r.taps[0], {from, width, width}, rows,
                      {to, r.out_dims[0], r.out_dims[0]}, scratch.columns.data());
  };
  if (r.in.form.type == ImageType::kUnit) {
    const auto* voxels = static_cast<const float*>(r.in.data);
    reduce(voxels + (z * r.in_dims[1] + y) * width, y_end - y, scratch.rows.data());
    return;
  }
  for (size_t row = y; row < y_end; row += kReadRows) {
    const size_t end = std::min(row + kReadRows, y_end);
    kernels::image_rows(r.simd, r.in, static_cast<int64_t>(z), static_cast<int64_t>(row),
                        static_cast<int64_t>(end), scratch.values.data());
    reduce(scratch.values.data(), end - row, scratch.rows.data() + (row - y) * r.out_dims[0]);
  }
}

// The tile's rows of input plane z, reduced along X, then along Y into `reduced`.
void reduce_plane(const Reduction& r, const Tile& tile, size_t z, Scratch& scratch,
                  float* reduced) {
  reduce_rows(r, z, r.first_input(1, tile.row), r.end_input(1, tile.row_end), scratch);
  const size_t width = r.out_dims[0];
  kernels::reduce_y(r.simd, r.taps[1], tile.row, tile.row_end, {scratch.rows.data(), width, width},
                    {reduced, width, width});
}

void reduce_tile(const Reduction& r, const Tile& tile) {
  const kernels::TapsView& along_z = r.taps[2];
  const auto taps = static_cast<size_t>(along_z.taps);
  const size_t plane_size = (tile.row_end - tile.row) * r.out_dims[0];
  Scratch scratch;
  Buffer<float> window;
  scratch.columns.resize_uninitialized(kernels::reduce_x_scratch(r.in_dims[0]));
  scratch.values.resize_uninitialized(kReadRows * r.in_dims[0]);
  scratch.rows.resize_uninitialized((r.end_input(1, tile.row_end) - r.first_input(1, tile.row)) *
                                    r.out_dims[0]);
  window.resize_uninitialized(taps * plane_size);
  size_t next = 0;  // first input plane that is not in the window; plane z has place z % taps
  for (size_t k = tile.plane; k < tile.plane_end; ++k) {
    const size_t first = r.first_input(2, k);
    for (next = std::max(next, first); next < first + taps; ++next) {
      reduce_plane(r, tile, next, scratch, window.data() + next % taps * plane_size);
    }
    const float* planes[kernels::kMaxTaps] = {};
    for (size_t t = 0; t < taps; ++t) planes[t] = window.data() + (first + t) % taps * plane_size;
    kernels::reduce_z(r.simd, along_z.weights + k * taps, along_z.taps, planes, plane_size,
                      r.out + (k * r.out_dims[1] + tile.row) * r.out_dims[0]);
  }
}

std::array<size_t, 3> to_sizes(const std::array<int64_t, 3>& dims) {
  return {static_cast<size_t>(dims[0]), static_cast<size_t>(dims[1]), static_cast<size_t>(dims[2])};
}

}  // namespace

bool reduce_image(const ImageView& in, const std::array<AxisTaps, 3>& taps,
                  const std::array<int64_t, 3>& out_dims, const Executor& executor, float* out) {
  Reduction r{in,
              to_sizes({in.dims[0], in.dims[1], in.dims[2]}),
              {taps[0].view(), taps[1].view(), taps[2].view()},
              to_sizes(out_dims),
              executor.simd(),
              out,
              0};
  const size_t row_bytes = r.out_dims[0] * static_cast<size_t>(taps[2].taps) * sizeof(float);
  r.tile_rows = std::clamp(kWindowBytes / row_bytes, kMinTileRows, r.out_dims[1]);
  const size_t tiles_y = divide_up(r.out_dims[1], r.tile_rows);
  const size_t tiles_z = divide_up(r.out_dims[2], kTilePlanes);
  return run_guarded(executor, tiles_y * tiles_z, [&](size_t task) {
    const size_t row = task % tiles_y * r.tile_rows;
    const size_t plane = task / tiles_y * kTilePlanes;
    const Tile tile{row, std::min(row + r.tile_rows, r.out_dims[1]), plane,
                    std::min(plane + kTilePlanes, r.out_dims[2])};
    reduce_tile(r, tile);
  });
}

}  // namespace plc

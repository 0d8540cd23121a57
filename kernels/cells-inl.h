// Where positions lie in an image: what the sampling kernels share. Included once per target.
#if defined(PELLICLE_KERNELS_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PELLICLE_KERNELS_CELLS_INL_H
#undef PELLICLE_KERNELS_CELLS_INL_H
#else
#define PELLICLE_KERNELS_CELLS_INL_H
#endif

#include "kernels/image.h"
#include "kernels/vectors-inl.h"

#if !PLC_SCALAR_TARGET
HWY_BEFORE_NAMESPACE();
namespace plc::kernels::HWY_NAMESPACE {

using IntTag = hn::RebindToSigned<FloatTag>;
using Ints = hn::Vec<IntTag>;

struct Cells {
  Ints index;
  Floats fraction;
};

// The cell of each coordinate. Clamped as a float first, by comparisons that send NaN to 0, and as
// an integer after: whatever p is, cell .. cell + 1 are voxels of the image.
HWY_INLINE Cells locate(Floats p, float scale, float offset, int32_t dim) {
  const FloatTag d;
  const IntTag di;
  const Floats last = hn::Set(d, static_cast<float>(dim - 1));
  Floats c = hn::Add(hn::Mul(hn::Set(d, scale), p), hn::Set(d, offset));
  c = hn::IfThenElseZero(hn::Gt(c, hn::Zero(d)), c);
  c = hn::IfThenElse(hn::Lt(c, last), c, last);
  const Ints index = hn::Min(hn::ConvertTo(di, c), hn::Set(di, dim - 2));
  return {index, hn::Sub(c, hn::ConvertTo(d, index))};
}

// The first voxel of each lane's cell, the steps to the next row and plane, and the place in it.
struct Place {
  Floats x, y, z;  // in [0,1]
  int32_t row, plane;
  alignas(64) uint32_t cell[kLanes];
};

HWY_INLINE Place locate(const GradientView& image, const Floats3& p) {
  const IntTag di;
  const hn::RebindToUnsigned<IntTag> du;
  const Cells x = locate(p.x, image.scale[0], image.offset[0], image.dims[0]);
  const Cells y = locate(p.y, image.scale[1], image.offset[1], image.dims[1]);
  const Cells z = locate(p.z, image.scale[2], image.offset[2], image.dims[2]);
  const int32_t row = image.dims[0];
  const int32_t plane = image.dims[0] * image.dims[1];
  const Ints cell = hn::Add(
      x.index, hn::Add(hn::Mul(y.index, hn::Set(di, row)), hn::Mul(z.index, hn::Set(di, plane))));
  Place place{x.fraction, y.fraction, z.fraction, row, plane, {}};
  hn::Store(hn::BitCast(du, cell), du, place.cell);
  return place;
}

// Where the lanes' cells lie among the stored voxels of an image.
struct Stored {
  size_t row, plane;  // steps to the next row and plane
  // Whether all eight voxels of every lane's cell are stored, not in bricks, and 32 bits hold their
  // numbers; else `first` lies.
  bool all;
  alignas(64) uint32_t first[kLanes];  // the first voxel of each lane's cell
};

// kPadded: whether the image may have a padding.
template <bool kPadded>
HWY_INLINE Stored stored(const ImageView& image, const Cells& x, const Cells& y, const Cells& z) {
  const IntTag di;
  const hn::RebindToUnsigned<IntTag> du;
  const int32_t pad = kPadded ? image.form.pad : 0;
  const int32_t row = image.dims[0] - 2 * pad;
  const int32_t rows = image.dims[1] - 2 * pad;
  const int64_t plane = int64_t{row} * rows;
  const auto unpadded = [&](Ints index)
                            HWY_ATTR { return kPadded ? hn::Sub(index, hn::Set(di, pad)) : index; };
  const Ints i = unpadded(x.index), j = unpadded(y.index), k = unpadded(z.index);
  const Ints cell = hn::Add(i, hn::Add(hn::Mul(j, hn::Set(di, row)),
                                       hn::Mul(k, hn::Set(di, static_cast<int32_t>(plane)))));
  bool all = true;
  if constexpr (kPadded) {
    const auto within = [&](Ints index, int32_t dim) HWY_ATTR {
      return hn::And(hn::Gt(index, hn::Set(di, -1)), hn::Gt(hn::Set(di, dim - 2 * pad - 1), index));
    };
    constexpr int64_t kMost = int64_t{1} << 32;  // of unsigned numbers
    all = image.bricks == nullptr && plane * (image.dims[2] - 2 * pad) <= kMost &&
          hn::AllTrue(di, hn::And(hn::And(within(i, image.dims[0]), within(j, image.dims[1])),
                                  within(k, image.dims[2])));
  }
  Stored result{static_cast<size_t>(row), static_cast<size_t>(plane), all, {}};
  hn::Store(hn::BitCast(du, cell), du, result.first);
  return result;
}

HWY_INLINE Floats lerp(Floats a, Floats b, Floats t) {
  return hn::Add(a, hn::Mul(hn::Sub(b, a), t));
}

}  // namespace plc::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // include guard per target

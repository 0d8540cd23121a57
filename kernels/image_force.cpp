#include "kernels/image_force.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/image_force.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::iso_force;
using scalar::sample_trilinear;
#else

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

HWY_INLINE Floats lerp(Floats a, Floats b, Floats t) {
  return hn::Add(a, hn::Mul(hn::Sub(b, a), t));
}

// The four voxels of a cell in one plane: two 8-byte loads, which cost less than gathers.
struct CellQuads {
  const float* plane;
  int32_t row;
  const int32_t* offset;  // of each lane's cell
  HWY_INLINE Quad operator()(uint32_t lane) const {
    const hn::Half<QuadTag> pair;
    const float* cell = plane + offset[lane];
    return hn::Combine(QuadTag(), hn::LoadU(pair, cell + row), hn::LoadU(pair, cell));
  }
};

// Bilinear in the plane of voxels: x, then y.
HWY_INLINE Floats sample_plane(const CellQuads& cells, Floats x, Floats y) {
  const Floats4 quad = load_transposed(cells);
  return lerp(lerp(quad.x, quad.y, x), lerp(quad.z, quad.w, x), y);
}

HWY_INLINE Floats sample(const ImageView& image, const Floats3& p) {
  const IntTag di;
  const Cells x = locate(p.x, image.scale[0], image.offset[0], image.dims[0]);
  const Cells y = locate(p.y, image.scale[1], image.offset[1], image.dims[1]);
  const Cells z = locate(p.z, image.scale[2], image.offset[2], image.dims[2]);
  const int32_t row = image.dims[0];
  const int32_t plane = image.dims[0] * image.dims[1];
  const Ints offset = hn::Add(
      x.index, hn::Add(hn::Mul(y.index, hn::Set(di, row)), hn::Mul(z.index, hn::Set(di, plane))));
  alignas(64) int32_t offsets[kLanes];
  hn::Store(offset, di, offsets);
  const Floats below = sample_plane({image.data, row, offsets}, x.fraction, y.fraction);
  const Floats above = sample_plane({image.data + plane, row, offsets}, x.fraction, y.fraction);
  return lerp(below, above, z.fraction);
}

void sample_trilinear(const ImageView& image, const Packed* position, uint32_t begin, uint32_t end,
                      float* values) {
  uint32_t i = begin;
  for (; end - i >= kLanes; i += kLanes) {
    hn::StoreU(sample(image, load_packed(position + i)), FloatTag(), values + i);
  }
  scalar::sample_trilinear(image, position, i, end, values);
}

void iso_force(const ImageView& image, const Packed* position, const float* nx, const float* ny,
               const float* nz, float coefficient, float iso, uint32_t begin, uint32_t end,
               float* fx, float* fy, float* fz) {
  const FloatTag d;
  for (uint32_t i = begin; i < end; i += kLanes) {
    const Floats value = sample(image, load_packed(position + i));
    const Floats push = hn::Mul(hn::Set(d, coefficient), hn::Sub(hn::Set(d, iso), value));
    store3(load3(fx, fy, fz, i) + load3(nx, ny, nz, i) * push, fx, fy, fz, i);
  }
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(sample_trilinear);
HWY_EXPORT(iso_force);

void sample_trilinear(SimdTarget simd, const ImageView& image, const Packed* position,
                      uint32_t begin, uint32_t end, float* values) {
  PLC_DISPATCH(simd, sample_trilinear)(image, position, begin, end, values);
}

void iso_force(SimdTarget simd, const ImageView& image, const Packed* position, const float* nx,
               const float* ny, const float* nz, float coefficient, float iso, uint32_t begin,
               uint32_t end, float* fx, float* fy, float* fz) {
  PLC_DISPATCH(simd, iso_force)
  (image, position, nx, ny, nz, coefficient, iso, begin, end, fx, fy, fz);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE

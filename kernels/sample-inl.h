// Trilinear sampling of an image, lanes are places (3.8). Included once per target.
#if defined(PELLICLE_KERNELS_SAMPLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PELLICLE_KERNELS_SAMPLE_INL_H
#undef PELLICLE_KERNELS_SAMPLE_INL_H
#else
#define PELLICLE_KERNELS_SAMPLE_INL_H
#endif

#include "kernels/cells-inl.h"
#include "kernels/image.h"
#include "kernels/vectors-inl.h"

#if !PLC_SCALAR_TARGET
HWY_BEFORE_NAMESPACE();
namespace plc::kernels::HWY_NAMESPACE {

// The four voxels of a cell in one plane: two 8-byte loads, which cost less than gathers.
struct CellQuads {
  const float* plane;
  int32_t row;
  const uint32_t* offset;  // of each lane's cell
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
  const Place at = locate(image, p);
  const Floats below = sample_plane({image.data, at.row, at.cell}, at.x, at.y);
  const Floats above = sample_plane({image.data + at.plane, at.row, at.cell}, at.x, at.y);
  return lerp(below, above, at.z);
}

}  // namespace plc::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // include guard per target

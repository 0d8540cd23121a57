#include "kernels/image_rows.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/image_rows.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/image_value.h"
#include "kernels/sample-inl.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::image_rows;
#else

template <class Voxel>
HWY_INLINE Floats load_voxels(const Voxel* voxels) {
  const FloatTag d;
  const IntTag di;
  if constexpr (sizeof(Voxel) == 4) {
    return hn::LoadU(d, reinterpret_cast<const float*>(voxels));
  } else {
    return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(hn::Rebind<Voxel, FloatTag>(), voxels)));
  }
}

template <class Voxel>
HWY_INLINE void stored_values(const VoxelForm& form, const Voxel* voxels, size_t count,
                              float* values) {
  const VoxelValues<Voxel> value(form);
  size_t i = 0;
  for (; count - i >= kLanes; i += kLanes) {
    hn::StoreU(value(load_voxels(voxels + i)), FloatTag(), values + i);
  }
  for (; i < count; ++i) values[i] = voxel_value(form, voxels[i]);
}

void image_rows(const ImageView& image, int64_t z, int64_t first, int64_t end, float* values) {
  const auto width = static_cast<size_t>(image.dims[0]);
  const BrickReads reads(image.bricks);
  with_voxel_type(image.form.type, [&](auto voxel) HWY_ATTR {
    for (int64_t y = first; y < end; ++y, values += width) {
      using Voxel = decltype(voxel);
      fill_padding(image, y, z, 0, image.dims[0], values);
      visit_stored<Voxel>(image, y, z, 0, image.dims[0],
                          [&](const Voxel* voxels, int64_t x, int64_t count) HWY_ATTR {
                            stored_values(image.form, voxels, static_cast<size_t>(count),
                                          values + x);
                          });
    }
  });
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(image_rows);

void image_rows(SimdTarget simd, const ImageView& image, int64_t z, int64_t first, int64_t end,
                float* values) {
  PLC_DISPATCH(simd, image_rows)(image, z, first, end, values);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE

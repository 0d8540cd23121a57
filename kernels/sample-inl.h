// Trilinear sampling of an image, lanes are places (3.8). Included once per target.
//
// A kernel chooses the voxel's type once, outside of its loop:
//   with_voxel_type(image.form.type, [&](auto voxel) HWY_ATTR {
//     for (...) { const Floats value = sample<decltype(voxel)>(image, place); ... }
//   });
#if defined(PELLICLE_KERNELS_SAMPLE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PELLICLE_KERNELS_SAMPLE_INL_H
#undef PELLICLE_KERNELS_SAMPLE_INL_H
#else
#define PELLICLE_KERNELS_SAMPLE_INL_H
#endif

#include <array>
#include <cstring>
#include <type_traits>

#include "kernels/cells-inl.h"
#include "kernels/image.h"
#include "kernels/vectors-inl.h"

#if !PLC_SCALAR_TARGET
HWY_BEFORE_NAMESPACE();
namespace plc::kernels::HWY_NAMESPACE {

// The four voxels of a cell in one plane: two 8-byte loads, which cost less than gathers.
struct CellQuads {
  const float* plane;
  size_t row;
  const uint32_t* offset;  // of each lane's cell
  HWY_INLINE Quad operator()(uint32_t lane) const {
    const hn::Half<QuadTag> pair;
    const float* cell = plane + offset[lane];
    return hn::Combine(QuadTag(), hn::LoadU(pair, cell + row), hn::LoadU(pair, cell));
  }
};

// The voxels of every lane's cell in one plane, as floats: x and x + 1 of row y, then of row y + 1.
// Nothing is read but these voxels.
template <class Voxel>
HWY_INLINE Floats4 load_cells(const Voxel* plane, size_t row, const uint32_t* offset) {
  const FloatTag d;
  const IntTag di;
  if constexpr (sizeof(Voxel) == 4) {
    return load_transposed(CellQuads{reinterpret_cast<const float*>(plane), row, offset});
  } else if constexpr (sizeof(Voxel) == 2) {
    alignas(64) int32_t near[kLanes], far[kLanes];
    for (uint32_t lane = 0; lane < kLanes; ++lane) {
      std::memcpy(near + lane, plane + offset[lane], 4);
      std::memcpy(far + lane, plane + offset[lane] + row, 4);
    }
    const Ints a = hn::Load(di, near), b = hn::Load(di, far);
    if constexpr (std::is_signed_v<Voxel>) {
      return {hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(a))),
              hn::ConvertTo(d, hn::ShiftRight<16>(a)),
              hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(b))),
              hn::ConvertTo(d, hn::ShiftRight<16>(b))};
    } else {
      const hn::RebindToUnsigned<IntTag> du;
      const Ints low = hn::Set(di, 0xFFFF);
      const auto high = [&](Ints v) HWY_ATTR {
        return hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(du, v)));
      };
      return {hn::ConvertTo(d, hn::And(a, low)), hn::ConvertTo(d, high(a)),
              hn::ConvertTo(d, hn::And(b, low)), hn::ConvertTo(d, high(b))};
    }
  } else {
    alignas(64) uint32_t quad[kLanes];
    for (uint32_t lane = 0; lane < kLanes; ++lane) {
      uint16_t near, far;
      std::memcpy(&near, plane + offset[lane], 2);
      std::memcpy(&far, plane + offset[lane] + row, 2);
      quad[lane] = static_cast<uint32_t>(near) | static_cast<uint32_t>(far) << 16;
    }
    const hn::RebindToUnsigned<IntTag> du;
    const auto all = hn::Load(du, quad);
    const auto low = hn::Set(du, 0xFF);
    return {hn::ConvertTo(d, hn::BitCast(di, hn::And(all, low))),
            hn::ConvertTo(d, hn::BitCast(di, hn::And(hn::ShiftRight<8>(all), low))),
            hn::ConvertTo(d, hn::BitCast(di, hn::And(hn::ShiftRight<16>(all), low))),
            hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<24>(all)))};
  }
}

// The values of stored voxels; the bits of voxel_value().
template <class Voxel>
struct VoxelValues {
  Floats low, scale, least, most;
  HWY_INLINE explicit VoxelValues(const VoxelForm& form)
      : low(hn::Set(FloatTag(), form.low)),
        scale(hn::Set(FloatTag(), form.scale)),
        least(hn::Set(FloatTag(), 0.0F - form.beyond)),
        most(hn::Set(FloatTag(), 1.0F + form.beyond)) {}
  HWY_INLINE Floats operator()(Floats voxel) const {
    if constexpr (std::is_same_v<Voxel, UnitVoxel>) return voxel;
    const Floats t = hn::Mul(hn::Sub(voxel, low), scale);
    if constexpr (std::is_integral_v<Voxel>) return hn::Min(hn::Max(t, least), most);
    const Floats above = hn::IfThenElse(hn::Gt(t, least), t, least);  // of a NaN: the least
    return hn::IfThenElse(hn::Lt(above, most), above, most);
  }
};

// Voxels count as they are, so that iso-surfaces lie where they do, and what lies between them is
// of the window: a place far from the surface is pulled no more than the window tells.
HWY_INLINE Floats within_window(Floats value) {
  const FloatTag d;
  return hn::Min(hn::Max(value, hn::Zero(d)), hn::Set(d, 1.0F));
}

// Bilinear in a plane of voxels: x, then y.
template <class Voxel>
HWY_INLINE Floats sample_plane(const Voxel* plane, size_t row, const uint32_t* offset,
                               const VoxelValues<Voxel>& value, Floats x, Floats y) {
  const Floats4 cell = load_cells(plane, row, offset);
  return lerp(lerp(value(cell.x), value(cell.y), x), lerp(value(cell.z), value(cell.w), x), y);
}

// On one axis: the stored voxel nearest to one of the padded image, and whether it is that one.
struct NearestStored {
  Ints index;
  FloatMask same;
};
HWY_INLINE NearestStored nearest_stored(Ints index, int32_t dim, int32_t pad) {
  const IntTag di;
  const Ints in_store = hn::Sub(index, hn::Set(di, pad));
  const Ints nearest = hn::Min(hn::Max(in_store, hn::Zero(di)), hn::Set(di, dim - 2 * pad - 1));
  return {nearest, hn::RebindMask(FloatTag(), hn::Eq(in_store, nearest))};
}

// Any place of any image: for vectors with a lane whose cell lies in the padding or at its border,
// which are as rare as objects that the image cuts, for images of bricks, and for images of more
// voxels than 32 bits number. Rows they number always.
template <class Voxel>
HWY_NOINLINE Floats sample_padded(const ImageView& image, const Cells& x, const Cells& y,
                                  const Cells& z) {
  const FloatTag d;
  const IntTag di;
  const int32_t pad = image.form.pad;
  // On the way through the padding: between equal values lies the same value.
  const auto beyond = [&](Ints index, int32_t dim) HWY_ATTR {
    return hn::Or(hn::Gt(hn::Set(di, pad - 1), index), hn::Gt(index, hn::Set(di, dim - pad - 1)));
  };
  const Floats pad_value = hn::Set(d, image.form.pad_value);
  if (hn::AllTrue(di, hn::Or(hn::Or(beyond(x.index, image.dims[0]), beyond(y.index, image.dims[1])),
                             beyond(z.index, image.dims[2])))) {
    return pad_value;
  }
  const auto both = [&](Ints index, int32_t dim) HWY_ATTR {
    return std::array<NearestStored, 2>{nearest_stored(index, dim, pad),
                                        nearest_stored(hn::Add(index, hn::Set(di, 1)), dim, pad)};
  };
  const auto xs = both(x.index, image.dims[0]), ys = both(y.index, image.dims[1]),
             zs = both(z.index, image.dims[2]);
  const auto row = static_cast<size_t>(image.dims[0] - 2 * pad);
  const int32_t rows = image.dims[1] - 2 * pad;
  const auto* voxels = static_cast<const Voxel*>(image.data);
  const VoxelValues<Voxel> value(image.form);
  const auto corner = [&](const NearestStored& i, const NearestStored& j,
                          const NearestStored& k) HWY_ATTR {
    const hn::RebindToUnsigned<IntTag> du;
    alignas(64) uint32_t in_row[kLanes], of_row[kLanes];
    alignas(64) float voxel[kLanes];
    hn::Store(hn::BitCast(du, i.index), du, in_row);
    if (image.bricks != nullptr) {
      alignas(64) uint32_t of_plane[kLanes];
      hn::Store(hn::BitCast(du, j.index), du, of_row);
      hn::Store(hn::BitCast(du, k.index), du, of_plane);
      for (uint32_t l = 0; l < kLanes; ++l) {
        voxel[l] = static_cast<float>(
            image.bricks->template voxel<Voxel>(in_row[l], of_row[l], of_plane[l]));
      }
      return hn::IfThenElse(hn::And(hn::And(i.same, j.same), k.same), value(hn::Load(d, voxel)),
                            pad_value);
    }
    hn::Store(hn::BitCast(du, hn::Add(j.index, hn::Mul(k.index, hn::Set(di, rows)))), du, of_row);
    for (uint32_t l = 0; l < kLanes; ++l) {
      voxel[l] = static_cast<float>(voxels[size_t{of_row[l]} * row + in_row[l]]);
    }
    return hn::IfThenElse(hn::And(hn::And(i.same, j.same), k.same), value(hn::Load(d, voxel)),
                          pad_value);
  };
  const auto plane = [&](const NearestStored& k) HWY_ATTR {
    const auto along_x = [&](const NearestStored& j) HWY_ATTR {
      return lerp(corner(xs[0], j, k), corner(xs[1], j, k), x.fraction);
    };
    return lerp(along_x(ys[0]), along_x(ys[1]), y.fraction);
  };
  return within_window(lerp(plane(zs[0]), plane(zs[1]), z.fraction));
}

// The same of an image of bricks.
template <class Voxel>
HWY_NOINLINE Floats sample_bricks(const ImageView& image, const Cells& x, const Cells& y,
                                  const Cells& z) {
  const FloatTag d;
  const IntTag di;
  const int32_t pad = image.form.pad;
  alignas(64) int32_t first[3][kLanes];
  // Whether both voxels of every cell along the axis are stored.
  const auto store = [&](size_t a, Ints index) HWY_ATTR {
    const Ints in_store = hn::Sub(index, hn::Set(di, pad));
    const Ints last = hn::Set(di, image.dims[a] - 2 * pad - 1);
    hn::Store(in_store, di, first[a]);
    return hn::AllTrue(di, hn::And(hn::Gt(in_store, hn::Set(di, -1)), hn::Gt(last, in_store)));
  };
  if (!(store(0, x.index) && store(1, y.index) && store(2, z.index))) {
    return sample_padded<Voxel>(image, x, y, z);
  }
  alignas(64) float voxel[8][kLanes];
  for (uint32_t l = 0; l < kLanes; ++l) {
    image.bricks->template cell<Voxel>(
        first[0][l], first[1][l], first[2][l],
        [&](size_t c, Voxel v) { voxel[c][l] = static_cast<float>(v); });
  }
  const VoxelValues<Voxel> value(image.form);
  const auto along_x = [&](size_t c) HWY_ATTR {
    return lerp(value(hn::Load(d, voxel[c])), value(hn::Load(d, voxel[c + 1])), x.fraction);
  };
  return within_window(lerp(lerp(along_x(0), along_x(2), y.fraction),
                            lerp(along_x(4), along_x(6), y.fraction), z.fraction));
}

// The image's value at p; Voxel is that of image.form.type. The bits of the scalar twin, and of the
// same image with its padding and its values in memory as UnitVoxels.
template <class Voxel>
HWY_INLINE Floats sample(const ImageView& image, const Floats3& p) {
  const Cells x = locate(p.x, image.scale[0], image.offset[0], image.dims[0]);
  const Cells y = locate(p.y, image.scale[1], image.offset[1], image.dims[1]);
  const Cells z = locate(p.z, image.scale[2], image.offset[2], image.dims[2]);
  constexpr bool kPadded = !std::is_same_v<Voxel, UnitVoxel>;
  const Stored cells = stored<kPadded>(image, x, y, z);
  if constexpr (kPadded) {
    if (HWY_UNLIKELY(!cells.all)) {
      return image.bricks != nullptr ? sample_bricks<Voxel>(image, x, y, z)
                                     : sample_padded<Voxel>(image, x, y, z);
    }
  }
  const auto* voxels = static_cast<const Voxel*>(image.data);
  const VoxelValues<Voxel> value(image.form);
  const Floats below = sample_plane(voxels, cells.row, cells.first, value, x.fraction, y.fraction);
  const Floats above =
      sample_plane(voxels + cells.plane, cells.row, cells.first, value, x.fraction, y.fraction);
  return within_window(lerp(below, above, z.fraction));
}

}  // namespace plc::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // include guard per target

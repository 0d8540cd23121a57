#include "kernels/guided_stage.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/guided_stage.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/integrate-inl.h"
#include "kernels/ring-inl.h"
#include "kernels/sample-inl.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::guided_move;
using scalar::guided_stage;
using scalar::sized_iso_force;
#else

// What (5) is multiplied by where the size of an adaptive mesh is so much above delta.
HWY_INLINE Floats stiffness(const SurfaceForces& f, Floats above) {
  const FloatTag d;
  const Floats one = hn::Set(d, 1.0F);
  const Floats size = hn::IfThenElse(hn::Gt(above, hn::Zero(d)), hn::Add(one, above), one);
  const Floats part = hn::Div(one, hn::Mul(size, size));
  const Floats sum = hn::Add(hn::Mul(hn::Set(d, f.curvature), part), hn::Set(d, f.smoothing));
  return hn::Mul(sum, part);
}

// Where the image is sampled for the vertices i .. i + kLanes - 1.
template <bool kSized>
HWY_INLINE Floats3 sampled_place(const SurfaceForces& f, uint32_t i) {
  const Floats3 p = load_packed(f.position + i);
  if constexpr (!kSized) return p;
  const Floats3 n = load3(f.normal, i);
  return p + n * hn::Mul(hn::Set(FloatTag(), f.facets), dot(load_packed(f.laplacian + i), n));
}

// Of the image, in the middles of a vertex's edges.
template <class Voxel>
struct StarSum {
  const ImageView& image;
  Floats3 centre;
  Floats sum = hn::Zero(FloatTag());
  HWY_INLINE void add(FloatMask has_slot, const Floats3& neighbour) {
    const Floats3 middle = (centre + neighbour) * hn::Set(FloatTag(), 0.5F);
    sum = hn::Add(sum, hn::IfThenElseZero(has_slot, sample<Voxel>(image, middle)));
  }
};

// What the means over the middles of edges add to the values of the vertices i .. i + kLanes - 1.
template <class Voxel>
HWY_INLINE Floats value_from_star(const SurfaceForces& f, const Float4* sizes, Floats own,
                                  uint32_t i) {
  const FloatTag d;
  const Floats valence = load_valence(f.ring, i);
  const FloatMask in_columns = hn::Not(hn::Gt(valence, hn::Set(d, static_cast<float>(kRingSlots))));
  const Floats above = hn::Max(load_packed4(sizes + i).w, hn::Zero(d));
  const Floats part = hn::IfThenElseZero(hn::And(in_columns, hn::Gt(valence, hn::Zero(d))),
                                         hn::Min(above, hn::Set(d, f.star)));
  const FloatMask adds = hn::Gt(part, hn::Zero(d));
  if (hn::AllFalse(d, adds)) return hn::Zero(d);
  StarSum<Voxel> star{f.image, load_packed(f.position + i)};
  walk_ring(f.ring, f.position, i, valence, star);
  const Floats mean = hn::Mul(star.sum, inverse_valence(valence));
  return hn::IfThenElseZero(adds, hn::Mul(hn::Sub(mean, own), part));
}

// The inverse of the stiffness of forces on the vertices i .. i + kLanes - 1.
template <class Voxel>
HWY_INLINE Floats compliance(const SurfaceForces& f, const Float4* sizes, uint32_t i) {
  const FloatTag d;
  const Floats3 place = sampled_place<true>(f, i);
  const Floats3 reach = load3(f.normal, i) * hn::Set(d, f.reach);
  const Floats rise =
      hn::Sub(sample<Voxel>(f.image, place + reach), sample<Voxel>(f.image, place - reach));
  const Floats pull = hn::Abs(hn::Mul(rise, hn::Set(d, f.attraction / (f.reach + f.reach))));
  const Floats bend = hn::Mul(hn::Set(d, static_cast<float>(kBendStiffness)),
                              stiffness(f, load_packed4(sizes + i).w));
  // Of 0 it is infinite.
  return hn::Min(hn::Div(hn::Set(d, 1.0F), hn::Add(pull, bend)), hn::Set(d, kMostCompliance));
}

// The image's value for the vertices i .. i + kLanes - 1.
template <class Voxel, bool kSized, bool kFirst>
HWY_INLINE Floats image_value_at(const SurfaceForces& f, const Float4* sizes, uint32_t i) {
  const Floats own = sample<Voxel>(f.image, sampled_place<kSized>(f, i));
  if constexpr (!kSized) return own;
  const FloatTag d;
  if constexpr (kFirst) {
    hn::StoreU(value_from_star<Voxel>(f, sizes, own, i), d, f.from_star + i);
    hn::StoreU(compliance<Voxel>(f, sizes, i), d, f.compliance + i);
  }
  return hn::Add(own, hn::LoadU(d, f.from_star + i));
}

// (5) and (7) of the vertices i .. i + kLanes - 1.
template <bool kSized>
HWY_INLINE Floats3 surface_force(const SurfaceForces& f, const Rk4Streams& s, Floats value,
                                 uint32_t i) {
  const FloatTag d;
  const Floats valence = load_valence(f.ring, i);
  const Floats3 around = record_sum(f.ring, f.laplacian, i, valence) * inverse_valence(valence);
  const FloatMask alive = hn::Gt(valence, hn::Zero(d));
  Floats alpha = hn::Set(d, f.curvature);
  if constexpr (kSized) alpha = stiffness(f, load_packed4(s.position + i).w);
  const Floats3 bent = where(alive, (load_packed(f.laplacian + i) - around) * alpha);
  const Floats push = hn::Mul(hn::Set(d, f.attraction), hn::Sub(hn::Set(d, f.iso), value));
  const Floats3 sum = bent + load3(f.normal, i) * push;
  if constexpr (!kSized) return sum;
  return sum * hn::LoadU(d, f.compliance + i);
}

// A stage reads more streams than the hardware follows, each of them in another page, and voxels
// far from each other; what later blocks need is fetched while a block is worked on. Of a step of
// 655,000 vertices (avx512, ns per vertex and step): streams 8 blocks ahead and the voxels of the
// next block, within a task, 124; across tasks 118; 96 and 16 blocks ahead 99. Voxels fetched
// between the updates, not in a loop of their own, 120.
template <class Voxel>
HWY_INLINE void prefetch_voxels(const SurfaceForces& f, uint32_t begin) {
  const ImageView& image = f.image;
  const auto* voxels = static_cast<const Voxel*>(image.data);
  for (uint32_t i = begin; i < begin + kRingLanes; i += kLanes) {
    const Floats3 p = load_packed(f.position + i);
    const Cells x = locate(p.x, image.scale[0], image.offset[0], image.dims[0]);
    const Cells y = locate(p.y, image.scale[1], image.offset[1], image.dims[1]);
    const Cells z = locate(p.z, image.scale[2], image.offset[2], image.dims[2]);
    const Stored at = stored<!std::is_same_v<Voxel, UnitVoxel> >(image, x, y, z);
    if (!at.all) continue;
    for (uint32_t l = 0; l < kLanes; ++l) {
      const auto* voxel = voxels + at.first[l];
      prefetch(voxel);
      prefetch(voxel + at.row);
      prefetch(voxel + at.plane);
      prefetch(voxel + at.plane + at.row);
    }
  }
}

HWY_INLINE void prefetch3(const ConstFloat3s& s, uint32_t begin) {
  prefetch(s.x + begin);
  prefetch(s.y + begin);
  prefetch(s.z + begin);
}
HWY_INLINE void prefetch3(const Float3s& s, uint32_t begin) {
  prefetch3(ConstFloat3s{s.x, s.y, s.z}, begin);
}
template <int kStage>
HWY_INLINE void prefetch_block(const SurfaceForces& f, const Rk4Streams& s, uint32_t begin) {
  prefetch_ring(f.ring, begin);
  prefetch_records(f.position, begin);
  if (kStage != 0) prefetch_records(s.position, begin);
  prefetch_records(f.laplacian, begin);
  prefetch3(f.normal, begin);
  prefetch3(s.velocity, begin);
  if (kStage != 0) prefetch3(s.speed, begin);
  if (kStage > 1) prefetch3(s.moved, begin);
  if (kStage != 0) prefetch3(s.rate, begin);
}

// The samples of the image at the vertices of the blocks `first` to `end`, in their order. Not
// inlined: every stage would have it for every type of voxel, which takes half of this file's time
// to compile.
template <bool kSized, bool kFirst>
HWY_NOINLINE void sample_blocks(const SurfaceForces& f, const Float4* sizes, const Blocks& blocks,
                                size_t first, size_t end, float* values) {
  constexpr size_t kVoxelsAhead = 16;  // blocks
  with_voxel_type(f.image.form.type, [&](auto voxel) HWY_ATTR {
    using Voxel = decltype(voxel);
    for (size_t b = first; b < end; ++b) {
      if (blocks.comes(b + kVoxelsAhead)) {
        prefetch_voxels<Voxel>(f, blocks.begin(b + kVoxelsAhead));
      }
      const uint32_t begin = blocks.begin(b);
      for (uint32_t i = begin; i < begin + kRingLanes; i += kLanes, values += kLanes) {
        hn::Store(image_value_at<Voxel, kSized, kFirst>(f, sizes, i), FloatTag(), values);
      }
    }
  });
}

// visit(index of the block, samples of the image at its vertices) for every block. Sampling waits
// for memory; in a loop of its own over a few blocks more of it is under way at once.
template <bool kSized, bool kFirst, class Visit>
HWY_INLINE void visit_samples(const SurfaceForces& f, const Float4* sizes, const Blocks& blocks,
                              const Visit& visit) {
  constexpr size_t kChunk = 64;  // less than kAhead: their positions have come
  alignas(64) float values[kChunk * kRingLanes];
  for (size_t first = 0; first < blocks.count; first += kChunk) {
    const size_t end = HWY_MIN(first + kChunk, blocks.count);
    sample_blocks<kSized, kFirst>(f, sizes, blocks, first, end, values);
    for (size_t b = first; b < end; ++b) visit(b, values + (b - first) * kRingLanes);
  }
}

// The same of a stage: visit(first vertex of the block, samples).
template <int kStage, bool kSized, class Visit>
HWY_INLINE void visit_blocks(const SurfaceForces& f, const Rk4Streams& s, const Blocks& blocks,
                             const Visit& visit) {
  visit_samples<kSized, kSized && kStage == 0>(
      f, s.position, blocks, [&](size_t b, const float* values) HWY_ATTR {
        if (blocks.comes(b + kAhead)) prefetch_block<kStage>(f, s, blocks.begin(b + kAhead));
        visit(blocks.begin(b), values);
      });
}

template <int kStage, bool kSized>
HWY_INLINE void stage_blocks(const Rk4Coefficients& coefficients, const SurfaceForces& forces,
                             const Rk4Streams& streams, const Blocks& blocks) {
  const Rk4Lanes<kStage> lanes(coefficients);
  visit_blocks<kStage, kSized>(
      forces, streams, blocks, [&](uint32_t begin, const float* values) HWY_ATTR {
        for (uint32_t i = begin; i < begin + kRingLanes; i += kLanes) {
          const Floats value = hn::Load(FloatTag(), values + (i - begin));
          run_stage(lanes, streams, surface_force<kSized>(forces, streams, value, i), i);
        }
      });
}

void guided_stage(int stage, const Rk4Coefficients& coefficients, const SurfaceForces& forces,
                  const Rk4Streams& streams, const Blocks& blocks) {
  with_stage(stage, [&](auto k) HWY_ATTR {
    if (forces.sized) {
      stage_blocks<decltype(k)::value, true>(coefficients, forces, streams, blocks);
    } else {
      stage_blocks<decltype(k)::value, false>(coefficients, forces, streams, blocks);
    }
  });
}

template <bool kSized>
HWY_INLINE Movement move_blocks(const Rk4Coefficients& coefficients, const SurfaceForces& forces,
                                const Rk4Streams& streams, const MoveBound& bound,
                                const MoveStreams& ends, const Blocks& blocks) {
  const Rk4Lanes<3> lanes(coefficients);
  MoveLanes move(bound);
  visit_blocks<3, kSized>(
      forces, streams, blocks, [&](uint32_t begin, const float* values) HWY_ATTR {
        for (uint32_t part = 0; part < kRingLanes / kLanes; ++part) {
          const uint32_t i = begin + part * kLanes;
          const Floats value = hn::Load(FloatTag(), values + (i - begin));
          move.move(arrive(lanes, streams, surface_force<kSized>(forces, streams, value, i), i),
                    streams.moved, ends, begin, part);
        }
      });
  return move.total();
}

Movement guided_move(const Rk4Coefficients& coefficients, const SurfaceForces& forces,
                     const Rk4Streams& streams, const MoveBound& bound, const MoveStreams& ends,
                     const Blocks& blocks) {
  return forces.sized ? move_blocks<true>(coefficients, forces, streams, bound, ends, blocks)
                      : move_blocks<false>(coefficients, forces, streams, bound, ends, blocks);
}

template <bool kFirst>
HWY_INLINE void add_iso_force(const SurfaceForces& f, const Float4* sizes, const Blocks& blocks,
                              const Float3s& force) {
  const FloatTag d;
  const Floats iso = hn::Set(d, f.iso), attraction = hn::Set(d, f.attraction);
  visit_samples<true, kFirst>(f, sizes, blocks, [&](size_t b, const float* values) HWY_ATTR {
    const uint32_t begin = blocks.begin(b);
    for (uint32_t i = begin; i < begin + kRingLanes; i += kLanes) {
      const Floats value = hn::Load(d, values + (i - begin));
      const Floats push = hn::Mul(attraction, hn::Sub(iso, value));
      store3(load3(force, i) + load3(f.normal, i) * push, force, i);
    }
  });
}

void sized_iso_force(int stage, const SurfaceForces& f, const Float4* sizes, uint32_t begin,
                     uint32_t end, Float3s force) {
  const Blocks blocks = Blocks::range(begin, end);
  if (stage == 0) {
    add_iso_force<true>(f, sizes, blocks, force);
  } else {
    add_iso_force<false>(f, sizes, blocks, force);
  }
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(guided_stage);
HWY_EXPORT(guided_move);
HWY_EXPORT(sized_iso_force);

void guided_stage(SimdTarget simd, int stage, const Rk4Coefficients& coefficients,
                  const SurfaceForces& forces, const Rk4Streams& streams, const Blocks& blocks) {
  const BrickReads reads(forces.image.bricks);
  PLC_DISPATCH(simd, guided_stage)(stage, coefficients, forces, streams, blocks);
}

Movement guided_move(SimdTarget simd, const Rk4Coefficients& coefficients,
                     const SurfaceForces& forces, const Rk4Streams& streams, const MoveBound& bound,
                     const MoveStreams& ends, const Blocks& blocks) {
  const BrickReads reads(forces.image.bricks);
  return PLC_DISPATCH(simd, guided_move)(coefficients, forces, streams, bound, ends, blocks);
}

void sized_iso_force(SimdTarget simd, int stage, const SurfaceForces& forces, const Float4* sizes,
                     uint32_t begin, uint32_t end, Float3s force) {
  const BrickReads reads(forces.image.bricks);
  PLC_DISPATCH(simd, sized_iso_force)(stage, forces, sizes, begin, end, force);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE

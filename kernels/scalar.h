// The scalar twin of every kernel: the same operations in the same order, one value at a time.
// They are what SimdTarget::kScalar runs, what the tests compare with, and the contract of bits in
// readable form; the kernels' headers say what each function does.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/blocks.h"
#include "kernels/face_pairs.h"
#include "kernels/gradient_force.h"
#include "kernels/guided_stage.h"
#include "kernels/hash_entries.h"
#include "kernels/image.h"
#include "kernels/image_force.h"
#include "kernels/integrate.h"
#include "kernels/nearby.h"
#include "kernels/ring.h"
#include "kernels/ring_forces.h"
#include "kernels/separable.h"
#include "kernels/sobel.h"
#include "kernels/voxels.h"

namespace plc::kernels::scalar {

struct Triple {
  float x = 0, y = 0, z = 0;
};

// visit(vertex) for every vertex of the blocks.
template <typename Visit>
void for_vertices(const Blocks& blocks, const Visit& visit) {
  for (size_t b = 0; b < blocks.count; ++b) {
    const uint32_t begin = blocks.begin(b);
    for (uint32_t v = begin; v < begin + kRingLanes; ++v) visit(v);
  }
}

// Sums over the ring of one vertex, from slot 0 up. The vector kernels call them for vertices of
// valence > kRingSlots, which are too rare to be worth vectors.
Triple difference_sum(const RingView& ring, const Float4* position, uint32_t v);  // y - x
Triple record_sum(const RingView& ring, const Float4* record, uint32_t v);
Triple spring_sum(const RingView& ring, const Float4* position, float rest_length,
                  const Metric& metric, uint32_t v);
Triple normal_sum(const RingView& ring, const Float4* position, uint32_t v);  // cross products
uint8_t turned_flag(const RingView& ring, const Float4* position, const Triple& normal, float most,
                    uint32_t v);
uint8_t violation_flags(const RingView& ring, const Float4* position, float min_squared,
                        float max_squared, uint32_t v);
float length_sum(const RingView& ring, const Float4* position, const Metric& metric, uint32_t v);

// ring_forces.h
void laplacian(const RingView& ring, const Float4* position, const Blocks& blocks,
               Float4* laplacian);
void normals_and_laplacian(const RingView& ring, const Float4* position, const Blocks& blocks,
                           Float3s normal, Float4* laplacian);
void curvature_force(const RingView& ring, const Float4* laplacian, float alpha_c, uint32_t begin,
                     uint32_t end, Float3s force);
void spring_force(const RingView& ring, const Float4* position, const Springs& springs,
                  uint32_t begin, uint32_t end, Float3s force);
void normals(const RingView& ring, const Float4* position, const Blocks& blocks, Float3s normal);
void metric_normals(const Metric& metric, ConstFloat3s normal, uint32_t begin, uint32_t end,
                    Float3s stretched, Float3s step);
void turned_faces(const RingView& ring, const Float4* position, const Blocks& blocks,
                  ConstFloat3s normal, float most, uint8_t* flags);
void edge_violations(const RingView& ring, const Float4* position, float min_squared,
                     float max_squared, const Blocks& blocks, uint8_t* flags);
double edge_length_sum(const RingView& ring, const Float4* position, const Metric& metric,
                       uint32_t begin, uint32_t end);

// image_force.h
void sample_trilinear(const ImageView& image, const Float4* position, uint32_t begin, uint32_t end,
                      float* values);
void iso_force(const ImageView& image, const Float4* position, ConstFloat3s normal,
               const IsoPull& pull, uint32_t begin, uint32_t end, Float3s force);

// image_rows.h
void image_rows(const ImageView& image, int64_t z, int64_t first, int64_t end, float* values);

// blend_rows.h
void blend_rows(const std::array<const float*, 4>& rows, float y, float z, size_t begin, size_t end,
                float* out);

// gradient_force.h
void gradient_force(const GradientView& gradient, const Float4* position, ConstFloat3s normal,
                    const GradientPull& pull, uint32_t begin, uint32_t end, Float3s force);

// integrate.h
void rk4_stage(int stage, const Rk4Coefficients& coefficients, const Rk4Streams& streams,
               const ConstFloat3s& force, const Blocks& blocks);
float max_squared(const ConstFloat3s& moved, const Blocks& blocks);
Movement move(const MoveBound& bound, const Float3s& moved, const ConstFloat3s& new_velocity,
              const MoveStreams& streams, const Blocks& blocks);

// guided_stage.h
void guided_stage(int stage, const Rk4Coefficients& coefficients, const SurfaceForces& forces,
                  const Rk4Streams& streams, const Blocks& blocks);
Movement guided_move(const Rk4Coefficients& coefficients, const SurfaceForces& forces,
                     const Rk4Streams& streams, const MoveBound& bound, const MoveStreams& ends,
                     const Blocks& blocks);
void sized_iso_force(int stage, const SurfaceForces& forces, const Float4* sizes, uint32_t begin,
                     uint32_t end, Float3s force);

// nearby.h
uint32_t near_or_turned(const NearbyView& view, const NearbyQuery& query, uint32_t* hits);

// face_pairs.h
size_t face_pairs(const FaceBoxes& tree, uint32_t leaf, const uint32_t* nodes, size_t count,
                  CandidatePair* pairs);

// hash_entries.h
uint32_t entries_within(const uint32_t* ids, const CoarsePlace* places, const EntryRun* runs,
                        size_t count, const CoarseBox& box, uint32_t* out);

// voxels.h
void normalize_voxels(VoxelType type, const void* voxels, size_t count, double low, double scale,
                      float* values);
VoxelExtent voxel_extent(VoxelType type, const void* voxels, size_t count);

// separable.h
void reduce_x(const TapsView& taps, const ConstRows& in, size_t rows, const Rows& out,
              float* scratch);
void reduce_y(const TapsView& taps, size_t begin, size_t end, const ConstRows& in, const Rows& out);
void reduce_z(const float* weights, int32_t taps, const float* const* planes, size_t count,
              float* out);

// sobel.h. The first two are the halves of the third, for columns begin .. end-1: the vector kernel
// calls them for the columns that fill no vector.
void sobel_columns(const float* const* rows, size_t begin, size_t end, const SobelColumns& to);
void sobel_row(const SobelColumns& columns, size_t begin, size_t end,
               const std::array<float, 3>& scale, float* gx, float* gy, float* gz);
void sobel(const float* const* rows, size_t width, const std::array<float, 3>& scale,
           float* scratch, float* gx, float* gy, float* gz);
void bound_vectors(const float* gx, const float* gy, const float* gz, size_t count, float bound,
                   Float4* vectors);
void vector_norms(const float* gx, const float* gy, const float* gz, size_t count, float factor,
                  float* norms);

// weighted_rows.h
void weighted_rows(const float* weights, size_t taps, const float* const* rows, size_t begin,
                   size_t end, float* out);

}  // namespace plc::kernels::scalar

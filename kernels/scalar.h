// The scalar twin of every kernel: the same operations in the same order, one value at a time.
// They are what SimdTarget::kScalar runs, what the tests compare with, and the contract of bits in
// readable form; the kernels' headers say what each function does.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/image.h"
#include "kernels/integrate.h"
#include "kernels/nearby.h"
#include "kernels/ring.h"
#include "kernels/separable.h"
#include "kernels/sobel.h"
#include "kernels/voxels.h"

namespace plc::kernels::scalar {

struct Triple {
  float x = 0, y = 0, z = 0;
};

// Sums over the ring of one vertex, from slot 0 up. The vector kernels call them for vertices of
// valence > kRingSlots, which are too rare to be worth vectors.
Triple difference_sum(const RingView& ring, const Packed* position, uint32_t v);  // y - x
Triple record_sum(const RingView& ring, const Packed* record, uint32_t v);
Triple spring_sum(const RingView& ring, const Packed* position, float rest_length,
                  const Metric& metric, uint32_t v);
Triple normal_sum(const RingView& ring, const Packed* position, uint32_t v);  // cross products
uint8_t violation_flags(const RingView& ring, const Packed* position, float min_squared,
                        float max_squared, uint32_t v);
float length_sum(const RingView& ring, const Packed* position, const Metric& metric, uint32_t v);

// ring_forces.h
void laplacian(const RingView& ring, const Packed* position, uint32_t begin, uint32_t end,
               Packed* laplacian);
void curvature_force(const RingView& ring, const Packed* laplacian, float alpha_c, uint32_t begin,
                     uint32_t end, float* fx, float* fy, float* fz);
void spring_force(const RingView& ring, const Packed* position, float alpha_e, float rest_length,
                  const Metric& metric, uint32_t begin, uint32_t end, float* fx, float* fy,
                  float* fz);
void normals(const RingView& ring, const Packed* position, uint32_t begin, uint32_t end, float* nx,
             float* ny, float* nz);
void metric_normals(const Metric& metric, const float* nx, const float* ny, const float* nz,
                    uint32_t begin, uint32_t end, float* mx, float* my, float* mz, float* step_x,
                    float* step_y, float* step_z);
void edge_violations(const RingView& ring, const Packed* position, float min_squared,
                     float max_squared, uint32_t begin, uint32_t end, uint8_t* flags);
double edge_length_sum(const RingView& ring, const Packed* position, const Metric& metric,
                       uint32_t begin, uint32_t end);

// image_force.h
void sample_trilinear(const ImageView& image, const Packed* position, uint32_t begin, uint32_t end,
                      float* values);
void iso_force(const ImageView& image, const Packed* position, const float* nx, const float* ny,
               const float* nz, float coefficient, float iso, uint32_t begin, uint32_t end,
               float* fx, float* fy, float* fz);

// gradient_force.h
void gradient_force(const GradientView& gradient, const Packed* position, const float* nx,
                    const float* ny, const float* nz, float along_normal, float along_tangent,
                    const std::array<float, 3>& map, uint32_t begin, uint32_t end, float* fx,
                    float* fy, float* fz);

// integrate.h
void rk4_stage(int stage, const Rk4Coefficients& coefficients, const Rk4Streams& streams,
               uint32_t begin, uint32_t end);
float max_squared(const float* dx, const float* dy, const float* dz, uint32_t begin, uint32_t end);
void clamp_movement(float max_length, float max_speed, float* dx, float* dy, float* dz, float* vx,
                    float* vy, float* vz, uint32_t begin, uint32_t end);
void move(const float* dx, const float* dy, const float* dz, float* px, float* py, float* pz,
          Packed* packed, float* path, uint32_t begin, uint32_t end);
double normal_energy_sum(const float* dx, const float* dy, const float* dz, const float* nx,
                         const float* ny, const float* nz, uint32_t begin, uint32_t end);

// nearby.h
uint32_t near_or_turned(const NearbyView& view, const NearbyQuery& query, uint32_t* hits);

// voxels.h
void normalize_voxels(VoxelType type, const void* voxels, size_t count, double low, double scale,
                      float* values);
VoxelExtent voxel_extent(VoxelType type, const void* voxels, size_t count);

// separable.h
void reduce_x(const TapsView& taps, size_t outputs, const float* in, size_t width, size_t in_stride,
              size_t rows, float* out, size_t out_stride, float* scratch);
void reduce_y(const TapsView& taps, size_t begin, size_t end, const float* in, size_t in_stride,
              size_t width, float* out, size_t out_stride);
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
                   Packed* vectors);
void vector_norms(const float* gx, const float* gy, const float* gz, size_t count, float factor,
                  float* norms);

// weighted_rows.h
void weighted_rows(const float* weights, size_t taps, const float* const* rows, size_t begin,
                   size_t end, float* out);

}  // namespace plc::kernels::scalar

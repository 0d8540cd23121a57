// Internal forces over neighbour rings: curvature (5) and springs (6), and normals (3.8).
#pragma once
#include <cstdint>

#include "kernels/blocks.h"
#include "kernels/float3s.h"
#include "kernels/ring.h"
#include "kernels/simd.h"

// Ranges [begin, end): begin and end are multiples of kRingLanes. Output streams are written for
// every vertex of the range or of the blocks, 0 for deleted vertices and padding. Bits do not
// depend on `simd`: every vertex sums its ring from slot 0 up, one operation at a time; a mean is
// that sum times 1/valence.
namespace plc::kernels {

// laplacian[v] = mean of the neighbours of v minus v (as the mean of the differences, which keeps
// digits that a mean of coordinates far from 0 loses), w = 0.
void laplacian(SimdTarget simd, const RingView& ring, const Float4* position, const Blocks& blocks,
               Float4* laplacian);

// f = alpha_c (L(v) - mean over the ring of L), L from laplacian() over the whole mesh: eq. (5).
void curvature_force(SimdTarget simd, const RingView& ring, const Float4* laplacian, float alpha_c,
                     uint32_t begin, uint32_t end, Float3s force);

struct Springs {
  float alpha;        // alpha_e
  float rest_length;  // in the metric
  Metric metric{};
};
// f += alpha_e sum (|y - x| - rest_length) (y - x) / |y - x|: eq. (6), with lengths in the metric.
// Coincident neighbours add 0.
void spring_force(SimdTarget simd, const RingView& ring, const Float4* position,
                  const Springs& springs, uint32_t begin, uint32_t end, Float3s force);

// Unit normal, outward: the sum of the cross products of successive ring edges (the face between
// the last slot and slot 0 comes last), normalised; 0 where the sum is 0.
void normals(SimdTarget simd, const RingView& ring, const Float4* position, const Blocks& blocks,
             Float3s normal);

// Both of the above with the same bits: one walk around the ring costs little more than normals
// alone.
void normals_and_laplacian(SimdTarget simd, const RingView& ring, const Float4* position,
                           const Blocks& blocks, Float3s normal, Float4* laplacian);

// From unit normals n in mesh coordinates to unit normals m in the metric, `stretched` - area
// vectors map by the inverse of the lengths - and to the unit step along m in mesh coordinates; 0
// where n is 0:
//   k = (n.x * (1/metric.x), ...);  m = k / |k|;  step = (m.x * (1/metric.x), ...)
void metric_normals(SimdTarget simd, const Metric& metric, ConstFloat3s normal, uint32_t begin,
                    uint32_t end, Float3s stretched, Float3s step);

// flags[v]: bit 0 when some edge of v is not longer than sqrt(min_squared) (constraint (1)), bit 1
// when some edge is not shorter than sqrt(max_squared) (constraint (2)); both times the mean of the
// sizes at its ends, 1 + w.
void edge_violations(SimdTarget simd, const RingView& ring, const Float4* position,
                     float min_squared, float max_squared, const Blocks& blocks, uint8_t* flags);

// flags[v]: 1 when a face around v is turned against the unit normal n of v: with its area vector
// a (the cross product of successive ring edges) a . n <= 0 or (a . n)^2 <= most^2 |a|^2; else 0.
void turned_faces(SimdTarget simd, const RingView& ring, const Float4* position,
                  const Blocks& blocks, ConstFloat3s normal, float most, uint8_t* flags);

// Sum of the lengths in the metric of all edges seen from each vertex of the range (each edge of a
// mesh counts twice over the mesh): each ring in float, the vertices in double in the order of
// lane_sum.h.
double edge_length_sum(SimdTarget simd, const RingView& ring, const Float4* position,
                       const Metric& metric, uint32_t begin, uint32_t end);

}  // namespace plc::kernels

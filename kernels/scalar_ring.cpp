// Scalar twins of kernels/ring_forces.h.
#include <cmath>

#include "kernels/lane_sum.h"
#include "kernels/scalar.h"

namespace plc::kernels::scalar {

namespace {

Triple difference(const Float4& to, const Float4& from) {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}
Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
float squared(const Triple& a) {
  return a.x * a.x + a.y * a.y + a.z * a.z;
}

float length_in(const Metric& metric, const Triple& edge) {
  return std::sqrt(squared({edge.x * metric.x, edge.y * metric.y, edge.z * metric.z}));
}

void add(Triple& sum, const Triple& term) {
  sum.x += term.x;
  sum.y += term.y;
  sum.z += term.z;
}

// The mean is the sum times the rounded inverse: one division for three coordinates.
float inverse_valence(const RingView& ring, uint32_t v) {
  return ring.valence[v] == 0 ? 0.0F : 1.0F / static_cast<float>(ring.valence[v]);
}

}  // namespace

Triple difference_sum(const RingView& ring, const Float4* position, uint32_t v) {
  Triple sum;
  for (uint32_t k = 0; k < ring.valence[v]; ++k) {
    add(sum, difference(position[ring.slot(v, k)], position[v]));
  }
  return sum;
}

Triple record_sum(const RingView& ring, const Float4* record, uint32_t v) {
  Triple sum;
  for (uint32_t k = 0; k < ring.valence[v]; ++k) {
    const Float4& r = record[ring.slot(v, k)];
    add(sum, {r.x, r.y, r.z});
  }
  return sum;
}

Triple spring_sum(const RingView& ring, const Float4* position, float rest_length,
                  const Metric& metric, uint32_t v) {
  Triple sum;
  for (uint32_t k = 0; k < ring.valence[v]; ++k) {
    const Triple edge = difference(position[ring.slot(v, k)], position[v]);
    const float length = length_in(metric, edge);
    const float pull = length > 0.0F ? (length - rest_length) / length : 0.0F;
    add(sum, {pull * edge.x, pull * edge.y, pull * edge.z});
  }
  return sum;
}

Triple normal_sum(const RingView& ring, const Float4* position, uint32_t v) {
  Triple sum;
  const uint32_t valence = ring.valence[v];
  if (valence == 0) return sum;
  const Triple first = difference(position[ring.slot(v, 0)], position[v]);
  Triple last = first;
  for (uint32_t k = 1; k < valence; ++k) {
    const Triple edge = difference(position[ring.slot(v, k)], position[v]);
    add(sum, cross(last, edge));
    last = edge;
  }
  add(sum, cross(last, first));
  return sum;
}

uint8_t turned_flag(const RingView& ring, const Float4* position, const Triple& normal, float most,
                    uint32_t v) {
  const uint32_t valence = ring.valence[v];
  if (valence == 0) return 0;
  const auto turned = [&](const Triple& last, const Triple& edge) {
    const Triple area = cross(last, edge);
    const float along = area.x * normal.x + area.y * normal.y + area.z * normal.z;
    return along <= 0.0F || along * along <= most * most * squared(area);
  };
  const Triple first = difference(position[ring.slot(v, 0)], position[v]);
  Triple last = first;
  for (uint32_t k = 1; k < valence; ++k) {
    const Triple edge = difference(position[ring.slot(v, k)], position[v]);
    if (turned(last, edge)) return 1;
    last = edge;
  }
  return turned(last, first) ? 1 : 0;
}

uint8_t violation_flags(const RingView& ring, const Float4* position, float min_squared,
                        float max_squared, uint32_t v) {
  uint8_t flags = 0;
  for (uint32_t k = 0; k < ring.valence[v]; ++k) {
    const Float4& end = position[ring.slot(v, k)];
    const float length = squared(difference(end, position[v]));
    const float size = 1.0F + 0.5F * (position[v].w + end.w);
    if (length <= min_squared * (size * size)) flags |= 1U;
    if (length >= max_squared * (size * size)) flags |= 2U;
  }
  return flags;
}

float length_sum(const RingView& ring, const Float4* position, const Metric& metric, uint32_t v) {
  float sum = 0;
  for (uint32_t k = 0; k < ring.valence[v]; ++k) {
    sum += length_in(metric, difference(position[ring.slot(v, k)], position[v]));
  }
  return sum;
}

void laplacian(const RingView& ring, const Float4* position, const Blocks& blocks,
               Float4* laplacian) {
  for_vertices(blocks, [&](uint32_t v) {
    const Triple sum = difference_sum(ring, position, v);
    const float inverse = inverse_valence(ring, v);
    laplacian[v] = {sum.x * inverse, sum.y * inverse, sum.z * inverse, 0.0F};
  });
}

void normals_and_laplacian(const RingView& ring, const Float4* position, const Blocks& blocks,
                           Float3s normal, Float4* laplacian) {
  normals(ring, position, blocks, normal);
  scalar::laplacian(ring, position, blocks, laplacian);
}

void curvature_force(const RingView& ring, const Float4* laplacian, float alpha_c, uint32_t begin,
                     uint32_t end, Float3s force) {
  for (uint32_t v = begin; v < end; ++v) {
    const Triple sum = record_sum(ring, laplacian, v);
    const float inverse = inverse_valence(ring, v);
    const bool alive = ring.valence[v] != 0;
    force.x[v] = alive ? (laplacian[v].x - sum.x * inverse) * alpha_c : 0.0F;
    force.y[v] = alive ? (laplacian[v].y - sum.y * inverse) * alpha_c : 0.0F;
    force.z[v] = alive ? (laplacian[v].z - sum.z * inverse) * alpha_c : 0.0F;
  }
}

void spring_force(const RingView& ring, const Float4* position, const Springs& springs,
                  uint32_t begin, uint32_t end, Float3s force) {
  for (uint32_t v = begin; v < end; ++v) {
    const Triple sum = spring_sum(ring, position, springs.rest_length, springs.metric, v);
    force.x[v] = force.x[v] + springs.alpha * sum.x;
    force.y[v] = force.y[v] + springs.alpha * sum.y;
    force.z[v] = force.z[v] + springs.alpha * sum.z;
  }
}

void normals(const RingView& ring, const Float4* position, const Blocks& blocks, Float3s normal) {
  for_vertices(blocks, [&](uint32_t v) {
    const Triple sum = normal_sum(ring, position, v);
    const float length = std::sqrt(squared(sum));
    const float inverse = length > 0.0F ? 1.0F / length : 0.0F;
    normal.x[v] = sum.x * inverse;
    normal.y[v] = sum.y * inverse;
    normal.z[v] = sum.z * inverse;
  });
}

void metric_normals(const Metric& metric, ConstFloat3s normal, uint32_t begin, uint32_t end,
                    Float3s stretched, Float3s step) {
  const Triple inverse{1.0F / metric.x, 1.0F / metric.y, 1.0F / metric.z};
  for (uint32_t v = begin; v < end; ++v) {
    const Triple k{normal.x[v] * inverse.x, normal.y[v] * inverse.y, normal.z[v] * inverse.z};
    const float length = std::sqrt(squared(k));
    const float unit = length > 0.0F ? 1.0F / length : 0.0F;
    stretched.x[v] = k.x * unit;
    stretched.y[v] = k.y * unit;
    stretched.z[v] = k.z * unit;
    step.x[v] = stretched.x[v] * inverse.x;
    step.y[v] = stretched.y[v] * inverse.y;
    step.z[v] = stretched.z[v] * inverse.z;
  }
}

void turned_faces(const RingView& ring, const Float4* position, const Blocks& blocks,
                  ConstFloat3s normal, float most, uint8_t* flags) {
  for_vertices(blocks, [&](uint32_t v) {
    flags[v] = turned_flag(ring, position, {normal.x[v], normal.y[v], normal.z[v]}, most, v);
  });
}

void edge_violations(const RingView& ring, const Float4* position, float min_squared,
                     float max_squared, const Blocks& blocks, uint8_t* flags) {
  for_vertices(blocks, [&](uint32_t v) {
    flags[v] = violation_flags(ring, position, min_squared, max_squared, v);
  });
}

double edge_length_sum(const RingView& ring, const Float4* position, const Metric& metric,
                       uint32_t begin, uint32_t end) {
  double lane[kRingLanes] = {};
  for (uint32_t v = begin; v < end; ++v) {
    lane[v % kRingLanes] += static_cast<double>(length_sum(ring, position, metric, v));
  }
  return add_lanes(lane);
}

}  // namespace plc::kernels::scalar

#include "engine/measure/moments.h"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/base/blocks.h"
#include "engine/base/double3.h"
#include "engine/measure/measures.h"
#include "engine/measure/mesh_topology.h"
#include "engine/measure/symmetric_eigen.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kFaceBlock = 1024;
// Faces whose parts are kept at a time: 72 bytes each.
constexpr size_t kChunk = size_t{1} << 16;

// Integrals over a volume of x and of x x^T, from a point of reference.
struct Moments {
  double first[3] = {0, 0, 0};
  SymmetricMatrix second = {0, 0, 0, 0, 0, 0};
};

constexpr size_t kRow[6] = {0, 1, 2, 0, 1, 2};
constexpr size_t kColumn[6] = {0, 1, 2, 1, 2, 0};

void add(Moments& sum, const Moments& part) {
  for (size_t k = 0; k < 3; ++k) sum.first[k] += part.first[k];
  for (size_t k = 0; k < 6; ++k) sum.second[k] += part.second[k];
}

std::array<double, 3> array_of(const Double3& p) {
  return {p.x, p.y, p.z};
}

// Of the tetrahedron from the reference, which is the origin here, to the face.
Moments tetrahedron(const Double3& p, const Double3& q, const Double3& r) {
  const double six_volume = dot(cross(q - p, r - p), p);
  const std::array<double, 3> a = array_of(p), b = array_of(q), c = array_of(r);
  const std::array<double, 3> s = array_of(p + q + r);
  Moments m;
  for (size_t k = 0; k < 3; ++k) m.first[k] = six_volume * s[k] / 24;
  for (size_t k = 0; k < 6; ++k) {
    const size_t i = kRow[k], j = kColumn[k];
    m.second[k] = six_volume * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]) / 120;
  }
  return m;
}

// The same integrals from a reference that lies at -d from the old one.
Moments shifted(const Moments& m, double volume, const std::array<double, 3>& d) {
  Moments out = m;
  for (size_t k = 0; k < 6; ++k) {
    const size_t i = kRow[k], j = kColumn[k];
    out.second[k] += m.first[i] * d[j] + d[i] * m.first[j] + volume * d[i] * d[j];
  }
  for (size_t k = 0; k < 3; ++k) out.first[k] += volume * d[k];
  return out;
}

void set_undefined(ComponentShape& c) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::fill(std::begin(c.centroid), std::end(c.centroid), kNan);
  std::fill(std::begin(c.moments), std::end(c.moments), kNan);
  std::fill(std::begin(c.principal_moments), std::end(c.principal_moments), kNan);
  std::fill(std::begin(c.principal_axes), std::end(c.principal_axes), kNan);
}

// Central moments and axes; c.volume is set.
void set_shape(const Moments& m, const double* reference, ComponentShape& c) {
  set_undefined(c);
  if (!(c.volume < 0 || c.volume > 0)) return;
  for (size_t k = 0; k < 3; ++k) c.centroid[k] = reference[k] + m.first[k] / c.volume;
  SymmetricMatrix central{};
  for (size_t k = 0; k < 6; ++k) {
    central[k] = m.second[k] - m.first[kRow[k]] * (m.first[kColumn[k]] / c.volume);
    c.moments[k] = central[k];
  }
  const SymmetricEigen eigen = symmetric_eigen(central);
  for (size_t i = 0; i < 3; ++i) {
    c.principal_moments[i] = eigen.value[i];
    for (size_t k = 0; k < 3; ++k) c.principal_axes[3 * i + k] = eigen.axis[i][k];
  }
}

// Per component of the topology.
Vector<Moments> component_moments(const MeshArrays& mesh, const MeshTopology& topology,
                                  const Executor& executor) {
  Vector<Moments> sums(topology.components.size());
  const size_t face_count = topology.component.size();
  Vector<Moments> parts(std::min(kChunk, face_count));
  for (size_t chunk = 0; chunk < face_count; chunk += kChunk) {
    const size_t count = std::min(kChunk, face_count - chunk);
    run_blocks(executor, count, kFaceBlock, [&](size_t, size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        const size_t f = chunk + i;
        const double* o =
            mesh.corner(3 * size_t{topology.components[topology.component[f]].first_face});
        parts[i] =
            tetrahedron(difference(mesh.corner(3 * f), o), difference(mesh.corner(3 * f + 1), o),
                        difference(mesh.corner(3 * f + 2), o));
      }
    });
    for (size_t i = 0; i < count; ++i) add(sums[topology.component[chunk + i]], parts[i]);
  }
  return sums;
}

void set_boxes(const MeshArrays& mesh, const MeshTopology& topology,
               Vector<ComponentShape>& by_number) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (ComponentShape& c : by_number) {
    std::fill(std::begin(c.low), std::end(c.low), kInfinity);
    std::fill(std::begin(c.high), std::end(c.high), -kInfinity);
  }
  for (size_t i = 0; i < 3 * topology.component.size(); ++i) {
    ComponentShape& c = by_number[topology.component[i / 3]];
    for (size_t k = 0; k < 3; ++k) {
      const double x = mesh.corner(i)[k];
      c.low[k] = std::min(c.low[k], x);
      c.high[k] = std::max(c.high[k], x);
    }
  }
}

// Sums over the components in their order, from a corner of the first.
void set_whole(const MeshArrays& mesh, const Vector<Moments>& moments,
               const Vector<ComponentMeasures>& order, ShapeMeasures& shape) {
  ComponentShape& whole = shape.whole;
  if (order.empty()) {
    set_undefined(whole);
    return;
  }
  const auto reference = [&](const ComponentMeasures& c) {
    return mesh.corner(3 * static_cast<size_t>(c.first_face));
  };
  const double* origin = reference(order[0]);
  std::copy_n(shape.components[0].low, 3, whole.low);
  std::copy_n(shape.components[0].high, 3, whole.high);
  Moments sum;
  for (size_t i = 0; i < order.size(); ++i) {
    const ComponentShape& c = shape.components[i];
    for (size_t k = 0; k < 3; ++k) {
      whole.low[k] = std::min(whole.low[k], c.low[k]);
      whole.high[k] = std::max(whole.high[k], c.high[k]);
    }
    whole.area += c.area;
    whole.volume += c.volume;  // NaN where one is
    add(sum, shifted(moments[order[i].component], order[i].volume,
                     array_of(difference(reference(order[i]), origin))));
  }
  set_shape(sum, origin, whole);
}

}  // namespace

ShapeMeasures shape_measures(const MeshArrays& mesh, const Executor& executor) {
  const MeshTopology topology =
      mesh_topology(mesh.abc, mesh.face_count, mesh.vertex_count, executor);
  const Vector<ComponentMeasures> order = component_measures(mesh, topology, executor);
  const Vector<Moments> moments = component_moments(mesh, topology, executor);
  Vector<ComponentShape> by_number(topology.components.size());
  set_boxes(mesh, topology, by_number);
  ShapeMeasures shape;
  for (const ComponentMeasures& m : order) {
    const ComponentTopology& t = topology.components[m.component];
    ComponentShape c = by_number[m.component];
    c.first_face = m.first_face;
    c.vertices = m.vertices;
    c.faces = m.faces;
    c.euler = t.euler();
    c.genus = m.genus;
    c.area = m.area;
    c.volume = t.encloses ? m.volume : std::numeric_limits<double>::quiet_NaN();
    set_shape(moments[m.component], mesh.corner(3 * static_cast<size_t>(m.first_face)), c);
    shape.components.push_back(c);
  }
  const SurfaceMeasures total = total_measures(mesh.vertex_count, topology, order);
  shape.whole.vertices = total.vertices;
  shape.whole.faces = total.faces;
  shape.whole.euler = total.euler;
  shape.whole.genus = total.genus;
  set_whole(mesh, moments, order, shape);
  return shape;
}

}  // namespace plc

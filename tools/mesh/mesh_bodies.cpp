#include "tools/mesh/mesh_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace plc::tools {

namespace {

// Components of faces that share vertices, numbered as they come: of each vertex; kNone for none.
struct Components {
  std::vector<uint32_t> of_vertex;
  std::vector<uint32_t> first_vertex;
};

class UnionFind {
 public:
  explicit UnionFind(size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  uint32_t root(uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(uint32_t a, uint32_t b) {
    const uint32_t ra = root(a);
    const uint32_t rb = root(b);
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

 private:
  std::vector<uint32_t> parent_;
};

Components components_of(const TriangleMesh& mesh) {
  const size_t vertices = mesh.xyz.size() / 3;
  UnionFind sets(vertices);
  std::vector<char> used(vertices, 0);
  for (size_t i = 0; i < mesh.abc.size(); ++i) {
    used[mesh.abc[i]] = 1;
    sets.join(mesh.abc[i], mesh.abc[i - i % 3]);
  }
  Components components{std::vector<uint32_t>(vertices, Bodies::kNone), {}};
  for (uint32_t v = 0; v < vertices; ++v) {
    if (used[v] == 0) continue;
    const uint32_t root = sets.root(v);  // the smallest vertex of its set
    if (root == v) {
      components.of_vertex[v] = static_cast<uint32_t>(components.first_vertex.size());
      components.first_vertex.push_back(v);
    } else {
      components.of_vertex[v] = components.of_vertex[root];
    }
  }
  return components;
}

const double* place(const TriangleMesh& mesh, uint32_t vertex) {
  return mesh.xyz.data() + 3 * size_t{vertex};
}

// Signed, of each component, about its first vertex: far from the origin little is lost.
std::vector<double> volumes_of(const TriangleMesh& mesh, const Components& components) {
  std::vector<double> volumes(components.first_vertex.size(), 0);
  for (size_t i = 0; i < mesh.abc.size(); i += 3) {
    const uint32_t component = components.of_vertex[mesh.abc[i]];
    const double* o = place(mesh, components.first_vertex[component]);
    double v[3][3];
    for (size_t c = 0; c < 3; ++c) {
      for (size_t k = 0; k < 3; ++k) v[c][k] = place(mesh, mesh.abc[i + c])[k] - o[k];
    }
    volumes[component] += (v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                           v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                           v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0])) /
                          6;
  }
  return volumes;
}

// Which components surround the first vertex of each one: those that a ray from it along x crosses
// an odd number of times. One pass over the faces; of each, the points whose z and y it covers.
class Surroundings {
 public:
  Surroundings(const TriangleMesh& mesh, const Components& components)
      : mesh_(mesh),
        components_(components),
        by_z_(components.first_vertex.size()),
        crossings_(components.first_vertex.size()) {
    std::iota(by_z_.begin(), by_z_.end(), 0U);
    std::sort(by_z_.begin(), by_z_.end(), [&](uint32_t a, uint32_t b) { return z(a) < z(b); });
    for (size_t i = 0; i < mesh.abc.size(); i += 3) cross(mesh.abc.data() + i);
  }

  std::vector<uint32_t> around(uint32_t component) const {
    std::vector<uint32_t> found;
    for (const auto& [other, count] : crossings_[component]) {
      if (count % 2 != 0) found.push_back(other);
    }
    return found;
  }

 private:
  const double* point(uint32_t component) const {
    return place(mesh_, components_.first_vertex[component]);
  }
  double z(uint32_t component) const { return point(component)[2]; }

  void cross(const uint32_t* abc) {
    const double* p[3] = {place(mesh_, abc[0]), place(mesh_, abc[1]), place(mesh_, abc[2])};
    const double low = std::min({p[0][2], p[1][2], p[2][2]});
    const double high = std::max({p[0][2], p[1][2], p[2][2]});
    const uint32_t own = components_.of_vertex[abc[0]];
    auto at = std::lower_bound(by_z_.begin(), by_z_.end(), low,
                               [&](uint32_t c, double value) { return z(c) < value; });
    for (; at != by_z_.end() && z(*at) <= high; ++at) {
      if (*at != own && hits(abc, point(*at))) ++crossings_[*at][own];
    }
  }

  // On which side of the edge a point lies, seen along x. The same for both faces of the edge. One
  // on it is taken to lie beside it, by a very small bit along y and a much smaller one along z, so
  // that a ray through an edge or a vertex crosses as many faces as one beside it.
  bool left_of(uint32_t a, uint32_t b, const double* q) const {
    const bool turned = a > b;
    if (turned) std::swap(a, b);
    const double* p = place(mesh_, a);
    const double* r = place(mesh_, b);
    const double side = (r[1] - p[1]) * (q[2] - p[2]) - (r[2] - p[2]) * (q[1] - p[1]);
    const double moved = side != 0 ? side : r[2] != p[2] ? p[2] - r[2] : r[1] - p[1];
    return (moved > 0) != turned;
  }

  bool hits(const uint32_t* abc, const double* q) const {
    const bool first = left_of(abc[0], abc[1], q);
    if (first != left_of(abc[1], abc[2], q) || first != left_of(abc[2], abc[0], q)) return false;
    // Where the ray meets the face's plane; the point is not on the face, as it is another
    // component's.
    double u[3], v[3], w[3];
    for (size_t k = 0; k < 3; ++k) {
      u[k] = place(mesh_, abc[1])[k] - place(mesh_, abc[0])[k];
      v[k] = place(mesh_, abc[2])[k] - place(mesh_, abc[0])[k];
      w[k] = q[k] - place(mesh_, abc[0])[k];
    }
    const double nx = u[1] * v[2] - u[2] * v[1];
    const double ny = u[2] * v[0] - u[0] * v[2];
    const double nz = u[0] * v[1] - u[1] * v[0];
    const double above = nx * w[0] + ny * w[1] + nz * w[2];
    return nx > 0 ? above < 0 : nx < 0 && above > 0;
  }

  const TriangleMesh& mesh_;
  const Components& components_;
  std::vector<uint32_t> by_z_;
  std::vector<std::map<uint32_t, int>> crossings_;
};

template <typename T>
std::vector<T> vertices_kept(const std::vector<T>& values, const std::vector<char>& kept,
                             size_t each) {
  std::vector<T> out;
  for (size_t i = 0; i < values.size(); ++i) {
    if (kept[i / each] != 0) out.push_back(values[i]);
  }
  return out;
}

}  // namespace

Bodies bodies_of(const TriangleMesh& mesh) {
  const Components components = components_of(mesh);
  const std::vector<double> volumes = volumes_of(mesh, components);
  const Surroundings surroundings(mesh, components);
  const auto count = static_cast<uint32_t>(volumes.size());
  std::vector<uint32_t> outer(count);  // the component that faces outward of each one's body
  for (uint32_t c = 0; c < count; ++c) {
    const std::vector<uint32_t> around = surroundings.around(c);
    const auto smallest = std::min_element(
        around.begin(), around.end(),
        [&](uint32_t a, uint32_t b) { return std::abs(volumes[a]) < std::abs(volumes[b]); });
    outer[c] = around.size() % 2 == 0 ? c : *smallest;
  }
  std::vector<uint32_t> number(count, Bodies::kNone);
  Bodies bodies;
  for (uint32_t c = 0; c < count; ++c) {
    if (outer[c] != c) continue;
    number[c] = static_cast<uint32_t>(bodies.volumes.size());
    bodies.volumes.push_back(0);
  }
  for (uint32_t c = 0; c < count; ++c) bodies.volumes[number[outer[c]]] += volumes[c];
  bodies.of_vertex = components.of_vertex;
  for (uint32_t& body : bodies.of_vertex) {
    if (body != Bodies::kNone) body = number[outer[body]];
  }
  return bodies;
}

TriangleMesh part_of(const TriangleMesh& mesh, const Bodies& bodies,
                     const std::vector<char>& kept) {
  const size_t vertices = mesh.xyz.size() / 3;
  std::vector<char> wanted(vertices, 0);
  std::vector<uint32_t> renumbered(vertices, 0);
  uint32_t next = 0;
  for (size_t v = 0; v < vertices; ++v) {
    const uint32_t body = bodies.of_vertex[v];
    if (body == Bodies::kNone || kept[body] == 0) continue;
    wanted[v] = 1;
    renumbered[v] = next++;
  }
  TriangleMesh part;
  part.doubles = mesh.doubles;
  part.space = mesh.space;
  part.xyz = vertices_kept(mesh.xyz, wanted, 3);
  part.normals = vertices_kept(mesh.normals, wanted, 3);
  for (const Scalars& scalars : mesh.scalars) {
    part.scalars.push_back({scalars.name, vertices_kept(scalars.values, wanted, 1)});
  }
  for (size_t i = 0; i < mesh.abc.size(); ++i) {
    if (wanted[mesh.abc[i - i % 3]] != 0) part.abc.push_back(renumbered[mesh.abc[i]]);
  }
  return part;
}

}  // namespace plc::tools

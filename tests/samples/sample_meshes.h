// Meshes with known properties for the tests.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "engine/base/mesh_arrays.h"
#include "pyramid/buffer.h"
#include "pyramid/memory.h"

namespace samples {

// A buffer with these values.
template <typename T, typename Values>
plc::Buffer<T> buffer_of(const Values& values) {
  plc::Buffer<T> buffer(values.size());
  std::transform(values.begin(), values.end(), buffer.begin(),
                 [](auto value) { return static_cast<T>(value); });
  return buffer;
}

struct Soup {
  std::vector<double> xyz;
  plc::Vector<uint32_t> abc;

  size_t vertex_count() const { return xyz.size() / 3; }
  size_t face_count() const { return abc.size() / 3; }
  plc::MeshArrays arrays() const { return {xyz.data(), vertex_count(), abc.data(), face_count()}; }
  uint32_t vertex(double x, double y, double z) {
    for (const double value : {x, y, z}) xyz.push_back(value);
    return static_cast<uint32_t>(vertex_count() - 1);
  }
  void face(uint32_t a, uint32_t b, uint32_t c) {
    for (const uint32_t v : {a, b, c}) abc.push_back(v);
  }
  // The other mesh beside this one.
  void append(const Soup& other) {
    const auto base = static_cast<uint32_t>(vertex_count());
    xyz.insert(xyz.end(), other.xyz.begin(), other.xyz.end());
    for (const uint32_t v : other.abc) abc.push_back(base + v);
  }
};

inline Soup moved(Soup m, double x, double y, double z, double scale = 1) {
  for (size_t i = 0; i < m.xyz.size(); i += 3) {
    m.xyz[i] = m.xyz[i] * scale + x;
    m.xyz[i + 1] = m.xyz[i + 1] * scale + y;
    m.xyz[i + 2] = m.xyz[i + 2] * scale + z;
  }
  return m;
}

inline Soup flipped(Soup m) {
  for (size_t i = 0; i < m.abc.size(); i += 3) std::swap(m.abc[i + 1], m.abc[i + 2]);
  return m;
}

// The cube [0, 1]^3, 8 vertices, 12 faces.
inline Soup cube() {
  Soup m;
  for (int i = 0; i < 8; ++i) m.vertex(i & 1, i >> 1 & 1, i >> 2 & 1);
  constexpr uint32_t kQuads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : kQuads) {
    m.face(q[0], q[1], q[2]);
    m.face(q[0], q[2], q[3]);
  }
  return m;
}

inline Soup octahedron() {
  Soup m;
  m.xyz = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
  m.abc = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  return m;
}

// The unit sphere: an octahedron whose faces are divided in four `levels` times; 8 * 4^levels
// faces.
inline Soup sphere(int levels) {
  Soup m = octahedron();
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const plc::Vector<uint32_t> old = std::move(m.abc);
    m.abc.clear();
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [it, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, 0U);
      if (fresh) {
        std::array<double, 3> p{};
        for (size_t k = 0; k < 3; ++k) p[k] = m.xyz[3 * a + k] + m.xyz[3 * b + k];
        const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        it->second = m.vertex(p[0] / length, p[1] / length, p[2] / length);
      }
      return it->second;
    };
    for (size_t i = 0; i < old.size(); i += 3) {
      const uint32_t a = old[i], b = old[i + 1], c = old[i + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      m.face(a, ab, ca);
      m.face(ab, b, bc);
      m.face(ca, bc, c);
      m.face(ab, bc, ca);
    }
  }
  return m;
}

// Around the z axis: tube of radius `minor` at distance `major`; 2 nu nv faces.
inline Soup torus(uint32_t nu, uint32_t nv, double major, double minor) {
  constexpr double kPi = 3.14159265358979323846;
  Soup m;
  for (uint32_t i = 0; i < nu; ++i) {
    for (uint32_t j = 0; j < nv; ++j) {
      const double u = 2 * kPi * i / nu, v = 2 * kPi * j / nv;
      const double distance = major + minor * std::cos(v);
      m.vertex(distance * std::cos(u), distance * std::sin(u), minor * std::sin(v));
    }
  }
  const auto id = [&](uint32_t i, uint32_t j) { return i % nu * nv + j % nv; };
  for (uint32_t i = 0; i < nu; ++i) {
    for (uint32_t j = 0; j < nv; ++j) {
      m.face(id(i, j), id(i + 1, j), id(i + 1, j + 1));
      m.face(id(i, j), id(i + 1, j + 1), id(i, j + 1));
    }
  }
  return m;
}

}  // namespace samples

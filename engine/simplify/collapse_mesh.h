// A closed oriented mesh whose edges are collapsed one by one: faces, what lies across each edge,
// and a corner of each vertex.
//
//   corner c = 3 f + k of face f    abc[c] its vertex, across[c] the corner opposite to the same
//                                   edge in the neighbouring face; 4 + 4 bytes
//   vertex v                        three doubles and one corner; 28 bytes
//
// Ids stay as they are: a collapse of (u, v) leaves u, and two faces die.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "engine/measure/cover.h"
#include "engine/measure/vertex_corners.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

inline constexpr uint32_t kNoCorner = 0xffffffffU;

class CollapseMesh {
 public:
  // The mesh is closed, oriented and manifold.
  CollapseMesh(const MeshArrays& mesh, const Executor& executor);

  size_t vertex_count() const { return xyz_.size() / 3; }  // dead ones too
  size_t face_count() const { return abc_.size() / 3; }
  size_t living_vertices() const { return living_vertices_; }
  size_t living_faces() const { return living_faces_; }
  bool vertex_lives(uint32_t v) const { return corner_of_[v] != kNoCorner; }
  bool face_lives(uint32_t f) const { return across_[3 * static_cast<size_t>(f)] != kNoCorner; }

  const double* xyz() const { return xyz_.data(); }
  const uint32_t* abc() const { return abc_.data(); }
  const uint32_t* face(uint32_t f) const { return abc_.data() + 3 * static_cast<size_t>(f); }
  Double3 at(uint32_t v) const { return point_of(xyz_.data(), v); }
  Corners3 corners(uint32_t f) const { return {at(face(f)[0]), at(face(f)[1]), at(face(f)[2])}; }
  uint32_t vertex(uint32_t corner) const { return abc_[corner]; }
  uint32_t across(uint32_t corner) const { return across_[corner]; }

  // visit(corner of v), counter-clockwise, once for each face of v.
  template <typename Visit>
  void around(uint32_t v, const Visit& visit) const {
    uint32_t c = corner_of_[v];
    do {
      visit(c);
      c = next_corner(across_[next_corner(c)]);
    } while (c != corner_of_[v]);
  }
  // The corner of u whose face has v next; kNoCorner where there is no such edge.
  uint32_t corner_to(uint32_t u, uint32_t v) const;
  // The edge from this corner to the next becomes its first vertex, u, at a place. The caller has
  // made sure that u and v have no neighbours in common but the two across their faces, and that
  // these have more than three.
  void collapse(uint32_t corner, const Double3& place);

 private:
  void join(uint32_t dying);

  Buffer<double> xyz_;
  Buffer<uint32_t> abc_, across_, corner_of_;
  size_t living_vertices_ = 0, living_faces_ = 0;
};

}  // namespace plc

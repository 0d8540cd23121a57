// Whether two faces of a mesh meet elsewhere than in the vertex or edge they share; exact.
//
// What counts, by the number of vertices the faces have in common (by id, not by position):
//   0  any common point, touching included, and so two vertices of different ids at one place;
//   1  any common point but the vertex;
//   2  only when coplanar with both apexes on the same side of the edge (folded back); two faces
//      across an edge in different planes meet nowhere else;
//   3  always.
// A face of exactly zero area (a repeated id included) meets nothing: it is a fault of its own
// kind, found by collinear(), and its neighbours would otherwise be blamed for it.
//
// All functions are exact on the given coordinates within the range of predicates.h, have no state
// and are thread-safe.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/base/four.h"
#include "engine/exact/predicates.h"
#include "kernels/ring.h"

namespace plc {

// A face by value: corners and their vertex ids. For faces that are not in a mesh yet.
struct Triangle {
  Point3 corner[3];
  uint32_t vertex[3];
};

inline Point3 to_point(const Float4& p) {
  return {p.x, p.y, p.z};
}
inline Point3 to_point(const double* xyz) {
  return {xyz[0], xyz[1], xyz[2]};
}

inline Triangle make_triangle(const Float4* positions, const uint32_t* abc) {
  return {{to_point(positions[abc[0]]), to_point(positions[abc[1]]), to_point(positions[abc[2]])},
          {abc[0], abc[1], abc[2]}};
}
// xyz: three doubles per vertex.
inline Triangle make_triangle(const double* xyz, const uint32_t* abc) {
  return {{to_point(xyz + 3 * static_cast<size_t>(abc[0])),
           to_point(xyz + 3 * static_cast<size_t>(abc[1])),
           to_point(xyz + 3 * static_cast<size_t>(abc[2]))},
          {abc[0], abc[1], abc[2]}};
}

bool triangles_intersect(const Triangle& f, const Triangle& g);

// A closed box of floats; the fourth lane is 0 and makes comparisons one vector wide.
struct alignas(32) FaceBox {
  float low[4];
  float high[4];
};

inline FaceBox face_box(const Float4& a, const Float4& b, const Float4& c) {
  const Four pa = load_four(a), pb = load_four(b), pc = load_four(c);
  FaceBox box;
  store_four(min_four(min_four(pa, pb), pc), box.low);
  store_four(max_four(max_four(pa, pb), pc), box.high);
  return box;
}
inline FaceBox face_box(const Float4* positions, const uint32_t* abc) {
  return face_box(positions[abc[0]], positions[abc[1]], positions[abc[2]]);
}

inline bool boxes_overlap(const FaceBox& f, const FaceBox& g) {
  return overlap_four(load_four(f.low), load_four(f.high), load_four(g.low), load_four(g.high));
}

// The faces f and g (three ids each) of a mesh of floats. Boxes first: the cheapest way to no.
// Faces that are tested against many others are better served by keeping their FaceBox.
inline bool faces_intersect(const Float4* positions, const uint32_t* f, const uint32_t* g) {
  return boxes_overlap(face_box(positions, f), face_box(positions, g)) &&
         triangles_intersect(make_triangle(positions, f), make_triangle(positions, g));
}

}  // namespace plc

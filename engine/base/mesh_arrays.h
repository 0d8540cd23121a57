// The arrays of a triangle mesh, borrowed: what functions on a mesh other than the engine's own
// take.
#pragma once
#include <cstddef>
#include <cstdint>

namespace plc {

// xyz: three finite values per vertex; abc: three indices below vertex_count per face. Either may
// be NULL where there are none.
template <typename Real>
struct MeshArraysOf {
  const Real* xyz;
  size_t vertex_count;
  const uint32_t* abc;
  size_t face_count;

  const Real* point(size_t vertex) const { return xyz + 3 * vertex; }
  const uint32_t* face(size_t f) const { return abc + 3 * f; }
  // Of corner c = 3 f + k: corner k of face f.
  const Real* corner(size_t c) const { return point(abc[c]); }
};

using MeshArrays = MeshArraysOf<double>;

// Of two containers: coordinates one after the other, indices one after the other.
template <typename Points, typename Faces>
MeshArraysOf<typename Points::value_type> arrays_of(const Points& xyz, const Faces& abc) {
  return {xyz.data(), xyz.size() / 3, abc.data(), abc.size() / 3};
}

}  // namespace plc

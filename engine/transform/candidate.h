// A transformation that a violated constraint asks for, found by reading only.
#pragma once
#include <cstdint>
#include <cstring>

#include "engine/transform/annular.h"
#include "engine/transform/edge.h"

namespace plc {

// In the order in which they are resolved: annular before axial (3.3).
enum class Operation : uint8_t {
  kAnnular,    // cycle u, v, a, or u, v, a, b: see cycle()
  kDeletion,   // of edge u-v
  kInversion,  // of edge u-v
  kCreation,   // on edge u-v
  kAxial       // between u and v
};

struct Candidate;
// Whether no vertex would get more neighbours than it may have; axial ones with a few to spare.
bool fits_neighbors(const Mesh& mesh, const Candidate& candidate);
// Of a patch: whether it leaves all held vertices, and all faces of three of them, as they are.
bool spares_held(const Mesh& mesh, const Candidate& candidate);
// Whether a vertex of it has turned too often for it (turns.h): what goes round in circles stays as
// it is, rather joined than cut. Then its vertices are to be frozen.
bool goes_in_circles(const Mesh& mesh, const Candidate& candidate);
void freeze(Mesh& mesh, const Candidate& candidate);

struct Candidate {
  Operation operation;
  float key;  // squared length or distance; negated where the longest comes first
  Edge edge;

  // Of an annular one. b is no vertex where the cycle has three edges.
  static constexpr uint32_t kNoVertex = ~0U;
  Cycle cycle() const { return {{edge.u, edge.v, edge.a, edge.b}, edge.b == kNoVertex ? 3U : 4U}; }

  // The total order of a pass: two that compare equal are the same.
  friend bool operator<(const Candidate& l, const Candidate& r) {
    const uint64_t of_l = l.rank(), of_r = r.rank();
    if (of_l != of_r) return of_l < of_r;
    return l.ends() != r.ends() ? l.ends() < r.ends() : l.others() < r.others();
  }

 private:
  // In the order of the operation, then of the key: floats of one sign have the order of their
  // bits.
  uint64_t rank() const {
    uint32_t bits;
    std::memcpy(&bits, &key, sizeof bits);
    bits ^= key < 0 ? ~0U : 1U << 31;
    return uint64_t{static_cast<uint8_t>(operation)} << 32 | bits;
  }
  uint64_t ends() const { return uint64_t{edge.u} << 32 | edge.v; }
  uint64_t others() const { return uint64_t{edge.a} << 32 | edge.b; }
};

// The key: squared length of an edge of it.
inline Candidate cut_along(const Cycle& cycle, float key) {
  const uint32_t last = cycle.size == 4 ? cycle.corner[3] : Candidate::kNoVertex;
  return {Operation::kAnnular, key, {cycle.corner[0], cycle.corner[1], cycle.corner[2], last}};
}

}  // namespace plc

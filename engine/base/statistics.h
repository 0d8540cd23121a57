// What happened on a level: counts of transformations, seconds, energies.
#pragma once
#include <cstdint>

namespace plc {

struct OperationCounts {
  int64_t creation = 0, inversion = 0, deletion = 0, annular = 0, axial = 0, tetrahedron = 0;
  int64_t refinement = 0;  // global refinements (3.4)
  int64_t deferred = 0;    // put off to the next iteration by a limit or by the embedding guard
  int64_t refused = 0;     // transformations that would have made the surface meet itself
  int64_t reverted = 0;    // movements taken back for the same reason, in vertices
  int64_t moves = 0;       // of single vertices, those in blocks that are awake
  int64_t checks = 0;      // of single vertices' constraints, after a movement

  int64_t transformations() const {
    return creation + inversion + deletion + annular + axial + tetrahedron;
  }
};

struct Seconds {
  double topology = 0, normals = 0, dynamics = 0, total = 0;
};

}  // namespace plc

// A surface of fewer faces: all vertices in a cube of a grid become one.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "tools/blocks/chunk_grid.h"

namespace plc::tools {

// Rossignac and Borrel, Multi-resolution 3D approximations for rendering complex scenes, 1993. The
// vertex of a cube is the mean of all corners of faces that lie in it. A face with corners in fewer
// than three cubes goes; faces between the same cubes that face each other go, too. What is left of
// a closed surface is closed, and nowhere farther from it than the diagonal of a cube.
//
// A vertex follows from the cube's own faces alone, which are added in the same order wherever they
// are: whoever has added all of them finds it at the same place, to the bit.
class VertexClusters {
 public:
  VertexClusters(double origin, double side) : origin_(origin), side_(side) {}

  // The number of the cluster, a new one where there has been none.
  uint32_t index_at(const Place& place);
  uint32_t index_of(const Int3& cube);
  void add(uint32_t cluster, const Place& sum, uint64_t count);
  void add_face(uint32_t a, uint32_t b, uint32_t c);

  // Faces that are left, in an order that follows from that of the calls; they are then as if they
  // had been added so. `above`: this, with cubes twice as wide.
  void settle();
  VertexClusters above() const;

  struct Face {
    uint32_t a, b, c;  // outward
  };
  const std::vector<Face>& faces() const { return faces_; }
  size_t size() const { return clusters_.size(); }
  struct Cluster {
    Int3 cube;
    Place sum{};
    uint64_t count = 0;
  };
  const Cluster& cluster(uint32_t index) const { return clusters_[index]; }
  Place place(uint32_t index) const;
  Triangle triangle(const Face& face) const {
    return {place(face.a), place(face.b), place(face.c)};
  }

 private:
  double origin_, side_;
  std::vector<Cluster> clusters_;
  std::vector<Face> faces_;
  std::unordered_map<uint64_t, uint32_t> index_;
};

}  // namespace plc::tools

// Which vertices of a mesh have been woken.
#pragma once
#include "engine/mesh/mesh.h"
#include "engine/mesh/vertex_bytes.h"

namespace samples {

// Counts from when it is made; vertices that are created are awake.
class Woken {
 public:
  explicit Woken(plc::Mesh& mesh) : woken_(mesh, 1, plc::VertexBytes::Reset::kWoken) {
    woken_.fill(0);
  }
  bool operator[](uint32_t v) const { return woken_[v] != 0; }

 private:
  plc::VertexBytes woken_;
};

}  // namespace samples

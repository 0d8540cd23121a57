// Shaded pictures of triangle meshes, by ray tracing; no display is needed.
#pragma once
#include <cstdint>
#include <vector>

#include "tools/mesh_io.h"

namespace plc::tools {

// Rows from top to bottom, 8-bit sRGB.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> rgb;

  Picture(int w, int h);
};

// Degrees. Azimuth 0 looks from -y (the front of a patient in LPS), 90 from +x (the left);
// elevation 90 looks from +z (the top).
struct View {
  double azimuth = 0;
  double elevation = 0;
};

// A mesh made ready for pictures. The mesh is copied.
class Renderer {
 public:
  // Throws Failure where the mesh has no face or a coordinate that is not finite in float.
  explicit Renderer(const TriangleMesh& mesh);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Draws the whole mesh, as large as fits, into the square of `size` pixels at (left, top). The
  // same bits for any number of threads.
  void draw(const View& view, Picture& picture, int left, int top, int size) const;

 private:
  struct Scene;
  Scene* scene_;
};

}  // namespace plc::tools

// Shaded pictures of triangle meshes, by ray tracing; no display is needed.
#pragma once
#include <cstddef>
#include <string>
#include <utility>

#include "tools/file/shared_bytes.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

// Rows from top to bottom, 8-bit sRGB.
struct Picture {
  int width = 0;
  int height = 0;
  SharedBytes rgb;

  Picture(int w, int h);
  Picture(int w, int h, SharedBytes pixels) : width(w), height(h), rgb(std::move(pixels)) {}
};

// Of a picture.
size_t pixel_bytes(int width, int height);

// Degrees. Azimuth 0 looks from -y (the front of a patient in LPS), 90 from +x (the left);
// elevation 90 looks from +z (the top).
struct View {
  double azimuth = 0;
  double elevation = 0;
};

// A mesh made ready for pictures. The mesh is copied.
class Renderer {
 public:
  // Throws Failure, which names `path`, where there is nothing to draw or a coordinate is not
  // finite.
  Renderer(const std::string& path, const TriangleMesh& mesh);
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

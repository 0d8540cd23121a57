// One HTML file with an image and surfaces in it, which needs nothing else.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tools/mesh/mesh_io.h"
#include "tools/view/grey_image.h"
#include "tools/view/page_source.h"

namespace plc::tools {

// A surface in patient space (LPS, mm).
struct ViewedSurface {
  std::string name;
  TriangleMesh mesh;
};

struct ViewedScene {
  std::string name;  // of the image
  plc_image image{};
  GreyImage grey;
  std::vector<ViewedSurface> surfaces;
  std::vector<std::string> notes;  // lines that the page shows, too
  std::string version;             // of the program
};

// Throws Failure, which names `path`, where the mesh has no face, or a coordinate that no float
// holds.
void check_surface(const std::string& path, const TriangleMesh& mesh);

// Whether the box around a surface in LPS and the image have nothing in common.
bool is_outside(const plc_image& image, const TriangleMesh& mesh);

// Written beside its target and renamed. Returns its size in bytes. Throws Failure.
uint64_t write_page(const std::string& path, const PageSource& source, const ViewedScene& scene);

}  // namespace plc::tools

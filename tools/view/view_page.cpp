#include "tools/view/view_page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"
#include "tools/view/packed.h"
#include "tools/volume/volume_frame.h"

namespace plc::tools {

namespace {

using Json = nlohmann::ordered_json;

// Names come from files: nothing in them may end the element that the text stands in.
std::string script_text(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

// The page's data: packed arrays, which the scene refers to by their numbers, and the scene itself.
class PageData {
 public:
  PageData(const std::string& path, const PageSource& source) : file_(path) { put(source.before); }

  // The array's number.
  int add(const std::string& packed) {
    put("<script type=\"text/plain\" id=\"array-" + std::to_string(count_) + "\">");
    put(packed);
    put("</script>\n");
    return count_++;
  }
  uint64_t finish(const Json& scene, const PageSource& source) {
    put("<script type=\"application/json\" id=\"scene\">" + script_text(scene) + "</script>\n");
    put(source.after);
    file_.commit();
    return size_;
  }

 private:
  void put(std::string_view text) {
    file_.write(text);
    size_ += text.size();
  }
  AtomicFile file_;
  uint64_t size_ = 0;
  int count_ = 0;
};

// The middle of the image, in LPS.
Place middle_of(const plc_image& image) {
  Place voxel;
  for (size_t axis = 0; axis < 3; ++axis) {
    voxel[axis] = static_cast<double>(image.dims[axis] - 1) / 2;
  }
  return lps_of(image, voxel);
}

// From voxels to mm, by rows.
std::array<double, 9> matrix_of(const plc_image& image) {
  std::array<double, 9> matrix{};
  for (size_t i = 0; i < 9; ++i) matrix[i] = image.direction[i] * image.spacing[i % 3];
  return matrix;
}

Json image_json(const ViewedScene& scene, const Place& middle, PageData& data) {
  const plc_image& image = scene.image;
  const GreyImage& grey = scene.grey;
  return {{"name", scene.name},
          {"dims", {image.dims[0], image.dims[1], image.dims[2]}},
          {"spacing", {image.spacing[0], image.spacing[1], image.spacing[2]}},
          {"matrix", matrix_of(image)},
          {"origin", {image.origin[0], image.origin[1], image.origin[2]}},
          {"middle", middle},
          {"exact", grey.exact},
          {"range", {grey.low, grey.high}},
          {"window", {grey.window.low, grey.window.high}},
          {"reduction", grey.reduction},
          {"grid", grey.dims},
          {"greys", data.add(packed_greys(grey.voxels))}};
}

// Relative to the middle of the image, where floats hold them to a few millionths of its size.
Json surface_json(const ViewedSurface& surface, const Place& middle, PageData& data) {
  const TriangleMesh& mesh = surface.mesh;
  const size_t count = mesh.xyz.size() / 3;
  std::vector<float> points(mesh.xyz.size());
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    points[i % 3 * count + i / 3] = static_cast<float>(mesh.xyz[i] - middle[i % 3]);
  }
  Json values = Json::array();
  for (const Scalars& scalars : mesh.scalars) {
    values.push_back({{"name", scalars.name}, {"array", data.add(packed_floats(scalars.values))}});
  }
  return {{"name", surface.name},
          {"vertices", count},
          {"faces", mesh.abc.size() / 3},
          {"points", data.add(packed_floats(points))},
          {"corners", data.add(packed_indices(mesh.abc))},
          {"values", values}};
}

}  // namespace

void check_surface(const std::string& path, const TriangleMesh& mesh) {
  if (mesh.abc.empty()) throw Failure{path + ": has no face: there is nothing to show"};
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    if (!(std::abs(mesh.xyz[i]) <= static_cast<double>(std::numeric_limits<float>::max()))) {
      throw Failure{path + ": its point " + std::to_string(i / 3) + " is nowhere (" +
                    std::to_string(mesh.xyz[i]) + ")"};
    }
  }
}

bool is_outside(const plc_image& image, const TriangleMesh& mesh) {
  constexpr double kMost = std::numeric_limits<double>::max();
  Place low = {kMost, kMost, kMost};
  Place high = {-kMost, -kMost, -kMost};
  for (size_t i = 0; i + 2 < mesh.xyz.size(); i += 3) {
    const Place voxel = voxel_of(image, {mesh.xyz[i], mesh.xyz[i + 1], mesh.xyz[i + 2]});
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], voxel[axis]);
      high[axis] = std::max(high[axis], voxel[axis]);
    }
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    if (high[axis] < -0.5 || low[axis] > static_cast<double>(image.dims[axis]) - 0.5) return true;
  }
  return false;
}

uint64_t write_page(const std::string& path, const PageSource& source, const ViewedScene& scene) {
  PageData data(path, source);
  const Place middle = middle_of(scene.image);
  Json json = {{"version", scene.version}, {"notes", scene.notes}};
  json["image"] = image_json(scene, middle, data);
  json["surfaces"] = Json::array();
  for (const ViewedSurface& surface : scene.surfaces) {
    json["surfaces"].push_back(surface_json(surface, middle, data));
  }
  return data.finish(json, source);
}

}  // namespace plc::tools

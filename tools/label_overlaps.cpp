#include "tools/label_overlaps.h"

#include <algorithm>
#include <array>
#include <limits>

#include "tools/command_check.h"

namespace plc::tools {

namespace {

struct Box {
  std::array<double, 3> low, high;

  double volume() const { return (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]); }
};

Box box_of(const TriangleMesh& mesh) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    box.low[i % 3] = std::min(box.low[i % 3], mesh.xyz[i]);
    box.high[i % 3] = std::max(box.high[i % 3], mesh.xyz[i]);
  }
  return box;
}

bool apart(const Box& a, const Box& b) {
  for (size_t axis = 0; axis < 3; ++axis) {
    if (a.high[axis] < b.low[axis] || b.high[axis] < a.low[axis]) return true;
  }
  return false;
}

void append(TriangleMesh& all, const TriangleMesh& mesh) {
  const auto first = static_cast<uint32_t>(all.xyz.size() / 3);
  all.xyz.insert(all.xyz.end(), mesh.xyz.begin(), mesh.xyz.end());
  for (const uint32_t corner : mesh.abc) all.abc.push_back(first + corner);
}

}  // namespace

bool disjoint(plc_context* context, const std::vector<const TriangleMesh*>& meshes) {
  TriangleMesh all;
  for (const TriangleMesh* mesh : meshes) append(all, *mesh);
  return check_of(context, all).valid != 0;
}

std::vector<Overlap> find_overlaps(plc_context* context,
                                   const std::vector<const TriangleMesh*>& meshes,
                                   const std::vector<char>& changed) {
  std::vector<Box> boxes;
  boxes.reserve(meshes.size());
  for (const TriangleMesh* mesh : meshes) boxes.push_back(box_of(*mesh));
  std::vector<Overlap> overlaps;
  for (size_t i = 0; i < meshes.size(); ++i) {
    if (meshes[i]->abc.empty()) continue;
    if (changed[i] != 0 && check_of(context, *meshes[i]).valid == 0) {
      overlaps.push_back({i, i, false, i});
    }
    for (size_t j = i + 1; j < meshes.size(); ++j) {
      const bool asked = changed[i] != 0 || changed[j] != 0;
      if (!asked || meshes[j]->abc.empty() || apart(boxes[i], boxes[j])) continue;
      TriangleMesh both = *meshes[i];
      append(both, *meshes[j]);
      const plc_check check = check_of(context, both);
      if (check.valid != 0) continue;
      const size_t outer = boxes[i].volume() < boxes[j].volume() ? j : i;
      overlaps.push_back({i, j, check.self_intersections == 0, outer});
    }
  }
  return overlaps;
}

}  // namespace plc::tools

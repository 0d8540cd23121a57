#include "tools/command/label_overlaps.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "tools/command/command_check.h"
#include "tools/command/mesh_precision.h"

namespace plc::tools {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

struct Box {
  std::array<double, 3> low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};

  void add(const double* p) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  bool within(const Box& b) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      if (low[axis] < b.low[axis] || b.high[axis] < high[axis]) return false;
    }
    return true;
  }
  double volume() const { return (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]); }
};

bool apart(const Box& a, const Box& b) {
  for (size_t axis = 0; axis < 3; ++axis) {
    if (a.high[axis] < b.low[axis] || b.high[axis] < a.low[axis]) return true;
  }
  return false;
}

const double* point(const TriangleMesh& mesh, uint32_t v) {
  return mesh.xyz.data() + 3 * size_t{v};
}

Box box_of(const TriangleMesh& mesh) {
  Box box;
  for (const uint32_t v : mesh.abc) box.add(point(mesh, v));
  return box;
}

// Of the parts that hang together by vertices.
std::vector<Box> boxes_of_parts(const TriangleMesh& mesh) {
  std::vector<uint32_t> parent(mesh.xyz.size() / 3);
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (size_t i = 0; i < mesh.abc.size(); i += 3) {
    for (size_t k = 1; k < 3; ++k) parent[root(mesh.abc[i + k])] = root(mesh.abc[i]);
  }
  std::vector<Box> all(parent.size());
  for (const uint32_t v : mesh.abc) all[root(v)].add(point(mesh, v));
  std::erase_if(all, [](const Box& box) { return box.low[0] > box.high[0]; });
  return all;
}

struct Solid {
  const TriangleMesh* mesh;
  Box box;
  std::vector<Box> parts;
};

bool may_nest(const Solid& a, const Solid& b) {
  const auto one_in_another = [](const std::vector<Box>& inner, const std::vector<Box>& outer) {
    return std::any_of(inner.begin(), inner.end(), [&](const Box& i) {
      return std::any_of(outer.begin(), outer.end(), [&](const Box& o) { return i.within(o); });
    });
  };
  return one_in_another(a.parts, b.parts) || one_in_another(b.parts, a.parts);
}

// A mesh put together of others, or of parts of them.
class Pile {
 public:
  void clear() {
    mesh_.xyz.clear();
    mesh_.abc.clear();
  }
  void add(const TriangleMesh& mesh) {
    const auto first = static_cast<uint32_t>(mesh_.xyz.size() / 3);
    mesh_.xyz.insert(mesh_.xyz.end(), mesh.xyz.begin(), mesh.xyz.end());
    for (const uint32_t corner : mesh.abc) mesh_.abc.push_back(first + corner);
  }
  // The faces whose boxes meet `box`, with their vertices.
  void add(const TriangleMesh& mesh, const Box& box) {
    if (ids_.size() < mesh.xyz.size() / 3) ids_.resize(mesh.xyz.size() / 3, kNone);
    const size_t begin = mesh_.abc.size();
    for (size_t i = 0; i < mesh.abc.size(); i += 3) {
      Box face;
      for (size_t k = 0; k < 3; ++k) face.add(point(mesh, mesh.abc[i + k]));
      if (apart(face, box)) continue;
      for (size_t k = 0; k < 3; ++k) mesh_.abc.push_back(mesh.abc[i + k]);
    }
    std::vector<uint32_t> used(mesh_.abc.begin() + static_cast<ptrdiff_t>(begin), mesh_.abc.end());
    for (size_t i = begin; i < mesh_.abc.size(); ++i) {
      uint32_t& id = ids_[mesh_.abc[i]];
      if (id == kNone) {
        id = static_cast<uint32_t>(mesh_.xyz.size() / 3);
        const double* p = point(mesh, mesh_.abc[i]);
        mesh_.xyz.insert(mesh_.xyz.end(), p, p + 3);
      }
      mesh_.abc[i] = id;
    }
    for (const uint32_t v : used) ids_[v] = kNone;
  }
  TriangleMesh& mesh() { return mesh_; }

 private:
  TriangleMesh mesh_;
  std::vector<uint32_t> ids_;  // in the pile, of the vertices of the mesh that is being added
};

// Pairs whose boxes overlap, in ascending order.
std::vector<std::pair<size_t, size_t>> close_pairs(const std::vector<Solid>& solids) {
  std::vector<size_t> order;
  for (size_t i = 0; i < solids.size(); ++i) {
    if (!solids[i].parts.empty()) order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return solids[a].box.low[0] < solids[b].box.low[0]; });
  std::vector<std::pair<size_t, size_t>> pairs;
  std::vector<size_t> open;  // those that have begun on the first axis and have not ended
  for (const size_t i : order) {
    const double low = solids[i].box.low[0];
    std::erase_if(open, [&](size_t j) { return solids[j].box.high[0] < low; });
    for (const size_t j : open) {
      if (!apart(solids[i].box, solids[j].box)) pairs.push_back(std::minmax(i, j));
    }
    open.push_back(i);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

bool disjoint(plc_context* context, const std::vector<const TriangleMesh*>& meshes,
              bool as_floats) {
  Pile all;
  for (const TriangleMesh* mesh : meshes) all.add(*mesh);
  if (as_floats && !round_to_floats(all.mesh().xyz)) return false;
  return check_of(context, all.mesh()).valid != 0;
}

std::vector<Overlap> find_overlaps(plc_context* context,
                                   const std::vector<const TriangleMesh*>& meshes,
                                   const std::vector<char>& changed) {
  std::vector<Solid> solids;
  solids.reserve(meshes.size());
  for (const TriangleMesh* mesh : meshes) {
    solids.push_back({mesh, box_of(*mesh), boxes_of_parts(*mesh)});
  }
  std::vector<Overlap> overlaps;
  for (size_t i = 0; i < meshes.size(); ++i) {
    if (changed[i] == 0 || meshes[i]->abc.empty()) continue;
    if (check_of(context, *meshes[i]).valid == 0) overlaps.push_back({i, i, false, i});
  }
  Pile both;
  for (const auto& [i, j] : close_pairs(solids)) {
    if (changed[i] == 0 && changed[j] == 0) continue;
    const Solid& a = solids[i];
    const Solid& b = solids[j];
    both.clear();
    const bool whole = may_nest(a, b);
    if (whole) {
      both.add(*a.mesh);
      both.add(*b.mesh);
    } else {
      both.add(*a.mesh, b.box);
      both.add(*b.mesh, a.box);
    }
    const plc_check check = check_of(context, both.mesh());
    if (whole ? check.valid != 0 : check.self_intersections == 0) continue;
    const size_t outer = a.box.volume() < b.box.volume() ? j : i;
    overlaps.push_back({i, j, check.self_intersections == 0, outer});
  }
  std::sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) {
    return std::pair(a.first, a.second) < std::pair(b.first, b.second);
  });
  return overlaps;
}

}  // namespace plc::tools

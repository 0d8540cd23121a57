#include "engine/start/crumbs.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/constants.h"
#include "engine/detect/tiny_components.h"
#include "engine/guard/obstacles.h"
#include "engine/start/joined_voxels.h"
#include "engine/transform/edge.h"
#include "kernels/image_value.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

struct Box {
  Vec3 low, high;

  bool holds(const Box& other) const {
    return low.x <= other.low.x && low.y <= other.low.y && low.z <= other.low.z &&
           high.x >= other.high.x && high.y >= other.high.y && high.z >= other.high.z;
  }
};

Box box_of(const Mesh& mesh, const Vector<uint32_t>& component) {
  Box box{mesh.at(component[0]), mesh.at(component[0])};
  for (const uint32_t v : component) {
    const Vec3 p = mesh.at(v);
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

// The component of v, whose vertices become seen.
Vector<uint32_t> component_of(const Mesh& mesh, uint32_t v, Vector<uint8_t>& seen) {
  Vector<uint32_t> component{v};
  seen[v] = 1;
  for (size_t i = 0; i < component.size(); ++i) {
    const uint32_t u = component[i];
    const uint32_t d = mesh.valence(u);
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t w = mesh.neighbor(u, k);
      if (std::exchange(seen[w], uint8_t{1}) == 0) component.push_back(w);
    }
  }
  return component;
}

// The voxel that is nearest to half a voxel beneath v.
Voxel beneath(const Mesh& mesh, const ImageView& image, uint32_t v) {
  const Vec3 p = mesh.at(v);
  const Vec3 n = vertex_normal(mesh, v);
  const float xyz[3] = {p.x, p.y, p.z}, normal[3] = {n.x, n.y, n.z};
  Voxel at;
  for (size_t a = 0; a < 3; ++a) {
    at[a] = static_cast<int32_t>(
        std::round(image.scale[a] * xyz[a] + image.offset[a] - 0.5F * normal[a]));
  }
  return at;
}

// Whether a component has many voxels of the object beneath it, or one of many.
bool holds_many(const Mesh& mesh, const ImageObject& object, const Vector<uint32_t>& component) {
  constexpr auto kMany = static_cast<size_t>(kPlaceVoxels);
  const ImageView& image = object.image;
  const auto has = [&](const Voxel& at) {
    return is_within(image.dims, at) && object.has(image_value(image, at[0], at[1], at[2]));
  };
  Vector<Voxel> held;
  for (const uint32_t v : component) {
    const Voxel at = beneath(mesh, image, v);
    if (!has(at) || std::find(held.begin(), held.end(), at) != held.end()) continue;
    held.push_back(at);
    if (held.size() == kMany || is_joined(at, kMany, has)) return true;
  }
  return false;
}

}  // namespace

int64_t delete_crumbs(Mesh& mesh, const ImageObject& object) {
  std::vector<Vector<uint32_t>> crumbs;
  std::vector<Box> cavities;
  size_t most = 0;  // vertices of a component that is no cavity
  Vector<uint8_t> seen(mesh.slots());
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (seen[v] != 0 || !mesh.alive(v)) continue;
    Vector<uint32_t> component = component_of(mesh, v, seen);
    if (signed_volume(mesh, component) < 0) {
      cavities.push_back(box_of(mesh, component));
      continue;
    }
    most = std::max(most, component.size());
    if (!holds_many(mesh, object, component)) crumbs.push_back(std::move(component));
  }
  int64_t deleted = 0;
  for (const Vector<uint32_t>& crumb : crumbs) {
    if (crumb.size() == most) continue;
    if (mesh.obstacles != nullptr && mesh.obstacles->any_inside(mesh, crumb)) continue;
    const Box box = box_of(mesh, crumb);
    const auto inside = [&](const Box& cavity) { return box.holds(cavity); };
    if (std::any_of(cavities.begin(), cavities.end(), inside)) continue;
    for (const uint32_t v : crumb) mesh.destroy(v);
    ++deleted;
  }
  return deleted;
}

}  // namespace plc

#include "tools/blocks/block_patch.h"

#include <algorithm>
#include <utility>

#include "tools/file/failure.h"

namespace plc::tools {

namespace {

constexpr uint32_t kNone = ~0U;

// A face seen from one of its corners: around the corner, `to` follows `from`.
struct Step {
  uint32_t corner, from, to;
  friend bool operator<(const Step& l, const Step& r) {
    return l.corner != r.corner ? l.corner < r.corner : l.from < r.from;
  }
};

std::vector<Step> steps_of(const std::vector<uint32_t>& abc) {
  std::vector<Step> steps;
  steps.reserve(abc.size());
  for (size_t f = 0; f < abc.size(); f += 3) {
    for (size_t k = 0; k < 3; ++k) {
      steps.push_back({abc[f + k], abc[f + (k + 1) % 3], abc[f + (k + 2) % 3]});
    }
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

// The star that the steps first .. last - 1 around one corner make.
Star star_of(const Step* first, const Step* last, uint32_t& fans) {
  const auto count = static_cast<size_t>(last - first);
  std::vector<size_t> next(count, count);
  std::vector<uint8_t> reached(count, 0);
  for (size_t i = 0; i < count; ++i) {
    if (i > 0 && first[i].from == first[i - 1].from) return Star::kBroken;
    const Step* found = std::lower_bound(first, last, Step{first->corner, first[i].to, 0});
    if (found == last || found->from != first[i].to) continue;
    next[i] = static_cast<size_t>(found - first);
    if (reached[next[i]] != 0) return Star::kBroken;
    reached[next[i]] = 1;
  }
  // Fans begin where nothing leads to; what is left are whole turns.
  size_t seen = 0;
  fans = 0;
  for (size_t i = 0; i < count; ++i) {
    if (reached[i] != 0) continue;
    ++fans;
    for (size_t at = i; at != count; at = next[at]) ++seen;
  }
  if (fans > 0) return seen == count ? Star::kBorder : Star::kBroken;
  size_t at = 0;
  do {
    ++seen;
    at = next[at];
  } while (at != 0);
  fans = 1;
  return seen == count ? Star::kWhole : Star::kBroken;
}

[[noreturn]] void fail(const std::string& what, const std::string& why) {
  throw Failure{what + ": " + why};
}

// Without the faces that are marked, and the vertices that have none left.
BlockMesh without(const BlockMesh& mesh, const std::vector<uint8_t>& gone) {
  std::vector<uint32_t> id(mesh.vertex_count(), kNone);
  BlockMesh left;
  std::vector<uint8_t> used(mesh.vertex_count(), 0);
  for (size_t f = 0; f < mesh.face_count(); ++f) {
    for (size_t k = 0; k < 3 && gone[f] == 0; ++k) used[mesh.abc[3 * f + k]] = 1;
  }
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (used[v] == 0) continue;
    id[v] = static_cast<uint32_t>(left.ids.size());
    left.ids.push_back(mesh.ids[v]);
    left.xyz.insert(left.xyz.end(), {mesh.xyz[3 * v], mesh.xyz[3 * v + 1], mesh.xyz[3 * v + 2]});
  }
  for (size_t f = 0; f < mesh.face_count(); ++f) {
    for (size_t k = 0; k < 3 && gone[f] == 0; ++k) left.abc.push_back(id[mesh.abc[3 * f + k]]);
  }
  return left;
}

// Takes faces out until no border touches itself.
void open_pinches(Patch& patch, const std::string& what) {
  for (;;) {
    const Stars stars = stars_of(patch.mesh);
    BlockMesh& mesh = patch.mesh;
    std::vector<uint8_t> gone(mesh.face_count(), 0);
    bool any = false;
    for (size_t f = 0; f < mesh.face_count(); ++f) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = mesh.abc[3 * f + k];
        if (stars.star[v] == Star::kBroken) fail(what, "its faces are of no closed surface");
        if (stars.fans[v] > 1) gone[f] = 1;
      }
      if (gone[f] == 0) continue;
      any = true;
      std::array<uint64_t, 3> face{};
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = mesh.abc[3 * f + k];
        face[k] = mesh.ids[v];
        std::copy_n(&mesh.xyz[3 * size_t{v}], 3, patch.aside_places[face[k]].begin());
      }
      patch.aside.push_back(face);
    }
    if (!any) return;
    mesh = without(mesh, gone);
  }
}

}  // namespace

BlockMesh joined(const std::map<Int3, BlockCell>& cells, const std::string& what) {
  BlockMesh mesh;
  for (const auto& [at, cell] : cells) {
    mesh.ids.insert(mesh.ids.end(), cell.ids.begin(), cell.ids.end());
  }
  std::sort(mesh.ids.begin(), mesh.ids.end());
  mesh.ids.erase(std::unique(mesh.ids.begin(), mesh.ids.end()), mesh.ids.end());
  if (mesh.ids.size() >= kNone) fail(what, "too many vertices for one task; use smaller blocks");
  mesh.xyz.resize(3 * mesh.ids.size());
  std::vector<uint8_t> placed(mesh.ids.size(), 0);
  std::vector<uint32_t> index;
  for (const auto& [at, cell] : cells) {
    index.clear();
    for (size_t v = 0; v < cell.ids.size(); ++v) {
      const auto i = static_cast<uint32_t>(
          std::lower_bound(mesh.ids.begin(), mesh.ids.end(), cell.ids[v]) - mesh.ids.begin());
      index.push_back(i);
      double* place = &mesh.xyz[3 * size_t{i}];
      if (placed[i] != 0 && !std::equal(place, place + 3, &cell.xyz[3 * v])) {
        fail(what, "two cells have the same vertex at different places");
      }
      std::copy_n(&cell.xyz[3 * v], 3, place);
      placed[i] = 1;
    }
    for (const uint32_t v : cell.abc) mesh.abc.push_back(index[v]);
  }
  return mesh;
}

Stars stars_of(const BlockMesh& mesh) {
  const std::vector<Step> steps = steps_of(mesh.abc);
  Stars stars;
  stars.star.assign(mesh.vertex_count(), Star::kBroken);
  stars.fans.assign(mesh.vertex_count(), 0);
  for (size_t i = 0; i < steps.size();) {
    size_t end = i;
    while (end < steps.size() && steps[end].corner == steps[i].corner) ++end;
    const uint32_t v = steps[i].corner;
    stars.star[v] = star_of(&steps[i], &steps[i] + (end - i), stars.fans[v]);
    i = end;
  }
  return stars;
}

Patch patch_of(BlockMesh mesh, const std::array<double, 3>& room_low,
               const std::array<double, 3>& room_high, uint64_t coarse, const std::string& what) {
  Patch patch;
  patch.mesh = std::move(mesh);
  open_pinches(patch, what);
  const BlockMesh& m = patch.mesh;
  const Stars stars = stars_of(m);
  patch.held.assign(m.vertex_count(), 0);
  for (size_t v = 0; v < m.vertex_count(); ++v) {
    if (stars.star[v] != Star::kWhole) patch.held[v] = 1;
  }
  for (int ring = 0; ring < kHeldRings; ++ring) {
    std::vector<uint8_t> next = patch.held;
    for (size_t f = 0; f < m.face_count(); ++f) {
      const uint32_t* v = &m.abc[3 * f];
      if ((patch.held[v[0]] | patch.held[v[1]] | patch.held[v[2]]) == 0) continue;
      for (size_t k = 0; k < 3; ++k) next[v[k]] = 1;
    }
    patch.held = std::move(next);
  }
  for (size_t v = 0; v < m.vertex_count(); ++v) {
    for (size_t a = 0; a < 3; ++a) {
      const double x = m.xyz[3 * v + a];
      if (x < room_low[a] || x > room_high[a]) patch.held[v] = 1;
    }
    if (patch.held[v] != 0) continue;
    ++patch.free;
    if (m.ids[v] < coarse) patch.held[v] = 2;
  }
  return patch;
}

std::map<Int3, BlockCell> divided(const BlockMesh& mesh, const BlockGrid& grid,
                                  const BlockGrid::Window& window) {
  std::map<Int3, std::vector<size_t>> faces;
  for (size_t f = 0; f < mesh.face_count(); ++f) {
    std::array<double, 3> middle{};
    for (size_t a = 0; a < 3; ++a) {
      for (size_t k = 0; k < 3; ++k) middle[a] += mesh.xyz[3 * size_t{mesh.abc[3 * f + k]} + a] / 3;
    }
    faces[window.nearest(grid.cell_of(middle))].push_back(f);
  }
  std::map<Int3, BlockCell> cells;
  std::vector<uint32_t> index(mesh.vertex_count());
  for (const auto& [at, list] : faces) {
    BlockCell& cell = cells[at];
    std::vector<uint32_t> corners;
    for (const size_t f : list) {
      corners.insert(corners.end(), &mesh.abc[3 * f], &mesh.abc[3 * f] + 3);
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    // Those of a mesh ascend with their ids.
    for (const uint32_t v : corners) {
      index[v] = static_cast<uint32_t>(cell.ids.size());
      cell.ids.push_back(mesh.ids[v]);
      cell.xyz.insert(cell.xyz.end(), {mesh.xyz[3 * size_t{v}], mesh.xyz[3 * size_t{v} + 1],
                                       mesh.xyz[3 * size_t{v} + 2]});
    }
    std::vector<std::array<uint32_t, 3>> sorted;
    for (const size_t f : list) {
      std::array<uint32_t, 3> face{};
      for (size_t k = 0; k < 3; ++k) face[k] = index[mesh.abc[3 * f + k]];
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      sorted.push_back(face);
    }
    std::sort(sorted.begin(), sorted.end());
    for (const auto& face : sorted) cell.abc.insert(cell.abc.end(), face.begin(), face.end());
  }
  return cells;
}

}  // namespace plc::tools

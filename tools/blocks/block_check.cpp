#include "tools/blocks/block_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tools/blocks/block_patch.h"
#include "tools/blocks/block_task.h"
#include "tools/cohort/content.h"
#include "tools/file/failure.h"
#include "tools/file/text.h"

namespace plc::tools {

namespace {

using Place = std::array<double, 3>;

Place minus(const double* a, const double* b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Place& a, const Place& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Sets that are joined, each with the volume of its faces.
class Components {
 public:
  size_t add() {
    parent_.push_back(parent_.size());
    volume_.push_back(0);
    return parent_.size() - 1;
  }
  size_t root(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(size_t a, size_t b) {
    a = root(a), b = root(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    volume_[std::min(a, b)] += volume_[std::max(a, b)];
  }
  void add_volume(size_t i, double volume) { volume_[root(i)] += volume; }
  size_t size() const { return parent_.size(); }
  double volume(size_t root) const { return volume_[root]; }
  void count(BlockCheck& check) {
    for (size_t i = 0; i < parent_.size(); ++i) {
      if (parent_[i] != i) continue;
      ++check.components;
      check.inward += volume_[i] < 0 ? 1 : 0;
    }
  }

 private:
  std::vector<size_t> parent_;
  std::vector<double> volume_;
};

class Proof {
 public:
  Proof(const std::string& folder, const BlockPlan& plan, int step, plc_context* context)
      : folder_(folder), plan_(plan), step_(step), context_(context) {
    check_.edge_min = std::numeric_limits<double>::infinity();
  }

  void look_at(int64_t block) {
    const Int3 at = plan_.grid.block_at(block);
    const std::map<Int3, BlockCell> cells =
        cells_before(folder_, plan_, step_, plan_.grid.cells_of(plan_.grid.window_of(at)));
    std::map<Int3, BlockCell> own;
    for (const Int3& cell : plan_.grid.own_cells(at)) {
      if (const auto found = cells.find(cell); found != cells.end()) own.insert(*found);
    }
    if (own.empty()) return;
    const BlockMesh window = joined(cells, "block " + BlockGrid::name_of(at));
    find_meetings(window);
    const Stars stars = stars_of(window);
    count_vertices(cells, own, window, stars);
    for (const auto& [cell, faces] : own) measure(cell, faces);
    connect(own);
  }

  BlockCheck end() {
    components_.count(check_);
    check_.euler = check_.vertices - check_.faces / 2;
    check_.genus = check_.components - check_.euler / 2;
    return check_;
  }

 private:
  void find_meetings(const BlockMesh& window) {
    plc_check found;
    plc_check_defaults(&found);
    if (plc_check_mesh(context_, window.xyz.data(), static_cast<int64_t>(window.vertex_count()),
                       window.abc.data(), static_cast<int64_t>(window.face_count()),
                       &found) != PLC_OK) {
      throw Failure{plc_context_message(context_)};
    }
    check_.self_intersections += found.self_intersections;
    check_.degenerate_faces += found.degenerate_faces;
  }

  // A vertex is counted with the first of the cells that have it.
  void count_vertices(const std::map<Int3, BlockCell>& cells, const std::map<Int3, BlockCell>& own,
                      const BlockMesh& window, const Stars& stars) {
    const auto index = [&](uint64_t id) {
      return static_cast<size_t>(std::lower_bound(window.ids.begin(), window.ids.end(), id) -
                                 window.ids.begin());
    };
    std::vector<uint8_t> seen(window.vertex_count(), 0);
    for (const auto& [at, cell] : cells) {
      const bool counts = own.count(at) != 0;
      for (const uint64_t id : cell.ids) {
        const size_t v = index(id);
        if (counts && (seen[v] & 2U) == 0) {
          seen[v] |= 2U;
          check_.open_vertices += stars.star[v] == Star::kWhole ? 0 : 1;
        }
        if ((seen[v] & 1U) != 0) continue;
        seen[v] |= 1U;
        check_.vertices += counts ? 1 : 0;
      }
    }
  }

  void measure(const Int3& at, const BlockCell& cell) {
    Place low{}, high{};
    plan_.grid.bounds_of({at, at}, low, high);
    const double reach = static_cast<double>(plan_.grid.margin()) / 2;
    check_.faces += static_cast<int64_t>(cell.abc.size() / 3);
    for (size_t f = 0; f < cell.abc.size(); f += 3) {
      const double* p[3] = {};
      bool strays = false;
      for (size_t k = 0; k < 3; ++k) {
        p[k] = &cell.xyz[3 * size_t{cell.abc[f + k]}];
        for (size_t a = 0; a < 3; ++a) {
          strays = strays || p[k][a] <= low[a] - reach || p[k][a] >= high[a] + reach;
        }
      }
      check_.stray_faces += strays ? 1 : 0;
      const Place normal = cross(minus(p[1], p[0]), minus(p[2], p[0]));
      check_.area += std::sqrt(dot(normal, normal)) / 2;
      for (size_t k = 0; k < 3; ++k) {
        const Place edge = minus(p[(k + 1) % 3], p[k]);
        const double length = std::sqrt(dot(edge, edge));
        check_.edge_min = std::min(check_.edge_min, length);
        check_.edge_max = std::max(check_.edge_max, length);
      }
    }
  }

  // What is connected within the block's own faces is one component with what other blocks have of
  // the same vertices.
  void connect(const std::map<Int3, BlockCell>& own) {
    constexpr size_t kNone = std::numeric_limits<size_t>::max();
    Components parts;  // of the block
    std::unordered_map<uint64_t, size_t> of_vertex;
    for (const auto& [at, cell] : own) {
      for (size_t f = 0; f < cell.abc.size(); f += 3) {
        size_t part = kNone;
        const double* p[3] = {};
        for (size_t k = 0; k < 3; ++k) {
          const uint32_t v = cell.abc[f + k];
          p[k] = &cell.xyz[3 * size_t{v}];
          const auto [found, fresh] = of_vertex.try_emplace(cell.ids[v], part);
          if (found->second == kNone) found->second = parts.add();
          if (part == kNone) part = found->second;
          parts.join(part, found->second);
        }
        const Place normal = cross({p[1][0], p[1][1], p[1][2]}, {p[2][0], p[2][1], p[2][2]});
        const double volume = dot({p[0][0], p[0][1], p[0][2]}, normal) / 6;
        parts.add_volume(part, volume);
        check_.volume += volume;
      }
    }
    std::vector<size_t> component(parts.size(), kNone);
    for (size_t i = 0; i < parts.size(); ++i) {
      if (parts.root(i) != i) continue;
      component[i] = components_.add();
      components_.add_volume(component[i], parts.volume(i));
    }
    // Other blocks have vertices near the border alone.
    for (const auto& [at, cell] : own) {
      if (at[0] % 3 == 1 && at[1] % 3 == 1 && at[2] % 3 == 1) continue;
      for (const uint64_t id : cell.ids) {
        const size_t here = component[parts.root(of_vertex[id])];
        const auto [found, fresh] = of_border_.try_emplace(id, here);
        if (!fresh) components_.join(here, found->second);
      }
    }
  }

  const std::string& folder_;
  const BlockPlan& plan_;
  int step_;
  plc_context* context_;
  BlockCheck check_;
  Components components_;
  std::unordered_map<uint64_t, size_t> of_border_;
};

}  // namespace

std::string hash_of_blocks(const std::string& folder, const BlockPlan& plan) {
  std::string all;
  for (int64_t block = 0; block < plan.grid.block_count(); ++block) {
    const Int3 at = plan.grid.block_at(block);
    const int step = plan.steps() - BlockGrid::kColours + BlockGrid::colour_of(at);
    put_value(all, BlockFile(block_path(folder, plan, step, at)).hash());
  }
  return content_hash(all);
}

BlockCheck check_blocks(const std::string& folder, const BlockPlan& plan, int step,
                        plc_context* context, const std::function<void(int64_t)>& told) {
  Proof proof(folder, plan, step, context);
  for (int64_t block = 0; block < plan.grid.block_count(); ++block) {
    proof.look_at(block);
    told(block + 1);
  }
  return proof.end();
}

}  // namespace plc::tools

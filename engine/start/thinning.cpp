#include "engine/start/thinning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/guard/self_meeting.h"
#include "engine/resolve/refinement.h"
#include "engine/start/half_edges.h"
#include "engine/transform/edge.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// In sizes: how near to one that stays others are merged into it. The first is a part of the way:
// it is faster, and what meets when it is thinned out further stays as fine as that.
constexpr float kReaches[] = {0.63F, 1.05F};
constexpr uint8_t kSteps = std::size(kReaches);
// What meets stays finer, and is merged anew, so many times; then its block stays as it was.
constexpr int kTries = 8;
// Side of a block, in delta. What lies at its border is thinned out by one thread.
constexpr float kSide = 24;
constexpr size_t kVertices = 4096;  // of a task

struct Place {
  Vec3 at;
  float size;
};

// The vertices of a surface by the blocks of a grid in which they lie.
class Grid {
 public:
  // Of a single block.
  explicit Grid(size_t vertices) : block_(vertices, 0), begin_{0, vertices}, ids_(vertices) {
    std::iota(ids_.begin(), ids_.end(), 0U);
  }
  Grid(const Vector<Place>& places, float side) : block_(places.size()), ids_(places.size()) {
    std::array<float, 3> low{}, high{};
    for (size_t v = 0; v < places.size(); ++v) {
      const float xyz[3] = {places[v].at.x, places[v].at.y, places[v].at.z};
      for (size_t a = 0; a < 3; ++a) {
        low[a] = v == 0 ? xyz[a] : std::min(low[a], xyz[a]);
        high[a] = v == 0 ? xyz[a] : std::max(high[a], xyz[a]);
      }
    }
    const auto along = [&](size_t a, float x) {
      return static_cast<uint32_t>((x - low[a]) / side);
    };
    const uint32_t columns = along(0, high[0]) + 1, rows = along(1, high[1]) + 1;
    begin_.assign(size_t{columns} * rows * (along(2, high[2]) + 1) + 1, 0);
    for (size_t v = 0; v < places.size(); ++v) {
      const Vec3 p = places[v].at;
      block_[v] = (along(2, p.z) * rows + along(1, p.y)) * columns + along(0, p.x);
      ++begin_[block_[v] + size_t{1}];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    Vector<size_t> end = begin_;
    for (uint32_t v = 0; v < block_.size(); ++v) ids_[end[block_[v]]++] = v;
  }
  size_t blocks() const { return begin_.size() - 1; }
  uint32_t block(uint32_t v) const { return block_[v]; }
  std::span<const uint32_t> vertices(size_t block) const {
    return {ids_.data() + begin_[block], ids_.data() + begin_[block + 1]};
  }

 private:
  Vector<uint32_t> block_;  // of each vertex
  Vector<size_t> begin_;    // of each block, in ids_
  Vector<uint32_t> ids_;    // ascending in each block
};

// Merges vertices within the blocks of a grid.
class Thinning {
 public:
  // steps: of each vertex, how many it takes part in.
  Thinning(const MeshArraysOf<float>& surface, const Vector<Place>& places, const Grid& grid,
           Vector<uint8_t>& steps, uint32_t most_neighbors, const Executor& executor)
      : places_(places),
        grid_(grid),
        steps_(steps),
        most_neighbors_(most_neighbors),
        executor_(executor),
        before_(surface, executor),
        mesh_(before_),
        at_border_(places.size(), 0),
        into_(places.size()) {
    std::iota(into_.begin(), into_.end(), 0U);
    for (size_t f = 0; f < mesh_.face_slots(); ++f) {
      const uint32_t* abc = mesh_.face(f);
      const uint32_t block = grid_.block(abc[0]);
      if (grid_.block(abc[1]) == block && grid_.block(abc[2]) == block) continue;
      for (size_t k = 0; k < 3; ++k) at_border_[abc[k]] = 1;
    }
  }

  // The blocks that are marked, all of whose vertices are as they were.
  void run(const Vector<uint8_t>& marked) {
    executor_.run(grid_.blocks(), [&](size_t block) {
      if (marked[block] == 0) return;
      Ring ring;
      for (uint8_t step = 0; step < kSteps; ++step) {
        for (const uint32_t v : grid_.vertices(block)) {
          while (merges(v, step) && merge_one(v, step, ring)) {
          }
        }
      }
    });
  }
  // Makes the marked blocks what they were.
  void restore(const Vector<uint8_t>& marked) {
    run_blocks(executor_, mesh_.face_slots(), kVertices, [&](size_t, size_t begin, size_t end) {
      for (size_t f = begin; f < end; ++f) {
        // Faces between blocks have not changed.
        if (marked[grid_.block(before_.face(f)[0])] != 0) mesh_.restore_face(before_, f);
      }
    });
    run_blocks(executor_, into_.size(), kVertices, [&](size_t, size_t begin, size_t end) {
      for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
        if (marked[grid_.block(v)] == 0) continue;
        mesh_.restore_vertex(before_, v);
        into_[v] = v;
      }
    });
  }
  // What v was merged into, or itself.
  uint32_t left_of(uint32_t v) const {
    while (into_[v] != v) v = into_[v];
    return v;
  }
  const HalfEdges& mesh() const { return mesh_; }

 private:
  using Ring = Vector<uint32_t>;  // neighbours

  bool merges(uint32_t v, uint8_t step) const {
    return mesh_.alive(v) && at_border_[v] == 0 && steps_[v] > step;
  }
  // The neighbours of v, that of mesh_.out(v) in front.
  void list_ring(uint32_t v, Ring& ring) const {
    ring.clear();
    mesh_.visit_ring(v, [&](uint32_t h) { ring.push_back(mesh_.to(h)); });
  }
  // Merges the first neighbour into v that may be.
  bool merge_one(uint32_t v, uint8_t step, Ring& ring) {
    list_ring(v, ring);
    const float reach = kReaches[step] * places_[v].size;
    uint32_t h = mesh_.out(v);
    for (const uint32_t w : ring) {
      if (merges(w, step) && squared(places_[w].at - places_[v].at) < reach * reach &&
          may_contract(h, ring) && keeps_shape(h)) {
        into_[w] = v;
        mesh_.contract(h);
        return true;
      }
      h = mesh_.around(h);
    }
    return false;
  }
  bool has_more_than_three(uint32_t v) const {
    const uint32_t first = mesh_.out(v);
    return mesh_.around(mesh_.around(mesh_.around(first))) != first;
  }
  // ring: that of where h begins.
  bool may_contract(uint32_t h, const Ring& ring) const {
    const uint32_t t = mesh_.twin(h);
    const uint32_t thirds[] = {mesh_.from(mesh_.previous(h)), mesh_.from(mesh_.previous(t))};
    if (!has_more_than_three(thirds[0]) || !has_more_than_three(thirds[1])) return false;
    size_t neighbors = ring.size(), common = 0;
    uint32_t g = t;
    do {
      common += static_cast<size_t>(std::count(ring.begin(), ring.end(), mesh_.to(g)));
      ++neighbors;
      g = mesh_.around(g);
    } while (g != t);
    return common == 2 && neighbors <= size_t{most_neighbors_} + 4;
  }
  // Whether the faces around where h ends, with its beginning in that place, neither turn too far
  // nor get too long.
  bool keeps_shape(uint32_t h) const {
    const uint32_t v = mesh_.from(h), w = mesh_.to(h), t = mesh_.twin(h);
    uint32_t g = mesh_.around(t), x = mesh_.to(g);  // from the first neighbour behind v
    for (;;) {
      const float longest = kMaxEdge * 0.5F * (places_[v].size + places_[x].size);
      if (squared(places_[x].at - places_[v].at) >= longest * longest) return false;
      g = mesh_.around(g);
      if (g == t) return true;
      const uint32_t y = mesh_.to(g);
      const Vec3 px = places_[x].at, py = places_[y].at;
      const Vec3 before = area_vector(places_[w].at, px, py);
      const Vec3 after = area_vector(places_[v].at, px, py);
      const float both = dot(before, after);
      constexpr float kSquaredCosine = kFoldCosine * kFoldCosine;
      if (!(both > 0 && both * both > kSquaredCosine * squared(before) * squared(after))) {
        return false;
      }
      x = y;
    }
  }

  const Vector<Place>& places_;
  const Grid& grid_;
  const Vector<uint8_t>& steps_;
  uint32_t most_neighbors_;
  const Executor& executor_;
  const HalfEdges before_;
  HalfEdges mesh_;
  Vector<uint8_t> at_border_;  // of vertices with a neighbour in another block
  Vector<uint32_t> into_;
};

// Makes the mesh what is left of the surface; ids: of its vertices, what they were there.
void fill(Mesh& mesh, const HalfEdges& left, const Vector<Place>& places, const Schedule& schedule,
          Vector<uint32_t>& ids) {
  Vector<uint32_t> living;
  Vector<Vec3> points;
  for (uint32_t v = 0; v < left.vertex_slots(); ++v) {
    if (!left.alive(v)) continue;
    living.push_back(v);
    points.push_back(places[v].at);
  }
  const Vector<uint32_t> order = morton_order(points, mesh.delta, schedule);
  mesh.clear();
  mesh.reserve(order.size());
  ids.resize(order.size());
  Vector<uint32_t> new_id(left.vertex_slots());
  for (size_t i = 0; i < ids.size(); ++i) {
    ids[i] = living[order[i]];
    new_id[ids[i]] = mesh.create(points[order[i]], {});
  }
  Neighbors ring;
  for (const uint32_t v : ids) {
    ring.resize(0);
    left.visit_ring(v, [&](uint32_t h) { ring.push_back(new_id[left.to(h)]); });
    mesh.set_ring(new_id[v], ring);
  }
}

Vector<Place> places_of(const MeshArraysOf<float>& surface, const Mesh& mesh,
                        const Executor& executor) {
  Vector<Place> places(surface.vertex_count);
  run_blocks(executor, places.size(), kVertices, [&](size_t, size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      const float* p = surface.point(v);
      const float above = mesh.sizing->field.above_delta(p[0], p[1], p[2]);
      places[v] = {{p[0], p[1], p[2]}, static_cast<float>(mesh.delta) * (1 + above)};
    }
  });
  return places;
}

// steps: of the surface's vertices, and then of the mesh's.
Status thin_out_blocks(const MeshArraysOf<float>& surface, const Vector<Place>& places,
                       const Grid& grid, const Schedule& schedule, const GoOn& go_on,
                       Vector<uint8_t>& steps, Mesh& mesh) {
  Thinning thinning(surface, places, grid, steps, mesh.most_neighbors, schedule);
  Vector<uint8_t> marked(grid.blocks(), 1);
  Vector<uint32_t> ids;
  for (int i = 0;; ++i) {
    thinning.run(marked);
    fill(mesh, thinning.mesh(), places, schedule, ids);
    const auto meeting = meeting_faces(mesh, schedule);
    if (Status s = ask(go_on); !s.ok()) return s;
    if (meeting.empty()) break;
    // One of two faces that meet is not what it was: of what was merged into its corners something
    // took part in a step, and does so no more. So this ends.
    Vector<uint8_t> meets(surface.vertex_count, 0);
    for (const auto& face : meeting) {
      for (const uint32_t v : face) meets[ids[v]] = 1;
    }
    std::fill(marked.begin(), marked.end(), uint8_t{0});
    for (uint32_t v = 0; v < surface.vertex_count; ++v) {
      if (meets[thinning.left_of(v)] == 0) continue;
      marked[grid.block(v)] = 1;
      if (steps[v] > 0) --steps[v];
    }
    for (uint32_t v = 0; v < surface.vertex_count && i >= kTries; ++v) {
      if (marked[grid.block(v)] != 0) steps[v] = 0;
    }
    thinning.restore(marked);
  }
  Vector<uint8_t> left(ids.size());
  for (size_t v = 0; v < ids.size(); ++v) left[v] = steps[ids[v]];
  steps.swap(left);
  return {};
}

}  // namespace

Status thin_out(const MeshArraysOf<float>& surface, const Schedule& schedule, const GoOn& go_on,
                Mesh& mesh) {
  Vector<uint8_t> steps(surface.vertex_count, kSteps);
  Vector<Place> places = places_of(surface, mesh, schedule);
  const Grid grid(places, kSide * static_cast<float>(mesh.delta));
  Status s = thin_out_blocks(surface, places, grid, schedule, go_on, steps, mesh);
  if (s.ok() && grid.blocks() > 1) {
    Vector<float> xyz;
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      const Vec3 p = mesh.at(v);
      xyz.insert(xyz.end(), {p.x, p.y, p.z});
    }
    const Vector<uint32_t> abc = mesh.faces();
    const auto rest = arrays_of(xyz, abc);
    places = places_of(rest, mesh, schedule);
    s = thin_out_blocks(rest, places, Grid(places.size()), schedule, go_on, steps, mesh);
  }
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.resize(v);
  return s;
}

}  // namespace plc

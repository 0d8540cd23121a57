#include "engine/start/thinning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/base/marks.h"
#include "engine/base/spares.h"
#include "engine/exact/triangle_intersection.h"
#include "engine/exact/vertex_star.h"
#include "engine/guard/box_tree.h"
#include "engine/guard/self_meeting.h"
#include "engine/resolve/refinement.h"
#include "engine/start/half_edges.h"
#include "engine/start/thinning_grid.h"
#include "engine/transform/edge.h"
#include "pyramid/buffer.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// In sizes: how near to one that stays others are merged into it.
constexpr float kReach = 1.25F;
// What meets stays as it was, and the rest is merged anew, so many times; then its block stays as
// it was, or all of the surface, where what meets was merged in different blocks.
constexpr int kTries = 8;
// Side of a block, in delta, and by how much of it the grid of each stage is moved: what is at the
// border of a block in one of them is within a block in another, but for some points.
constexpr float kSide = 32;
constexpr float kShifts[] = {0, 0.5F, 0.25F};
constexpr size_t kVertices = 4096;  // of a task

// What v was merged into, or itself. into: of each vertex what it was merged into first, or itself.
uint32_t left_of(const Vector<uint32_t>& into, uint32_t v) {
  while (into[v] != v) v = into[v];
  return v;
}

// Merges vertices, in stages.
class Thinning {
 public:
  // stays: of each vertex, whether it neither is merged nor others are into it.
  Thinning(HalfEdges&& surface, const Buffer<SizedPlace>& places, Vector<uint8_t>& stays,
           uint32_t most_neighbors, const Executor& executor)
      : places_(places),
        stays_(stays),
        most_neighbors_(most_neighbors),
        executor_(executor),
        mesh_(std::move(surface)),
        into_(places.size()) {
    std::iota(into_.begin(), into_.end(), 0U);
  }

  // Those within the blocks of a grid, all blocks at once. Faces with corners in the same block do
  // not meet afterwards, if they did not before.
  void run(const ThinningGrid& grid) {
    grid_ = &grid;
    flags_.assign(places_.size(), 0);
    run_blocks(executor_, mesh_.face_slots(), kVertices, [&](size_t, size_t begin, size_t end) {
      for (size_t f = begin; f < end; ++f) {
        if (mesh_.face_alive(f)) mark_border(mesh_.face(f));
      }
    });
    executor_.run(grid.blocks(), [&](size_t block) {
      if (grid.vertices(block).empty()) return;
      const Spares<Scratch>::Lent scratch = scratches_.lend();
      thin_out(static_cast<uint32_t>(block), *scratch);
    });
  }
  // As left_of() takes it.
  Vector<uint32_t> take_into() { return std::move(into_); }
  const HalfEdges& mesh() const { return mesh_; }

 private:
  // Of a vertex in a stage.
  static constexpr uint8_t kAtBorder = 1;  // of its block, which it has not to itself
  static constexpr uint8_t kGrown = 2;     // something was merged into it
  static constexpr uint8_t kEmbedded = 4;  // the faces around it do not meet each other
  static constexpr uint8_t kSeen = 8;      // whether they do has been looked at
  static constexpr uint8_t kInRing = 16;   // of the vertex at hand
  using Ring = Vector<uint32_t>;           // neighbours
  struct Face {
    std::array<uint32_t, 3> corner;
    bool changed;  // in this stage
    bool fresh;    // it may meet any; those that are not do not meet each other
    bool meets;
  };
  // What a task needs for a block.
  struct Scratch {
    Ring ring;
    Vector<HalfEdges::Contraction> done;
    Vector<Face> faces, before;  // ascending by their first corners; what was listed last
    Vector<uint32_t> corners;    // of all faces
    BoxTree tree;
    BoxTree::Scratch found;
    Vector<std::pair<uint32_t, uint32_t>> doubtful;  // vertices, and a face of each
    Vector<uint32_t> meeting;                        // vertices
  };

  void mark_border(const uint32_t* abc) {
    const uint32_t block = grid_->block(abc[0]);
    if (grid_->block(abc[1]) == block && grid_->block(abc[2]) == block) return;
    for (size_t k = 0; k < 3; ++k) {
      if ((read_mark(flags_[abc[k]]) & kAtBorder) == 0) set_mark(flags_[abc[k]], kAtBorder);
    }
  }
  bool has(uint32_t v, uint8_t flag) const { return (flags_[v] & flag) != 0; }

  // Of two faces that meet one has changed: of what was merged into its corners something took
  // part, and does so no more. So this ends.
  void thin_out(uint32_t block, Scratch& s) {
    s.faces.clear();
    for (int i = 0;; ++i) {
      s.done.clear();
      for (const uint32_t v : grid_->vertices(block)) {
        while (merges(v) && merge_one(v, s)) {
        }
      }
      if (s.done.empty()) return;
      list_faces(block, i == 0, s);
      find_meeting(block, s);
      if (s.meeting.empty()) return;
      for (const uint32_t v : grid_->vertices(block)) {
        const bool meets =
            std::binary_search(s.meeting.begin(), s.meeting.end(), left_of(into_, v));
        if (meets || i >= kTries) stays_[v] = 1;
      }
      undo(block, s);
    }
  }
  void undo(uint32_t block, Scratch& s) {
    for (; !s.done.empty(); s.done.pop_back()) {
      mesh_.undo(s.done.back());
      into_[s.done.back().w] = s.done.back().w;
    }
    for (const uint32_t v : grid_->vertices(block)) flags_[v] &= kAtBorder;
  }
  bool merges(uint32_t v) const { return mesh_.alive(v) && !has(v, kAtBorder) && stays_[v] == 0; }
  // The neighbours of v, that of mesh_.out(v) in front.
  void list_ring(uint32_t v, Ring& ring) const {
    ring.clear();
    mesh_.visit_ring(v, [&](uint32_t h) { ring.push_back(mesh_.to(h)); });
  }
  // Merges the first neighbour into v that may be. All neighbours are of the block: v is not at its
  // border.
  bool merge_one(uint32_t v, Scratch& s) {
    Ring& ring = s.ring;
    list_ring(v, ring);
    for (const uint32_t w : ring) flags_[w] |= kInRing;
    const uint32_t h = first_to_merge(v, ring);
    for (const uint32_t w : ring) flags_[w] &= static_cast<uint8_t>(~kInRing);
    if (h == HalfEdges::kNone) return false;
    into_[mesh_.to(h)] = v;
    flags_[v] |= kGrown;
    s.done.push_back(mesh_.contract(h));
    return true;
  }
  uint32_t first_to_merge(uint32_t v, const Ring& ring) const {
    const float reach = kReach * places_[v].size;
    uint32_t h = mesh_.out(v);
    for (const uint32_t w : ring) {
      if (merges(w) && squared(places_[w].at - places_[v].at) < reach * reach &&
          may_contract(h, ring.size()) && keeps_shape(h)) {
        return h;
      }
      h = mesh_.around(h);
    }
    return HalfEdges::kNone;
  }
  bool has_more_than_three(uint32_t v) const {
    const uint32_t first = mesh_.out(v);
    return mesh_.around(mesh_.around(mesh_.around(first))) != first;
  }
  // neighbors: of where h begins, which are marked.
  bool may_contract(uint32_t h, size_t neighbors) const {
    const uint32_t t = mesh_.twin(h);
    const uint32_t thirds[] = {mesh_.from(mesh_.previous(h)), mesh_.from(mesh_.previous(t))};
    if (!has_more_than_three(thirds[0]) || !has_more_than_three(thirds[1])) return false;
    size_t common = 0;
    uint32_t g = t;
    do {
      common += static_cast<size_t>(has(mesh_.to(g), kInRing));
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

  // All faces with a corner in the block.
  void list_faces(uint32_t block, bool first, Scratch& s) const {
    s.faces.swap(s.before);
    s.faces.clear();
    auto last = s.before.cbegin();
    const auto within = [&](uint32_t v) { return grid_->block(v) == block; };
    for (const uint32_t v : grid_->vertices(block)) {
      if (!mesh_.alive(v)) continue;
      while (last != s.before.cend() && last->corner[0] < v) ++last;
      mesh_.visit_ring(v, [&](uint32_t h) {
        Face face{{v, mesh_.to(h), mesh_.from(HalfEdges::previous(h))}, false, false, false};
        for (const uint32_t w : face.corner) {
          if (!within(w)) continue;
          if (w < v) return;  // found from there
          face.changed = face.changed || has(w, kGrown);
        }
        face.fresh = first ? face.changed : !was_clear(face, last, s.before.cend());
        s.faces.push_back(face);
      });
    }
  }
  // Whether the face was there the last time and met none, of all faces if it had changed, else of
  // those that had; what has changed since is to be compared with the others, too.
  static bool was_clear(const Face& face, Vector<Face>::const_iterator last,
                        Vector<Face>::const_iterator end) {
    for (; last != end && last->corner[0] == face.corner[0]; ++last) {
      if (last->corner == face.corner) return !last->meets && (last->changed || !face.changed);
    }
    return false;
  }
  // Lists the corners of faces that meet, of which one has changed.
  void find_meeting(uint32_t block, Scratch& s) {
    s.meeting.clear();
    s.corners.clear();
    for (const Face& face : s.faces) {
      s.corners.insert(s.corners.end(), face.corner.begin(), face.corner.end());
    }
    s.corners.resize(BoxTree::room_for(s.faces.size()), 0);
    s.tree.build(s.faces.size(), SerialExecutor(executor_.simd()), [&](size_t f) {
      return BoxTree::Face{box_of(s.faces[f]), s.faces[f].fresh};
    });
    const auto test = [&](uint32_t f, uint32_t g) {
      Face &a = s.faces[f], &b = s.faces[g];
      if ((a.changed || b.changed) && triangles_intersect(triangle(a), triangle(b))) {
        a.meets = b.meets = true;
        s.meeting.insert(s.meeting.end(), a.corner.begin(), a.corner.end());
        s.meeting.insert(s.meeting.end(), b.corner.begin(), b.corner.end());
      }
    };
    for (uint32_t node = 0; node < s.tree.nodes(); ++node) {
      s.tree.pairs(executor_.simd(), s.corners.data(), node, s.found, test);
    }
    list_doubtful(block, s);
    for (auto first = s.doubtful.cbegin(); first != s.doubtful.cend(); ++first) {
      for (auto g = first + 1; g != s.doubtful.cend() && g->first == first->first; ++g) {
        const Face &a = s.faces[first->second], &b = s.faces[g->second];
        if ((a.fresh || b.fresh) && !share_embedded(a, b, block)) test(first->second, g->second);
      }
    }
    std::sort(s.meeting.begin(), s.meeting.end());
  }
  // Vertices with faces of which some may meet each other, though they share it, and these faces.
  void list_doubtful(uint32_t block, Scratch& s) {
    const auto within = [&](uint32_t v) { return grid_->block(v) == block; };
    for (const Face& face : s.faces) {
      if (!face.changed) continue;
      for (const uint32_t v : face.corner) {
        if (within(v)) is_embedded(v);
      }
    }
    s.doubtful.clear();
    for (uint32_t f = 0; f < s.faces.size(); ++f) {
      for (const uint32_t v : s.faces[f].corner) {
        if (!within(v) || (has(v, kSeen) && !has(v, kEmbedded))) s.doubtful.emplace_back(v, f);
      }
    }
    std::sort(s.doubtful.begin(), s.doubtful.end());
  }
  Box3 box_of(const Face& face) const {
    const Vec3 a = places_[face.corner[0]].at, b = places_[face.corner[1]].at,
               c = places_[face.corner[2]].at;
    return {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
            {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}};
  }
  bool share_embedded(const Face& a, const Face& b, uint32_t block) {
    return std::any_of(a.corner.begin(), a.corner.end(), [&](uint32_t v) {
      return std::find(b.corner.begin(), b.corner.end(), v) != b.corner.end() &&
             grid_->block(v) == block && is_embedded(v);
    });
  }
  // v: of the block at hand.
  bool is_embedded(uint32_t v) {
    if (!has(v, kSeen)) {
      Fan fan(places_[v].at);
      mesh_.visit_ring(v, [&](uint32_t h) { fan.add(places_[mesh_.to(h)].at); });
      flags_[v] |= kSeen;
      if (fan.is_embedded()) flags_[v] |= kEmbedded;
    }
    return has(v, kEmbedded);
  }
  Triangle triangle(const Face& face) const {
    Triangle t;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 p = places_[face.corner[k]].at;
      t.corner[k] = {p.x, p.y, p.z};
      t.vertex[k] = face.corner[k];
    }
    return t;
  }

  const Buffer<SizedPlace>& places_;
  const ThinningGrid* grid_ = nullptr;  // of the stage
  Vector<uint8_t>& stays_;
  uint32_t most_neighbors_;
  const Executor& executor_;
  HalfEdges mesh_;
  Vector<uint32_t> into_;
  Vector<uint8_t> flags_;  // of vertices
  Spares<Scratch> scratches_;
};

// Makes the mesh what is left of the surface; ids: of its vertices, what they were there.
void fill(Mesh& mesh, const HalfEdges& left, const Buffer<SizedPlace>& places,
          const Schedule& schedule, Vector<uint32_t>& ids) {
  Vector<uint32_t> living;
  Vector<Vec3> points;
  for (uint32_t v = 0; v < left.vertex_slots(); ++v) {
    if (!left.alive(v)) continue;
    living.push_back(v);
    points.push_back(places[v].at);
  }
  const Vector<uint32_t> order = morton_order(points, mesh.delta, schedule);
  ids.resize(order.size());
  Buffer<uint32_t> new_id;
  new_id.resize_uninitialized(left.vertex_slots());
  for (uint32_t i = 0; i < ids.size(); ++i) {
    ids[i] = living[order[i]];
    new_id[ids[i]] = i;
  }
  const auto valence = [&](uint32_t i) {
    uint32_t count = 0;
    left.visit_ring(ids[i], [&](uint32_t) { ++count; });
    return count;
  };
  mesh.clear();
  mesh.create_many(static_cast<uint32_t>(ids.size()), valence, schedule);
  run_blocks(schedule, ids.size(), kVertices, [&](size_t, size_t begin, size_t end) {
    Neighbors ring;
    for (auto i = static_cast<uint32_t>(begin); i < end; ++i) {
      ring.resize(0);
      left.visit_ring(ids[i], [&](uint32_t h) { ring.push_back(new_id[left.to(h)]); });
      mesh.exchange_ring(i, ring);
      mesh.place(i, places[ids[i]].at);
    }
  });
}

Buffer<SizedPlace> places_of(const Buffer<float>& xyz, const Mesh& mesh, const Executor& executor) {
  Buffer<SizedPlace> places;
  places.resize_uninitialized(xyz.size() / 3);
  run_blocks(executor, places.size(), kVertices, [&](size_t, size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      const float* p = xyz.data() + 3 * v;
      const float above = mesh.sizing->field.above_delta(p[0], p[1], p[2]);
      places[v] = {{p[0], p[1], p[2]}, static_cast<float>(mesh.delta) * (1 + above)};
    }
  });
  return places;
}

// What became of a surface's vertices.
struct Merged {
  Vector<uint32_t> into;  // as left_of() takes it
  Vector<uint32_t> ids;   // of those of the mesh: what they were
};

// Makes the mesh what is left of the surface. Of that nothing else is kept: it takes more than the
// mesh does. stays: as of Thinning; none where it is empty.
Status thin_out_once(const MakeCrossings& make, const Schedule& schedule, const StartHooks& hooks,
                     Mesh& mesh, Vector<uint8_t>& stays, Merged& merged) {
  Crossings crossings;
  if (Status s = make(crossings); !s.ok()) return s;
  HalfEdges surface(std::move(crossings.abc), crossings.xyz.size() / 3, schedule);
  const bool first = stays.empty();
  if (first && hooks.before_thinning) hooks.before_thinning(surface, crossings.xyz);
  const Buffer<SizedPlace> places = places_of(crossings.xyz, mesh, schedule);
  crossings.xyz = Buffer<float>();
  if (first) stays.assign(places.size(), 0);
  Thinning thinning(std::move(surface), places, stays, mesh.most_neighbors, schedule);
  const Box3 bounds = bounds_of(places);
  const float side = kSide * static_cast<float>(mesh.delta);
  for (const float shift : kShifts) {
    thinning.run(ThinningGrid(places, thinning.mesh(), bounds, side, shift, schedule));
    if (Status s = ask(hooks.go_on); !s.ok()) return s;
  }
  fill(mesh, thinning.mesh(), places, schedule, merged.ids);
  merged.into = thinning.take_into();
  return {};
}

}  // namespace

Status thin_out(const MakeCrossings& make, const Schedule& schedule, const StartHooks& hooks,
                Mesh& mesh) {
  Vector<uint8_t> stays;
  for (int i = 0;; ++i) {
    Merged merged;
    if (Status s = thin_out_once(make, schedule, hooks, mesh, stays, merged); !s.ok()) return s;
    // What meets was merged in different blocks. It stays as it was, as what meets in a block.
    const auto meeting = meeting_faces(mesh, schedule);
    if (meeting.empty()) return {};
    Vector<uint8_t> meets(stays.size(), 0);
    for (const auto& face : meeting) {
      for (const uint32_t v : face) meets[merged.ids[v]] = 1;
    }
    for (uint32_t v = 0; v < stays.size(); ++v) {
      if (i >= kTries || meets[left_of(merged.into, v)] != 0) stays[v] = 1;
    }
  }
}

}  // namespace plc

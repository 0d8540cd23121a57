#include "engine/guard/meeting_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "engine/base/blocks.h"
#include "engine/exact/triangle_intersection.h"
#include "engine/exact/vertex_star.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

// Per task: vertices whose faces are searched, and nodes of leaves that are.
constexpr size_t kStarBlock = 128;
constexpr size_t kSearchBlock = 4;

uint32_t lowest_bit(uint32_t mask) {
  return static_cast<uint32_t>(std::countr_zero(mask));
}

}  // namespace

// The index of a listed face, whichever of its corners comes first here.
uint32_t MeetingSearch::index_of(const Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) const {
  // Brings the corner that it is listed with to the front.
  while (!mesh.marked(a) || !mesh.precedes(a, b) || !mesh.precedes(a, c)) {
    const uint32_t first = a;
    a = b;
    b = c;
    c = first;
  }
  const auto at =
      std::lower_bound(vertices_.begin(), vertices_.end(), where_listed(mesh, a),
                       [&](uint32_t v, uint64_t place) { return where_listed(mesh, v) < place; });
  const auto i = static_cast<size_t>(at - vertices_.begin());
  uint32_t f = begin_[i];
  while (f + 1 < begin_[i + 1] && (face(f)[1] != b || face(f)[2] != c)) ++f;
  return f;
}

// Tests the marked faces around v against each other.
void MeetingSearch::search_star(const Mesh& mesh, uint32_t v, Pairs& pairs) const {
  const uint32_t count = mesh.rings.valence[v];
  if (count == 0 || mesh.absent(v)) return;
  bool marked = mesh.marked(v), moved = mesh.moved(v), border = false;
  for (uint32_t k = 0; k < count && !(marked && moved); ++k) {
    marked = marked || mesh.marked(mesh.rings.slot(v, k));
    moved = moved || mesh.moved(mesh.rings.slot(v, k));
  }
  for (uint32_t k = 0; k < count && mesh.held != nullptr; ++k) {
    border = border || mesh.absent(mesh.rings.slot(v, k));
  }
  if (!marked || !moved) return;
  if (!border && star_is_embedded(mesh.rings, mesh.positions, v)) return;
  const auto corners = [&](uint32_t k) {
    return std::array<uint32_t, 3>{v, mesh.rings.slot(v, k),
                                   mesh.rings.slot(v, k + 1 == count ? 0 : k + 1)};
  };
  for (uint32_t i = 0; i < count; ++i) {
    const auto f = corners(i);
    if (!mesh.listed(f.data())) continue;
    const bool f_moved = mesh.moved(f.data());
    const Triangle t = make_triangle(mesh.positions, f.data());
    for (uint32_t j = i + 1; j < count; ++j) {
      const auto g = corners(j);
      if (mesh.listed(g.data()) && (f_moved || mesh.moved(g.data())) &&
          triangles_intersect(t, make_triangle(mesh.positions, g.data()))) {
        const uint32_t a = index_of(mesh, f[0], f[1], f[2]), b = index_of(mesh, g[0], g[1], g[2]);
        pairs.emplace_back(std::min(a, b), std::max(a, b));
      }
    }
  }
}

// Lists the nodes of leaves whose boxes overlap that of this one, itself and those after it.
void MeetingSearch::find_near(uint32_t node, Vector<uint32_t>& near) const {
  near.clear();
  if (level_count_ == 2) {
    near.push_back(node);
    return;
  }
  const Box3 box = levels_[2].boxes[node / kLanes].at(node % kLanes);
  const bool moved = levels_[1].moved[node] != 0;
  struct Visit {
    uint32_t level, node;
  };
  std::array<Visit, 16 * kLanes> stack;  // at most 7 of each level wait
  uint32_t depth = 0;
  stack[depth++] = {static_cast<uint32_t>(level_count_ - 1), 0};
  while (depth != 0) {
    const Visit at = stack[--depth];
    const Level& level = levels_[at.level];
    uint32_t hits = level.boxes[at.node].overlapping(box);
    if (!moved) hits &= level.moved[at.node];
    // Nodes before this one find the pair when it is their turn.
    const uint32_t own = node >> (3 * (at.level - 2));  // the child of this level that holds it
    if (own >= (at.node + 1) * kLanes) continue;
    if (own >= at.node * kLanes) hits &= ~((1U << (own - at.node * kLanes)) - 1);
    for (; hits != 0; hits &= hits - 1) {
      const uint32_t child = at.node * kLanes + lowest_bit(hits);
      if (at.level == 2) {
        near.push_back(child);
      } else {
        stack[depth++] = {at.level - 1, child};
      }
    }
  }
}

// Tests the faces in the leaves of one node against those in the same and in later leaves with
// which they have no vertex in common.
void MeetingSearch::search_leaves(const Mesh& mesh, SimdTarget simd, uint32_t node,
                                  Scratch& scratch, Pairs& pairs) const {
  const Level &leaves = levels_[0], &nodes = levels_[1];
  find_near(node, scratch.near);
  const size_t room = scratch.near.size() * kernels::kMostPairs;
  if (scratch.candidates.size() < room) scratch.candidates.resize_uninitialized(room);
  const kernels::FaceBoxes tree{faces_.data(), leaves.boxes.data(), leaves.moved.data(),
                                nodes.boxes.data(), nodes.moved.data()};
  const auto end = std::min<size_t>((size_t{node} + 1) * kLanes, leaves.boxes.size());
  for (size_t leaf = size_t{node} * kLanes; leaf < end; ++leaf) {
    const size_t count =
        kernels::face_pairs(simd, tree, static_cast<uint32_t>(leaf), scratch.near.data(),
                            scratch.near.size(), scratch.candidates.data());
    for (size_t i = 0; i < count; ++i) {
      const auto [f, g] = scratch.candidates[i];
      if (triangles_intersect(make_triangle(mesh.positions, face(f)),
                              make_triangle(mesh.positions, face(g)))) {
        pairs.emplace_back(f, g);
      }
    }
  }
}

void MeetingSearch::search(const Mesh& mesh, std::span<const uint32_t> stars,
                           const Executor& executor) {
  const size_t nodes = levels_[1].boxes.size();
  const size_t star_tasks = block_count(stars.size(), kStarBlock);
  const size_t tasks = star_tasks + block_count(nodes, kSearchBlock);
  found_.resize(std::max(found_.size(), tasks));
  executor.run(tasks, [&](size_t task) {
    Pairs& pairs = found_[task];
    pairs.clear();
    if (task < star_tasks) {
      const size_t begin = task * kStarBlock;
      for (size_t i = begin; i < std::min(stars.size(), begin + kStarBlock); ++i) {
        search_star(mesh, stars[i], pairs);
      }
    } else {
      const Spares<Scratch>::Lent scratch = scratches_.lend();
      const size_t begin = (task - star_tasks) * kSearchBlock;
      for (size_t node = begin; node < std::min(nodes, begin + kSearchBlock); ++node) {
        search_leaves(mesh, executor.simd(), static_cast<uint32_t>(node), *scratch, pairs);
      }
    }
  });
  for (size_t task = 0; task < tasks; ++task) {
    pairs_.insert(pairs_.end(), found_[task].begin(), found_[task].end());
  }
  sort_pairs(mesh);
}

// A number by which faces lie in the order of their marked corners of the lowest ids, and around
// each in that of its ring, whatever they are listed with.
uint64_t MeetingSearch::place_of(const Mesh& mesh, uint32_t f) const {
  const uint32_t* abc = face(f);
  size_t first = 3;
  for (size_t k = 0; k < 3; ++k) {
    if (mesh.marked(abc[k]) && (first == 3 || abc[k] < abc[first])) first = k;
  }
  const uint32_t v = abc[first], w = abc[(first + 1) % 3];
  uint32_t slot = 0;
  while (mesh.rings.slot(v, slot) != w) ++slot;
  return uint64_t{v} << 32 | slot;
}

void MeetingSearch::sort_pairs(const Mesh& mesh) {
  if (pairs_.empty()) return;
  // Faces across an edge are found at both of its ends.
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  if (mesh.strays == nullptr) return;
  struct Placed {
    std::array<uint64_t, 2> places;
    FacePair pair;
  };
  Vector<Placed> placed;
  for (const auto& [f, g] : pairs_) {
    const uint64_t of_f = place_of(mesh, f), of_g = place_of(mesh, g);
    if (of_f < of_g) placed.push_back({{of_f, of_g}, {f, g}});
    if (of_f > of_g) placed.push_back({{of_g, of_f}, {g, f}});
  }
  std::sort(placed.begin(), placed.end(),
            [](const Placed& l, const Placed& r) { return l.places < r.places; });
  for (size_t i = 0; i < placed.size(); ++i) pairs_[i] = placed[i].pair;
}

const Vector<FacePair>& MeetingSearch::find(const RingView& rings, uint32_t slots,
                                            const Float4* positions, const uint8_t* marked,
                                            const Executor& executor, const Float4* before,
                                            const uint32_t* held, const uint8_t* strays) {
  mesh_ = {rings, slots, positions, marked, before, nullptr, held, strays};
  pairs_.clear();
  list_vertices(mesh_);
  list_faces(mesh_, executor);
  if (face_count() == 0) return pairs_;
  build_leaves(mesh_, executor);
  do build_level(level_count_, executor);
  while (levels_[level_count_ - 1].boxes.size() > 1);
  search(mesh_, {vertices_.data(), vertices_.size()}, executor);
  return pairs_;
}

// The vertices that have changed and their neighbours, where faces around them are listed.
void MeetingSearch::list_stars(const Mesh& mesh, const uint32_t* changed, size_t count) {
  stars_.clear();
  const auto list = [&](uint32_t v) {
    if (listed_[v] != 0) stars_.push_back(v);
  };
  for (const uint32_t v : std::span(changed, count)) {
    list(v);
    for (uint32_t k = 0; k < mesh.rings.valence[v]; ++k) list(mesh.rings.slot(v, k));
  }
  std::sort(stars_.begin(), stars_.end());
  stars_.erase(std::unique(stars_.begin(), stars_.end()), stars_.end());
}

const Vector<FacePair>& MeetingSearch::find_changed(const uint32_t* changed, size_t count,
                                                    const Executor& executor) {
  pairs_.clear();
  if (face_count() == 0 || count == 0) return pairs_;
  changed_.resize(std::max<size_t>(changed_.size(), mesh_.slots));
  for (const uint32_t v : std::span(changed, count)) changed_[v] = 1;
  Mesh mesh = mesh_;
  mesh.changed = changed_.data();
  update_tree(mesh, changed, count);
  list_stars(mesh, changed, count);
  search(mesh, stars_, executor);
  for (const uint32_t v : std::span(changed, count)) changed_[v] = 0;
  return pairs_;
}

}  // namespace plc

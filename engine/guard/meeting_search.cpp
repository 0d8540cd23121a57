#include "engine/guard/meeting_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "engine/base/blocks.h"
#include "engine/exact/triangle_intersection.h"
#include "engine/exact/vertex_star.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

// Per task: vertices whose faces are listed, and nodes that are built; vertices whose faces are
// searched, and nodes of leaves that are.
constexpr size_t kVertexBlock = 128;
constexpr size_t kNodeBlock = 128;
constexpr size_t kStarBlock = 128;
constexpr size_t kSearchBlock = 4;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

uint32_t lowest_bit(uint32_t mask) {
  return static_cast<uint32_t>(std::countr_zero(mask));
}

// visit(index) of the bytes that are not 0, ascending. They are few, so eight are looked at at
// once.
template <typename Visit>
void for_set_bytes(const uint8_t* bytes, uint32_t count, const Visit& visit) {
  for (uint32_t i = 0; i < count; ++i) {
    uint64_t eight = 0;
    while (i + sizeof eight <= count &&
           (std::memcpy(&eight, bytes + i, sizeof eight), eight == 0)) {
      i += sizeof eight;
    }
    if (i < count && bytes[i] != 0) visit(i);
  }
}

}  // namespace

Box3 MeetingSearch::all_lanes(const BoxLanes& b) {
  Box3 box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = *std::min_element(b.low[axis], b.low[axis] + kLanes);
    box.high[axis] = *std::max_element(b.high[axis], b.high[axis] + kLanes);
  }
  return box;
}

// The marked vertices and their neighbours; all vertices where there are no marks.
void MeetingSearch::list_vertices(const Mesh& mesh) {
  for (const uint32_t v : vertices_) listed_[v] = 0;
  vertices_.clear();
  listed_.resize(mesh.slots);
  const auto list = [&](uint32_t v) {
    if (listed_[v] == 0) vertices_.push_back(v);
    listed_[v] = 1;
  };
  const auto with_neighbors = [&](uint32_t v) {
    const uint32_t count = mesh.rings.valence[v];
    if (count != 0) list(v);
    for (uint32_t k = 0; k < count; ++k) list(mesh.rings.slot(v, k));
  };
  if (mesh.marks != nullptr) {
    for_set_bytes(mesh.marks, mesh.slots, with_neighbors);
    sort_vertices(mesh.slots);
    return;
  }
  for (uint32_t v = 0; v < mesh.slots; ++v) {
    if (mesh.rings.valence[v] != 0) list(v);
  }
}

// Makes the listed vertices ascend. Where there are many, it is faster to go through all ids.
void MeetingSearch::sort_vertices(uint32_t slots) {
  constexpr size_t kFew = 128;
  if (vertices_.size() < slots / kFew) {
    std::sort(vertices_.begin(), vertices_.end());
    return;
  }
  vertices_.clear();
  for_set_bytes(listed_.data(), slots, [&](uint32_t v) { vertices_.push_back(v); });
}

void MeetingSearch::list_faces(const Mesh& mesh, const Executor& executor) {
  // Visits each face once: at that of its marked corners which has the lowest id.
  const auto for_faces = [&](size_t begin, size_t end, const auto& vertex, const auto& face) {
    for (size_t i = begin; i < end; ++i) {
      const uint32_t v = vertices_[i];
      vertex(i);
      if (!mesh.marked(v)) continue;
      const uint32_t count = mesh.rings.valence[v];
      uint32_t b = mesh.rings.slot(v, 0);
      for (uint32_t k = 0; k < count; ++k) {
        const uint32_t a = b;
        b = mesh.rings.slot(v, k + 1 == count ? 0 : k + 1);
        if ((v < a || !mesh.marked(a)) && (v < b || !mesh.marked(b))) face(v, a, b);
      }
    }
  };
  const size_t count = vertices_.size();
  block_faces_.resize_uninitialized(block_count(count, kVertexBlock));
  run_blocks(executor, count, kVertexBlock, [&](size_t block, size_t begin, size_t end) {
    uint32_t faces = 0;
    for_faces(
        begin, end, [](size_t) {}, [&](uint32_t, uint32_t, uint32_t) { ++faces; });
    block_faces_[block] = faces;
  });
  uint32_t total = 0;
  for (uint32_t& n : block_faces_) {
    const uint32_t here = n;
    n = total;
    total += here;
  }
  face_count_ = total;
  // Whole leaves: kernels read the ids of all lanes.
  faces_.resize_uninitialized(3 * block_count(total, kLanes) * kLanes);
  std::fill(faces_.begin() + 3 * static_cast<std::ptrdiff_t>(total), faces_.end(), 0U);
  begin_.resize_uninitialized(count + 1);
  begin_[count] = total;
  run_blocks(executor, count, kVertexBlock, [&](size_t block, size_t begin, size_t end) {
    uint32_t next = block_faces_[block];
    for_faces(
        begin, end, [&](size_t i) { begin_[i] = next; },
        [&](uint32_t a, uint32_t b, uint32_t c) {
          uint32_t* out = faces_.data() + 3 * static_cast<size_t>(next++);
          out[0] = a, out[1] = b, out[2] = c;
        });
  });
}

void MeetingSearch::build_leaves(const Mesh& mesh, const Executor& executor) {
  if (levels_.empty()) levels_.emplace_back();
  level_count_ = 1;
  Level& level = levels_[0];
  const size_t count = block_count(face_count(), kLanes);
  level.boxes.resize_uninitialized(count);
  level.moved.resize_uninitialized(count);
  run_blocks(executor, count, kNodeBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t leaf = begin; leaf < end; ++leaf) {
      BoxLanes& boxes = level.boxes[leaf];
      uint32_t moved = 0;
      const auto used =
          static_cast<uint32_t>(std::min<size_t>(kLanes, face_count() - leaf * kLanes));
      for (uint32_t k = 0; k < used; ++k) {
        const uint32_t* abc = faces_.data() + 3 * (leaf * kLanes + k);
        const FaceBox box = face_box(mesh.positions, abc);
        boxes.set(k,
                  {{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}});
        moved |= static_cast<uint32_t>(mesh.moved(abc)) << k;
      }
      for (uint32_t k = used; k < kLanes; ++k) {
        boxes.set(k, {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}});
      }
      level.moved[leaf] = static_cast<uint8_t>(moved);
    }
  });
}

void MeetingSearch::build_level(size_t index, const Executor& executor) {
  if (levels_.size() <= index) levels_.emplace_back();
  level_count_ = index + 1;
  Level& level = levels_[index];
  const Level& below = levels_[index - 1];
  const size_t children = below.boxes.size(), count = block_count(children, kLanes);
  level.boxes.resize_uninitialized(count);
  level.moved.resize_uninitialized(count);
  run_blocks(executor, count, kNodeBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t node = begin; node < end; ++node) {
      uint32_t moved = 0;
      for (uint32_t k = 0; k < kLanes; ++k) {
        const size_t child = node * kLanes + k;
        const bool used = child < children;
        level.boxes[node].set(k, used ? all_lanes(below.boxes[child])
                                      : Box3{{kInfinity, kInfinity, kInfinity},
                                             {-kInfinity, -kInfinity, -kInfinity}});
        moved |= static_cast<uint32_t>(used && below.moved[child] != 0) << k;
      }
      level.moved[node] = static_cast<uint8_t>(moved);
    }
  });
}

// The index of a listed face, whichever of its corners comes first here.
uint32_t MeetingSearch::index_of(const Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) const {
  const auto before = [&](uint32_t x, uint32_t y) { return !mesh.marked(y) || x < y; };
  // Brings the marked corner of the lowest id to the front.
  while (!mesh.marked(a) || !before(a, b) || !before(a, c)) {
    const uint32_t first = a;
    a = b;
    b = c;
    c = first;
  }
  const auto i = static_cast<size_t>(std::lower_bound(vertices_.begin(), vertices_.end(), a) -
                                     vertices_.begin());
  uint32_t f = begin_[i];
  while (f + 1 < begin_[i + 1] && (face(f)[1] != b || face(f)[2] != c)) ++f;
  return f;
}

// Tests the marked faces around v against each other.
void MeetingSearch::search_star(const Mesh& mesh, uint32_t v, Pairs& pairs) const {
  const uint32_t count = mesh.rings.valence[v];
  if (count == 0) return;
  bool marked = mesh.marked(v), moved = mesh.moved(v);
  for (uint32_t k = 0; k < count && !(marked && moved); ++k) {
    marked = marked || mesh.marked(mesh.rings.slot(v, k));
    moved = moved || mesh.moved(mesh.rings.slot(v, k));
  }
  if (!marked || !moved || star_is_embedded(mesh.rings, mesh.positions, v)) return;
  const auto corners = [&](uint32_t k) {
    return std::array<uint32_t, 3>{v, mesh.rings.slot(v, k),
                                   mesh.rings.slot(v, k + 1 == count ? 0 : k + 1)};
  };
  for (uint32_t i = 0; i < count; ++i) {
    const auto f = corners(i);
    if (!mesh.marked(f.data())) continue;
    const bool f_moved = mesh.moved(f.data());
    const Triangle t = make_triangle(mesh.positions, f.data());
    for (uint32_t j = i + 1; j < count; ++j) {
      const auto g = corners(j);
      if (mesh.marked(g.data()) && (f_moved || mesh.moved(g.data())) &&
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

const Vector<FacePair>& MeetingSearch::find(const RingView& rings, uint32_t slots,
                                            const Float4* positions, const uint8_t* marked,
                                            const Executor& executor, const Float4* before) {
  const Mesh mesh{rings, slots, positions, marked, before};
  pairs_.clear();
  list_vertices(mesh);
  list_faces(mesh, executor);
  if (face_count() == 0) return pairs_;
  build_leaves(mesh, executor);
  do build_level(level_count_, executor);
  while (levels_[level_count_ - 1].boxes.size() > 1);
  const size_t nodes = levels_[1].boxes.size();
  const size_t vertex_tasks = block_count(vertices_.size(), kStarBlock);
  const size_t tasks = vertex_tasks + block_count(nodes, kSearchBlock);
  found_.resize(std::max(found_.size(), tasks));
  executor.run(tasks, [&](size_t task) {
    Pairs& pairs = found_[task];
    pairs.clear();
    if (task < vertex_tasks) {
      const size_t begin = task * kStarBlock;
      for (size_t i = begin; i < std::min(vertices_.size(), begin + kStarBlock); ++i) {
        search_star(mesh, vertices_[i], pairs);
      }
    } else {
      const Spares<Scratch>::Lent scratch = scratches_.lend();
      const size_t begin = (task - vertex_tasks) * kSearchBlock;
      for (size_t node = begin; node < std::min(nodes, begin + kSearchBlock); ++node) {
        search_leaves(mesh, executor.simd(), static_cast<uint32_t>(node), *scratch, pairs);
      }
    }
  });
  for (size_t task = 0; task < tasks; ++task) {
    pairs_.insert(pairs_.end(), found_[task].begin(), found_[task].end());
  }
  // Faces across an edge are found at both of its ends.
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  return pairs_;
}

}  // namespace plc

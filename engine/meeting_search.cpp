#include "engine/meeting_search.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "engine/blocks.h"
#include "engine/triangle_intersection.h"
#include "engine/vertex_star.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

// Vertices and nodes per task.
constexpr size_t kVertexBlock = 512;
constexpr size_t kNodeBlock = 128;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

uint32_t lowest_bit(uint32_t mask) {
  return static_cast<uint32_t>(__builtin_ctz(mask));
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
  for (uint32_t v = 0; v < mesh.slots; ++v) {
    if (mesh.marks != nullptr) {
      // Marks are few: eight at a time.
      uint64_t eight = 0;
      while (v + sizeof eight <= mesh.slots &&
             (std::memcpy(&eight, mesh.marks + v, sizeof eight), eight == 0)) {
        v += sizeof eight;
      }
      if (v == mesh.slots) break;
    }
    if (!mesh.marked(v) || mesh.rings.valence[v] == 0) continue;
    list(v);
    if (mesh.marks == nullptr) continue;
    for (uint32_t k = 0; k < mesh.rings.valence[v]; ++k) list(mesh.rings.slot(v, k));
  }
  std::sort(vertices_.begin(), vertices_.end());
}

void MeetingSearch::list_faces(const Mesh& mesh, const Executor& executor) {
  // Each face from the first of its corners that is listed.
  const auto for_faces = [&](size_t begin, size_t end, const auto& vertex, const auto& face) {
    for (size_t i = begin; i < end; ++i) {
      const uint32_t v = vertices_[i];
      vertex(i);
      const uint32_t count = mesh.rings.valence[v];
      uint32_t b = mesh.rings.slot(v, 0);
      for (uint32_t k = 0; k < count; ++k) {
        const uint32_t a = b;
        b = mesh.rings.slot(v, k + 1 == count ? 0 : k + 1);
        if ((v < a || listed_[a] == 0) && (v < b || listed_[b] == 0)) face(v, a, b);
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
  faces_.resize_uninitialized(3 * static_cast<size_t>(total));
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
  level.marked.resize_uninitialized(count);
  run_blocks(executor, count, kNodeBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t leaf = begin; leaf < end; ++leaf) {
      BoxLanes& boxes = level.boxes[leaf];
      uint32_t marked = 0;
      const auto used =
          static_cast<uint32_t>(std::min<size_t>(kLanes, face_count() - leaf * kLanes));
      for (uint32_t k = 0; k < used; ++k) {
        const uint32_t* abc = faces_.data() + 3 * (leaf * kLanes + k);
        const FaceBox box = face_box(mesh.positions, abc);
        boxes.set(k,
                  {{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}});
        marked |= static_cast<uint32_t>(mesh.marked(abc)) << k;
      }
      for (uint32_t k = used; k < kLanes; ++k) {
        boxes.set(k, {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}});
      }
      level.marked[leaf] = static_cast<uint8_t>(marked);
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
  level.marked.resize_uninitialized(count);
  run_blocks(executor, count, kNodeBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t node = begin; node < end; ++node) {
      uint32_t marked = 0;
      for (uint32_t k = 0; k < kLanes; ++k) {
        const size_t child = node * kLanes + k;
        const bool used = child < children;
        level.boxes[node].set(k, used ? all_lanes(below.boxes[child])
                                      : Box3{{kInfinity, kInfinity, kInfinity},
                                             {-kInfinity, -kInfinity, -kInfinity}});
        marked |= static_cast<uint32_t>(used && below.marked[child] != 0) << k;
      }
      level.marked[node] = static_cast<uint8_t>(marked);
    }
  });
}

uint32_t MeetingSearch::index_of(uint32_t a, uint32_t b, uint32_t c) const {
  const auto before = [&](uint32_t x, uint32_t y) { return listed_[y] == 0 || x < y; };
  // The first of those that are listed in front: a star's faces have one.
  while (listed_[a] == 0 || !before(a, b) || !before(a, c)) {
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

// Marked faces around v, with the others around v.
void MeetingSearch::search_star(const Mesh& mesh, uint32_t v, Pairs& pairs) const {
  const uint32_t count = mesh.rings.valence[v];
  if (count == 0) return;
  bool marked = mesh.marked(v);
  for (uint32_t k = 0; k < count && !marked; ++k) marked = mesh.marked(mesh.rings.slot(v, k));
  if (!marked || star_is_plain(mesh.rings, mesh.positions, v)) return;
  const auto corners = [&](uint32_t k) {
    return std::array<uint32_t, 3>{v, mesh.rings.slot(v, k),
                                   mesh.rings.slot(v, k + 1 == count ? 0 : k + 1)};
  };
  for (uint32_t i = 0; i < count; ++i) {
    const auto f = corners(i);
    const bool f_marked = mesh.marked(f.data());
    const Triangle t = make_triangle(mesh.positions, f.data());
    for (uint32_t j = i + 1; j < count; ++j) {
      const auto g = corners(j);
      if ((f_marked || mesh.marked(g.data())) &&
          triangles_intersect(t, make_triangle(mesh.positions, g.data()))) {
        const uint32_t a = index_of(f[0], f[1], f[2]), b = index_of(g[0], g[1], g[2]);
        pairs.emplace_back(std::min(a, b), std::max(a, b));
      }
    }
  }
}

// Marked faces of one leaf with those of a later one, or the same, that have no common vertex.
void MeetingSearch::search_leaves(const Mesh& mesh, uint32_t leaf, const Box3& other_box,
                                  uint32_t other, Pairs& pairs) const {
  const Level& level = levels_[0];
  uint32_t near = level.boxes[leaf].overlapping(other_box) & level.marked[leaf];
  for (; near != 0; near &= near - 1) {
    const uint32_t k = lowest_bit(near);
    uint32_t hits = level.boxes[other].overlapping(level.boxes[leaf].at(k));
    hits &= level.marked[other];
    if (other == leaf) hits &= ~((2U << k) - 1);
    const uint32_t* f = face(leaf * kLanes + k);
    for (; hits != 0; hits &= hits - 1) {
      const uint32_t* g = face(other * kLanes + lowest_bit(hits));
      bool common = false;
      for (int i = 0; i < 3; ++i) common |= (f[i] == g[0]) | (f[i] == g[1]) | (f[i] == g[2]);
      if (common) continue;
      if (triangles_intersect(make_triangle(mesh.positions, f), make_triangle(mesh.positions, g))) {
        const auto a = static_cast<uint32_t>((f - faces_.data()) / 3);
        const auto b = static_cast<uint32_t>((g - faces_.data()) / 3);
        pairs.emplace_back(std::min(a, b), std::max(a, b));
      }
    }
  }
}

void MeetingSearch::search_leaf(const Mesh& mesh, uint32_t leaf, Pairs& pairs) const {
  if (levels_[0].marked[leaf] == 0) return;
  const Box3 box = all_lanes(levels_[0].boxes[leaf]);
  struct Visit {
    uint32_t level, node;
  };
  std::array<Visit, 16 * kLanes> stack;  // at most 7 of each level wait
  uint32_t depth = 0;
  const auto top = static_cast<uint32_t>(level_count_ - 1);
  if (top == 0) {
    search_leaves(mesh, leaf, box, 0, pairs);
    return;
  }
  stack[depth++] = {top, 0};
  while (depth != 0) {
    const Visit at = stack[--depth];
    const Level& level = levels_[at.level];
    const BoxLanes& boxes = level.boxes[at.node];
    uint32_t hits = boxes.overlapping(box) & level.marked[at.node];
    // Children that lie before this leaf have found it themselves.
    const uint32_t own = leaf >> (3 * (at.level - 1));  // the child of this level that holds it
    if (own >= (at.node + 1) * kLanes) continue;
    if (own >= at.node * kLanes) hits &= ~((1U << (own - at.node * kLanes)) - 1);
    for (; hits != 0; hits &= hits - 1) {
      const uint32_t k = lowest_bit(hits), child = at.node * kLanes + k;
      if (at.level == 1) {
        search_leaves(mesh, leaf, boxes.at(k), child, pairs);
      } else {
        stack[depth++] = {at.level - 1, child};
      }
    }
  }
}

const Vector<FacePair>& MeetingSearch::find(const RingView& rings, uint32_t slots,
                                            const Packed* positions, const uint8_t* marked,
                                            const Executor& executor) {
  const Mesh mesh{rings, slots, positions, marked};
  pairs_.clear();
  faces_.clear();
  list_vertices(mesh);
  list_faces(mesh, executor);
  if (face_count() == 0) return pairs_;
  build_leaves(mesh, executor);
  while (levels_[level_count_ - 1].boxes.size() > 1) build_level(level_count_, executor);
  const size_t leaves = levels_[0].boxes.size();
  const size_t vertex_tasks = block_count(vertices_.size(), kVertexBlock);
  const size_t tasks = vertex_tasks + block_count(leaves, kNodeBlock);
  found_.resize(std::max(found_.size(), tasks));
  executor.run(tasks, [&](size_t task) {
    Pairs& pairs = found_[task];
    pairs.clear();
    if (task < vertex_tasks) {
      const size_t begin = task * kVertexBlock;
      for (size_t i = begin; i < std::min(vertices_.size(), begin + kVertexBlock); ++i) {
        search_star(mesh, vertices_[i], pairs);
      }
    } else {
      const size_t begin = (task - vertex_tasks) * kNodeBlock;
      for (size_t leaf = begin; leaf < std::min(leaves, begin + kNodeBlock); ++leaf) {
        search_leaf(mesh, static_cast<uint32_t>(leaf), pairs);
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

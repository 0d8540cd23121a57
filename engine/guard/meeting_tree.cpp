// The listed faces of a search for meetings, and the tree of boxes over them.
#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "engine/base/blocks.h"
#include "engine/base/marks.h"
#include "engine/exact/triangle_intersection.h"
#include "engine/guard/meeting_search.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

// Per task: vertices whose faces are listed, and nodes that are built.
constexpr size_t kVertexBlock = 128;
constexpr size_t kNodeBlock = 128;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Box3 box_of(const Float4* positions, const uint32_t* abc) {
  const FaceBox box = face_box(positions, abc);
  return {{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}};
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
    visit_marks(mesh.marks, mesh.slots, with_neighbors);
    sort_vertices(mesh.slots);
    if (mesh.strays != nullptr) place_strays(mesh);
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
  visit_marks(listed_.data(), slots, [&](uint32_t v) { vertices_.push_back(v); });
}

uint64_t MeetingSearch::where_listed(const Mesh& mesh, uint32_t v) {
  if (!mesh.stray(v)) return uint64_t{v} << 32;
  // Behind the neighbour of the lowest id that is no stray, or that of a neighbour.
  constexpr uint32_t kNone = ~0U;
  const auto neighbor = [&](uint32_t w) {
    uint32_t first = kNone;
    for (uint32_t k = 0; k < mesh.rings.valence[w]; ++k) {
      const uint32_t x = mesh.rings.slot(w, k);
      if (!mesh.stray(x)) first = std::min(first, x);
    }
    return first;
  };
  uint32_t behind = neighbor(v);
  for (uint32_t k = 0; k < mesh.rings.valence[v] && behind == kNone; ++k) {
    behind = neighbor(mesh.rings.slot(v, k));
  }
  if (behind == kNone) behind = v;
  return uint64_t{behind} << 32 | (uint64_t{v} + 1);
}

// The listed vertices ascend.
void MeetingSearch::place_strays(const Mesh& mesh) {
  struct Listed {
    uint64_t place;
    uint32_t vertex;
  };
  Vector<Listed> strays;
  Vector<uint32_t> others;
  others.reserve(vertices_.size());
  for (const uint32_t v : vertices_) {
    if (mesh.stray(v)) {
      strays.push_back({where_listed(mesh, v), v});
    } else {
      others.push_back(v);
    }
  }
  std::sort(strays.begin(), strays.end(),
            [](const Listed& l, const Listed& r) { return l.place < r.place; });
  vertices_.clear();
  auto stray = strays.begin();
  for (const uint32_t v : others) {
    for (; stray != strays.end() && stray->place < uint64_t{v} << 32; ++stray) {
      vertices_.push_back(stray->vertex);
    }
    vertices_.push_back(v);
  }
  for (; stray != strays.end(); ++stray) vertices_.push_back(stray->vertex);
}

void MeetingSearch::list_faces(const Mesh& mesh, const Executor& executor) {
  // Visits each face once.
  const auto for_faces = [&](size_t begin, size_t end, const auto& vertex, const auto& face) {
    for (size_t i = begin; i < end; ++i) {
      const uint32_t v = vertices_[i];
      vertex(i);
      if (!mesh.marked(v) || mesh.absent(v)) continue;
      const uint32_t count = mesh.rings.valence[v];
      uint32_t b = mesh.rings.slot(v, 0);
      for (uint32_t k = 0; k < count; ++k) {
        const uint32_t a = b;
        b = mesh.rings.slot(v, k + 1 == count ? 0 : k + 1);
        if (mesh.absent(a) || mesh.absent(b)) continue;
        if (mesh.precedes(v, a) && mesh.precedes(v, b)) face(v, a, b);
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
        const uint32_t* abc = face(static_cast<uint32_t>(leaf * kLanes + k));
        boxes.set(k, box_of(mesh.positions, abc));
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

void MeetingSearch::set_face(const Mesh& mesh, uint32_t f) {
  levels_[0].boxes[f / kLanes].set(f % kLanes, box_of(mesh.positions, face(f)));
  levels_[0].moved[f / kLanes] |= static_cast<uint8_t>(1U << (f % kLanes));
  nodes_.push_back(f / kLanes);
}

// Node `child` of the level below has a face that has moved.
void MeetingSearch::set_child(size_t level, size_t child) {
  levels_[level].boxes[child / kLanes].set(child % kLanes,
                                           all_lanes(levels_[level - 1].boxes[child]));
  levels_[level].moved[child / kLanes] |= static_cast<uint8_t>(1U << (child % kLanes));
}

void MeetingSearch::update_tree(const Mesh& mesh, const uint32_t* changed, size_t count) {
  for (size_t level = 0; level < level_count_; ++level) {
    std::fill(levels_[level].moved.begin(), levels_[level].moved.end(), uint8_t{0});
  }
  nodes_.clear();
  for (const uint32_t v : std::span(changed, count)) {
    const uint32_t valence = mesh.rings.valence[v];
    for (uint32_t k = 0; k < valence; ++k) {
      const std::array<uint32_t, 3> abc{v, mesh.rings.slot(v, k),
                                        mesh.rings.slot(v, k + 1 == valence ? 0 : k + 1)};
      if (mesh.listed(abc.data())) set_face(mesh, index_of(mesh, abc[0], abc[1], abc[2]));
    }
  }
  for (size_t level = 1; level < level_count_; ++level) {
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    for (uint32_t& node : nodes_) {
      set_child(level, node);
      node /= kLanes;
    }
  }
}

}  // namespace plc

// The listed faces of a search for meetings, and their boxes.
#include <algorithm>
#include <array>
#include <span>

#include "engine/base/blocks.h"
#include "engine/base/marks.h"
#include "engine/exact/triangle_intersection.h"
#include "engine/guard/meeting_search.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kVertexBlock = 128;  // per task: vertices whose faces are listed

Box3 box_of(const Float4* positions, const uint32_t* abc) {
  const FaceBox box = face_box(positions, abc);
  return {{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}};
}

}  // namespace

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
  faces_.resize_uninitialized(BoxTree::room_for(total));
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

void MeetingSearch::build_tree(const Mesh& mesh, const Executor& executor) {
  tree_.build(face_count(), executor, [&](size_t f) {
    const uint32_t* abc = face(static_cast<uint32_t>(f));
    return BoxTree::Face{box_of(mesh.positions, abc), mesh.moved(abc)};
  });
}

void MeetingSearch::update_tree(const Mesh& mesh, const uint32_t* changed, size_t count) {
  tree_.set_still();
  for (const uint32_t v : std::span(changed, count)) {
    const uint32_t valence = mesh.rings.valence[v];
    for (uint32_t k = 0; k < valence; ++k) {
      const std::array<uint32_t, 3> abc{v, mesh.rings.slot(v, k),
                                        mesh.rings.slot(v, k + 1 == valence ? 0 : k + 1)};
      if (!mesh.listed(abc.data())) continue;
      tree_.set(index_of(mesh, abc[0], abc[1], abc[2]), box_of(mesh.positions, abc.data()));
    }
  }
  tree_.update();
}

}  // namespace plc

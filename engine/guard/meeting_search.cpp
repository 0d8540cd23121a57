#include "engine/guard/meeting_search.h"

#include <algorithm>
#include <array>
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

void MeetingSearch::search(const Mesh& mesh, std::span<const uint32_t> stars,
                           const Executor& executor) {
  const size_t nodes = tree_.nodes();
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
      const Spares<BoxTree::Scratch>::Lent scratch = scratches_.lend();
      const size_t begin = (task - star_tasks) * kSearchBlock;
      for (size_t node = begin; node < std::min(nodes, begin + kSearchBlock); ++node) {
        tree_.pairs(executor.simd(), faces_.data(), static_cast<uint32_t>(node), *scratch,
                    [&](uint32_t f, uint32_t g) {
                      if (triangles_intersect(make_triangle(mesh.positions, face(f)),
                                              make_triangle(mesh.positions, face(g)))) {
                        pairs.emplace_back(f, g);
                      }
                    });
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
  build_tree(mesh_, executor);
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

#include "engine/resolve/conform.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <queue>
#include <string>
#include <tuple>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/guard/obstacles.h"
#include "engine/guard/self_meeting.h"
#include "engine/mesh/face_rings.h"
#include "engine/mesh/mesh_invariants.h"
#include "engine/resolve/refinement.h"
#include "engine/resolve/resolution.h"
#include "engine/transform/creation.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// The iteration never advances, so that pairs that an annular transformation has cut are never old
// enough to be joined again: without forces that part them they would be cut and joined for ever.
constexpr uint32_t kIteration = 1;
// So many vertices to a transformation are hardly worth another pass.
constexpr uint32_t kFewOperations = 256;

// visit(u, v, squared length) for every edge, u < v.
template <typename Visit>
void visit_edges(const Mesh& mesh, const Visit& visit) {
  for (uint32_t u = 0; u < mesh.slots(); ++u) {
    for (uint32_t k = 0; k < mesh.valence(u); ++k) {
      const uint32_t v = mesh.neighbor(u, k);
      if (u < v) visit(u, v, squared_distance(mesh.at(u), mesh.at(v)));
    }
  }
}

struct LongEdge {
  float squared;
  uint32_t u, v;
  // Puts the longest edge on top of a queue, and of equally long ones that of the lowest ids.
  friend bool operator<(const LongEdge& l, const LongEdge& r) {
    return std::tie(l.squared, r.u, r.v) < std::tie(r.squared, l.u, l.v);
  }
};

// How many vertices there will be at least: no face within (2) is larger than the equilateral one.
double vertices_needed(const Mesh& mesh, const Executor& executor) {
  Vector<double> areas(block_count(mesh.slots(), kGrain), 0);
  run_blocks(executor, mesh.slots(), kGrain, [&](size_t block, size_t begin, size_t end) {
    mesh.visit_faces(static_cast<uint32_t>(begin), static_cast<uint32_t>(end),
                     [&](uint32_t v, uint32_t a, uint32_t b) {
                       areas[block] += static_cast<double>(length(area_vector(mesh, v, a, b))) / 2;
                     });
  });
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  const double edge = static_cast<double>(kMaxEdge) * mesh.delta;
  return area / (std::sqrt(3.0) / 4 * edge * edge) / 2;
}

// The ends of the edges that vertices were created on, in the order of their ids.
using Ends = Vector<std::array<uint32_t, 2>>;

// whole: of the vertices that were given; edges between two of them of which one is marked stay.
Status divide_long_edges(Mesh& mesh, const Vector<uint8_t>& whole, const Executor& executor,
                         Ends& ends, OperationCounts& counts) {
  if (vertices_needed(mesh, executor) > static_cast<double>(mesh.most_vertices))
    return too_many_vertices();
  const auto stays = [&](uint32_t v) { return v < whole.size() && whole[v] != 0; };
  // An edge in the queue stays what it is until its turn: only edges taken from it go.
  std::priority_queue<LongEdge> queue;
  const auto consider = [&](uint32_t u, uint32_t v, float squared) {
    const float size = mesh.size_between(u, v);
    if (squared >= kMaxEdge * kMaxEdge * size * size && !stays(u) && !stays(v))
      queue.push({squared, std::min(u, v), std::max(u, v)});
  };
  visit_edges(mesh, consider);
  while (!queue.empty()) {
    const LongEdge top = queue.top();
    queue.pop();
    const Edge e = edge_between(mesh, top.u, top.v);
    if (mesh.slots() >= mesh.most_vertices) return too_many_vertices();
    if (std::max(mesh.valence(e.a), mesh.valence(e.b)) >= mesh.most_neighbors) {
      return {ErrorCode::kInvalidData, "too many edges at one vertex to divide those around it"};
    }
    const uint32_t w = create_on_edge(mesh, e);
    assert(w == whole.size() + ends.size());
    ends.push_back({e.u, e.v});
    ++counts.creation;
    for (const uint32_t x : {e.u, e.a, e.v, e.b}) {
      consider(w, x, squared_distance(mesh.at(w), mesh.at(x)));
    }
  }
  return {};
}

// Marks a vertex of the given ones, or those that the edge of a created one led between.
void mark_given(uint32_t v, const Ends& ends, Vector<uint8_t>& whole) {
  if (v < whole.size()) {
    whole[v] = 1;
    return;
  }
  for (const uint32_t end : ends[v - whole.size()]) mark_given(end, ends, whole);
}

Status too_thin() {
  return {ErrorCode::kInvalidData,
          "the surface has faces too thin to be divided in single precision"};
}

// Where divided faces meet, in single precision, they are left whole: the guards look as far as the
// longest edge asks for (measure_edges), and divide it if they can.
Status divide_faces(Mesh& mesh, const Schedule& schedule, OperationCounts& counts) {
  constexpr int kTries = 8;
  const uint32_t given = mesh.slots();
  const Mesh undivided = mesh.copy();
  const OperationCounts before = counts;
  Vector<uint8_t> whole(given, 0);
  for (int i = 0;; ++i) {
    Ends ends;
    if (Status s = divide_long_edges(mesh, whole, schedule, ends, counts); !s.ok()) return s;
    if (mesh.slots() == given) return {};
    // The search has boxes around vertices of successive ids. Where these lie anywhere, all boxes
    // overlap, and it would take quadratic time.
    const Vector<uint32_t> order = morton_order(mesh, schedule);
    mesh.renumber(order, schedule);
    const auto meeting = meeting_faces(mesh, schedule);
    Obstacles::Meeting with_obstacle;
    if (mesh.obstacles != nullptr && mesh.obstacles->find_meeting(mesh, with_obstacle)) {
      return too_thin();
    }
    if (meeting.empty()) return {};
    if (i == kTries) std::fill(whole.begin(), whole.end(), uint8_t{1});
    for (const auto& face : meeting) {
      for (const uint32_t v : face) mark_given(order[v], ends, whole);
    }
    mesh.take(undivided.copy());
    counts = before;
  }
}

// Edges where the size is below delta count for as much longer as they are to be shorter.
double longest_edge(const Mesh& mesh) {
  float longest = 0;
  visit_edges(mesh, [&](uint32_t u, uint32_t v, float squared) {
    const float size = mesh.size_between(u, v) / static_cast<float>(mesh.delta);
    longest = std::max(longest, size < 1 ? squared / (size * size) : squared);
  });
  return std::sqrt(static_cast<double>(longest));
}

Status settle(Mesh& mesh, const Executor& executor, Detection& detection, Resolution& resolution,
              OperationCounts& counts, const GoOn& go_on) {
  mesh.renumber(morton_order(mesh, executor), executor);
  detection.restart();
  resolution.restart();
  measure_edges(mesh);
  for (int pass = 0; pass < kConformPasses; ++pass) {
    const int64_t before = counts.transformations();
    // Nothing freezes here: the passes end where one changes nothing, or there are too many.
    std::fill(mesh.turns.begin(), mesh.turns.end(), uint8_t{0});
    if (Resolution::asks_for_pairs(mesh, kIteration)) {
      detection.search_near_all();
    } else {
      detection.list_all();
      detection.update_hash();
    }
    resolution.run(kIteration, {}, counts);
    if (Status s = ask(go_on); !s.ok()) return s;
    const int64_t done = counts.transformations() - before;
    // Sizes of an adaptive mesh are kept while it moves: a few edges more or less are for then.
    const int64_t few = mesh.sizing == nullptr ? 0 : mesh.vertex_count() / kFewOperations;
    if (done <= few) break;
  }
  return {};
}

void put_at_rest(Mesh& mesh, const Executor& executor) {
  mesh.renumber(morton_order(mesh, executor), executor);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    mesh.wake(v);
    mesh.velocity.set(v, {});
    mesh.path[v] = 0;
    mesh.turns[v] = 0;
    mesh.cut_id[v] = 0;
  }
}

}  // namespace

Status conform(Mesh& mesh, double delta, const Schedule& schedule, OperationCounts& counts,
               const GoOn& go_on) {
  mesh.delta = delta;
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.resize(v);
  if (Status s = divide_faces(mesh, schedule, counts); !s.ok()) return s;
  Detection detection(mesh, schedule);
  Resolution resolution(mesh, schedule, detection);
  // So that the longest edge is just within (2).
  constexpr double kRoom = 1.01;
  double step = longest_edge(mesh) / static_cast<double>(kMaxEdge) * kRoom;
  while (step < delta && mesh.vertex_count() != 0) {
    mesh.delta = step;
    if (Status s = settle(mesh, schedule, detection, resolution, counts, go_on); !s.ok()) return s;
    step *= kRefinement;
  }
  mesh.delta = delta;
  if (Status s = settle(mesh, schedule, detection, resolution, counts, go_on); !s.ok()) return s;
  put_at_rest(mesh, schedule);
  if (mesh.vertex_count() == 0) {
    return {ErrorCode::kInvalidData,
            "nothing is left of the surface at this resolution: it is too small or too thin"};
  }
  if (mesh.sizing == nullptr) {
    constexpr float kRounding = 1.001F;
    measure_edges(mesh);
    if (mesh.stretch > kRounding) return too_thin();
    mesh.stretch = 1;
  } else {
    mesh.stretch = kSizedStretch;
    mesh.longest_edge = mesh.longest_sized_edge();
  }
  assert(broken_invariant(mesh).empty());
  if (const auto meeting = meeting_faces(mesh, schedule); !meeting.empty()) {
    const Vec3 p = mesh.at(meeting[0][0]);
    char line[160];
    std::snprintf(line, sizeof line,
                  "the surface meets itself after it was brought to delta %.6g: %zu faces, the "
                  "first at (%.6g, %.6g, %.6g)",
                  delta, meeting.size(), static_cast<double>(p.x), static_cast<double>(p.y),
                  static_cast<double>(p.z));
    return {ErrorCode::kInternal, line};
  }
  return {};
}

}  // namespace plc

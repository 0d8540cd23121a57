#include "engine/simplify/simplification.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/blocks.h"
#include "engine/base/spares.h"
#include "engine/measure/mesh_topology.h"
#include "engine/simplify/quadric.h"
#include "engine/simplify/trial.h"

namespace plc {
namespace {

// Collapses that are tried at once, and of those by one task. Results depend on the first.
constexpr size_t kBatch = 256, kTask = 4;
// Of the tolerance, what is proved on the way: so the measurement, which tells up to 2 % more than
// there is (hausdorff.h), stays within the tolerance.
constexpr double kWorking = 0.975;
// Of the weight of a quadric: how strongly the middle of the edge draws, see least_of().
constexpr double kPull = 1e-6;
// What progress tells at the end of the first round, the longest.
constexpr double kFirstRound = 0.9;

struct Entry {
  double cost;
  uint32_t u, v;
  uint32_t version;
  // The cheapest is on top of the heap; ties by ids.
  bool operator<(const Entry& o) const {
    if (cost != o.cost) return cost > o.cost;
    if (u != o.u) return u > o.u;
    if (v != o.v) return v > o.v;
    return version > o.version;
  }
};

class Simplification {
 public:
  Simplification(const MeshArrays& mesh, const SimplifyOptions& options, const Executor& executor)
      : executor_(executor),
        mesh_(mesh, executor),
        original_(mesh, executor),
        proofs_(mesh.face_count),
        around_{mesh_,
                tree_,
                proofs_,
                original_,
                component_,
                options.tolerance * options.tolerance * kWorking * kWorking,
                options.two_sided} {
    const EdgeTable edges(mesh.abc, mesh.face_count, mesh.vertex_count, executor);
    component_ =
        mesh_topology(mesh.abc, mesh.face_count, mesh.vertex_count, edges, executor).component;
    tree_.build(mesh_, executor);
    floats_ = std::all_of(mesh.xyz, mesh.xyz + 3 * mesh.vertex_count,
                          [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
    Bounds all;
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) all.add(point_of(mesh.xyz, v));
    centre_ = (all.low + all.high) * 0.5;
    set_quadrics();
    version_.resize(mesh.vertex_count);
    busy_.resize(mesh.vertex_count);
    dirty_.resize(mesh.vertex_count);
    std::fill(dirty_.begin(), dirty_.end(), uint8_t{1});
  }

  Status run(const std::function<bool(double)>& go_on) {
    double done = 0;
    while (true) {
      fill_heap();
      const size_t before = mesh_.living_vertices();
      const auto edges = static_cast<double>(heap_.size());
      while (!heap_.empty()) {
        run_batch();
        done = std::max(done, kFirstRound * (1 - static_cast<double>(heap_.size()) / edges));
        if (go_on && !go_on(done)) return {ErrorCode::kCancelled, "cancelled"};
      }
      if (before == mesh_.living_vertices()) break;
    }
    return {};
  }

  void take(SimplifiedMesh& result) const {
    Vector<uint32_t> id(mesh_.vertex_count(), 0);
    for (uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
      if (!mesh_.vertex_lives(v)) continue;
      id[v] = static_cast<uint32_t>(result.xyz.size() / 3);
      const Double3 p = mesh_.at(v);
      result.xyz.insert(result.xyz.end(), {p.x, p.y, p.z});
    }
    for (uint32_t f = 0; f < mesh_.face_count(); ++f) {
      if (!mesh_.face_lives(f)) continue;
      for (int k = 0; k < 3; ++k) result.abc.push_back(id[mesh_.face(f)[k]]);
    }
  }

 private:
  void set_quadrics() {
    quadric_.resize(mesh_.vertex_count());
    run_blocks(executor_, mesh_.vertex_count(), 512, [&](size_t, size_t begin, size_t end) {
      for (size_t v = begin; v < end; ++v) {
        if (!mesh_.vertex_lives(static_cast<uint32_t>(v))) continue;
        mesh_.around(static_cast<uint32_t>(v), [&](uint32_t c) {
          const Corners3 t = mesh_.corners(c / 3);
          quadric_[v].add(quadric_of(t[0] - centre_, t[1] - centre_, t[2] - centre_));
        });
      }
    });
  }

  // Where the quadrics of both are least, but near the edge.
  Double3 place_of(uint32_t u, uint32_t v, double& cost) const {
    Quadric q = quadric_[u];
    q.add(quadric_[v]);
    const Double3 a = mesh_.at(u) - centre_, b = mesh_.at(v) - centre_;
    const Double3 along = b - a;
    Double3 place = least_of(q, (a + b) * 0.5, kPull);
    if (dot(place - (a + b) * 0.5, place - (a + b) * 0.5) > 4 * dot(along, along)) {
      place = (a + b) * 0.5;
    }
    cost = std::max(q.at(place), 0.0) + 1e-9 * q.weight * dot(along, along);
    place = place + centre_;
    if (floats_) {
      place = {static_cast<double>(static_cast<float>(place.x)),
               static_cast<double>(static_cast<float>(place.y)),
               static_cast<double>(static_cast<float>(place.z))};
    }
    return place;
  }

  Entry entry_of(uint32_t u, uint32_t v) const {
    if (u > v) std::swap(u, v);
    Entry e{0, u, v, version_[u] + version_[v]};
    place_of(u, v, e.cost);
    return e;
  }

  // With every edge around which something has changed since the last time.
  void fill_heap() {
    heap_.clear();
    Vector<Vector<Entry>> parts(block_count(mesh_.vertex_count(), 512));
    run_blocks(executor_, mesh_.vertex_count(), 512, [&](size_t block, size_t begin, size_t end) {
      for (auto u = static_cast<uint32_t>(begin); u < end; ++u) {
        if (!mesh_.vertex_lives(u)) continue;
        mesh_.around(u, [&](uint32_t c) {
          const uint32_t v = mesh_.vertex(next_corner(c));
          if (u < v && (dirty_[u] != 0 || dirty_[v] != 0)) parts[block].push_back(entry_of(u, v));
        });
      }
    });
    for (const Vector<Entry>& part : parts) heap_.insert(heap_.end(), part.begin(), part.end());
    std::make_heap(heap_.begin(), heap_.end());
    std::fill(dirty_.begin(), dirty_.end(), uint8_t{0});
  }

  // Whether no vertex beside u or v is beside another edge of the batch; they are from now on.
  bool claim(uint32_t u, uint32_t v) {
    bool free = true;
    const auto look = [&](uint32_t c) {
      free = free && busy_[mesh_.vertex(next_corner(c))] != round_;
    };
    mesh_.around(u, look);
    mesh_.around(v, look);
    if (!free) return false;
    const auto mark = [&](uint32_t c) { busy_[mesh_.vertex(next_corner(c))] = round_; };
    mesh_.around(u, mark);
    mesh_.around(v, mark);
    return true;
  }

  // The next collapses, cheapest first, that have no vertex in common; how many.
  size_t choose_batch() {
    ++round_;
    size_t size = 0;
    deferred_.clear();
    trials_.resize(kBatch);
    while (!heap_.empty() && size < kBatch && deferred_.size() < 2 * kBatch) {
      std::pop_heap(heap_.begin(), heap_.end());
      const Entry e = heap_.back();
      heap_.pop_back();
      if (!mesh_.vertex_lives(e.u) || !mesh_.vertex_lives(e.v) ||
          e.version != version_[e.u] + version_[e.v]) {
        continue;
      }
      const uint32_t corner = mesh_.corner_to(e.u, e.v);
      if (corner == kNoCorner) continue;
      if (!claim(e.u, e.v)) {
        deferred_.push_back(e);
        continue;
      }
      Trial& trial = trials_[size++];
      trial.corner = corner, trial.u = e.u, trial.v = e.v;
    }
    for (const Entry& e : deferred_) {
      heap_.push_back(e);
      std::push_heap(heap_.begin(), heap_.end());
    }
    return size;
  }

  // All are tried at once, as none changes the mesh; those that can be done are, one after the
  // other, unless what becomes of one meets what has become of another.
  void run_batch() {
    const size_t size = choose_batch();
    run_blocks(executor_, size, kTask, [&](size_t, size_t begin, size_t end) {
      const auto trier = triers_.lend();
      for (size_t i = begin; i < end; ++i) {
        double cost = 0;
        trials_[i].place = place_of(trials_[i].u, trials_[i].v, cost);
        (*trier).run(around_, trials_[i]);
      }
    });
    done_.clear();
    for (size_t i = 0; i < size; ++i) {
      if (!trials_[i].good) continue;
      if (!apart(trials_[i])) {
        dirty_[trials_[i].u] = 1;
        continue;
      }
      commit(trials_[i]);
      done_.push_back(static_cast<uint32_t>(i));
    }
    tree_.refresh(executor_);
  }

  bool apart(const Trial& trial) const {
    for (const uint32_t i : done_) {
      const Trial& other = trials_[i];
      if (!other.bounds.overlaps(trial.bounds)) continue;
      for (const Triangle& f : other.shape) {
        for (const Triangle& g : trial.shape) {
          if (triangles_intersect(f, g)) return false;
        }
      }
    }
    return true;
  }

  void commit(const Trial& trial) {
    for (const uint32_t f : trial.faces) proofs_.clear(f);
    for (const uint32_t f : trial.dying) proofs_.clear(f);
    for (const uint32_t t : trial.originals) proofs_.renew(t);
    for (const Trial::Use& use : trial.uses) proofs_.use(use.original, use.face);
    mesh_.collapse(trial.corner, trial.place);
    quadric_[trial.u].add(quadric_[trial.v]);
    ++version_[trial.u];
    tree_.change(trial.faces.data(), trial.faces.size());
    tree_.change(trial.dying, 2);
    dirty_[trial.u] = 1;
    mesh_.around(trial.u, [&](uint32_t c) {
      const uint32_t v = mesh_.vertex(next_corner(c));
      dirty_[v] = 1;
      heap_.push_back(entry_of(trial.u, v));
      std::push_heap(heap_.begin(), heap_.end());
    });
  }

  const Executor& executor_;
  CollapseMesh mesh_;
  MeshTarget original_;
  Proofs proofs_;
  LivingTree tree_;
  Vector<uint32_t> component_;
  Buffer<Quadric> quadric_;
  Buffer<uint32_t> version_, busy_;
  Buffer<uint8_t> dirty_;
  Vector<Entry> heap_, deferred_;
  std::vector<Trial> trials_;
  Vector<uint32_t> done_;
  Spares<Trier> triers_;
  Double3 centre_;
  uint32_t round_ = 0;
  bool floats_ = false;
  TrialContext around_;
};

}  // namespace

Status simplify(const MeshArrays& mesh, const SimplifyOptions& options, const Executor& executor,
                SimplifiedMesh& result) {
  Simplification work(mesh, options, executor);
  Status status = work.run(options.go_on);
  if (status.ok()) work.take(result);
  return status;
}

}  // namespace plc

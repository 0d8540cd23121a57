#include "engine/resolve/resolution.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <utility>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/base/parallel_sort.h"
#include "engine/detect/denied_cycles.h"
#include "engine/detect/edge_constraints.h"
#include "engine/detect/proximity.h"
#include "engine/guard/obstacles.h"
#include "kernels/ring_forces.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

constexpr size_t kChunk = 64;          // queue entries per task
constexpr size_t kPairChunk = 16;      // ... of constraint (3), which take longer
constexpr uint32_t kSortedQueue = 16;  // queues of more than one in so many vertices are not sorted
constexpr size_t kTrialRun = 512;      // candidates per run of trials
constexpr size_t kFewTrials = 8;       // not worth tasks

// Runs collect(i, out) for [0, count) by chunks, and sorts what they have found.
template <typename Less, typename Collect>
Vector<Candidate> collect_sorted(const Executor& executor, size_t count, size_t chunk_size,
                                 const Less& less, const Collect& collect) {
  std::vector<Vector<Candidate>> found(block_count(count, chunk_size));
  run_blocks(executor, count, chunk_size, [&](size_t chunk, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) collect(i, found[chunk]);
  });
  Vector<Candidate> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  parallel_sort(all, executor, less);
  return all;
}

}  // namespace

Resolution::Resolution(Mesh& mesh, const Executor& executor, Detection& detection)
    : mesh_(mesh),
      executor_(executor),
      detection_(detection),
      trials_(mesh, detection.hash(), executor) {}

bool Resolution::asks_for_pairs(const Mesh& mesh, uint32_t iteration) {
  return mesh.sizing == nullptr || !mesh.sizing->full_image || iteration >= kFirstPairs;
}

void Resolution::restart() {
  stamp_.clear();
  stamps_ = round_ = 0;
  tiny_.start(mesh_);
}

void Resolution::save(StateWriter& to) const {
  to.add(next_cut_);
  tiny_.save(to);
}

void Resolution::restore(StateReader& from) {
  restart();
  from.read(next_cut_);
  tiny_.restore(from, mesh_.slots());
}

void Resolution::run(uint32_t iteration, const Vector<uint32_t>& moved_since,
                     OperationCounts& counts) {
  iteration_ = iteration;
  operations_.clear();
  operations_.resize(mesh_.slots());
  pair_queue_ = moved_since;
  changed_.clear();
  counts.tetrahedron += tiny_.delete_turned_over(mesh_, staying());
  stamp_.resize(mesh_.slots(), 0);
  queue_violated_edges();
  const bool pairs = asks_for_pairs(mesh_, iteration);
  for (int pass = 0; pass < kMaxAxialPasses; ++pass) {
    resolve_edges(counts);
    if (!pairs || !resolve_pairs(pass == 0, counts)) break;
  }
  // What the limits left over is checked again in the next iteration, and pairs that are not asked
  // for yet.
  for (const auto* queue : {&edge_queue_, &pair_queue_}) {
    for (const uint32_t v : *queue) {
      if (mesh_.alive(v)) mesh_.wake(v);
    }
  }
  counts.deferred += static_cast<int64_t>(edge_queue_.size() + (pairs ? pair_queue_.size() : 0));
  counts.tetrahedron += tiny_.update(mesh_, changed_, staying());
}

TinyComponents::Stays Resolution::staying() const {
  if (mesh_.obstacles == nullptr && !mesh_.is_patch()) return nullptr;
  return [this](const Vector<uint32_t>& component) {
    return (mesh_.obstacles != nullptr && mesh_.obstacles->any_inside(mesh_, component)) ||
           std::any_of(component.begin(), component.end(),
                       [this](uint32_t v) { return mesh_.is_held(v); });
  };
}

void Resolution::queue_violated_edges() {
  assert(std::is_sorted(detection_.due().begin(), detection_.due().end()));
  edge_queue_.clear();
  const auto delta = static_cast<float>(mesh_.delta);
  flags_.resize_uninitialized(mesh_.padded());
  blocks_.clear();
  for (const auto* queue : {&detection_.due(), &std::as_const(pair_queue_)}) {
    for (const uint32_t v : *queue) {
      if (blocks_.empty() || blocks_.back() != v / kRingLanes) blocks_.push_back(v / kRingLanes);
    }
  }
  if (!pair_queue_.empty()) {
    std::sort(blocks_.begin(), blocks_.end());
    blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
  }
  run_blocks(executor_, blocks_.size(), kTaskBlocks, [&](size_t, size_t begin, size_t end) {
    kernels::edge_violations(executor_.simd(), mesh_.rings(), mesh_.position.data(), delta * delta,
                             kMaxEdge * kMaxEdge * delta * delta,
                             Blocks::of(blocks_.data(), blocks_.size(), begin, end), flags_.data());
  });
  cycles_due_.clear();
  for (const auto* queue : {&detection_.due(), &std::as_const(pair_queue_)}) {
    for (const uint32_t v : *queue) {
      if (flags_[v] == 0) continue;
      edge_queue_.push_back(v);
      look_for_cycles(v);
    }
  }
}

// Denied ones around v, once v has its turn in the queue of edges.
void Resolution::look_for_cycles(uint32_t v) {
  if (mesh_.sizing == nullptr) return;
  if (cycles_due_.size() < mesh_.slots()) cycles_due_.resize(mesh_.slots());
  cycles_due_[v] = 1;
}

uint32_t Resolution::stamp_queue(const Vector<uint32_t>& queue) {
  ++stamps_;
  for (const uint32_t v : queue) stamp_[v] = stamps_;
  return stamps_;
}

// Makes a queue ascending, with each living vertex once.
void Resolution::unique(Vector<uint32_t>& queue) {
  stamp_.resize(mesh_.slots(), 0);
  if (queue.size() < mesh_.slots() / kSortedQueue) {
    parallel_sort(queue, executor_);
    queue.erase(std::unique(queue.begin(), queue.end()), queue.end());
    std::erase_if(queue, [&](uint32_t v) { return !mesh_.alive(v); });
    return;
  }
  const uint32_t stamp = stamp_queue(queue);
  queue.clear();
  for (uint32_t v = 0; v < mesh_.slots(); ++v) {
    if (stamp_[v] == stamp && mesh_.alive(v)) queue.push_back(v);
  }
}

void Resolution::resolve_edges(OperationCounts& counts) {
  for (int round = 0; round < kMaxRounds; ++round) {
    unique(edge_queue_);
    if (edge_queue_.empty()) return;
    detection_.shorten_hash();
    const Vector<Candidate> candidates = edge_candidates(edge_queue_);
    edge_queue_.clear();
    apply_round(candidates, edge_queue_, counts);
  }
}

Vector<Candidate> Resolution::edge_candidates(const Vector<uint32_t>& queue) {
  assert(std::is_sorted(queue.begin(), queue.end()) && stamp_.size() >= mesh_.slots());
  const uint32_t stamp = stamp_queue(queue);
  const auto collect = [&](size_t i, Vector<Candidate>& out) {
    const uint32_t u = queue[i];
    const uint32_t d = mesh_.valence(u);
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t v = mesh_.neighbor(u, k);
      if (v < u && stamp_[v] == stamp) continue;  // the edge comes from v
      uint32_t from = u;
      uint32_t slot = k;
      if (v < u) {
        from = v;
        slot = 0;
        while (mesh_.neighbor(v, slot) != u) ++slot;
      }
      if (const auto candidate = edge_candidate(mesh_, from, slot)) out.push_back(*candidate);
    }
    // To look around all due vertices finds nothing more that stays, and takes 3 to 10 % longer.
    // Nor does it to look again around those that only something was put off at: most of what a
    // transformation makes goes through a vertex that it has changed.
    if (u >= cycles_due_.size() || cycles_due_[u] == 0) return;
    cycles_due_[u] = 0;
    if (const auto candidate = denied_cycle(mesh_, u)) out.push_back(*candidate);
  };
  return collect_sorted(executor_, queue.size(), kChunk, std::less<Candidate>(), collect);
}

// One pass over (3); false when nothing was left to do. The first pass takes the pairs that the
// detection has found; all look again around what has changed since.
bool Resolution::resolve_pairs(bool first, OperationCounts& counts) {
  unique(pair_queue_);
  const Vector<Candidate> candidates = pair_candidates(pair_queue_, first);
  pair_queue_.clear();
  if (candidates.empty()) return false;
  Vector<uint32_t> later;
  apply_round(candidates, later, counts);
  pair_queue_.insert(pair_queue_.end(), later.begin(), later.end());
  return true;
}

Vector<Candidate> Resolution::pair_candidates(const Vector<uint32_t>& queue, bool first) {
  const uint32_t stamp = stamp_queue(queue);
  const size_t known = first ? detection_.surroundings().too_near().size() : 0;
  const auto collect = [&](size_t i, Vector<Candidate>& out) {
    if (i >= known) {
      proximity_candidates(mesh_, detection_.hash(), queue[i - known], stamp_, stamp, iteration_,
                           out);
      return;
    }
    const VertexPair& pair = detection_.surroundings().too_near()[i];
    if (const auto candidate = pair_candidate(mesh_, pair.u, pair.w, iteration_)) {
      out.push_back(*candidate);
    }
  };
  // The nearest pairs come first, whatever transformation they ask for. A pair may have been found
  // from both of its ends.
  const auto nearer = [](const Candidate& l, const Candidate& r) {
    return std::tie(l.key, l.edge.u, l.edge.v, l.operation, l.edge.a) <
           std::tie(r.key, r.edge.u, r.edge.v, r.operation, r.edge.a);
  };
  auto all = collect_sorted(executor_, known + queue.size(), kPairChunk, nearer, collect);
  const auto same = [](const Candidate& l, const Candidate& r) {
    return l.operation == r.operation && l.edge.u == r.edge.u && l.edge.v == r.edge.v;
  };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  return all;
}

void Resolution::apply_round(const Vector<Candidate>& candidates, Vector<uint32_t>& later,
                             OperationCounts& counts) {
  round_ = ++stamps_;
  for (size_t begin = 0; begin < candidates.size(); begin += kTrialRun) {
    const size_t end = std::min(begin + kTrialRun, candidates.size());
    std::array<size_t, kTrialRun> trial;
    try_candidates(candidates.data() + begin, end - begin, trial.data());
    for (size_t i = begin; i < end; ++i) {
      apply_in_turn(candidates[i], trial[i - begin], later, counts);
    }
  }
}

// Asks the guard, in parallel, about the candidates that will have their turn if it admits all that
// come before them. trial[i] becomes the number of candidate i's trial, or kUntried.
void Resolution::try_candidates(const Candidate* candidates, size_t count, size_t* trial) {
  const uint32_t claim = ++stamps_;
  tried_.clear();
  for (size_t i = 0; i < count; ++i) {
    trial[i] = Trials::kUntried;
    if (!Trials::can_try(mesh_, candidates[i]) || !free_footprint(candidates[i], claim)) continue;
    if (mesh_.is_patch() && !spares_held(mesh_, candidates[i])) continue;
    for (const uint32_t v : footprint_) stamp_[v] = claim;
    trial[i] = tried_.size();
    tried_.push_back(&candidates[i]);
  }
  if (tried_.size() < kFewTrials) {
    tried_.clear();
    std::fill(trial, trial + count, Trials::kUntried);
  }
  trials_.run(tried_);
}

void Resolution::apply_in_turn(const Candidate& candidate, size_t trial, Vector<uint32_t>& later,
                               OperationCounts& counts) {
  if (!free_footprint(candidate, round_)) {
    later.push_back(candidate.edge.u);
    later.push_back(candidate.edge.v);
    // A cycle is not always seen along its edges: it is looked for again.
    if (candidate.operation == Operation::kAnnular) {
      look_for_cycles(candidate.edge.u);
      look_for_cycles(candidate.edge.v);
    }
    return;
  }
  if (mesh_.is_patch() && !spares_held(mesh_, candidate)) return;
  if (!within_limit(candidate)) {
    ++counts.deferred;
    return;
  }
  if (goes_in_circles(mesh_, candidate)) {
    freeze(mesh_, candidate);
    ++counts.refused;
    return;
  }
  if (fits_neighbors(mesh_, candidate)) {
    trials_.begin(footprint_);
    if (apply(candidate, trial, counts)) {
      trials_.end();
      for (const uint32_t v : footprint_) stamp_[v] = round_;
      return;
    }
  }
  // The vertices stay due: the next iteration tries again.
  ++counts.refused;
  mesh_.wake(candidate.edge.u);
  mesh_.wake(candidate.edge.v);
}

// Fills footprint_ with the closed rings of the vertices that the candidate changes or was found
// from; false when an earlier candidate has claimed one of them, by this claim or for the round.
bool Resolution::free_footprint(const Candidate& candidate, uint32_t claim) {
  const Edge& e = candidate.edge;
  uint32_t corners[4] = {e.u, e.v, e.u, e.u};
  if (candidate.operation == Operation::kAnnular) {
    const Cycle cycle = candidate.cycle();
    std::copy_n(cycle.corner.begin(), cycle.size, corners);
  }
  if (candidate.operation == Operation::kInversion) {
    corners[2] = e.a;
    corners[3] = e.b;
  }
  footprint_.clear();
  // What an earlier candidate of the round created has no claim slot yet, and is claimed, too.
  const auto add = [&](uint32_t v) {
    footprint_.push_back(v);
    return v < stamp_.size() && stamp_[v] != round_ && stamp_[v] != claim;
  };
  for (const uint32_t c : corners) {
    if (!mesh_.alive(c) || !add(c)) return false;
    const uint32_t d = mesh_.valence(c);
    for (uint32_t k = 0; k < d; ++k) {
      if (!add(mesh_.neighbor(c, k))) return false;
    }
  }
  return true;
}

// Where an operation is put off the vertices stay due, so that the next iteration sees it again.
bool Resolution::within_limit(const Candidate& candidate) {
  const Edge& e = candidate.edge;
  const auto busiest = std::max(operations_[e.u], operations_[e.v]);
  if (busiest >= kMaxOperationsPerVertex) {
    mesh_.wake(e.u);
    mesh_.wake(e.v);
    return false;
  }
  operations_[e.u] = operations_[e.v] = static_cast<uint8_t>(busiest + 1);
  return true;
}

}  // namespace plc

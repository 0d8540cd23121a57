#include "engine/recover/evolution.h"

#include <cassert>

#include "engine/base/constants.h"
#include "engine/guard/self_meeting.h"
#include "engine/mesh/mesh_invariants.h"

namespace plc {

namespace {

// The promise of every iteration; debug builds hold it to it.
[[maybe_unused]] bool sound(const Mesh& mesh, const Executor& executor) {
  return broken_invariant(mesh).empty() && meeting_faces(mesh, executor).empty();
}

}  // namespace

Evolution::Evolution(Mesh& mesh, const Schedule& schedule, SimdTarget simd, const Model& model,
                     const EvolutionOptions& options)
    : mesh_(mesh),
      schedule_(schedule),
      simd_(simd),
      slow_vertices_(options.slow_vertices),
      sleep_(mesh, schedule, options.speeds),
      dynamics_(mesh, schedule, simd, model),
      guard_(mesh, schedule, simd),
      resolution_(mesh, schedule, simd) {}

void Evolution::restart() {
  resolution_.restart();
  sleep_.restart();
}

Status Evolution::iterate(const Guide& guide, Seconds& seconds, OperationCounts& counts) {
  const double start = now();
  // The user's force may change at any time.
  sleep_.choose(guide.user != nullptr && guide.user->force);
  passed("sleep");
  PassEnd after;
  if (observer_) after = [this](const std::string& names) { passed(names); };
  if (Status s = dynamics_.step(guide, seconds, &sleep_, after); !s.ok()) return s;
  passed("energy");
  sleep_.observe();
  passed("calm");
  const double moved = now();
  const auto& due =
      slow_vertices_ ? resolution_.take_due(sleep_.awake()) : resolution_.take_due(true);
  passed("due, hash, surroundings");
  counts.moves += static_cast<int64_t>(awake());
  counts.checks += static_cast<int64_t>(due.size());
  guard_.find_folds(sleep_.awake_and_rim());
  guard_.assess(due, resolution_.surroundings().at_risk());
  passed("risk");
  back_.clear();
  counts.reverted += guard_.take_back(dynamics_.before(), resolution_.hash(), back_);
  passed("motion guard");
  resolution_.add_due(back_);
  resolution_.run(++iteration_, counts);
  passed("resolution");
  assert(sound(mesh_, schedule_));
  const double end = now();
  seconds.topology += end - moved;
  seconds.total += end - start;
  return {};
}

void Evolution::check_all(Seconds& seconds, OperationCounts& counts) {
  const double start = now();
  for (int pass = 0; pass < kCheckPasses; ++pass) {
    const int64_t before = counts.transformations();
    resolution_.take_all();
    resolution_.run(++iteration_, counts);
    if (counts.transformations() == before) break;
  }
  passed("check of all");
  const double end = now();
  seconds.topology += end - start;
  seconds.total += end - start;
}

bool Evolution::embedded() {
  const auto meeting = meeting_faces(mesh_, schedule_, simd_);
  for (const auto& face : meeting) {
    for (const uint32_t v : face) {
      mesh_.risk[v] = Mesh::kNearRisk;
      mesh_.wake(v);
    }
  }
  passed("embedded");
  return meeting.empty();
}

void Evolution::save(StateWriter& to) const {
  to.add(iteration_);
  sleep_.save(to);
  dynamics_.save(to);
  resolution_.save(to);
}

void Evolution::restore(StateReader& from) {
  from.read(iteration_);
  sleep_.restore(from);
  dynamics_.restore(from);
  resolution_.restore(from);
}

std::vector<PartHash> Evolution::hashes() const {
  std::vector<PartHash> all = part_hashes(mesh_);
  dynamics_.append_hashes(all);
  const Surroundings& around = resolution_.surroundings();
  Fnv near;
  for (const VertexPair& pair : around.too_near()) {
    near.add(pair.u);
    near.add(pair.w);
  }
  all.insert(all.end(), {part_hash("fallen asleep", sleep_.fallen()),
                         {"too near", near.value()},
                         part_hash("at risk", around.at_risk()),
                         part_hash("taken back", back_)});
  return all;
}

}  // namespace plc

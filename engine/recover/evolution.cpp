#include "engine/recover/evolution.h"

#include <cassert>

#include "engine/base/constants.h"
#include "engine/guard/obstacles.h"
#include "engine/guard/self_meeting.h"
#include "engine/mesh/mesh_invariants.h"

namespace plc {

namespace {

// The promise of every iteration; debug builds hold it to it.
[[maybe_unused]] bool sound(const Mesh& mesh, const Executor& executor) {
  Obstacles::Meeting meeting;
  return broken_invariant(mesh).empty() && meeting_faces(mesh, executor).empty() &&
         (mesh.obstacles == nullptr || !mesh.obstacles->find_meeting(mesh, meeting));
}

}  // namespace

Evolution::Evolution(Mesh& mesh, const Schedule& schedule, const Model& model,
                     const EvolutionOptions& options)
    : mesh_(mesh),
      schedule_(schedule),
      slow_vertices_(options.slow_vertices),
      sleep_(mesh, schedule, options.speeds),
      dynamics_(mesh, schedule, model, options.counted),
      detection_(mesh, schedule),
      guard_(mesh, schedule),
      resolution_(mesh, schedule, detection_) {}

void Evolution::restart() {
  detection_.restart();
  resolution_.restart();
  sleep_.restart();
  guard_.restart();
}

Status Evolution::iterate(const Guide& guide, Seconds& seconds, OperationCounts& counts) {
  const double start = now();
  std::vector<Pass> table;
  append_movement(guide, seconds, table);
  append_topology(seconds, counts, table);
  PassEnd after;
  if (observer_) {
    after = [this](const std::string& names, uint32_t writes) { notify(names, writes); };
  }
  Status s = schedule_.run_passes(table, dynamics_.in_order(guide), after);
  if (!s.ok()) return s;
  assert(sound(mesh_, schedule_));
  seconds.total += now() - start;
  return {};
}

void Evolution::append_movement(const Guide& guide, Seconds& seconds, std::vector<Pass>& table) {
  // The user's force may change at any time.
  const bool all = guide.user != nullptr && guide.user->force;
  table.push_back({"sleep", kCalm | kRings, kAwake | kVelocities | kDisplacements,
                   &seconds.dynamics, [this, all] { sleep_.choose(all); }});
  dynamics_.append_passes(guide, &sleep_, seconds, table);
  table.push_back({"calm", kAwake | kRings | kNormals | kDisplacements, kCalm, &seconds.dynamics,
                   [this] { sleep_.observe(); }});
}

void Evolution::append_topology(Seconds& seconds, OperationCounts& counts,
                                std::vector<Pass>& table) {
  const auto add = [&](const char* name, uint32_t reads, uint32_t writes, const auto& body) {
    table.push_back({name, reads, writes, &seconds.topology, body});
  };
  constexpr uint32_t kSurface = kRings | kPositions | kNormals;
  add("due", kAwake | kCalm, kDue, [this, &counts] {
    if (slow_vertices_) {
      detection_.list_due(sleep_.awake(), sleep_.calm());
    } else {
      detection_.list_all();
    }
    counts.moves += static_cast<int64_t>(awake());
    counts.checks += static_cast<int64_t>(detection_.due().size());
  });
  add("hash", kDue | kPositions, kHash, [this] { detection_.update_hash(); });
  add("folds", kAwake | kSurface, kFolds, [this] { guard_.find_folds(sleep_.awake_and_rim()); });
  add("surroundings", kDue | kHash | kSurface | kFolds, kSurroundings,
      [this] { detection_.search(guard_.risk(), guard_.newly_folded()); });
  add("risk", kDue | kSurroundings | kFolds, kRisk,
      [this] { guard_.assess(detection_.due(), detection_.surroundings().at_risk()); });
  add("motion guard", kRisk | kStages | kSurface,
      kPositions | kVelocities | kDue | kCalm | kHash | kTakenBack, [this, &counts] {
        back_.clear();
        counts.reverted += guard_.take_back(dynamics_.before(), detection_.hash(), back_);
      });
  add("resolution", kEverything, kEverything,
      [this, &counts] { resolution_.run(++iteration_, back_, counts); });
}

void Evolution::check_all(Seconds& seconds, OperationCounts& counts) {
  const double start = now();
  for (int pass = 0; pass < kCheckPasses; ++pass) {
    const int64_t before = counts.transformations();
    detection_.search_near_all();
    resolution_.run(++iteration_, {}, counts);
    if (counts.transformations() == before) break;
  }
  notify("check of all");
  const double end = now();
  seconds.topology += end - start;
  seconds.total += end - start;
}

bool Evolution::embedded() {
  const auto meeting = meeting_faces(mesh_, schedule_);
  for (const auto& face : meeting) {
    for (const uint32_t v : face) {
      guard_.suspect(v);
      mesh_.wake(v);
    }
  }
  notify("embedded");
  return meeting.empty();
}

void Evolution::save(StateWriter& to) const {
  to.add(iteration_);
  sleep_.save(to);
  dynamics_.save(to);
  detection_.save(to);
  guard_.save(to);
  resolution_.save(to);
}

void Evolution::restore(StateReader& from) {
  from.read(iteration_);
  sleep_.restore(from);
  dynamics_.restore(from);
  detection_.restore(from);
  guard_.restore(from);
  resolution_.restore(from);
}

std::vector<PartHash> Evolution::hashes() const {
  std::vector<PartHash> all = part_hashes(mesh_);
  dynamics_.append_hashes(all);
  const Surroundings& around = detection_.surroundings();
  Fnv near;
  for (const VertexPair& pair : around.too_near()) {
    near.add(pair.u);
    near.add(pair.w);
  }
  all.insert(all.end(), {part_hash("idle", detection_.idle().all()),
                         part_hash("calm", sleep_.calm().all()),
                         part_hash("drift", sleep_.drift().all()),
                         part_hash("risk", guard_.risk().all()),
                         part_hash("fallen asleep", sleep_.fallen()),
                         {"too near", near.value()},
                         part_hash("at risk", around.at_risk()),
                         part_hash("taken back", back_)});
  return all;
}

}  // namespace plc

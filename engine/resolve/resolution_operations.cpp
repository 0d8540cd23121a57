// How the resolution applies one operation, and what is checked again after it.
#include "engine/base/constants.h"
#include "engine/guard/obstacles.h"
#include "engine/resolve/resolution.h"
#include "engine/transform/annular.h"
#include "engine/transform/axial.h"
#include "engine/transform/creation.h"
#include "engine/transform/deletion.h"
#include "engine/transform/inversion.h"

namespace plc {

// False when the embedding guard refused it; the mesh is as before then.
bool Resolution::apply(const Candidate& candidate, size_t trial, OperationCounts& counts) {
  const auto count = [](bool done, int64_t& counter) {
    counter += done ? 1 : 0;
    return done;
  };
  switch (candidate.operation) {
    case Operation::kAnnular:
      return count(apply_annular(candidate, trial), counts.annular);
    case Operation::kDeletion:
      return apply_deletion(candidate, trial, counts);
    case Operation::kInversion:
      if (count(apply_inversion(candidate, trial), counts.inversion)) return true;
      // A long edge that may not be inverted is split.
      return candidate.key < 0 &&
             count(apply_creation({Operation::kCreation, candidate.key, candidate.edge},
                                  Trials::kUntried),
                   counts.creation);
    case Operation::kCreation:
      return count(apply_creation(candidate, trial), counts.creation);
    case Operation::kAxial:
      return count(apply_axial(candidate), counts.axial);
  }
  return false;
}

void Resolution::check_again(uint32_t v) {
  edge_queue_.push_back(v);
  look_for_cycles(v);
  pair_queue_.push_back(v);
  mesh_.touch(v);
  trials_.changed(v);
}

void Resolution::enter_and_check(uint32_t v) {
  detection_.hash().insert(v, mesh_.at(v));
  check_again(v);
}

// What limits the operations on a vertex limits those on all that is made of it.
void Resolution::inherit_operations(uint32_t created, uint32_t from) {
  if (operations_.size() < mesh_.slots()) operations_.resize(mesh_.slots());
  operations_[created] = operations_[from];
}

bool Resolution::apply_creation(const Candidate& candidate, size_t trial) {
  if (trials_.admitted(candidate, trial) == Trials::kRefused) return false;
  const uint32_t created = create_on_edge(mesh_, candidate.edge);
  inherit_operations(created, candidate.edge.u);
  enter_and_check(created);
  return true;
}

bool Resolution::apply_inversion(const Candidate& candidate, size_t trial) {
  const Edge& e = candidate.edge;
  if (trials_.admitted(candidate, trial) == Trials::kRefused) return false;
  invert_edge(mesh_, e);
  for (const uint32_t v : {e.u, e.v, e.a, e.b}) check_again(v);
  return true;
}

bool Resolution::apply_deletion(const Candidate& candidate, size_t trial, OperationCounts& counts) {
  const Edge& e = candidate.edge;
  if (mesh_.valence(e.a) == 3 || mesh_.valence(e.b) == 3) {
    // Exactly two common neighbours and an apex of valence 3: the component is a tetrahedron.
    if (mesh_.obstacles != nullptr && mesh_.obstacles->any_inside(mesh_, {e.u, e.v, e.a, e.b})) {
      return false;
    }
    delete_tetrahedron(mesh_, mesh_.valence(e.a) == 3 ? e.a : e.b);
    ++counts.tetrahedron;
    return true;
  }
  const uint32_t place = trials_.admitted(candidate, trial);
  if (place == Trials::kRefused) return false;
  delete_edge(mesh_, e, Trials::deletion_place(mesh_, e, place));
  enter_and_check(e.u);
  changed_.push_back(e.u);
  ++counts.deletion;
  return true;
}

bool Resolution::apply_annular(const Candidate& candidate, size_t trial) {
  if (trials_.admitted(candidate, trial) == Trials::kRefused) return false;
  const Cycle cycle = candidate.cycle();
  const auto copies = annular_copies(mesh_, cycle, kAnnularRetreat);
  const auto right = cut_cycle(mesh_, cycle, copies, next_cut_++, iteration_);
  for (uint32_t i = 0; i < cycle.size; ++i) {
    inherit_operations(right[i], cycle.corner[i]);
    for (const uint32_t v : {cycle.corner[i], right[i]}) {
      enter_and_check(v);
      changed_.push_back(v);
    }
  }
  return true;
}

bool Resolution::apply_axial(const Candidate& candidate) {
  const AxialPlan plan = plan_axial(mesh_, candidate.edge.u, candidate.edge.v);
  if (!guard_.embeds(mesh_, detection_.hash(), propose_axial(mesh_, plan))) return false;
  for (const uint32_t v : join(mesh_, plan)) {
    inherit_operations(v, candidate.edge.u);
    enter_and_check(v);
  }
  return true;
}

}  // namespace plc

#include "engine/guard/trials.h"

#include <catch2/catch.hpp>
#include <set>

#include "engine/base/constants.h"
#include "engine/detect/edge_constraints.h"
#include "engine/transform/annular.h"
#include "engine/transform/creation.h"
#include "engine/transform/deletion.h"
#include "engine/transform/inversion.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Candidate;
using plc::Mesh;
using plc::Operation;
using plc::Trials;

// Two crumpled balls, one close within the other: their short edges cannot all be deleted, and some
// only towards one end. And a tube of three short sides.
void fill_scene(Mesh& mesh) {
  samples::Random random(5);
  samples::Soup soup = samples::sphere(4);
  for (size_t v = 0; v < soup.xyz.size(); v += 3) {
    const double factor = random.uniform(0.86, 1.0);
    for (size_t i = v; i < v + 3; ++i) soup.xyz[i] *= factor;
  }
  samples::Soup inner = soup;
  for (double& x : inner.xyz) x *= 0.985;
  soup.append(samples::flipped(inner));
  soup.append(samples::moved(samples::tube(3, 30, 0.5), 3, 0, 0, 0.25));
  samples::fill_mesh(mesh, soup, 0.25);
}

plc::SpatialHash hash_of(const Mesh& mesh) {
  plc::SpatialHash hash;
  hash.build(mesh, plc::kHashCell * static_cast<float>(mesh.delta), samples::kSerial);
  return hash;
}

// Deletions where edges are too short, cuts where three of them go around, and some inversions and
// creations.
plc::Vector<Candidate> triable(const Mesh& mesh) {
  plc::Vector<Candidate> found;
  samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
    const plc::Edge e = plc::edge_at(mesh, u, k);
    if ((u + k) % 4 == 0 && plc::can_invert(mesh, e)) {
      found.push_back({Operation::kInversion, 0, e});
    } else if ((u + k) % 8 == 1) {
      found.push_back({Operation::kCreation, 0, e});
    } else if (const auto c = plc::edge_candidate(mesh, u, k); c && Trials::can_try(mesh, *c)) {
      found.push_back(*c);
    }
  });
  return found;
}

// The closed rings of the edge's vertices and apexes, or of the corners of a cycle.
plc::Vector<uint32_t> footprint(const Mesh& mesh, const Candidate& c) {
  const uint32_t corners[4] = {c.edge.u, c.edge.v, c.edge.a, c.edge.b};
  plc::Vector<uint32_t> all;
  for (const uint32_t v : corners) {
    if (v == Candidate::kNoVertex) continue;
    all.push_back(v);
    for (const uint32_t w : mesh.ring(v)) all.push_back(w);
  }
  return all;
}

// Those, in this order, of which no vertex belongs to one before.
plc::Vector<Candidate> apart(const Mesh& mesh, const plc::Vector<Candidate>& candidates) {
  std::set<uint32_t> claimed;
  plc::Vector<Candidate> chosen;
  for (const Candidate& c : candidates) {
    const auto own = footprint(mesh, c);
    const bool free =
        std::none_of(own.begin(), own.end(), [&](uint32_t v) { return claimed.count(v) != 0; });
    if (!free) continue;
    claimed.insert(own.begin(), own.end());
    chosen.push_back(c);
  }
  return chosen;
}

// What the guard says of the mesh as it is.
uint32_t asked_now(const Mesh& mesh, const plc::SpatialHash& hash, const Candidate& c) {
  plc::EmbeddingGuard guard;
  if (c.operation == Operation::kCreation) {
    return guard.embeds(mesh, hash, plc::propose_creation(mesh, c.edge)) ? 0 : Trials::kRefused;
  }
  if (c.operation == Operation::kInversion) {
    return guard.embeds(mesh, hash, plc::propose_inversion(mesh, c.edge)) ? 0 : Trials::kRefused;
  }
  if (c.operation == Operation::kAnnular) {
    const auto copies = plc::annular_copies(mesh, c.cycle(), plc::kAnnularRetreat);
    const plc::Proposal cut = plc::propose_annular(mesh, c.cycle(), copies);
    return guard.embeds(mesh, hash, cut) ? 0 : Trials::kRefused;
  }
  for (uint32_t place = 0; place < Trials::kPlaces; ++place) {
    const plc::Vec3 at = Trials::deletion_place(mesh, c.edge, place);
    if (guard.embeds(mesh, hash, plc::propose_deletion(mesh, c.edge, at))) return place;
  }
  return Trials::kRefused;
}

void apply(Mesh& mesh, plc::SpatialHash& hash, Trials& trials, const Candidate& c, uint32_t place) {
  trials.begin(footprint(mesh, c));
  if (c.operation == Operation::kCreation) {
    const uint32_t w = plc::create_on_edge(mesh, c.edge);
    hash.insert(w, mesh.at(w));
    trials.changed(w);
  } else if (c.operation == Operation::kInversion) {
    plc::invert_edge(mesh, c.edge);
    trials.changed(c.edge.a);
  } else if (c.operation == Operation::kAnnular) {
    const plc::Cycle cycle = c.cycle();
    const auto copies = plc::annular_copies(mesh, cycle, plc::kAnnularRetreat);
    const auto right = plc::cut_cycle(mesh, cycle, copies, 1, 1);
    for (uint32_t i = 0; i < cycle.size; ++i) {
      for (const uint32_t v : {cycle.corner[i], right[i]}) {
        hash.insert(v, mesh.at(v));
        trials.changed(v);
      }
    }
  } else {
    plc::delete_edge(mesh, c.edge, Trials::deletion_place(mesh, c.edge, place));
    hash.insert(c.edge.u, mesh.at(c.edge.u));
    trials.changed(c.edge.u);
  }
  trials.end();
}

}  // namespace

TEST_CASE("a trial says what the guard says when its turn has come", "[trials]") {
  const fixtures::ThreadExecutor threads(3);
  for (const plc::Executor* executor : {static_cast<const plc::Executor*>(&samples::kSerial),
                                        static_cast<const plc::Executor*>(&threads)}) {
    Mesh mesh;
    fill_scene(mesh);
    plc::SpatialHash hash = hash_of(mesh);
    Trials trials(mesh, hash, *executor);
    int turned = 0;  // what the mesh had let through, or refused, before others were applied
    int refused = 0, elsewhere = 0, cut = 0;
    for (int run = 0; run < 3; ++run) {
      const auto candidates = apart(mesh, triable(mesh));
      REQUIRE(candidates.size() > 20);
      plc::Vector<const Candidate*> tried;
      plc::Vector<uint32_t> before;
      for (size_t i = 0; i < candidates.size(); ++i) {
        if (i % 5 != 0) tried.push_back(&candidates[i]);
        before.push_back(asked_now(mesh, hash, candidates[i]));
      }
      trials.run(tried);
      for (size_t i = 0; i < candidates.size(); ++i) {
        const size_t trial = i % 5 != 0 ? i - i / 5 - 1 : Trials::kUntried;
        const uint32_t expected = asked_now(mesh, hash, candidates[i]);
        const uint32_t place = trials.admitted(candidates[i], trial);
        CAPTURE(run, i);
        REQUIRE(place == expected);
        turned += static_cast<int>(place != before[i]);
        refused += static_cast<int>(place == Trials::kRefused);
        elsewhere += static_cast<int>(place == 1 || place == 2);
        cut += static_cast<int>(candidates[i].operation == Operation::kAnnular && place == 0);
        if (place != Trials::kRefused) apply(mesh, hash, trials, candidates[i], place);
      }
    }
    CHECK(turned > 0);
    CHECK(refused > 0);
    CHECK(elsewhere > 0);
    CHECK(cut > 0);
  }
}

TEST_CASE("what no trial is for is asked then", "[trials]") {
  Mesh mesh;
  fill_scene(mesh);
  const plc::SpatialHash hash = hash_of(mesh);
  Trials trials(mesh, hash, samples::kSerial);
  trials.run({});
  for (const Candidate& c : triable(mesh)) {
    CHECK(trials.admitted(c, Trials::kUntried) == asked_now(mesh, hash, c));
  }
}

TEST_CASE("all but axial transformations and tetrahedra are tried", "[trials]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tetrahedron(), 10);
  const plc::Edge e = plc::edge_at(mesh, 0, 0);
  CHECK_FALSE(Trials::can_try(mesh, {Operation::kDeletion, 1, e}));
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  const plc::Edge f = plc::edge_at(mesh, 0, 0);
  CHECK(Trials::can_try(mesh, {Operation::kDeletion, 1, f}));
  CHECK(Trials::can_try(mesh, {Operation::kInversion, 1, f}));
  CHECK(Trials::can_try(mesh, {Operation::kCreation, 1, f}));
  CHECK(Trials::can_try(mesh, {Operation::kAnnular, 1, f}));
  CHECK_FALSE(Trials::can_try(mesh, {Operation::kAxial, 1, f}));
}

#include "engine/guard/embedding_guard.h"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "engine/base/constants.h"
#include "engine/transform/creation.h"
#include "engine/transform/deletion.h"
#include "engine/transform/inversion.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Cycle;
using plc::Edge;
using plc::Mesh;
using plc::Proposal;
using samples::Soup;

// A face with the places of its corners, from its smallest id.
struct PlacedFace {
  std::array<uint32_t, 3> id;
  std::array<float, 9> xyz;
  friend bool operator==(const PlacedFace& l, const PlacedFace& r) {
    return l.id == r.id && l.xyz == r.xyz;
  }
  friend bool operator<(const PlacedFace& l, const PlacedFace& r) {
    return std::tie(l.id, l.xyz) < std::tie(r.id, r.xyz);
  }
};

PlacedFace placed(const std::array<uint32_t, 3>& id, const std::array<plc::Vec3, 3>& place) {
  const auto first = static_cast<size_t>(std::min_element(id.begin(), id.end()) - id.begin());
  PlacedFace face{};
  for (size_t i = 0; i < 3; ++i) {
    const size_t from = (first + i) % 3;
    face.id[i] = id[from];
    face.xyz[3 * i] = place[from].x;
    face.xyz[3 * i + 1] = place[from].y;
    face.xyz[3 * i + 2] = place[from].z;
  }
  return face;
}

std::vector<PlacedFace> faces_of(const Mesh& mesh) {
  std::vector<PlacedFace> faces;
  for (const auto& f : samples::sorted_faces(mesh)) {
    faces.push_back(placed(f, {mesh.at(f[0]), mesh.at(f[1]), mesh.at(f[2])}));
  }
  return faces;
}

// The faces that the proposal leaves and makes.
std::vector<PlacedFace> after(const Mesh& mesh, const Proposal& proposal) {
  std::vector<PlacedFace> faces;
  for (const PlacedFace& f : faces_of(mesh)) {
    const auto has = [&](uint32_t v) { return std::count(f.id.begin(), f.id.end(), v) != 0; };
    const bool removed =
        std::any_of(proposal.removed_corners.begin(), proposal.removed_corners.end(), has) ||
        (has(proposal.removed_edge[0]) && has(proposal.removed_edge[1]));
    if (!removed) faces.push_back(f);
  }
  for (const auto& f : proposal.faces) faces.push_back(placed(f.id, f.place));
  std::sort(faces.begin(), faces.end());
  return faces;
}

bool admitted(const Mesh& mesh, const Proposal& proposal) {
  plc::SpatialHash hash;
  hash.build(mesh, plc::kMinApart * static_cast<float>(mesh.delta), samples::kSerial);
  return plc::EmbeddingGuard().embeds(mesh, hash, proposal);
}

// Those of three and of four edges that can be cut.
std::vector<Cycle> cycles_over(const Mesh& mesh, const Edge& e) {
  std::vector<Cycle> cycles;
  for (const uint32_t o : plc::common_neighbors(mesh, e.u, e.v)) {
    if (o != e.a && o != e.b) cycles.push_back({{e.u, e.v, o}});
  }
  for (const uint32_t a : mesh.ring(e.v)) {
    for (const uint32_t b : mesh.ring(e.u)) {
      if (a == e.u || b == e.v || mesh.adjacent(e.u, a) || mesh.adjacent(e.v, b)) continue;
      if (mesh.adjacent(a, b)) cycles.push_back({{e.u, e.v, a, b}, 4});
    }
  }
  return cycles;
}

// Proposes and carries out: visit(mesh before, proposal, apply).
template <typename Visit>
void for_each_operation(const Soup& soup, double delta, const Visit& visit) {
  Mesh whole;
  samples::fill_mesh(whole, soup, delta);
  const auto fresh = [&] {
    Mesh mesh;
    samples::fill_mesh(mesh, soup, delta);
    return mesh;
  };
  samples::for_each_edge(whole, [&](uint32_t u, uint32_t k) {
    Mesh mesh = fresh();
    const Edge e = plc::edge_at(mesh, u, k);
    const auto common = plc::common_neighbors(mesh, e.u, e.v);
    if (common.size() == 2 && mesh.valence(e.a) > 3 && mesh.valence(e.b) > 3) {
      const plc::Vec3 place = plc::midpoint(mesh.at(e.u), mesh.at(e.v));
      visit(mesh, plc::propose_deletion(mesh, e, place), [&] { plc::delete_edge(mesh, e, place); });
      mesh.take(fresh());
    }
    visit(mesh, plc::propose_creation(mesh, e), [&] { plc::create_on_edge(mesh, e); });
    mesh.take(fresh());
    if (mesh.valence(e.u) > 3 && mesh.valence(e.v) > 3 && !mesh.adjacent(e.a, e.b)) {
      visit(mesh, plc::propose_inversion(mesh, e), [&] { plc::invert_edge(mesh, e); });
      mesh.take(fresh());
    }
    for (const Cycle& cycle : cycles_over(mesh, e)) {
      const auto copies = plc::annular_copies(mesh, cycle, plc::kAnnularRetreat);
      visit(mesh, plc::propose_annular(mesh, cycle, copies),
            [&] { plc::cut_cycle(mesh, cycle, copies, 1, 1); });
      mesh.take(fresh());
    }
  });
  for (uint32_t u = 0; u < whole.slots(); ++u) {
    for (uint32_t v = u + 1; v < whole.slots(); v += 3) {
      if (whole.adjacent(u, v)) continue;
      Mesh mesh = fresh();
      const plc::AxialPlan plan = plc::plan_axial(mesh, u, v);
      visit(mesh, plc::propose_axial(mesh, plan), [&] { plc::join(mesh, plan); });
    }
  }
}

using Places = std::vector<std::array<float, 3>>;

// Around the vertex, as the change has it. From the smallest place on: rings have no beginning.
Places from_smallest(Places ring) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  return ring;
}
Places changed_ring(const Mesh& mesh, const Proposal::RingChange& change) {
  Places ring;
  const auto add = [&](plc::Vec3 p) { ring.push_back({p.x, p.y, p.z}); };
  for (const uint32_t w : mesh.ring(change.vertex)) {
    if (w == change.gone) continue;
    if (w != change.neighbor || change.keeps) add(mesh.at(w));
    if (w == change.neighbor) add(change.place);
  }
  return from_smallest(ring);
}
Places ring_of(const Mesh& mesh, uint32_t v) {
  Places ring;
  for (const uint32_t w : mesh.ring(v)) {
    const plc::Vec3 p = mesh.at(w);
    ring.push_back({p.x, p.y, p.z});
  }
  return from_smallest(ring);
}

// The vertices that stay and have new faces.
std::set<uint32_t> touched(const Mesh& mesh, const Proposal& proposal) {
  std::set<uint32_t> all;
  for (const auto& face : proposal.faces) {
    for (const uint32_t v : face.id) {
      const auto& gone = proposal.removed_corners;
      if (v < mesh.slots() && std::count(gone.begin(), gone.end(), v) == 0) all.insert(v);
    }
  }
  return all;
}

Soup jittered(Soup soup, double amplitude, uint64_t seed) {
  samples::Random random(seed);
  for (double& c : soup.xyz) c += random.uniform(-amplitude, amplitude);
  return soup;
}

}  // namespace

TEST_CASE("a proposal says exactly which faces its transformation makes and takes",
          "[embedding_guard]") {
  for (const Soup& soup : {samples::octahedron(), samples::sphere(1), samples::bipyramid(7, 1),
                           samples::tube(3, 4, 0.5), samples::torus(3, 6, 2, 0.5)}) {
    for_each_operation(soup, 1, [](Mesh& mesh, const Proposal& proposal, const auto& apply) {
      const std::vector<PlacedFace> expected = after(mesh, proposal);
      apply();
      CHECK(faces_of(mesh) == expected);
    });
  }
}

TEST_CASE("a proposal on one edge says what becomes of the rings around it", "[embedding_guard]") {
  int proposals = 0;
  for (const Soup& soup : {samples::sphere(1), samples::bipyramid(7, 1), samples::tube(3, 4, 0.5),
                           samples::torus(3, 6, 2, 0.5)}) {
    for_each_operation(soup, 1, [&](Mesh& mesh, const Proposal& proposal, const auto& apply) {
      if (proposal.rings.empty()) return;  // an annular or axial transformation
      ++proposals;
      std::map<uint32_t, Places> expected;
      for (const auto& change : proposal.rings) {
        expected[change.vertex] = changed_ring(mesh, change);
      }
      CHECK(expected.size() == proposal.rings.size());
      const std::set<uint32_t> all = touched(mesh, proposal);
      CHECK(expected.size() == all.size());
      apply();
      for (const uint32_t v : all) CHECK(ring_of(mesh, v) == expected[v]);
    });
  }
  CHECK(proposals > 300);
}

TEST_CASE("a transformation is admitted exactly where its surface does not meet itself",
          "[embedding_guard]") {
  int admissions = 0, refusals = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    Soup soup = seed % 3 == 0   ? samples::torus(8, 5, 1.2, 0.45)
                : seed % 3 == 1 ? samples::sphere(1)
                                : samples::tube(3, 5, 0.5);
    soup = jittered(soup, 0.12, seed);
    Mesh whole;
    samples::fill_mesh(whole, soup, 0.8);
    if (samples::meeting_count(whole) != 0) continue;
    for_each_operation(soup, 0.8, [&](Mesh& mesh, const Proposal& proposal, const auto& apply) {
      const bool admit = admitted(mesh, proposal);
      apply();
      const bool embedded = samples::meeting_count(mesh) == 0;
      CHECK(admit == embedded);
      (admit ? admissions : refusals) += 1;
    });
  }
  CHECK(admissions > 1000);
  CHECK(refusals > 100);
}

TEST_CASE("a creation is admitted but where rounding puts the mid-point beyond another face",
          "[embedding_guard]") {
  Mesh mesh;
  samples::fill_mesh(mesh, jittered(samples::sphere(2), 0.1, 3), 0.5);
  samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
    CHECK(admitted(mesh, plc::propose_creation(mesh, plc::edge_at(mesh, u, k))));
  });
  Mesh flat;
  samples::fill_mesh(flat, samples::flat_tetrahedron(), 0.5);
  REQUIRE(samples::meeting_count(flat) == 0);
  CHECK_FALSE(admitted(flat, plc::propose_creation(flat, plc::edge_between(flat, 0, 3))));
  CHECK(admitted(flat, plc::propose_creation(flat, plc::edge_between(flat, 0, 1))));
}

TEST_CASE("a face with edges of nearly 3.46 delta is found when its middle is pierced",
          "[embedding_guard]") {
  // Equilateral faces of a flat bipyramid, edges 3.4.
  const double edge = 3.4;
  Soup soup = samples::bipyramid(3, 1.4);
  for (double& c : soup.xyz) c *= edge / std::sqrt(3.0);
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  // The middle of the face (top, 0, 1) and a small triangle through it.
  const plc::Vec3 a = mesh.at(4), b = mesh.at(0), c = mesh.at(1);
  const plc::Vec3 middle = (a + b + c) * (1.0F / 3.0F);
  const plc::Vec3 n = plc::area_vector(a, b, c) * (1.0F / plc::length(plc::area_vector(a, b, c)));
  Proposal proposal;
  proposal.faces = {{{100, 101, 102},
                     {middle + n * 0.1F, middle - n * 0.1F, middle + n * 0.1F + (b - a) * 0.02F}}};
  CHECK_FALSE(admitted(mesh, proposal));
  proposal.faces[0].place[1] = middle + n * 0.01F;
  CHECK(admitted(mesh, proposal));
}

TEST_CASE("faces of zero area are not made", "[embedding_guard]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  Proposal proposal;
  proposal.faces = {{{100, 101, 102}, {plc::Vec3{5, 5, 5}, {6, 5, 5}, {7, 5, 5}}}};
  CHECK_FALSE(admitted(mesh, proposal));
  proposal.faces[0].place[2].y = 6;
  CHECK(admitted(mesh, proposal));
}

TEST_CASE("new faces that meet each other are refused", "[embedding_guard]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  Proposal proposal;
  proposal.faces = {{{100, 101, 102}, {plc::Vec3{5, 5, 5}, {6, 5, 5}, {5, 6, 5}}},
                    {{103, 104, 105}, {plc::Vec3{5.2F, 5.2F, 4}, {5.2F, 5.2F, 6}, {7, 7, 5}}}};
  CHECK_FALSE(admitted(mesh, proposal));
  for (auto& p : proposal.faces[1].place) p.z += 3;
  CHECK(admitted(mesh, proposal));
  // Alike, but sharing an edge: allowed to touch there.
  proposal.faces[1] = {{101, 100, 103}, {plc::Vec3{6, 5, 5}, {5, 5, 5}, {5, 4, 5}}};
  CHECK(admitted(mesh, proposal));
}

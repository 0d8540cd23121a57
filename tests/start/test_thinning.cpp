#include "engine/start/thinning.h"

#include <catch2/catch.hpp>
#include <vector>

#include "engine/guard/self_meeting.h"
#include "engine/mesh/mesh_invariants.h"
#include "tests/samples/sample_shapes.h"
#include "tests/samples/sample_volumes.h"

namespace {

// Sizes of 1 everywhere: an image without a surface.
struct Evenly {
  Evenly() {
    REQUIRE(sizing.field
                .build({values.data(), {32, 32, 32}, {1, 1, 1}, {0, 0, 0}, {}}, 0.5F, 1, {0.5, 1},
                       plc::SerialExecutor())
                .ok());
  }
  std::vector<float> values = std::vector<float>(32 * 32 * 32, 0.0F);
  plc::Sizing sizing;
};

// A rough ball of radius 6 with edges of a fifth: within one block whatever the grid.
samples::Soup rough_ball(double scale) {
  samples::Random random(7);
  samples::Soup soup = samples::sphere(5);
  for (size_t v = 0; v < soup.xyz.size(); v += 3) {
    const double factor = 6 * scale * random.uniform(0.985, 1.0);
    for (size_t i = v; i < v + 3; ++i) soup.xyz[i] *= factor;
  }
  return soup;
}

struct Thinned {
  plc::Mesh mesh;
  int tries = 0;
};

// first: what is made the first time.
void thin_out(const samples::Soup& first, const samples::Soup& soup, plc::Sizing& sizing,
              Thinned& thinned) {
  thinned.mesh.delta = 1;
  thinned.mesh.sizing = &sizing;
  const auto make = [&](plc::Crossings& surface) -> plc::Status {
    const samples::Soup& made = ++thinned.tries == 1 ? first : soup;
    surface = {samples::buffer_of<float>(made.xyz), samples::buffer_of<uint32_t>(made.abc)};
    return {};
  };
  REQUIRE(plc::thin_out(make, plc::Schedule({}), {}, thinned.mesh).ok());
}

void thin_out(const samples::Soup& soup, plc::Sizing& sizing, Thinned& thinned) {
  thin_out(soup, soup, sizing, thinned);
}

}  // namespace

TEST_CASE("sheets that thinned out would meet stay as they were, by what is found in their block",
          "[thinning]") {
  Evenly even;
  const samples::Soup outer = rough_ball(1),
                      inner = samples::flipped(samples::turned(rough_ball(0.98)));
  samples::Soup both = outer;
  both.append(inner);
  Thinned alone, within, shell;
  thin_out(outer, even.sizing, alone);
  thin_out(inner, even.sizing, within);
  thin_out(both, even.sizing, shell);
  CHECK(alone.mesh.vertex_count() < outer.xyz.size() / 3 / 8);
  CHECK(shell.mesh.vertex_count() > 1.1 * (alone.mesh.vertex_count() + within.mesh.vertex_count()));
  CHECK(shell.mesh.vertex_count() < 0.9 * static_cast<double>(both.xyz.size()) / 3);
  CHECK(plc::broken_invariant(shell.mesh).empty());
  CHECK(plc::meeting_faces(shell.mesh, plc::SerialExecutor()).empty());
  // Nothing was left to find where blocks are side by side.
  CHECK(alone.tries == 1);
  CHECK(shell.tries == 1);
}

// No surface is known that meets itself across blocks once it is thinned out: one that does from
// the start takes its place.
TEST_CASE("where the whole meets itself it is made once more, and stays finer there",
          "[thinning]") {
  Evenly even;
  const auto pair = [](double apart) {
    samples::Soup other = rough_ball(1);
    for (size_t v = 0; v < other.xyz.size(); v += 3) other.xyz[v] += apart;
    samples::Soup both = rough_ball(1);
    both.append(other);
    return both;
  };
  Thinned once, twice;
  thin_out(pair(13), even.sizing, once);
  thin_out(pair(11), pair(13), even.sizing, twice);
  CHECK(once.tries == 1);
  CHECK(twice.tries == 2);
  CHECK(twice.mesh.vertex_count() > once.mesh.vertex_count());
  CHECK(plc::broken_invariant(twice.mesh).empty());
  CHECK(plc::meeting_faces(twice.mesh, plc::SerialExecutor()).empty());
}

// The tool of test_determinism.cpp: that it names what it is there to name.
#include "engine/recover/pass_observer.h"

#include <bit>
#include <catch2/catch.hpp>

#include "tests/samples/sample_traces.h"

namespace {

using plc::Mesh;
using plc::SimdTarget;
using samples::Step;
using samples::Trace;

constexpr int kIteration = 5;

samples::Run small_run() {
  samples::Run run = samples::make_run(
      "chain", samples::chain_potential(samples::empty_volume({32, 32, 32})), 0.5, 0);
  run.recovery.max_iterations = 8;
  return run;
}

Trace traced(const samples::Fault& fault = {}) {
  return samples::traced(small_run(), 1, SimdTarget::kScalar, fault);
}

// The run in which `spoil` is done after a pass of one iteration.
Trace spoilt(const std::string& where, const std::function<void(Mesh&)>& spoil) {
  return traced([&](int iteration, const std::string& pass, Mesh& mesh) {
    if (iteration == kIteration && pass == where) spoil(mesh);
  });
}

void flip_bit(float& value, uint32_t bit = 0) {
  value = std::bit_cast<float>(std::bit_cast<uint32_t>(value) ^ 1U << bit);
}

// The state after the pass of one iteration.
const Step& step_at(const Trace& trace, const std::string& pass) {
  for (const Step& step : trace.steps) {
    if (step.iteration == kIteration && step.pass == pass) return step;
  }
  FAIL("no pass " + pass);
  return trace.steps.front();
}

}  // namespace

TEST_CASE("every pass of an iteration is seen, in its order", "[pass_observer]") {
  const Trace trace = traced();
  std::vector<std::string> passes;
  for (const Step& step : trace.steps) {
    if (step.iteration == kIteration) passes.push_back(step.pass);
  }
  CHECK(passes == std::vector<std::string>{
                      "sleep", "begin", "normals", "stage 1", "laplacian 2", "stage 2",
                      "laplacian 3", "stage 3", "laplacian 4", "stage 4 and move", "calm", "due",
                      "hash", "surroundings, folds", "risk", "motion guard", "resolution"});
  CHECK(trace.steps.front().pass == "start");
  CHECK(trace.steps[trace.steps.size() - 2].pass == "ids");
  CHECK(trace.steps.back().pass == "embedded");
}

TEST_CASE("who looks changes nothing", "[pass_observer]") {
  const samples::Run run = small_run();
  const plc::Schedule schedule(1);
  Mesh mesh;
  std::vector<plc::LevelRecord> records;
  REQUIRE(plc::pyramidal_recover_shape(samples::pyramid_of(run), run.recovery, schedule,
                                       SimdTarget::kScalar, {}, mesh, records)
              .ok());
  CHECK(plc::state_hash(mesh) == traced().hash);
}

TEST_CASE("two runs of the same differ nowhere", "[pass_observer]") {
  CHECK(samples::first_difference(traced(), traced()) == "");
}

TEST_CASE("one bit of one vertex is named by iteration, pass and stream", "[pass_observer]") {
  const Trace sound = traced();
  const auto velocity = [](Mesh& mesh) { flip_bit(mesh.velocity.x[40]); };
  for (const std::string pass : {"sleep", "stage 2", "hash", "motion guard", "resolution"}) {
    CHECK(samples::first_difference(sound, spoilt(pass, velocity)) ==
          "iteration 5, pass " + pass + ": velocity");
  }
  const auto position = [](Mesh& mesh) { flip_bit(mesh.position[40].y); };
  CHECK(samples::first_difference(sound, spoilt("laplacian 3", position)) ==
        "iteration 5, pass laplacian 3: position");
  const auto slower = [](Mesh& mesh) { mesh.calm[40] ^= 1U; };
  CHECK(samples::first_difference(sound, spoilt("calm", slower)) == "iteration 5, pass calm: calm");
}

TEST_CASE("what a pass makes of a difference is seen in what it writes", "[pass_observer]") {
  const Trace sound = traced();
  const Trace other = spoilt("sleep", [](Mesh& mesh) { flip_bit(mesh.position[40].x, 16); });
  const auto differing = [&](const std::string& pass) {
    return samples::differing_parts(step_at(sound, pass), step_at(other, pass));
  };
  CHECK(differing("sleep") == "position");
  CHECK(differing("normals") == "position, normal, laplacian");
  CHECK(differing("stage 1") ==
        "position, normal, laplacian, stage velocity, new velocity, other stage position");
}

TEST_CASE("a pass that only one run has is named", "[pass_observer]") {
  const Trace whole = traced();
  Trace cut = whole;
  cut.steps.resize(3);
  CHECK(samples::first_difference(whole, cut) ==
        "iteration " + std::to_string(whole.steps[3].iteration) + ", pass " + whole.steps[3].pass +
            ": only in the first run");
  Trace other = whole;
  other.steps[2].pass = "rest";
  CHECK(samples::first_difference(whole, other).find("rest in the second run") !=
        std::string::npos);
}

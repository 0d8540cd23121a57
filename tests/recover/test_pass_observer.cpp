// The tool of test_determinism.cpp: that it names what it is there to name.
#include "engine/recover/pass_observer.h"

#include <bit>
#include <catch2/catch.hpp>
#include <map>
#include <set>

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

// What a part of the state is to the table of passes.
uint32_t resource_of(std::string_view part) {
  static const std::map<std::string_view, uint32_t> kResources = {
      {"rings", plc::kRings},
      {"position", plc::kPositions},
      {"velocity", plc::kVelocities},
      {"normal", plc::kNormals},
      {"metric normal", plc::kNormals},
      {"metric step", plc::kNormals},
      {"displacement", plc::kDisplacements},
      {"path", plc::kDue},
      {"idle", plc::kDue},
      {"calm", plc::kCalm},
      {"drift", plc::kCalm},
      {"turns", plc::kCalm},
      {"risk", plc::kRisk},
      {"laplacian", plc::kLaplacians},
      {"force", plc::kStages},
      {"stage velocity", plc::kStages},
      {"new velocity", plc::kStages},
      {"stage position", plc::kStages},
      {"other stage position", plc::kStages},
      {"blocks", plc::kAwake},
      {"step", plc::kStep},
      {"rest length", plc::kRestLength},
      {"user force", plc::kUserForce},
      {"fallen asleep", plc::kAwake},
      {"too near", plc::kSurroundings},
      {"at risk", plc::kSurroundings},
      {"taken back", plc::kTakenBack}};
  const auto found = kResources.find(part);
  return found == kResources.end() ? plc::kEverything : found->second;
}

// "stage 2: normal, path": what a pass has written that its row in the table does not say.
std::set<std::string> written_in_secret(const Trace& trace) {
  std::set<std::string> all;
  for (size_t i = 1; i < trace.steps.size(); ++i) {
    const Step& before = trace.steps[i - 1];
    const Step& after = trace.steps[i];
    for (size_t p = 0; p < after.parts.size(); ++p) {
      if (after.parts[p] == before.parts[p]) continue;
      const uint32_t resource = resource_of(after.parts[p].part);
      if ((resource & ~after.writes) == 0) continue;
      all.insert(after.pass + ": " + std::string(after.parts[p].part));
    }
  }
  return all;
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
  CHECK(passes == std::vector<std::string>{"sleep", "begin", "normals", "stage 1", "laplacian 2",
                                           "stage 2", "laplacian 3", "stage 3", "laplacian 4",
                                           "stage 4 and move", "calm", "due", "hash, folds",
                                           "surroundings", "risk", "motion guard", "resolution"});
  CHECK(trace.steps.front().pass == "start");
  CHECK(trace.steps[trace.steps.size() - 2].pass == "ids");
  CHECK(trace.steps.back().pass == "embedded");
}

TEST_CASE("who looks changes nothing", "[pass_observer]") {
  const samples::Run run = small_run();
  const plc::Schedule schedule(1, SimdTarget::kScalar);
  Mesh mesh;
  std::vector<plc::LevelRecord> records;
  REQUIRE(plc::pyramidal_recover_shape(samples::pyramid_of(run), run.recovery, schedule, {}, mesh,
                                       records)
              .ok());
  CHECK(plc::state_hash(mesh) == traced().hash);
}

TEST_CASE("two runs of the same differ nowhere", "[pass_observer]") {
  CHECK(samples::first_difference(traced(), traced()) == "");
}

TEST_CASE("one bit of one vertex is named by iteration, pass and stream", "[pass_observer]") {
  const Trace sound = traced();
  const auto velocity = [](Mesh& mesh) { flip_bit(mesh.velocity.x[40]); };
  for (const std::string pass : {"sleep", "stage 2", "hash, folds", "motion guard", "resolution"}) {
    CHECK(samples::first_difference(sound, spoilt(pass, velocity)) ==
          "iteration 5, pass " + pass + ": velocity");
  }
  const auto position = [](Mesh& mesh) { flip_bit(mesh.position[40].y); };
  CHECK(samples::first_difference(sound, spoilt("laplacian 3", position)) ==
        "iteration 5, pass laplacian 3: position");
  const auto turned = [](Mesh& mesh) { mesh.turns[40] ^= 1U; };
  CHECK(samples::first_difference(sound, spoilt("calm", turned)) ==
        "iteration 5, pass calm: turns");
  const auto woken = [](Mesh& mesh) { mesh.wake(40); };
  CHECK(samples::first_difference(sound, spoilt("due", woken)) == "iteration 5, pass due: idle");
}

TEST_CASE("no pass writes what its row of the table does not say", "[pass_observer]") {
  using Change = std::function<void(samples::Run&)>;
  const std::pair<const char*, Change> kWays[] = {
      {"curvature and image", [](samples::Run&) {}},
      {"springs", [](samples::Run& run) { run.recovery.model.spring = 0.1F; }},
      {"gradient, scaled",
       [](samples::Run& run) {
         run.recovery.model.gradient_normal = 0.5F;
         run.recovery.model.bound = plc::Bound::kScale;
       }},
      {"metric, pinned",
       [](samples::Run& run) {
         run.volume.spacing = {1, 1, 2};
         run.recovery.scale.anisotropy = plc::Anisotropy::kMetric;
         run.recovery.user.pins = {{{16, 16, 16}, 6}};
       }},
      {"a force of the user's", [](samples::Run& run) {
         run.recovery.force = [](int, const plc::MeshSpace&, const Mesh& mesh, const plc::Float4*,
                                 plc::Streams3& force) {
           for (uint32_t v = 0; v < mesh.slots(); ++v) force.set(v, {0.01F, 0, 0});
           return plc::Status();
         };
       }}};
  for (const auto& [name, change] : kWays) {
    samples::Run run = small_run();
    change(run);
    INFO(name);
    CHECK(written_in_secret(samples::traced(run, 1, SimdTarget::kScalar)) ==
          std::set<std::string>{});
  }
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

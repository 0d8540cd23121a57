// Runs pass by pass: which pass is the first in which two of them differ, and in what.
#pragma once
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "engine/mesh/state_hash.h"
#include "engine/recover/evolution.h"
#include "engine/recover/recovery.h"
#include "tests/samples/sample_runs.h"

namespace samples {

// The state after a pass.
struct Step {
  int iteration;  // of the whole run, from 1; 0: before the first
  std::string pass;
  uint32_t writes;  // what the table says of it
  std::vector<plc::PartHash> parts;
};

struct Trace {
  std::vector<Step> steps;
  std::vector<plc::LevelRecord> records;
  uint64_t hash = 0;              // of the result
  size_t most_awake = 0;          // vertices that moved in one iteration
  size_t most_beside_asleep = 0;  // ... in an iteration through which others slept
};

// May change the mesh after a pass, before the state is looked at: as if the pass had done it.
using Fault = std::function<void(int iteration, const std::string& pass, plc::Mesh& mesh)>;

inline Trace traced(const Run& run, int threads, plc::SimdTarget target, const Fault& fault = {}) {
  const plc::Schedule schedule(threads, target);
  plc::Mesh mesh;
  Trace trace;
  int iteration = 0;
  plc::RecoveryHooks hooks;
  hooks.pass = [&](const std::string& pass, uint32_t writes, const plc::Evolution& evolution) {
    if (pass == "sleep") {
      ++iteration;
      trace.most_awake = std::max(trace.most_awake, evolution.awake());
      if (evolution.any_asleep()) {
        trace.most_beside_asleep = std::max(trace.most_beside_asleep, evolution.awake());
      }
    }
    if (fault) fault(iteration, pass, mesh);
    trace.steps.push_back({iteration, pass, writes, evolution.hashes()});
  };
  REQUIRE(plc::pyramidal_recover_shape(pyramid_of(run, schedule), run.recovery, schedule, hooks,
                                       mesh, trace.records)
              .message() == "");
  trace.hash = plc::state_hash(mesh);
  return trace;
}

// "velocity, position": the parts in which two states differ, or nothing.
inline std::string differing_parts(const Step& a, const Step& b) {
  std::string parts;
  for (size_t p = 0; p < a.parts.size(); ++p) {
    if (a.parts[p] == b.parts[p]) continue;
    if (!parts.empty()) parts += ", ";
    parts += a.parts[p].part;
  }
  return parts;
}

// "iteration 17, pass stage 2: velocity", or nothing.
inline std::string first_difference(const Trace& a, const Trace& b) {
  const auto name = [](const Step& step) {
    return "iteration " + std::to_string(step.iteration) + ", pass " + step.pass;
  };
  for (size_t i = 0; i < std::max(a.steps.size(), b.steps.size()); ++i) {
    if (i >= a.steps.size()) return name(b.steps[i]) + ": only in the second run";
    if (i >= b.steps.size()) return name(a.steps[i]) + ": only in the first run";
    const Step& one = a.steps[i];
    const Step& other = b.steps[i];
    if (one.iteration != other.iteration || one.pass != other.pass) {
      return name(one) + " is " + name(other) + " in the second run";
    }
    const std::string parts = differing_parts(one, other);
    if (!parts.empty()) return name(one).append(": ").append(parts);
  }
  return a.hash == b.hash ? "" : "the result";
}

}  // namespace samples

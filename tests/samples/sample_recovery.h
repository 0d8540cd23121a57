// Whole recoveries on one thread, with what they reported.
#pragma once
#include <catch2/catch.hpp>
#include <vector>

#include "engine/recover/recovery.h"
#include "tests/samples/sample_runs.h"

namespace samples {

struct Recovered {
  plc::Status status;
  plc::Mesh mesh;
  std::vector<plc::LevelRecord> records;
};

inline Recovered recover(const Run& run, const plc::RecoveryHooks& hooks = {}) {
  Recovered r;
  const plc::Schedule schedule(1);
  const plc::Pyramid pyramid = pyramid_of(run);
  REQUIRE(!pyramid.levels.empty());
  r.status =
      plc::pyramidal_recover_shape(pyramid, run.recovery, schedule, hooks, r.mesh, r.records);
  return r;
}

// What every result promises.
inline void check_valid(const plc::Mesh& mesh) {
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(meeting_count(mesh) == 0);
  CHECK(mesh.slots() == mesh.vertex_count());
}

inline double sphere_volume(double r) {
  return 4.0 / 3 * 3.14159265358979 * r * r * r;
}

}  // namespace samples

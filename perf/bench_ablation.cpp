// Bone of the head CT, coarse to fine as the paper has it, without one of the heuristics that the
// command cannot leave out, as their results are worth nothing but a comparison:
//   bench_ablation HEAD_CT check-all|no-renumbering
// prints the seconds and the hash of the result as JSON. perf/part/ablation.sh calls it.
#include <cstdio>
#include <string>

#include "engine/mesh/state_hash.h"
#include "perf/bench_head.h"

namespace {

int run(const std::string& path, const std::string& left_out) {
  const plc::Schedule schedule(0);
  const bench::HeadVolume head(path, schedule);
  plc_parameters p = head.parameters;
  p.late_bubbles = 0;
  const double start = plc::now();
  plc::Pyramid pyramid;
  plc::RecoverySpec spec = head.prepare(p, schedule, pyramid);
  if (left_out == "check-all") spec.slow_vertices = false;
  if (left_out == "no-renumbering") spec.renumbering = false;
  const double built = plc::now();
  plc::Mesh mesh;
  std::vector<plc::LevelRecord> records;
  bench::demand(
      plc::pyramidal_recover_shape(std::move(pyramid), spec, schedule, {}, mesh, records));
  std::printf("{\"seconds\": {\"pyramid\": %.6f, \"evolution\": %.6f}, \"hash\": \"%016llx\"}\n",
              built - start, plc::now() - built,
              static_cast<unsigned long long>(plc::state_hash(mesh)));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string left_out = argc == 3 ? argv[2] : "";
  if (left_out != "check-all" && left_out != "no-renumbering") {
    std::fputs("usage: bench_ablation HEAD_CT check-all|no-renumbering\n", stderr);
    return 2;
  }
  try {
    return run(argv[1], left_out);
  } catch (const plc::tools::Failure& failure) {
    std::fprintf(stderr, "bench_ablation: %s\n", failure.message.c_str());
    return 1;
  }
}

#include "tests/campaign/campaign_run.h"

#include <algorithm>
#include <bit>
#include <cstdio>

#include "tests/campaign/campaign_watch.h"

namespace campaign {

namespace {

int64_t limit_of(const Case& c, const RunRecord& first) {
  if (c.second.memory_part == 0) return 0;
  return 1 + static_cast<int64_t>(c.second.memory_part * static_cast<double>(first.memory));
}

// Where the second run had no more memory, and where something is wrong on purpose, which steps may
// find in another order, both statuses are right and need not be equal.
bool comparable(const Case& c, const RunRecord& second) {
  const bool out_of_memory = c.second.memory_part > 0 && second.status == PLC_OUT_OF_MEMORY;
  return !out_of_memory && (c.fault.empty() || !c.second.steps);
}

constexpr const char* kFindingNames[kFindings] = {
    "none",      "invalid",  "self-intersection", "rounded", "status",
    "invariant", "restless", "difference",        "crash",   "hang"};

}  // namespace

std::string difference(const RunRecord& a, const RunRecord& b) {
  if (a.status != b.status || a.message != b.message) {
    return "status " + std::to_string(a.status) + " (" + a.message + ") and " +
           std::to_string(b.status) + " (" + b.message + ")";
  }
  for (size_t i = 0; i < std::min(a.iterations.size(), b.iterations.size()); ++i) {
    const Iteration& x = a.iterations[i];
    const Iteration& y = b.iterations[i];
    const auto same = [](double p, double q) {
      return std::bit_cast<uint64_t>(p) == std::bit_cast<uint64_t>(q);
    };
    if (x.level == y.level && x.iteration == y.iteration && x.vertices == y.vertices &&
        same(x.energy, y.energy) && same(x.speed, y.speed)) {
      continue;
    }
    char line[240];
    std::snprintf(line, sizeof line,
                  "first in level %d iteration %d: %lld and %lld vertices, energy %.17g and %.17g",
                  x.level, x.iteration, static_cast<long long>(x.vertices),
                  static_cast<long long>(y.vertices), x.energy, y.energy);
    return line;
  }
  if (a.iterations.size() != b.iterations.size()) return "numbers of iterations";
  for (size_t i = 0; i < std::min(a.levels.size(), b.levels.size()); ++i) {
    if (a.levels[i] != b.levels[i]) return a.levels[i] + " and " + b.levels[i];
  }
  if (a.levels.size() != b.levels.size()) return "numbers of levels";
  return a.hash != b.hash ? "the results, not the levels" : "";
}

const char* finding_name(Finding finding) {
  return kFindingNames[static_cast<size_t>(finding)];
}

Result run_case(const Case& c, samples::Soup* mesh) {
  const double start = processor_seconds();
  Result result;
  RunRecord& one = result.runs[0];
  RunRecord& other = result.runs[1];
  const Way first_way;
  Watch first(c, first_way, true), second(c, c.second, false);
  one = first.run(0, mesh);
  other = second.run(limit_of(c, one), nullptr);
  result.finding = first.finding();
  result.what = first.what();
  if (result.finding == Finding::kNone && comparable(c, other)) {
    result.what = difference(one, other);
    if (!result.what.empty()) result.finding = Finding::kDifference;
  }
  if (result.finding == Finding::kNone) {
    result.finding = second.finding();
    result.what = second.what();
  }
  result.seconds = processor_seconds() - start;
  return result;
}

}  // namespace campaign

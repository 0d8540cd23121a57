// Runs a case twice, the second time in another way, and says what is wrong.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tests/campaign/campaign_case.h"

namespace campaign {

enum class Finding : uint8_t {
  kNone,
  kInvalid,           // closed, manifold, oriented, outward: not all of them
  kSelfIntersection,  // in the space that the mesh evolves in
  kRounded,           // valid there, but not in the space that it was asked for
  kStatus,            // not one that is right for the input
  kInvariant,         // a value that cannot be, as an energy below 0
  kRestless,          // a level that is to converge reaches max_iterations
  kDifference,        // between the two runs
  kCrash,
  kHang,
};
inline constexpr int kFindings = 10;
const char* finding_name(Finding finding);

// One iteration as progress tells it; what differs first says where two runs part.
struct Iteration {
  int level, iteration;
  int64_t vertices;
  double energy, speed;
};

struct RunRecord {
  plc_status status = PLC_OK;
  std::string message;
  uint64_t hash = 0;
  int64_t vertices = 0;
  std::vector<Iteration> iterations;
  std::vector<std::string> levels;  // a line for each
  int64_t memory = 0;               // bytes at most
  bool paused = false, saved = false;
  double seconds = 0;  // of the processor
};

struct Result {
  Finding finding = Finding::kNone;
  std::string what;
  RunRecord runs[2];
  double seconds = 0;  // of the processor
};

// Where two runs part: an iteration, a level, the status; nothing where they are the same.
std::string difference(const RunRecord& a, const RunRecord& b);

// mesh: where not NULL, the surface of the first run, in the case's space.
Result run_case(const Case& c, samples::Soup* mesh = nullptr);

}  // namespace campaign

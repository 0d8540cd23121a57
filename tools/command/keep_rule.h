// --keep: which bodies of a surface are kept.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace plc::tools {

struct KeepRule {
  std::string text;           // as given, but "" for "all"
  int64_t count = 0;          // as many, the largest; 0: by volume
  double least_volume = 0.0;  // in the unit of the coordinates
};

constexpr const char* kKeepType = "all|largest|N|Vmm3";

// "all", "largest", a number of bodies, or "500mm3". Throws CLI::ValidationError.
KeepRule to_keep_rule(const std::string& option, const std::string& text);

// A mark for each body, by its volume; of equal ones the first.
std::vector<char> kept_by(const KeepRule& rule, const std::vector<double>& volumes);

}  // namespace plc::tools

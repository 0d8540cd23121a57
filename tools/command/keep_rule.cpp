#include "tools/command/keep_rule.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numeric>

#include "tools/command/option_values.h"

namespace plc::tools {

KeepRule to_keep_rule(const std::string& option, const std::string& text) {
  constexpr const char* kExpected =
      "all, largest, a number of bodies above 0, or a volume such as 500mm3";
  constexpr const char* kUnit = "mm3";
  if (text == "all") return {};
  KeepRule rule{text, 0, 0};
  const size_t unit = text.rfind(kUnit);
  try {
    if (text == "largest") {
      rule.count = 1;
    } else if (unit != std::string::npos && unit + 3 == text.size()) {
      rule.least_volume = to_number(option, text.substr(0, unit));
      if (!(rule.least_volume > 0)) refuse_value(option, text, kExpected);
    } else {
      rule.count = to_integer(option, text);
      if (rule.count < 1) refuse_value(option, text, kExpected);
    }
  } catch (const CLI::ValidationError&) {
    refuse_value(option, text, kExpected);
  }
  return rule;
}

std::vector<char> kept_by(const KeepRule& rule, const std::vector<double>& volumes) {
  std::vector<char> kept(volumes.size(), 0);
  if (rule.text.empty()) {
    std::fill(kept.begin(), kept.end(), char{1});
  } else if (rule.count == 0) {
    for (size_t i = 0; i < volumes.size(); ++i) kept[i] = volumes[i] >= rule.least_volume ? 1 : 0;
  } else {
    std::vector<size_t> order(volumes.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return volumes[a] > volumes[b]; });
    order.resize(std::min(order.size(), static_cast<size_t>(rule.count)));
    for (const size_t i : order) kept[i] = 1;
  }
  return kept;
}

}  // namespace plc::tools

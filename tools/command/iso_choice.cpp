#include "tools/command/iso_choice.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "tools/command/option_values.h"

namespace plc::tools {

namespace {

constexpr const char* kIsoExpected =
    "finite numbers, otsu, or percentiles such as p95, separated by commas";

IsoChoice to_iso_choice(const std::string& option, const std::string& text,
                        const std::string& word) {
  using Kind = IsoChoice::Kind;
  if (word == "otsu") return {word, Kind::kOtsu, 0};
  const bool percentile = word.size() > 1 && word[0] == 'p';
  double number = 0;
  try {
    number = to_number(option, percentile ? word.substr(1) : word);
  } catch (const CLI::ValidationError&) {
    refuse_value(option, text, kIsoExpected);
  }
  if (!percentile) return {word, Kind::kNumber, number};
  if (!(number >= 0 && number <= 100)) refuse_value(option, text, kIsoExpected);
  return {word, Kind::kPercentile, number};
}

}  // namespace

std::vector<IsoChoice> to_iso_choices(const std::string& option, const std::string& text) {
  std::vector<IsoChoice> choices;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    choices.push_back(to_iso_choice(option, text, text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return choices;
}

}  // namespace plc::tools

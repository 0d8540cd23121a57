// The parser of `extract`, for the options that a cohort has.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "tools/cohort/plan.h"

namespace plc::tools {

class CohortParser : public ExtractParser {
 public:
  // `labels`: as of `extract --labels`.
  CohortParser(std::string mesh_suffix, bool labels);

  Kind kind_of(const std::string& option) const override;
  std::vector<std::string> check(const std::vector<std::string>& words) const override;
  void check_alone(const std::string& word) const override;

 private:
  std::string mesh_suffix_;
  bool labels_;
};

// Options of extract that tell files, of which a cohort has its own.
bool is_own_option(const std::string& name);

// The options that have been given, a word each: "--iso=226".
std::vector<std::string> given_words(const CLI::App& command, const ExtractParser& parser);

}  // namespace plc::tools

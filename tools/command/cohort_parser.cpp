#include "tools/command/cohort_parser.h"

#include <algorithm>
#include <set>
#include <utility>

#include "tools/command/command_labels.h"
#include "tools/command/engine_handles.h"
#include "tools/command/extract_job.h"
#include "tools/command/extract_options.h"
#include "tools/file/failure.h"

namespace plc::tools {
namespace {

// A fresh one for each command line: parsing fills it.
struct Extract {
  CLI::App app;
  ExtractOptions options;

  Extract() {
    add_extract_options(app, options);
    add_label_options(app, options);
  }

  void parse(std::vector<std::string> words) {
    try {
      std::reverse(words.begin(), words.end());  // as CLI11 wants them
      app.parse(std::move(words));
      read_structures(options);
    } catch (const CLI::ParseError& e) {
      throw Failure{e.what()};
    }
  }
};

// Of parameters: the engine looks at them before it looks at the image, of which there is none
// here. What an iso-value that the image tells goes with, and labels, is known when they run.
void check_range(const ExtractJob& job, bool labels) {
  if (labels || (!job.iso.text.empty() && !job.iso.is_number())) return;
  plc_context_options alone;
  plc_context_options_defaults(&alone);
  alone.threads = 1;
  const ContextHandle context = make_context(alone);
  plc_image none;
  plc_image_defaults(&none);
  none.spacing[0] = 0;
  plc_parameters parameters = job.parameters;
  if (!job.iso.text.empty()) parameters.iso = job.iso.number;
  plc_surface* surface = nullptr;
  if (plc_extract(context.get(), &none, &parameters, nullptr, &surface) == PLC_INVALID_ARGUMENT) {
    throw failure_of(context.get());
  }
}

}  // namespace

bool is_own_option(const std::string& name) {
  static const std::set<std::string> own = {"output", "report", "trace",           "each-level",
                                            "quiet",  "labels", "slicer-progress", "help"};
  return own.contains(name);
}

CohortParser::CohortParser(std::string mesh_suffix, bool labels)
    : mesh_suffix_(std::move(mesh_suffix)), labels_(labels) {}

ExtractParser::Kind CohortParser::kind_of(const std::string& option) const {
  if (option.empty() || option[0] == '-' || is_own_option(option)) return Kind::kUnknown;
  static Extract extract;
  const CLI::Option* found = extract.app.get_option_no_throw("--" + option);
  if (found == nullptr || found->get_positional()) return Kind::kUnknown;
  return found->get_items_expected_max() == 0 ? Kind::kFlag : Kind::kValue;
}

std::vector<std::string> CohortParser::check(const std::vector<std::string>& words) const {
  Extract extract;
  std::vector<std::string> all = words;
  all.push_back("--output=surface" + mesh_suffix_);
  all.push_back(labels_ ? "--labels=image" : "image");
  extract.parse(all);
  const ExtractOptions& options = extract.options;
  for (const ExtractJob& job : jobs_of(options)) check_range(job, labels_);
  std::vector<std::string> files;
  if (!options.attach.empty()) files.push_back(options.attach);
  if (!options.init_file.empty()) files.push_back(options.init_file);
  return files;
}

void CohortParser::check_alone(const std::string& word) const {
  Extract extract;
  extract.parse({word, "--output=surface" + mesh_suffix_, "image"});
}

std::vector<std::string> given_words(const CLI::App& command, const ExtractParser& parser) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options()) {
    const std::string& name = option->get_lnames().empty() ? "" : option->get_lnames()[0];
    const ExtractParser::Kind kind = parser.kind_of(name);
    if (kind == ExtractParser::Kind::kUnknown || option->count() == 0) continue;
    if (kind == ExtractParser::Kind::kFlag) words.push_back("--" + name);
    if (kind == ExtractParser::Kind::kFlag) continue;
    for (const std::string& result : option->results()) {
      words.push_back(std::string("--").append(name).append("=").append(result));
    }
  }
  return words;
}

}  // namespace plc::tools

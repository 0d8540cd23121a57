#include "tools/cohort/plan.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "tools/cohort/bids.h"
#include "tools/cohort/cohort_progress.h"
#include "tools/file/failure.h"
#include "tools/file/folder.h"
#include "tools/file/printable.h"

namespace plc::tools {
namespace {

namespace fs = std::filesystem;

// "--iso" of "--iso=226".
std::string option_of(const std::string& word) {
  return word.substr(0, word.find('='));
}

// A task runs in another folder than the plan: files are named by absolute paths.
std::string with_absolute_path(const std::string& word, const std::string& folder) {
  for (const std::string begin : {"--attach=", "--init=mesh=", "--init=mask="}) {
    if (!word.starts_with(begin) || word.size() == begin.size()) continue;
    return begin + (fs::path(folder) / word.substr(begin.size())).lexically_normal().string();
  }
  return word;
}

// The word for a cell; "" where the cell says that a flag is not given.
std::string word_of(const std::string& column, const std::string& cell, bool is_flag) {
  if (!is_flag) return "--" + column + "=" + cell;
  if (cell == "yes" || cell == "true" || cell == "1") return "--" + column;
  if (cell == "no" || cell == "false" || cell == "0") return "";
  throw Failure{"'" + printable(cell) + "' is not yes or no"};
}

// A failure of a table's row names the row; a folder has none.
template <typename Work>
auto within(const Row& row, const std::string& between, const Work& work) {
  try {
    return work();
  } catch (const Failure& failure) {
    throw Failure{row.where == row.input ? failure.message : row.where + between + failure.message};
  }
}

class Planner {
 public:
  Planner(const PlanOptions& options, const ExtractParser& parser)
      : options_(options), parser_(parser), table_(read_table(options.list, options.table)) {
    for (const std::string& column : table_.options) {
      if (parser_.kind_of(column) == ExtractParser::Kind::kUnknown) {
        throw Failure{options.list + ": column " + printable(column) +
                      " is no option of extract that a cohort takes"};
      }
    }
    manifest_.version = options.version;
    manifest_.suffix = options.mesh_suffix;
    manifest_.root = table_.root;
    manifest_.labels = options.labels;
    const std::string here = fs::current_path().string();
    for (const std::string& word : options.words) common_.push_back(with_absolute_path(word, here));
  }

  // First all that is fast, so that a mistake in the last row is told at once.
  Manifest run() {
    for (const Row& row : table_.rows) {
      Scan scan;
      within(row, ", column name: ", [&] { require_utf8(row.name); });
      within(row, ", column input: ", [&] { require_utf8(row.input); });
      scan.name = row.name;
      scan.input = row.input;
      scan.output = row.output;
      scan.options = words_of(row);
      for (const std::string& word : scan.options) {
        within(row, std::string(", ") + option_of(word) + ": ", [&] { require_utf8(word); });
      }
      files_.push_back(files_named(row, scan.options));
      scan.stamp = within(row, ", column input: ", [&] { return stamp_of(scan.input); });
      manifest_.scans.push_back(scan);
    }
    CohortProgress progress("scans read", manifest_.scans.size(), options_.quiet);
    for (size_t i = 0; i < manifest_.scans.size(); ++i) {
      Scan& scan = manifest_.scans[i];
      const Row& row = table_.rows[i];
      scan.hash = within(row, ", column input: ", [&] { return hash_of(scan.input); });
      std::vector<std::string> hashes;
      for (const std::string& file : files_[i]) {
        hashes.push_back(within(row, ": ", [&] { return hash_of_shared(file); }));
      }
      scan.key = key_of(scan, manifest_, hashes);
      progress.update(i + 1, "");
    }
    return manifest_;
  }

 private:
  std::vector<std::string> words_of(const Row& row) const {
    std::vector<std::string> words = common_;
    for (const auto& [column, cell] : row.cells) {
      const std::string name = column;
      const std::string text = cell;
      const std::string word = within(row, ", column " + name + ": ", [&] {
        const bool is_flag = parser_.kind_of(name) == ExtractParser::Kind::kFlag;
        std::string made = word_of(name, text, is_flag);
        if (!made.empty()) parser_.check_alone(made);
        return made;
      });
      const auto same = [&](const std::string& w) { return option_of(w) == "--" + name; };
      words.erase(std::remove_if(words.begin(), words.end(), same), words.end());
      if (!word.empty()) words.push_back(with_absolute_path(word, table_.folder));
    }
    std::stable_sort(words.begin(), words.end(), [](const std::string& a, const std::string& b) {
      return option_of(a) < option_of(b);
    });
    return words;
  }

  // Most rows have the same options.
  std::vector<std::string> files_named(const Row& row, const std::vector<std::string>& words) {
    const auto known = checked_.find(words);
    if (known != checked_.end()) return known->second;
    const auto files = within(row, ": ", [&] { return parser_.check(words); });
    return checked_.emplace(words, files).first->second;
  }

  std::string hash_of_shared(const std::string& file) {
    const auto known = hashes_.find(file);
    if (known != hashes_.end()) return known->second;
    return hashes_.emplace(file, hash_of(file)).first->second;
  }

  const PlanOptions& options_;
  const ExtractParser& parser_;
  Table table_;
  Manifest manifest_;
  std::vector<std::string> common_;
  std::vector<std::vector<std::string>> files_;  // of each scan, that its options name
  std::map<std::vector<std::string>, std::vector<std::string>> checked_;
  std::map<std::string, std::string> hashes_;
};

}  // namespace

Manifest plan_cohort(const PlanOptions& options, const ExtractParser& parser) {
  Manifest manifest = Planner(options, parser).run();
  make_folder(options.folder);
  if (!manifest.root.empty()) write_description(options.folder, manifest.root, manifest.version);
  write_manifest(options.folder, manifest);
  return manifest;
}

}  // namespace plc::tools

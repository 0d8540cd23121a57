#include "tools/cohort/plan_table.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string_view>
#include <system_error>

#include "tools/cohort/bids.h"
#include "tools/file/failure.h"
#include "tools/file/path_suffix.h"
#include "tools/file/printable.h"

namespace plc::tools {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == '\t') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

bool is_empty(const std::string& cell) {
  return cell.empty() || cell == "n/a";
}

std::string absolute(const std::string& folder, const std::string& path) {
  return (fs::path(folder) / path).lexically_normal().string();
}

class TsvReader {
 public:
  TsvReader(const std::string& path, Table& table) : path_(path), table_(table), file_(path) {
    if (!file_) throw Failure{path + ": cannot be read"};
    const std::string folder = fs::absolute(path).parent_path().string();
    table_.folder = folder;
  }

  void read() {
    read_header();
    std::string line;
    for (int number = 2; next(line); ++number) {
      if (!line.empty()) add(path_ + ": row " + std::to_string(number), cells_of(line));
    }
    if (file_.bad()) throw Failure{path_ + ": cannot be read"};
  }

 private:
  bool next(std::string& line) {
    if (!std::getline(file_, line)) return false;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
  }

  void read_header() {
    std::string line;
    if (!next(line)) throw Failure{path_ + ": is empty"};
    constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of UTF-8, as spreadsheets begin files
    if (line.starts_with(kMark)) line.erase(0, kMark.size());
    columns_ = cells_of(line);
    std::set<std::string> seen;
    for (const std::string& column : columns_) {
      if (!seen.insert(column).second) {
        throw Failure{path_ + ": column " + printable(column) + " is there twice"};
      }
      if (column != "name" && column != "input") table_.options.push_back(column);
    }
    for (const char* needed : {"name", "input"}) {
      if (!seen.contains(needed)) {
        throw Failure{path_ + ": its first line has no column \"" + needed +
                      "\"; columns are separated by tabs"};
      }
    }
  }

  void add(const std::string& where, const std::vector<std::string>& cells) {
    if (cells.size() != columns_.size()) {
      throw Failure{where + ": has " + std::to_string(cells.size()) + " columns, the first line " +
                    std::to_string(columns_.size())};
    }
    Row row;
    row.where = where;
    for (size_t i = 0; i < cells.size(); ++i) {
      if (!is_printable(cells[i])) {
        throw Failure{where + ", column " + columns_[i] + ": has control characters"};
      }
      if (columns_[i] == "name") {
        row.name = cells[i];
      } else if (columns_[i] == "input") {
        if (is_empty(cells[i])) throw Failure{where + ", column input: is empty"};
        row.input = absolute(table_.folder, cells[i]);
      } else if (!is_empty(cells[i])) {
        row.cells.emplace_back(columns_[i], cells[i]);
      }
    }
    row.output = row.name;
    table_.rows.push_back(row);
  }

  const std::string& path_;
  Table& table_;
  std::ifstream file_;
  std::vector<std::string> columns_;
};

bool is_image(const std::string& path) {
  static const std::set<std::string> suffixes = {".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha",
                                                 ".mhd", ".inv3",   ".tif",  ".tiff", ".dcm"};
  return suffixes.contains(path_suffix(path));
}

// A folder in it may be a series of slices.
void read_images(const std::string& folder, Table& table) {
  std::error_code error;
  std::vector<std::string> inputs;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    std::error_code none;
    const std::string path = i->path().string();
    if (i->path().filename().string().starts_with(".")) continue;
    if (i->is_directory(none) || is_image(path)) inputs.push_back(path);
  }
  if (error) throw Failure{folder + ": cannot be read: " + error.message()};
  std::sort(inputs.begin(), inputs.end());
  for (const std::string& input : inputs) {
    std::string name = fs::path(input).filename().string();
    if (!fs::is_directory(input)) name.resize(name.size() - path_suffix(name).size());
    table.rows.push_back({input, name, fs::absolute(input).lexically_normal().string(), name, {}});
  }
}

void check_name(const Row& row) {
  const std::string& name = row.name;
  constexpr size_t kLongest = 200;  // of the 255 bytes of a file's name, suffixes go on
  if (name.empty()) throw Failure{row.where + ", column name: is empty"};
  const bool good = name[0] != '.' && name[0] != '-' && name.find('/') == std::string::npos &&
                    is_printable(name) && name.size() <= kLongest;
  if (!good) {
    throw Failure{row.where + ", column name: '" + printable(name) +
                  "' is no name of a file, or begins with . or -"};
  }
}

// Results and folders of the cohort that a scan would write over.
bool is_taken(const std::string& output) {
  static const std::set<std::string> taken = {"cohort",    "failed", "work",
                                              "submitted", "logs",   "dataset_description"};
  return taken.contains(output);
}

}  // namespace

Table read_table(const std::string& list, const TableOptions& options) {
  Table table;
  table.folder = fs::current_path().string();
  std::error_code none;
  if (!fs::is_directory(list, none)) {
    if (!options.suffix.empty()) {
      throw Failure{"--suffix: is of a BIDS tree, and " + list + " is a table"};
    }
    TsvReader(list, table).read();
  } else if (is_bids(list)) {
    read_bids(list, options, table);
  } else {
    if (!options.suffix.empty()) {
      throw Failure{list + ": is no BIDS tree: it has no dataset_description.json"};
    }
    read_images(list, table);
  }
  if (table.rows.empty()) throw Failure{list + ": there are no scans in it"};
  std::map<std::string, std::string> names;
  std::map<std::string, std::string> outputs;
  for (const Row& row : table.rows) {
    check_name(row);
    if (is_taken(row.output)) throw Failure{row.where + ": the name " + row.name + " is taken"};
    const auto [first, is_new] = names.emplace(row.name, row.where);
    if (!is_new)
      throw Failure{row.where + ": the name " + row.name + " is that of " + first->second};
    const auto [other, is_other] = outputs.emplace(row.output, row.where);
    if (!is_other) throw Failure{row.where + ": would be written over that of " + other->second};
  }
  return table;
}

}  // namespace plc::tools

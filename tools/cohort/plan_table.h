// The scans of a cohort as their user lists them: a table, a folder of images, or a BIDS tree.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace plc::tools {

struct Row {
  std::string where;  // for messages: "scans.tsv: row 3"
  std::string name;
  std::string input;
  std::string output;                                      // without a suffix
  std::vector<std::pair<std::string, std::string>> cells;  // column and text, of options
};

struct Table {
  std::vector<std::string> options;  // the columns beside name and input
  std::vector<Row> rows;
  std::string folder;  // relative paths begin here
  std::string root;    // of the BIDS tree; "": none
};

struct TableOptions {
  std::string suffix;       // of BIDS: T1w, CT ... ; "": of a folder all images
  std::string description;  // of BIDS derivatives: desc-DESCRIPTION
};

// `list`: a file of columns between tabs with their names in the first line, a folder whose entries
// are images, or a folder with a dataset_description.json. Names are unique. Throws Failure.
Table read_table(const std::string& list, const TableOptions& options);

}  // namespace plc::tools

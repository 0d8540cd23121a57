#include "tools/cohort/bids.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"
#include "tools/file/path_suffix.h"

namespace plc::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescription = "dataset_description.json";

bool is_word(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return std::isalnum(c) != 0; });
}

bool is_image(const std::string& name) {
  const std::string suffix = path_suffix(name);
  return suffix == ".nii" || suffix == ".nii.gz";
}

// "sub-01_desc-x_T1w" to "sub-01": what stands before the suffix, without a description.
std::string entities_of(const std::string& stem) {
  std::string entities = stem.substr(0, stem.rfind('_'));
  const size_t desc = entities.find("_desc-");
  if (desc != std::string::npos) {
    const size_t end = std::min(entities.find('_', desc + 1), entities.size());
    entities.erase(desc, end - desc);
  }
  return entities;
}

void add_images(const fs::path& root, const fs::path& subject, const TableOptions& options,
                std::vector<Row>& rows) {
  std::error_code error;
  for (fs::recursive_directory_iterator i(subject, error), end; !error && i != end;
       i.increment(error)) {
    std::string stem = i->path().filename().string();
    if (!is_image(stem)) continue;
    stem.resize(stem.size() - path_suffix(stem).size());
    if (!stem.ends_with("_" + options.suffix)) continue;
    const fs::path folder = i->path().parent_path().lexically_relative(root);
    const std::string entities = entities_of(stem);
    const fs::path output = folder / (entities + "_desc-" + options.description + "_mesh");
    const std::string input = fs::absolute(i->path()).lexically_normal().string();
    rows.push_back({input, stem, input, output.string(), {}});
  }
  if (error) throw Failure{subject.string() + ": cannot be read: " + error.message()};
}

}  // namespace

bool is_bids(const std::string& folder) {
  std::error_code none;
  return fs::is_regular_file(fs::path(folder) / kDescription, none);
}

void read_bids(const std::string& folder, const TableOptions& options, Table& table) {
  if (!is_word(options.suffix)) {
    throw Failure{folder + ": is a BIDS tree: --suffix tells which images, as in --suffix T1w"};
  }
  if (!is_word(options.description)) {
    throw Failure{"--desc: '" + options.description + "' is not letters and digits"};
  }
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    std::error_code none;
    const bool subject = i->path().filename().string().starts_with("sub-");
    if (subject && i->is_directory(none)) add_images(folder, i->path(), options, table.rows);
  }
  if (error) throw Failure{folder + ": cannot be read: " + error.message()};
  std::sort(table.rows.begin(), table.rows.end(),
            [](const Row& a, const Row& b) { return a.input < b.input; });
  table.root = fs::absolute(folder).lexically_normal().string();
}

std::string bids_surface(const std::string& output, const std::string& name) {
  std::string word;  // BIDS has letters and digits only: 0.5 is 0p5, -200 is m200
  for (const char c : name) {
    if (c == '.') word += 'p';
    if (c == '-') word += 'm';
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) word += c;
  }
  const size_t desc = output.rfind("_desc-");
  return output.substr(0, desc) + "_desc-" + word + "_mesh";
}

void write_description(const std::string& folder, const std::string& root,
                       const std::string& version) {
  const nlohmann::ordered_json json = {
      {"Name", "Surfaces of " + fs::path(root).filename().string()},
      {"BIDSVersion", "1.8.0"},
      {"DatasetType", "derivative"},
      {"GeneratedBy", {{{"Name", "Pellicle"}, {"Version", version}}}},
      {"SourceDatasets", {{{"URL", "file://" + root}}}}};
  AtomicFile file(folder + "/" + kDescription);
  file.write(json.dump(2) + "\n");
  file.commit();
}

}  // namespace plc::tools

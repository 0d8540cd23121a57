#include "tools/cohort/manifest.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"

namespace plc::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string path_in(const std::string& folder) {
  return folder + "/cohort.json";
}

Json json_of(const Scan& scan) {
  return {{"name", scan.name},         {"input", scan.input},
          {"bytes", scan.stamp.bytes}, {"modified", scan.stamp.modified},
          {"hash", scan.hash},         {"options", scan.options},
          {"output", scan.output},     {"key", scan.key}};
}

Scan scan_of(const Json& json) {
  Scan scan;
  scan.name = json.at("name").get<std::string>();
  scan.input = json.at("input").get<std::string>();
  scan.stamp.bytes = json.at("bytes").get<uint64_t>();
  scan.stamp.modified = json.at("modified").get<int64_t>();
  scan.hash = json.at("hash").get<std::string>();
  scan.options = json.at("options").get<std::vector<std::string>>();
  scan.output = json.at("output").get<std::string>();
  scan.key = json.at("key").get<std::string>();
  return scan;
}

// Whatever they are, results are the same.
bool changes_results(const std::string& option) {
  return !option.starts_with("--threads=") && !option.starts_with("--simd=");
}

}  // namespace

void require_utf8(const std::string& text) {
  try {
    (void)Json(text).dump();
  } catch (const Json::type_error&) {
    throw Failure{"is not UTF-8"};
  }
}

std::string key_of(const Scan& scan, const Manifest& manifest,
                   const std::vector<std::string>& hashes_of_files) {
  std::vector<std::string> options;
  std::copy_if(scan.options.begin(), scan.options.end(), std::back_inserter(options),
               changes_results);
  const Json all = {manifest.version, manifest.suffix, manifest.labels,
                    scan.hash,        options,         hashes_of_files};
  return content_hash(all.dump());
}

void write_manifest(const std::string& folder, const Manifest& manifest) {
  AtomicFile file(path_in(folder));
  const Json head = {{"pellicle", manifest.version},
                     {"suffix", manifest.suffix},
                     {"root", manifest.root},
                     {"labels", manifest.labels}};
  std::string text = head.dump();
  text.pop_back();
  file.write(text + ",\n\"scans\":[");
  const char* between = "\n";
  for (const Scan& scan : manifest.scans) {
    file.write(between + json_of(scan).dump());
    between = ",\n";
  }
  file.write("\n]}\n");
  file.commit();
}

Manifest read_manifest(const std::string& folder, const std::string& version) {
  const std::string path = path_in(folder);
  std::ifstream file(path);
  if (!file) throw Failure{path + ": cannot be read; pellicle cohort plan makes it"};
  Manifest manifest;
  try {
    const Json json = Json::parse(file);
    manifest.version = json.at("pellicle").get<std::string>();
    manifest.suffix = json.at("suffix").get<std::string>();
    manifest.root = json.at("root").get<std::string>();
    manifest.labels = json.at("labels").get<bool>();
    for (const Json& scan : json.at("scans")) manifest.scans.push_back(scan_of(scan));
  } catch (const Json::exception&) {
    throw Failure{path + ": is no plan of a cohort"};
  }
  if (manifest.version != version) {
    throw Failure{path + ": was planned by Pellicle " + manifest.version + ", this is " + version +
                  "; plan again to make everything anew"};
  }
  return manifest;
}

}  // namespace plc::tools

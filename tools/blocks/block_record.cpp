#include "tools/blocks/block_record.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/file/atomic_file.h"

namespace plc::tools {

namespace {

using Json = nlohmann::ordered_json;

std::string record_path(const std::string& block) {
  return std::filesystem::path(block).replace_extension(".json").string();
}

}  // namespace

std::string record_text(const TaskRecord& record) {
  const Json json = {{"vertices", record.vertices},    {"free", record.free},
                     {"after", record.after},          {"iterations", record.iterations},
                     {"converged", record.converged},  {"seconds", record.seconds},
                     {"ended", record.ended},          {"bricks_read", record.bricks_read},
                     {"peak_bytes", record.peak_bytes}};
  return json.dump();
}

void write_record(const std::string& block, const TaskRecord& record) {
  AtomicFile file(record_path(block));
  file.write(record_text(record) + "\n");
  file.commit();
}

std::optional<TaskRecord> read_record(const std::string& block) {
  std::ifstream file(record_path(block));
  if (!file) return std::nullopt;
  const Json json = Json::parse(file, nullptr, false);
  TaskRecord record;
  try {
    json.at("vertices").get_to(record.vertices);
    json.at("free").get_to(record.free);
    json.at("after").get_to(record.after);
    json.at("iterations").get_to(record.iterations);
    json.at("converged").get_to(record.converged);
    json.at("seconds").get_to(record.seconds);
    json.at("ended").get_to(record.ended);
    json.at("bricks_read").get_to(record.bricks_read);
    json.at("peak_bytes").get_to(record.peak_bytes);
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  return record;
}

}  // namespace plc::tools

// What is told of a task, beside its file: DIR/level1/1-0-2.json. Nothing is made of it but
// `status`, and a task is done without it, too: the file of its cells alone, which is written
// later, says so.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace plc::tools {

struct TaskRecord {
  int64_t vertices = 0, free = 0;  // of the window before, and of them those that may move
  int64_t after = 0;               // vertices of the window
  int64_t iterations = 0;
  bool converged = true;
  double seconds = 0;
  double ended = 0;         // seconds since 1970
  int64_t bricks_read = 0;  // for this task; 0 of an image that is held whole
  int64_t peak_bytes = 0;   // of the engine, since its process began
};

// One line of JSON.
std::string record_text(const TaskRecord& record);

// Atomically. `block`: the path of the task's file. Throws Failure.
void write_record(const std::string& block, const TaskRecord& record);
// None where there is none, or somebody has damaged it.
std::optional<TaskRecord> read_record(const std::string& block);

}  // namespace plc::tools

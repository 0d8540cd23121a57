#include "tools/command/trace_file.h"

#include <array>
#include <cinttypes>
#include <cstdio>
#include <utility>

#include "tools/file/atomic_file.h"

namespace plc::tools {

TraceFile::TraceFile(std::string path) : path_(std::move(path)) {
  if (path_.empty()) return;
  const AtomicFile probe(path_);
  text_ = "iteration,level,level_iteration,vertices,energy,speed,seconds,fraction\n";
}

void TraceFile::add(const plc_progress& p) {
  if (path_.empty() || p.iteration == 0) return;  // no iteration yet
  std::array<char, 200> line{};
  std::snprintf(line.data(), line.size(), "%d,%d,%d,%" PRId64 ",%.9g,%.9g,%.6f,%.6f\n",
                ++iteration_, p.level, p.iteration, p.vertices, p.energy, p.speed, p.seconds,
                p.fraction);
  text_ += line.data();
}

void TraceFile::commit() const {
  if (path_.empty()) return;
  AtomicFile file(path_);
  file.write(text_);
  file.commit();
}

}  // namespace plc::tools

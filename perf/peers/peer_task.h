// What a program for comparison is asked to do. Without options: bone of the head CT.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "perf/peers/peer.h"
#include "tools/file/failure.h"
#include "tools/mesh/mesh_io.h"

namespace peer {

// Options stand before or behind the volume and what else the program takes:
//   --iso V          value of the surface
//   --window L,H     values of the surroundings and of the object, beyond which nothing matters
//   --smooth         by peer_flying_edges: smoothed by a windowed sinc
//   -o FILE          the mesh, in LPS
struct Task {
  double iso = 226;
  float low = -105.5F, high = 1418.9F;  // the window that `pellicle extract` derives
  bool smooth = false;
  std::string mesh;
  std::vector<std::string> words;  // those that are no options: the volume, ...
};

inline double number_of(const std::string& name, const char* text, const char** end) {
  char* rest = nullptr;
  const double value = std::strtod(text, &rest);
  if (rest == text || !std::isfinite(value)) {
    throw plc::tools::Failure{name + ": a number is expected"};
  }
  *end = rest;
  return value;
}

// Throws Failure.
inline Task task_of(int argc, char** argv) {
  Task task;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--smooth") {
      task.smooth = true;
      continue;
    }
    if (word.rfind('-', 0) != 0) {
      task.words.push_back(word);
      continue;
    }
    if (i + 1 == argc) throw plc::tools::Failure{word + ": not known, or without its value"};
    const char* value = argv[++i];
    const char* end = "";
    if (word == "-o") {
      task.mesh = value;
    } else if (word == "--iso") {
      task.iso = number_of(word, value, &end);
    } else if (word == "--window") {
      task.low = static_cast<float>(number_of(word, value, &end));
      if (*end != ',') throw plc::tools::Failure{word + ": LOW,HIGH is expected"};
      task.high = static_cast<float>(number_of(word, end + 1, &end));
    } else {
      throw plc::tools::Failure{word + ": not known"};
    }
    if (*end != '\0') throw plc::tools::Failure{word + ": a number is expected"};
  }
  return task;
}

// Where the task wants it. xyz: voxel indices of the volume times its spacing.
inline void write_result(const Task& task, const Volume& volume, std::vector<double> xyz,
                         std::vector<uint32_t> abc) {
  if (task.mesh.empty()) return;
  for (size_t i = 0; i < xyz.size(); i += 3) {
    const double p[3] = {xyz[i], xyz[i + 1], xyz[i + 2]};
    for (size_t a = 0; a < 3; ++a) {
      const double* axes = volume.direction.data() + 3 * a;
      xyz[i + a] = volume.origin[a] + axes[0] * p[0] + axes[1] * p[1] + axes[2] * p[2];
    }
  }
  plc::tools::TriangleMesh mesh{std::move(xyz), std::move(abc), {}};
  mesh.doubles = true;
  plc::tools::write_mesh(task.mesh, mesh);
}

// A program's main(): `run` prints a JSON object. Exit code 2 where it was called wrongly, or the
// volume cannot be read.
inline int run_peer(int argc, char** argv,
                    const std::function<void(const Volume&, const Task&)>& run) {
  try {
    const Task task = task_of(argc, argv);
    if (task.words.empty()) throw plc::tools::Failure{"a volume is needed"};
    const Volume volume = read(task.words[0]);
    run(volume, task);
    return 0;
  } catch (const plc::tools::Failure& failure) {
    std::fprintf(stderr, "%s: %s\n", argv[0], failure.message.c_str());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", argv[0], e.what());
  }
  return 2;
}

}  // namespace peer

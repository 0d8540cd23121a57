// How time and memory of an iteration grow with the surface:
//   bench_growth VERTICES [THREADS [ITERATIONS]]
// A surface of about so many vertices in a potential that is computed (bench_potential.h), every
// vertex awake. Prints a JSON object: nanoseconds per vertex and iteration of the whole and of its
// parts - each the median, smallest and largest of the iterations -, what it would take on one
// thread to read and write in order as many bytes as the streams of a movement have, bytes per
// vertex and the hash of the surface at the end. Results do not depend on THREADS.
//
// Bytes are the most that the process held while it iterated, less what it held before there was a
// mesh. To see no memory that the making of the surface left behind, another process makes it.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "engine/recover/evolution.h"
#include "engine/resolve/refinement.h"
#include "engine/start/iso_surface.h"
#include "perf/bench_copy.h"
#include "perf/bench_potential.h"

namespace {

constexpr double kDelta = 1 / 1.2;    // voxels
constexpr double kStartCell = 2.7;    // the iso-surface of such a lattice has as many vertices
constexpr int kStartIterations = 25;  // until the edges are those of an evolution
// With the time step that the published results are of.
constexpr plc::Model kModel{.time_step = 1};

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "bench_growth: %s\n", what.c_str());
  std::exit(1);
}

void demand(const plc::Status& status) {
  if (!status.ok()) fail(status.message());
}

// A number of /proc/self/status, in bytes.
int64_t status_bytes(const char* name) {
  std::FILE* file = std::fopen("/proc/self/status", "r");
  if (file == nullptr) fail("no /proc/self/status");
  char line[256];
  long kib = -1;
  while (std::fgets(line, sizeof line, file) != nullptr) {
    if (std::strncmp(line, name, std::strlen(name)) == 0) {
      kib = std::strtol(line + std::strlen(name) + 1, nullptr, 10);
    }
  }
  std::fclose(file);
  if (kib < 0) fail(std::string("no ") + name + " in /proc/self/status");
  return int64_t{1024} * kib;
}

// VmHWM starts anew from what is held now.
void forget_peak() {
  const int file = open("/proc/self/clear_refs", O_WRONLY);
  if (file < 0 || write(file, "5", 1) != 1) fail("cannot reset the peak of memory");
  close(file);
}

// What crosses from the process that makes the surface.
struct Vertex {
  plc::Vec3 position, velocity, normal;
  uint32_t valence;
};

template <typename T>
void put(std::FILE* file, const T* values, size_t count) {
  if (std::fwrite(values, sizeof(T), count, file) != count) fail("cannot write a temporary file");
}

template <typename T>
void get(std::FILE* file, T* values, size_t count) {
  if (std::fread(values, sizeof(T), count, file) != count) fail("cannot read a temporary file");
}

void write_mesh(const plc::Mesh& mesh, std::FILE* file) {
  const uint32_t count = mesh.slots();
  put(file, &count, 1);
  for (uint32_t v = 0; v < count; ++v) {
    const Vertex vertex{mesh.at(v), mesh.velocity.at(v), mesh.normal.at(v), mesh.valence(v)};
    put(file, &vertex, 1);
    for (uint32_t k = 0; k < vertex.valence; ++k) {
      const uint32_t w = mesh.neighbor(v, k);
      put(file, &w, 1);
    }
  }
}

void read_mesh(std::FILE* file, plc::Mesh& mesh) {
  uint32_t count = 0;
  get(file, &count, 1);
  mesh.reserve(count + count / 32);  // what a renumbered mesh has
  for (uint32_t i = 0; i < count; ++i) {
    Vertex vertex;
    get(file, &vertex, 1);
    const uint32_t v = mesh.create(vertex.position, vertex.velocity);
    mesh.normal.set(v, vertex.normal);
    plc::Neighbors ring;
    for (uint32_t k = 0; k < vertex.valence; ++k) {
      uint32_t w = 0;
      get(file, &w, 1);
      ring.push_back(w);
    }
    mesh.set_ring(v, ring);
  }
  mesh.delta = kDelta;
}

void make_surface(const bench::Potential& potential, const plc::Guide& guide, int threads,
                  std::FILE* file) {
  const plc::Schedule schedule(threads);
  plc::Mesh mesh;
  mesh.delta = kDelta;
  const std::vector<float> lattice = potential.sample(kStartCell);
  demand(plc::iso_surface({potential.view(lattice, kStartCell), bench::Potential::kIso, true},
                          schedule, mesh));
  mesh.renumber(plc::morton_order(mesh));
  plc::Evolution evolution(mesh, schedule, kModel);
  evolution.restart();
  plc::Seconds seconds;
  plc::OperationCounts counts;
  for (int i = 0; i < kStartIterations; ++i) demand(evolution.iterate(guide, seconds, counts));
  mesh.renumber(plc::morton_order(mesh));
  write_mesh(mesh, file);
}

struct Sample {
  double total, topology, normals, dynamics;  // ns per vertex
};

void print_spread(const char* name, std::vector<Sample>& samples, double Sample::*part) {
  std::sort(samples.begin(), samples.end(),
            [part](const Sample& l, const Sample& r) { return l.*part < r.*part; });
  const auto value = [&](size_t i) { return samples[i].*part; };
  std::printf("\"%s\": {\"median\": %.2f, \"min\": %.2f, \"max\": %.2f}, ", name,
              value(samples.size() / 2), value(0), value(samples.size() - 1));
}

// What a movement reads and writes of the streams of dynamics.h and mesh.h, bytes per vertex: rings
// (8 columns, walked seven times), positions, Laplacians, normals, velocities, the sums of
// Runge-Kutta. Without voxels, and each record as if it were fetched once.
constexpr double kMovementBytes = 956;
constexpr double kMovementMemory = 200;  // bytes per vertex of those streams

// Nanoseconds per vertex for as many bytes in order, two read for one written: the memory's limit.
double stream_ns(uint32_t vertices) {
  const auto count = static_cast<size_t>(kMovementMemory / 3 / sizeof(float) * vertices);
  plc::Buffer<float> a(count), b(count), sum(count);
  double least = 1e300;
  for (int i = 0; i < 5; ++i) {
    const double start = plc::now();
    for (size_t k = 0; k < count; ++k) sum[k] = a[k] + b[k];
    asm volatile("" ::"r"(sum.data()) : "memory");  // it is wanted
    least = std::min(least, plc::now() - start);
  }
  const double seconds_per_byte = least / (3.0 * static_cast<double>(count) * sizeof(float));
  return 1e9 * seconds_per_byte * kMovementBytes;
}

void measure(const plc::Guide& guide, int threads, int iterations, std::FILE* file) {
  const int64_t before = status_bytes("VmRSS");
  const plc::Schedule schedule(threads);
  plc::Mesh mesh;
  read_mesh(file, mesh);
  const uint32_t vertices = mesh.vertex_count();
  plc::Evolution evolution(mesh, schedule, kModel);
  evolution.restart();
  std::vector<Sample> samples;
  int64_t peak = 0;
  for (int i = -1; i < iterations; ++i) {  // the first one makes the buffers
    for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.wake(v);
    forget_peak();
    plc::Seconds s;
    plc::OperationCounts counts;
    demand(evolution.iterate(guide, s, counts));
    peak = std::max(peak, status_bytes("VmHWM"));
    const double ns = 1e9 / mesh.vertex_count();
    if (i >= 0) {
      samples.push_back({s.total * ns, s.topology * ns, s.normals * ns, s.dynamics * ns});
    }
  }
  std::printf("{\"vertices\": %u, \"threads\": %d, ", vertices, threads);
  print_spread("total", samples, &Sample::total);
  print_spread("topology", samples, &Sample::topology);
  print_spread("normals", samples, &Sample::normals);
  print_spread("dynamics", samples, &Sample::dynamics);
  std::printf("\"stream\": %.2f, ", stream_ns(vertices));
  std::printf("\"bytes_per_vertex\": %.1f, \"mesh_bytes_per_vertex\": %.1f, ",
              static_cast<double>(peak - before) / vertices,
              static_cast<double>(mesh.bytes()) / vertices);
  std::printf("\"hash\": \"%016" PRIx64 "\"}\n", bench::hash_of(mesh));
}

}  // namespace

int main(int argc, char** argv) {
  const int64_t vertices = argc > 1 ? std::atoll(argv[1]) : 0;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  const int threads = argc > 2 ? std::atoi(argv[2]) : cores;
  const int iterations = argc > 3 ? std::atoi(argv[3]) : 5;
  if (vertices < 1000 || vertices > 100'000'000 || threads < 1 || iterations < 1) {
    std::fprintf(stderr, "bench_growth: VERTICES (1000 .. 100000000) [THREADS [ITERATIONS]]\n");
    return 2;
  }
  const bench::Potential potential(vertices);
  const std::vector<float> image = potential.sample(1);
  plc::Guide guide;
  guide.image = potential.view(image, 1);
  guide.iso = bench::Potential::kIso;

  std::FILE* file = std::tmpfile();
  if (file == nullptr) fail("no temporary file");
  // Before there are threads, which would not be in the other process.
  const pid_t maker = fork();
  if (maker < 0) fail("no second process");
  if (maker == 0) {
    make_surface(potential, guide, cores, file);
    std::fflush(file);
    std::_Exit(0);
  }
  int status = 0;
  if (waitpid(maker, &status, 0) != maker || status != 0) fail("no surface was made");
  std::rewind(file);
  measure(guide, threads, iterations, file);
  std::fclose(file);
  return 0;
}

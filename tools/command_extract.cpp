#include "tools/command_extract.h"

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include "tools/command_check.h"
#include "tools/engine_handles.h"
#include "tools/interrupt.h"
#include "tools/mesh_io.h"
#include "tools/progress_line.h"
#include "tools/report.h"
#include "tools/volume_io.h"

namespace plc::tools {

namespace {

constexpr int kExitInvalid = 1;

double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

struct Watch {
  ProgressLine& line;
  const InterruptGuard& interrupt;
};

int on_progress(const plc_progress* progress, void* user) {
  auto& watch = *static_cast<Watch*>(user);
  watch.line.update(*progress);
  return watch.interrupt.interrupted() ? 1 : 0;
}

TriangleMesh mesh_of(const plc_surface* surface, plc_space space) {
  TriangleMesh mesh;
  const auto vertices = static_cast<size_t>(plc_surface_vertex_count(surface));
  std::vector<float> xyz(3 * vertices);
  plc_surface_positions(surface, space, xyz.data());
  mesh.xyz.assign(xyz.begin(), xyz.end());
  mesh.abc.resize(3 * static_cast<size_t>(plc_surface_face_count(surface)));
  plc_surface_faces(surface, space, mesh.abc.data());
  mesh.normals.resize(3 * vertices);
  plc_surface_normals(surface, space, mesh.normals.data());
  return mesh;
}

// NULL where it was cancelled.
SurfaceHandle evolve(plc_context* context, const plc_image& image, const ExtractOptions& options,
                     const InterruptGuard& interrupt) {
  ProgressLine line(options.quiet);
  Watch watch{line, interrupt};
  plc_extras extras;
  plc_extras_defaults(&extras);
  extras.progress = on_progress;
  extras.progress_user = &watch;
  plc_surface* surface = nullptr;
  const plc_status status = plc_extract(context, &image, &options.parameters, &extras, &surface);
  if (status == PLC_CANCELLED) return nullptr;
  if (status != PLC_OK) throw failure_of(context, status);
  return SurfaceHandle(surface);
}

plc_measures measures_of(plc_context* context, const plc_surface* surface) {
  plc_measures measures{};
  measures.struct_size = sizeof measures;
  const plc_status status = plc_surface_measure(context, surface, PLC_SPACE_LPS, &measures);
  if (status != PLC_OK) throw failure_of(context, status);
  return measures;
}

// Before the long run rather than after it.
void check_paths(const ExtractOptions& options) {
  check_mesh_path(options.output);
  if (options.report.empty()) return;
  if (options.report == options.output) {
    throw Failure{options.report + ": is to be both the mesh and the report"};
  }
  check_report_path(options.report);
}

}  // namespace

int run_extract(const ExtractOptions& options) {
  const double start = now();
  InterruptGuard interrupt;
  check_paths(options);
  interrupt.end_at_once();
  const ContextHandle context = make_context(options.context);
  const LoadedVolume volume = read_volume(options.input);
  Timings timings;
  timings.read = now() - start;

  interrupt.note_first();
  const SurfaceHandle surface = evolve(context.get(), volume.image, options, interrupt);
  if (surface == nullptr || interrupt.interrupted()) {
    std::fputs("pellicle: interrupted\n", stderr);
    return kExitInterrupted;
  }
  if (plc_surface_face_count(surface.get()) == 0) {
    throw Failure{"no surface is left: at this iso the object is smaller than the mesh resolves"};
  }

  // What is written from here on is whole; a signal waits for it.
  interrupt.only_note();
  const double written = now();
  const plc_measures measures = measures_of(context.get(), surface.get());
  const TriangleMesh mesh = mesh_of(surface.get(), options.space);
  // The engine's promise is about its own mesh space; this one is rounded to another.
  const plc_check check = check_of(context.get(), mesh);
  write_mesh(options.output, mesh);
  timings.write = now() - written;
  timings.total = now() - start;
  if (!options.report.empty()) {
    write_report(options.report, make_report(context.get(), volume.image, surface.get(), measures,
                                             timings, options.space));
  }
  if (!options.quiet) {
    std::fputs(summary(volume.image, surface.get(), measures, timings, options.output).c_str(),
               stdout);
  }
  if (check.valid == 0) {
    std::fprintf(stderr, "pellicle: %s: written, but not valid as `pellicle check` tells\n",
                 options.output.c_str());
    return kExitInvalid;
  }
  return 0;
}

}  // namespace plc::tools

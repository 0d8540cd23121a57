#include "tools/command/command_extract.h"

#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/command/clock.h"
#include "tools/command/command_labels.h"
#include "tools/command/engine_handles.h"
#include "tools/command/extract_inputs.h"
#include "tools/command/extract_job.h"
#include "tools/command/extract_volume.h"
#include "tools/command/kept_surface.h"
#include "tools/command/mesh_precision.h"
#include "tools/command/progress_line.h"
#include "tools/command/report.h"
#include "tools/command/surface_mesh.h"
#include "tools/command/trace_file.h"
#include "tools/file/failure.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

namespace {

struct Watch {
  ProgressLine& line;
  TraceFile& trace;
  const InterruptGuard& interrupt;
};

int on_progress(const plc_progress* progress, void* user) {
  auto& watch = *static_cast<Watch*>(user);
  watch.line.update(*progress);
  watch.trace.add(*progress);
  return watch.interrupt.interrupted() ? 1 : 0;
}

// What the surface will cost, where that is out of proportion. How levels end the summary says.
void on_log(plc_log_level level, const char* line, void*) {
  if (level != PLC_LOG_WARNING || std::strncmp(line, "expected: ", 10) != 0) return;
  std::fprintf(stderr, "pellicle: %s\n", line);
}

// The files of --each-level: a callback must not throw through the engine, so it keeps the failure.
struct LevelFiles {
  plc_context* context;
  const std::string& output;
  const ExtractOptions& options;
  std::optional<Failure> failure;
};

plc_verdict on_level(const plc_level_report* level, const plc_surface* surface, void* user) {
  auto& files = *static_cast<LevelFiles*>(user);
  try {
    const std::string path = named(files.output, "level" + std::to_string(level->level));
    TriangleMesh mesh = placed_mesh(files.context, surface, files.options);
    settle_surface(files.context, mesh, files.options.space, path);
    write_mesh(path, mesh);
  } catch (const Failure& failure) {
    files.failure = failure;
    return PLC_VERDICT_STOP;
  }
  return PLC_VERDICT_ACCEPT;
}

// NULL where it was cancelled.
SurfaceHandle evolve(plc_context* context, ExtractVolume& volume, const ExtractJob& job,
                     const ExtractInputs& inputs, const ExtractOptions& options, ProgressLine& line,
                     TraceFile& trace, const InterruptGuard& interrupt) {
  Watch watch{line, trace, interrupt};
  plc_extras extras = inputs.extras();
  extras.progress = on_progress;
  extras.progress_user = &watch;
  LevelFiles files{context, job.output, options, std::nullopt};
  if (options.each_level) {
    extras.level = on_level;
    extras.level_user = &files;
  }
  plc_surface* surface = nullptr;
  const plc_status status = volume.extract(context, job.parameters, extras, line, &surface);
  if (status == PLC_CANCELLED) return nullptr;
  if (status != PLC_OK) throw failure_of(context);
  SurfaceHandle result(surface);
  if (files.failure) throw *files.failure;
  return result;
}

// Before the long run rather than after it.
void check_paths(const std::vector<ExtractJob>& jobs) {
  for (const ExtractJob& job : jobs) {
    check_mesh_path(job.output);
    if (!job.report.empty()) check_report_path(job.report);
  }
}

class Extraction {
 public:
  Extraction(const ExtractOptions& options, InterruptGuard& interrupt)
      : options_(options), interrupt_(interrupt), jobs_(jobs_of(options)) {
    check_paths(jobs_);
    for (const ExtractJob& job : jobs_) traces_.emplace_back(job.trace);
    interrupt.end_at_once();
    volume_.emplace(options);
    inputs_.emplace(options, volume_->whole());
    for (ExtractJob& job : jobs_) resolve(job, volume_->voxels());
    context_ = make_context(context_options());  // from here on there are threads
    read_ = now() - start_;
  }

  // The exit code.
  int run() {
    for (size_t i = 0; i < jobs_.size(); ++i) {
      if (const int code = run(i); code != 0) return code;
    }
    return 0;
  }

 private:
  // What the machine has not is refused in a line, before the system ends the process without one.
  plc_context_options context_options() const {
    plc_context_options context = options_.context;
    context.memory_limit = memory_limit(options_, volume_->held() + inputs_->held());
    if (options_.progress != Progress::kNone) context.log = on_log;
    return context;
  }

  int run(size_t index) {
    ExtractJob job = jobs_[index];
    start_text_.clear();
    if (job.follows) follow(index, job);
    interrupt_.note_first();
    ProgressLine line(options_.progress);
    surface_ =
        evolve(context_.get(), *volume_, job, *inputs_, options_, line, traces_[index], interrupt_);
    line.clear();
    if (surface_ == nullptr || interrupt_.interrupted()) return interrupt_.tell();
    if (plc_surface_face_count(surface_.get()) == 0) {
      throw Failure{"no surface is left: at this iso the object is smaller than the mesh resolves"};
    }
    write(job, traces_[index]);
    line.done();
    return 0;
  }

  // Figure 24: from the last surface, on the full image, where that is nearer.
  void follow(size_t index, ExtractJob& job) {
    plc_parameters& p = job.parameters;
    const ExtractJob& before = jobs_[index - 1];
    const double last = before.parameters.iso;
    if (!nearer(volume_->voxels(), last, p.iso, p.inside_below != 0)) return;
    TriangleMesh start = mesh_of(context_.get(), surface_.get(), options_.space);
    settle_precision(context_.get(), start);  // as that of the file is
    inputs_->start_from(std::move(start));
    p.init = PLC_INIT_MESH;
    p.levels = 0;
    p.level_iso_count = 0;
    // It starts from all of it, of which --keep has left less in the file.
    start_text_ = options_.keep.text.empty() ? "mesh=" + before.output
                                             : "surface of " + text_of(last) + " before --keep";
  }

  // What the image has told, and what has been left out.
  void add_choices(nlohmann::ordered_json& report, const ExtractJob& job,
                   const KeptSurface& result) const {
    if (!start_text_.empty()) report["parameters"]["init"] = start_text_;
    if (!job.iso.text.empty() && !job.iso.is_number()) report["iso_from"] = job.iso.text;
    if (result.bodies > 0) {
      report["keep"] = {
          {"asked", options_.keep.text}, {"kept", result.kept}, {"of", result.bodies}};
    }
    if (const auto counts = volume_->brick_counts(context_.get())) {
      report["bricks"] = {
          {"count", counts->bricks}, {"read", counts->read}, {"read_again", counts->read_again}};
    }
    if (!options_.box) return;
    const VoxelBox& box = *options_.box;
    report["input"]["box"] = {box.low[0],  box.high[0], box.low[1],
                              box.high[1], box.low[2],  box.high[2]};
    if (options_.space != PLC_SPACE_VOXEL) return;
    for (auto& site : report["sites"]) {
      for (size_t k = 0; k < 3; ++k) {
        site["place"][k] = site["place"][k].get<double>() + static_cast<double>(box.low[k]);
      }
    }
  }

  // What is written from here on is whole; a signal waits for it.
  void write(const ExtractJob& job, const TraceFile& trace) {
    interrupt_.only_note();
    const double written = now();
    KeptSurface result = kept_surface(context_.get(), surface_.get(), options_);
    const plc_measures& measures = result.measures;
    TriangleMesh& mesh = result.mesh;
    // The engine's promise is about its own mesh space; this one is rounded to another.
    settle_surface(context_.get(), mesh, options_.space, job.output);
    doubles_ = mesh.doubles;
    write_mesh(job.output, mesh);
    trace.commit();
    const Timings timings{read_, now() - written, now() - start_};
    if (!job.report.empty()) {
      auto report = make_report(context_.get(), volume_->image(), surface_.get(), measures, timings,
                                options_);
      report["coordinates"] = precision_text(doubles_);
      add_choices(report, job, result);
      write_report(job.report, report);
    }
    if (options_.progress != Progress::kNone) {
      if (!job.iso.text.empty() && !job.iso.is_number()) {
        std::printf("iso      %.6g (%s)\n", job.parameters.iso, job.iso.text.c_str());
      }
      if (const auto counts = volume_->brick_counts(context_.get())) {
        std::printf("bricks   %" PRId64 " of the image, %" PRId64 " read, %" PRId64
                    " of them again\n",
                    counts->bricks, counts->read, counts->read_again);
      }
      if (result.bodies > 0) {
        std::printf("kept     %zu of %zu bodies\n", result.kept, result.bodies);
      }
      std::fputs(
          summary(context_.get(), volume_->image(), surface_.get(), measures, timings, job.output)
              .c_str(),
          stdout);
      std::fflush(stdout);
    }
    for (const std::string& line :
         unfinished_levels(context_.get(), surface_.get(), job.parameters.max_iterations)) {
      std::fprintf(stderr, "pellicle: %s\n", line.c_str());
    }
    tell_precision(doubles_, job.output);
  }

  const ExtractOptions& options_;
  InterruptGuard& interrupt_;
  double start_ = now();
  double read_ = 0;
  std::vector<ExtractJob> jobs_;
  std::vector<TraceFile> traces_;
  ContextHandle context_;
  std::optional<ExtractVolume> volume_;
  std::optional<ExtractInputs> inputs_;
  SurfaceHandle surface_;   // the last one
  std::string start_text_;  // what it follows, as the report tells it; "": what --init says
  bool doubles_ = false;    // it was written in
};

}  // namespace

int run_extract(const ExtractOptions& options, InterruptGuard& interrupt) {
  if (!options.labels.empty()) return run_labels(options, interrupt);
  return Extraction(options, interrupt).run();
}

}  // namespace plc::tools

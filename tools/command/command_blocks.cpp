#include "tools/command/command_blocks.h"

#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/blocks/block_check.h"
#include "tools/blocks/block_plan.h"
#include "tools/blocks/block_task.h"
#include "tools/cohort/cohort_progress.h"
#include "tools/command/block_jobs.h"
#include "tools/command/engine_handles.h"
#include "tools/command/extract_volume.h"
#include "tools/command/mesh_precision.h"
#include "tools/command/plan_blocks.h"
#include "tools/file/failure.h"
#include "tools/mesh/mesh_io.h"
#include "tools/volume/mesh_spaces.h"

namespace plc::tools {

namespace {

// ---- run -----------------------------------------------------------------------------------

// The image of a plan: by bricks where it can be read so.
class BlockVolume {
 public:
  explicit BlockVolume(const BlockPlan& plan) : source_(open_bricks(plan.input)) {
    if (source_ == nullptr) loaded_ = read_volume_apart(plan.input, NiftiFrame::kAuto);
    const plc_image& image = source_ ? source_->image() : loaded_.image;
    if (image.type != plan.image.type || !std::equal(image.dims, image.dims + 3, plan.image.dims) ||
        !std::equal(image.spacing, image.spacing + 3, plan.image.spacing)) {
      throw Failure{plan.input + ": is not the image that was planned with"};
    }
  }

  size_t held() const { return loaded_.bytes.size(); }

  // The context must outlive this.
  const plc_volume* open(plc_context* context, const BlockPlan& plan) {
    if (source_ != nullptr) {
      fetch_.source = source_.get();
      volume_ = volume_of(context, fetch_, plan.low, plan.high);
    } else {
      plc_volume* made = nullptr;
      demand(context, plc_volume_create(context, &loaded_.image, PLC_BORROW, &made));
      volume_.reset(made);
    }
    return volume_.get();
  }

  int64_t bricks_read(plc_context* context) const {
    if (source_ == nullptr) return 0;
    plc_brick_counts counts;
    plc_brick_counts_defaults(&counts);
    demand(context, plc_volume_brick_counts(context, volume_.get(), &counts));
    return counts.read;
  }

 private:
  std::unique_ptr<BrickSource> source_;
  LoadedVolume loaded_;
  BrickFetch fetch_;
  VolumeHandle volume_;
};

// The blocks of a step that this share is to do.
std::vector<int64_t> share_of(const BlockOptions& options, const BlockPlan& plan, int step) {
  const std::vector<int64_t> all = plan.grid.blocks_of_colour(step % BlockGrid::kColours);
  std::vector<int64_t> own;
  for (size_t i = 0; i < all.size(); ++i) {
    if (static_cast<int>(i % static_cast<size_t>(options.parts)) + 1 == options.part) {
      own.push_back(all[i]);
    }
  }
  return own;
}

int run_tasks(const BlockOptions& options, InterruptGuard& interrupt) {
  const BlockPlan plan = read_plan(options.folder);
  if (options.step && *options.step >= plan.steps()) {
    throw Failure{"--step " + std::to_string(*options.step) + ": the plan has " +
                  std::to_string(plan.steps()) + ", from 0"};
  }
  if (options.parts > 1 && !options.step) {
    throw Failure{"--task: of a step, which --step tells: steps wait for each other"};
  }
  if (options.serve && (options.step || options.parts > 1)) {
    throw Failure{"--serve: does what stdin names, without --step and --task"};
  }
  interrupt.end_at_once();
  BlockVolume volume(plan);
  ExtractOptions limits;
  limits.memory = options.memory;
  plc_context_options context_options;
  plc_context_options_defaults(&context_options);
  context_options.threads = options.threads;
  context_options.memory_limit = memory_limit(limits, volume.held());
  const ContextHandle context = make_context(context_options);
  BlockTasks tasks(options.folder, plan, context.get(), volume.open(context.get(), plan));
  if (options.serve) return serve_tasks(tasks, interrupt);
  std::vector<std::pair<int, int64_t>> left;
  for (int step = options.step.value_or(0);
       step < (options.step ? *options.step + 1 : plan.steps()); ++step) {
    for (const int64_t block : share_of(options, plan, step)) {
      if (!tasks.done(step, block)) left.emplace_back(step, block);
    }
  }
  interrupt.note_first();
  CohortProgress progress("tasks done, ", left.size(), options.quiet);
  size_t done = 0, restless = 0;
  for (const auto& [step, block] : left) {
    TaskRecord record;
    if (!tasks.run(
            step, block, [&] { return interrupt.interrupted(); }, record)) {
      return interrupt.tell();
    }
    restless += record.converged ? 0 : 1;
    progress.update(++done, "level " + std::to_string(plan.level_of(step)) + ", block " +
                                BlockGrid::name_of(plan.grid.block_at(block)));
    if (interrupt.interrupted()) return interrupt.tell();
  }
  if (!options.quiet) {
    std::printf("done     %zu tasks in %.1f s, %zu of them not converged, %" PRId64
                " bricks read\n",
                done, progress.seconds(), restless, volume.bricks_read(context.get()));
  }
  return 0;
}

// ---- check ---------------------------------------------------------------------------------

int run_check(const BlockOptions& options, InterruptGuard& interrupt) {
  const BlockPlan plan = read_plan(options.folder);
  interrupt.end_at_once();
  plc_context_options context_options;
  plc_context_options_defaults(&context_options);
  const ContextHandle context = make_context(context_options);
  BlockCheck check;
  {
    CohortProgress progress("blocks checked", static_cast<size_t>(plan.grid.block_count()),
                            options.quiet);
    check = check_blocks(options.folder, plan, plan.steps(), context.get(),
                         [&](int64_t done) { progress.update(static_cast<size_t>(done), ""); });
  }
  const nlohmann::ordered_json json = {{"valid", check.valid()},
                                       {"hash", hash_of_blocks(options.folder, plan)},
                                       {"vertices", check.vertices},
                                       {"faces", check.faces},
                                       {"components", check.components},
                                       {"inward_components", check.inward},
                                       {"euler", check.euler},
                                       {"genus", check.genus},
                                       {"area_voxels", check.area},
                                       {"volume_voxels", check.volume},
                                       {"edge_min_voxels", check.edge_min},
                                       {"edge_max_voxels", check.edge_max},
                                       {"open_vertices", check.open_vertices},
                                       {"degenerate_faces", check.degenerate_faces},
                                       {"self_intersections", check.self_intersections},
                                       {"stray_faces", check.stray_faces}};
  if (options.json) {
    std::puts(json.dump(2).c_str());
  } else {
    for (const auto& [key, value] : json.items()) {
      std::string name = key;
      std::replace(name.begin(), name.end(), '_', ' ');
      std::printf("%-29s %s\n", name.c_str(),
                  value.is_boolean()  ? value.get<bool>() ? "yes" : "no"
                  : value.is_string() ? value.get<std::string>().c_str()
                                      : value.dump().c_str());
    }
  }
  return check.valid() ? 0 : 1;
}

// ---- mesh ----------------------------------------------------------------------------------

std::vector<Int3> all_cells(const BlockGrid& grid) {
  const Int3& n = grid.blocks();
  return grid.cells_of({{0, 0, 0}, {3 * n[0] - 1, 3 * n[1] - 1, 3 * n[2] - 1}});
}

int run_mesh(const BlockOptions& options) {
  check_mesh_path(options.mesh);
  const BlockPlan plan = read_plan(options.folder);
  const BlockMesh whole =
      joined(cells_before(options.folder, plan, plan.steps(), all_cells(plan.grid)), "blocks");
  TriangleMesh mesh;
  mesh.xyz = whole.xyz;
  mesh.abc = whole.abc;
  mesh.space = space_name(PLC_SPACE_VOXEL);
  bring_to(mesh, options.space, options.space, &plan.image, options.mesh);
  plc_context_options context_options;
  plc_context_options_defaults(&context_options);
  const ContextHandle context = make_context(context_options);
  settle_surface(context.get(), mesh, options.space, options.mesh);
  write_mesh(options.mesh, mesh);
  std::printf("written  %s, %zu vertices, %zu faces\n", options.mesh.c_str(), whole.vertex_count(),
              whole.face_count());
  return 0;
}

// ---- precomputed ---------------------------------------------------------------------------

int run_precomputed(BlockOptions& options) {
  const BlockPlan plan = read_plan(options.folder);
  std::optional<CohortProgress> progress;
  options.precomputed.progress = [&](size_t done, size_t all) {
    if (!progress) progress.emplace("boxes written", all, options.quiet);
    progress->update(done, "");
  };
  const PrecomputedRecord record = write_precomputed(options.folder, plan, options.precomputed);
  progress.reset();
  for (size_t lod = 0; lod < record.lods.size() && !options.quiet; ++lod) {
    const PrecomputedRecord::Lod& l = record.lods[lod];
    std::printf("lod %-4zu %" PRId64 " chunks of %g voxels, %" PRId64 " faces, %" PRId64 " bytes\n",
                lod, l.fragments, l.chunk, l.faces, l.bytes);
  }
  return 0;
}

void add_run(CLI::App& app, BlockOptions& options) {
  add_block_folder(app, options.folder);
  const auto text = [&](const std::string& name, const std::string& type,
                        const std::string& fallback, const std::string& meaning, auto read) {
    app.add_option_function<std::string>(name, read, meaning)
        ->type_name(type)
        ->default_str(fallback);
  };
  text("--step", "S", "all, one after the other",
       "The tasks of one step, of which every one can run at the same time as the others; all "
       "steps before it must be done",
       [&o = options](const std::string& s) { o.step = at_least(0, "--step", s); });
  text("--task", "I/N", "1/1", "The I-th of N shares of the step, I from 1",
       [&o = options](const std::string& s) { to_share("--task", s, o.part, o.parts); });
  text("--threads", "N", "all", "Threads",
       [&o = options](const std::string& s) { o.threads = at_least(1, "--threads", s); });
  text("--memory", "SIZE", "what is left", "Memory of the process, as in 4G",
       [&o = options](const std::string& s) { o.memory = to_bytes("--memory", s); });
  app.add_flag(
      "--serve", options.serve,
      "Tasks that stdin names, a line STEP BLOCK each, until it ends: each is answered by a "
      "line of JSON, for schedulers that keep a process for many tasks");
  app.add_flag("--quiet", options.quiet, "No progress and no summary");
}

void add_precomputed(CLI::App& app, BlockOptions& options) {
  add_block_folder(app, options.folder);
  PrecomputedOptions& to = options.precomputed;
  app.add_option("-o,--output", to.output, "Folder of the meshes; made where it is not there")
      ->required()
      ->type_name("FOLDER");
  app.add_option_function<std::string>(
         "--lods", [&to](const std::string& s) { to.lods = at_least(1, "--lods", s); },
         "Levels of detail")
      ->type_name("N")
      ->default_str("until one chunk holds everything");
  app.add_option_function<std::string>(
         "--segment",
         [&to](const std::string& s) {
           const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), to.segment);
           if (error != std::errc() || end != s.data() + s.size() || to.segment == 0) {
             refuse_value("--segment", s, "a number of 1 to 2^64 - 1");
           }
         },
         "Its number in neuroglancer")
      ->type_name("ID")
      ->default_str("1");
  app.add_flag("--quiet", options.quiet, "No progress and no summary");
}

}  // namespace

void add_block_options(CLI::App& command, BlockOptions& options) {
  command.require_subcommand(1);
  add_block_plan(
      *command.add_subcommand("plan", "Do the coarse levels, and plan the tasks of the rest"),
      options);
  add_run(*command.add_subcommand("run", "Do the tasks that are left, or a share of them"),
          options);
  CLI::App* check =
      command.add_subcommand("check", "Prove, block by block, that all are one valid surface");
  add_block_folder(*check, options.folder);
  check->add_flag("--json", options.json, "JSON instead of a table");
  check->add_flag("--quiet", options.quiet, "No progress");
  add_block_status(
      *command.add_subcommand("status", "Tell which tasks are done, and when the rest is"),
      options);
  add_block_submit(
      *command.add_subcommand("submit", "Run what is left as job arrays of Slurm, one a step"),
      options);
  CLI::App* mesh = command.add_subcommand("mesh", "Write the surface of all blocks as one mesh");
  add_block_folder(*mesh, options.folder);
  mesh->add_option("-o,--output", options.mesh, mesh_suffixes(MeshUse::kWritten))
      ->required()
      ->type_name("FILE");
  mesh->add_option_function<std::string>(
          "--space",
          [&options](const std::string& s) { options.space = to_choice("--space", s, kSpaces); },
          "Of the coordinates")
      ->type_name("lps|ras|voxel")
      ->default_str("lps");
  add_precomputed(*command.add_subcommand("precomputed", "Write the surface for neuroglancer"),
                  options);
}

int run_block_command(const CLI::App& command, BlockOptions& options, InterruptGuard& interrupt) {
  const std::string& name = command.get_subcommands()[0]->get_name();
  if (name == "plan") return run_block_plan(options, interrupt);
  if (name == "run") return run_tasks(options, interrupt);
  if (name == "check") return run_check(options, interrupt);
  if (name == "status") return run_block_status(options);
  if (name == "submit") return run_block_submit(options);
  if (name == "precomputed") return run_precomputed(options);
  return run_mesh(options);
}

}  // namespace plc::tools

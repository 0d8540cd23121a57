#include "tools/command/plan_blocks.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <set>
#include <vector>

#include "tools/blocks/block_plan.h"
#include "tools/blocks/block_sides.h"
#include "tools/blocks/block_task.h"
#include "tools/command/clock.h"
#include "tools/command/engine_handles.h"
#include "tools/command/extract_inputs.h"
#include "tools/command/extract_job.h"
#include "tools/command/extract_volume.h"
#include "tools/command/progress_line.h"
#include "tools/command/surface_mesh.h"
#include "tools/file/failure.h"
#include "tools/file/folder.h"

namespace plc::tools {

namespace {

namespace fs = std::filesystem;

struct CoarseWatch {
  ProgressLine& line;
  const InterruptGuard& interrupt;
  int until;  // the last level that is done whole
};

int on_progress(const plc_progress* progress, void* user) {
  auto& watch = *static_cast<CoarseWatch*>(user);
  watch.line.update(*progress);
  return watch.interrupt.interrupted() ? 1 : 0;
}

plc_verdict on_level(const plc_level_report* level, const plc_surface* /*surface*/, void* user) {
  const auto& watch = *static_cast<const CoarseWatch*>(user);
  return level->level <= watch.until ? PLC_VERDICT_STOP : PLC_VERDICT_ACCEPT;
}

void check_plan(const BlockOptions& options) {
  const plc_parameters& p = options.extract.parameters;
  const auto refuse = [](const std::string& why) { throw Failure{"blocks: " + why}; };
  if (options.from_level < 0 || options.from_level >= kMostBlockLevels) {
    refuse("--from-level must be 0 to " + std::to_string(kMostBlockLevels - 1));
  }
  if (p.levels >= 0 && p.levels <= options.from_level) {
    refuse("--from-level " + std::to_string(options.from_level) + ": must be below --levels " +
           std::to_string(p.levels) + ", as the levels above it are done whole");
  }
  if (p.force != PLC_FORCE_ISO) refuse("only --force iso can be done by blocks");
  if (options.extract.isos.size() != 1) refuse("one --iso must be given");
}

// Before the coarse levels are done.
int64_t checked_margin(const BlockOptions& options, const plc_image& image) {
  const int64_t margin =
      margin_of(BlockPlan::band_of(options.extract.parameters, image, options.from_level));
  if (options.side >= int64_t{1} << 31U) {
    throw Failure{"blocks: --side " + std::to_string(options.side) + ": must be below 2^31"};
  }
  if (options.side >= 4 * margin) {
    const BlockGrid grid({image.dims[0], image.dims[1], image.dims[2]}, options.side, margin);
    if (!too_many_blocks(grid)) return margin;
    throw Failure{"blocks: more than 2^24 of them, use larger ones"};
  }
  throw Failure{
      "blocks: --side " + std::to_string(options.side) + ": must be " + std::to_string(4 * margin) +
      " or more for edges as long as these and --from-level " + std::to_string(options.from_level)};
}

BlockPlan plan_of(const BlockOptions& options, plc_context* context, const plc_image& image,
                  int64_t margin, const plc_surface* surface) {
  BlockPlan plan;
  plan.version = plc_version_string();
  plan.input = fs::absolute(options.extract.input).lexically_normal().string();
  plan.image = image;
  plan.from_level = options.from_level;
  plan.grid = BlockGrid({image.dims[0], image.dims[1], image.dims[2]}, options.side, margin);
  plc_parameters_defaults(&plan.parameters);
  demand(context, plc_surface_parameters(context, surface, &plan.parameters));
  demand(context, plc_surface_input_range(context, surface, &plan.low, &plan.high));
  char hash[24];
  std::snprintf(hash, sizeof hash, "%016" PRIx64, plc_surface_hash(surface));
  plan.hash = hash;
  return plan;
}

}  // namespace

void add_block_plan(CLI::App& app, BlockOptions& options) {
  add_extract_options(app, options.extract);
  static const std::set<std::string> other = {
      "output",          "space",     "nifti-frame", "report",  "trace",    "each-level",
      "slicer-progress", "box",       "keep",        "feature", "sigma",    "init",
      "attach",          "structure", "force",       "labels",  "gradient", "gradient-tangent",
      "gradient-bound"};
  std::vector<CLI::Option*> gone;
  for (CLI::Option* option : app.get_options()) {
    if (!option->get_lnames().empty() && other.contains(option->get_lnames()[0])) {
      gone.push_back(option);
    }
  }
  for (CLI::Option* option : gone) app.remove_option(option);
  options.extract.output = "surface.ply";
  app.add_option("-o,--output", options.folder, "Folder of the plan; made where it is not there")
      ->required()
      ->type_name("DIR")
      ->group("Blocks");
  app.add_option("--side", options.side, "Voxels of a block on each axis")
      ->type_name("N")
      ->default_str("512")
      ->group("Blocks");
  app.add_option("--from-level", options.from_level,
                 "The coarsest level that is done by blocks; those above it are done by plan")
      ->type_name("H")
      ->default_str("1")
      ->group("Blocks");
}

int run_block_plan(BlockOptions& options, InterruptGuard& interrupt) {
  check_plan(options);
  // The longer edges may be, the larger blocks must be.
  plc_parameters& p = options.extract.parameters;
  if (p.mesh == PLC_MESH_AUTO) p.mesh = PLC_MESH_UNIFORM;
  p.init = PLC_INIT_BUBBLE;  // the levels above the blocks are done by plan
  const double start = now();
  interrupt.end_at_once();
  ExtractVolume volume(options.extract);
  const int64_t margin = checked_margin(options, volume.image());
  ExtractJob job = jobs_of(options.extract)[0];
  resolve(job, volume.voxels());
  plc_context_options context_options = options.extract.context;
  context_options.memory_limit = memory_limit(options.extract, volume.held());
  const ContextHandle context = make_context(context_options);
  const ExtractInputs inputs(options.extract, volume.whole());
  ProgressLine line(options.extract.progress);
  CoarseWatch watch{line, interrupt, options.from_level + 1};
  plc_extras extras = inputs.extras();
  extras.progress = on_progress;
  extras.progress_user = &watch;
  extras.level = on_level;
  extras.level_user = &watch;
  interrupt.note_first();
  plc_surface* made = nullptr;
  const plc_status status = volume.extract(context.get(), job.parameters, extras, line, &made);
  if (status == PLC_CANCELLED) return interrupt.tell();
  demand(context.get(), status);
  const SurfaceHandle surface(made);
  line.clear();
  if (plc_surface_level_count(surface.get()) == 0 || plc_surface_face_count(surface.get()) == 0) {
    throw Failure{"blocks: the coarse levels hold no surface"};
  }
  plc_level_report last;
  plc_level_report_defaults(&last);
  demand(context.get(), plc_surface_level(context.get(), surface.get(),
                                          plc_surface_level_count(surface.get()) - 1, &last));
  if (last.level <= options.from_level) {
    throw Failure{"blocks: nothing that holds a surface shows above level " +
                  std::to_string(last.level) +
                  (last.level > 0 ? "; use --from-level " + std::to_string(last.level - 1)
                                  : std::string(": it can only be extracted whole"))};
  }
  BlockPlan plan = plan_of(options, context.get(), volume.image(), margin, surface.get());
  if (plan.parameters.levels <= plan.from_level) {
    throw Failure{"blocks: --from-level " + std::to_string(plan.from_level) +
                  ": the image has no more than " + std::to_string(plan.parameters.levels) +
                  " levels above it"};
  }
  const TriangleMesh mesh = mesh_of(context.get(), surface.get(), PLC_SPACE_VOXEL);
  plan.start_vertices = static_cast<int64_t>(mesh.xyz.size() / 3);
  plan.start_faces = static_cast<int64_t>(mesh.abc.size() / 3);
  plan.inside = blocks_inside(plan.grid, mesh.xyz, mesh.abc);
  interrupt.only_note();
  make_folder(options.folder + "/start");
  if (fs::exists(options.folder + "/plan.json")) {
    const BlockPlan before = read_plan(options.folder);
    if (before.hash != plan.hash || before.input != plan.input ||
        before.grid.side() != plan.grid.side() || before.from_level != plan.from_level) {
      throw Failure{options.folder + ": has another plan already"};
    }
  }
  for (int step = 0; step < plan.steps(); step += BlockGrid::kColours) {
    make_folder(options.folder + "/level" + std::to_string(plan.level_of(step)));
  }
  write_start(options.folder, plan, mesh.xyz, mesh.abc);
  write_plan(options.folder, plan);
  if (options.extract.progress != Progress::kNone) {
    const Int3& n = plan.grid.blocks();
    std::printf("planned  %" PRId64 " x %" PRId64 " x %" PRId64 " blocks of %" PRId64
                " voxels, %d steps, from %" PRId64 " vertices, in %.1f s\n",
                n[0], n[1], n[2], plan.grid.side(), plan.steps(), plan.start_vertices,
                now() - start);
  }
  return 0;
}

}  // namespace plc::tools

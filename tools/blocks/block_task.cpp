#include "tools/blocks/block_task.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <utility>

#include "tools/file/failure.h"

namespace plc::tools {

namespace {

namespace fs = std::filesystem;

// Of a vertex that a task has made: 8 bits of its step and one, 24 of its block, 32 of its number.
uint64_t new_id(int step, int64_t block, size_t number) {
  return static_cast<uint64_t>(step + 1) << 56U | static_cast<uint64_t>(block) << 32U | number;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string name_of(const BlockPlan& plan, int step, const Int3& block) {
  return "level " + std::to_string(plan.level_of(step)) + ", block " + BlockGrid::name_of(block);
}

int on_progress(const plc_progress* /*progress*/, void* user) {
  const auto& cancelled = *static_cast<const std::function<bool()>*>(user);
  return cancelled && cancelled() ? 1 : 0;
}

plc_verdict on_level(const plc_level_report* level, const plc_surface* /*surface*/, void* user) {
  auto& record = *static_cast<TaskRecord*>(user);
  record.iterations = level->iterations;
  record.converged = level->converged != 0;
  return PLC_VERDICT_ACCEPT;
}

void sort_by_id(BlockMesh& mesh) {
  std::vector<uint32_t> order(mesh.vertex_count()), rank(mesh.vertex_count());
  for (size_t v = 0; v < order.size(); ++v) order[v] = static_cast<uint32_t>(v);
  std::sort(order.begin(), order.end(),
            [&](uint32_t l, uint32_t r) { return mesh.ids[l] < mesh.ids[r]; });
  BlockMesh sorted;
  for (size_t v = 0; v < order.size(); ++v) {
    const size_t from = order[v];
    rank[from] = static_cast<uint32_t>(v);
    sorted.ids.push_back(mesh.ids[from]);
    sorted.xyz.insert(sorted.xyz.end(), &mesh.xyz[3 * from], &mesh.xyz[3 * from] + 3);
  }
  for (const uint32_t v : mesh.abc) sorted.abc.push_back(rank[v]);
  mesh = std::move(sorted);
}

// Adds the faces that had been left out; their corners may be in the mesh, held.
void put_back(const Patch& patch, BlockMesh& mesh) {
  if (patch.aside.empty()) return;
  std::map<uint64_t, uint32_t> known;
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (patch.aside_places.count(mesh.ids[v]) != 0) {
      known[mesh.ids[v]] = static_cast<uint32_t>(v);
    }
  }
  for (const auto& [id, place] : patch.aside_places) {
    if (known.count(id) != 0) continue;
    known[id] = static_cast<uint32_t>(mesh.vertex_count());
    mesh.ids.push_back(id);
    mesh.xyz.insert(mesh.xyz.end(), place.begin(), place.end());
  }
  for (const auto& face : patch.aside) {
    for (const uint64_t id : face) mesh.abc.push_back(known[id]);
  }
}

}  // namespace

std::map<Int3, BlockCell> cells_before(const std::string& folder, const BlockPlan& plan, int step,
                                       const std::vector<Int3>& cells) {
  std::map<std::string, std::unique_ptr<BlockFile>> files;
  std::map<Int3, BlockCell> found;
  for (const Int3& at : cells) {
    const BlockGrid::Writer writer = plan.grid.writer_of(at, step);
    const std::string path = block_path(folder, plan, writer.step, writer.block);
    std::unique_ptr<BlockFile>& file = files[path];
    if (file == nullptr) {
      if (!fs::exists(path)) {
        throw Failure{path + ": is not there yet; the tasks of steps before come first"};
      }
      file = std::make_unique<BlockFile>(path);
    }
    BlockCell cell = file->read(at);
    if (!cell.abc.empty()) found[at] = std::move(cell);
  }
  return found;
}

BlockTasks::BlockTasks(std::string folder, BlockPlan plan, plc_context* context,
                       const plc_volume* volume)
    : folder_(std::move(folder)), plan_(std::move(plan)), context_(context), volume_(volume) {}

void BlockTasks::demand(plc_status status) const {
  if (status != PLC_OK) throw Failure{plc_context_message(context_)};
}

bool BlockTasks::done(int step, int64_t block) const {
  return fs::exists(block_path(folder_, plan_, step, plan_.grid.block_at(block)));
}

// A volume that is held whole has no bricks.
int64_t BlockTasks::bricks_read() const {
  plc_brick_counts counts;
  plc_brick_counts_defaults(&counts);
  return plc_volume_brick_counts(context_, volume_, &counts) == PLC_OK ? counts.read : 0;
}

const plc_pyramid* BlockTasks::pyramid_of(int level) {
  if (level_ == level) return pyramid_.get();
  pyramid_.reset();
  const plc_parameters p = task_parameters(plan_, level);
  plc_pyramid* made = nullptr;
  demand(plc_pyramid_create(context_, volume_, &p, &made));
  pyramid_.reset(made);
  level_ = level;
  return made;
}

BlockTasks::Surface BlockTasks::evolve(const Patch& patch, int step, int64_t block,
                                       const std::function<bool()>& cancelled, TaskRecord& record) {
  static constexpr uint8_t kNothing = 0;  // held of a patch without a vertex
  plc_extras extras;
  plc_extras_defaults(&extras);
  extras.space = PLC_SPACE_VOXEL;
  extras.mesh_xyz = patch.mesh.xyz.data();
  extras.mesh_vertex_count = static_cast<int64_t>(patch.mesh.vertex_count());
  extras.mesh_abc = patch.mesh.abc.data();
  extras.mesh_face_count = static_cast<int64_t>(patch.mesh.face_count());
  extras.mesh_held = patch.held.empty() ? &kNothing : patch.held.data();
  room_of(plan_.grid.window_of(plan_.grid.block_at(block)), extras.room_low, extras.room_high);
  extras.room_inside = std::binary_search(plan_.inside.begin(), plan_.inside.end(), block) ? 1 : 0;
  extras.progress = on_progress;
  extras.progress_user = const_cast<std::function<bool()>*>(&cancelled);  // only read
  extras.level = on_level;
  extras.level_user = &record;
  const int level = plan_.level_of(step);
  const plc_parameters p = task_parameters(plan_, level);
  plc_run* made = nullptr;
  demand(plc_run_create(context_, pyramid_of(level), &p, &extras, &made));
  const Run run(made);
  const plc_status status = plc_run_advance(context_, run.get(), PLC_ALL_LEVELS, nullptr);
  if (status == PLC_CANCELLED) return nullptr;
  demand(status);
  plc_surface* surface = nullptr;
  demand(plc_run_surface(context_, run.get(), &surface));
  return Surface(surface);
}

// What is held keeps its id and its place, to the bit; everything else is new.
BlockMesh BlockTasks::after(const Patch& patch, const plc_surface* surface, int step,
                            int64_t block) const {
  const auto count = static_cast<size_t>(plc_surface_vertex_count(surface));
  const auto faces = static_cast<size_t>(plc_surface_face_count(surface));
  std::vector<double> xyz(3 * count);
  std::vector<int64_t> source(count);
  std::vector<uint32_t> abc(3 * faces);
  const auto vertices = static_cast<int64_t>(count);
  demand(plc_surface_positions_f64(context_, surface, PLC_SPACE_VOXEL, xyz.data(), vertices));
  demand(plc_surface_patch(context_, surface, source.data(), vertices));
  demand(plc_surface_faces(context_, surface, PLC_SPACE_VOXEL, abc.data(),
                           static_cast<int64_t>(faces)));
  BlockMesh mesh;
  std::vector<uint32_t> index(count);
  size_t made = 0;
  for (size_t v = 0; v < count; ++v) {
    if (source[v] == PLC_PATCH_ABSENT) continue;
    index[v] = static_cast<uint32_t>(mesh.vertex_count());
    const double* place = &xyz[3 * v];
    if (source[v] >= 0) {
      const auto from = static_cast<size_t>(source[v]);
      place = &patch.mesh.xyz[3 * from];
      mesh.ids.push_back(patch.mesh.ids[from]);
    } else {
      mesh.ids.push_back(new_id(step, block, made++));
    }
    mesh.xyz.insert(mesh.xyz.end(), place, place + 3);
  }
  for (size_t f = 0; f < faces; ++f) {
    for (size_t k = 0; k < 3; ++k) mesh.abc.push_back(index[abc[3 * f + k]]);
  }
  return mesh;
}

Patch BlockTasks::patch_in(const std::map<Int3, BlockCell>& cells, const BlockGrid::Window& window,
                           int step, const std::string& what) const {
  // With smaller reductions edges are divided one by one.
  constexpr double kRefined = 1.32;  // the root of that of a refinement
  const int first = step / BlockGrid::kColours * BlockGrid::kColours;  // of the level
  const uint64_t coarse = plan_.parameters.reduction > kRefined ? new_id(first, 0, 0) : 0;
  std::array<double, 3> low{}, high{};
  room_of(window, low.data(), high.data());
  return patch_of(joined(cells, what), low, high, coarse, what);
}

// Where vertices of a window may be.
void BlockTasks::room_of(const BlockGrid::Window& window, double* low, double* high) const {
  std::array<double, 3> from{}, to{};
  plan_.grid.bounds_of(window, from, to);
  for (size_t a = 0; a < 3; ++a) {
    low[a] = from[a] + plan_.band();
    high[a] = to[a] - plan_.band();
  }
}

bool BlockTasks::run(int step, int64_t block, const std::function<bool()>& cancelled,
                     TaskRecord& record) {
  const auto start = std::chrono::steady_clock::now();
  record = {};
  const int64_t read_before = bricks_read();
  const Int3 at = plan_.grid.block_at(block);
  const std::string what = name_of(plan_, step, at);
  const BlockGrid::Window window = plan_.grid.window_of(at);
  const std::vector<Int3> all = plan_.grid.cells_of(window);
  std::map<Int3, BlockCell> cells = cells_before(folder_, plan_, step, all);
  const Patch patch = cells.empty() ? Patch() : patch_in(cells, window, step, what);
  record.vertices = static_cast<int64_t>(patch.mesh.vertex_count());
  record.free = static_cast<int64_t>(patch.free);
  record.after = record.vertices;
  // Where a surface has been and is gone, it is not known which side is left.
  const bool searched = plan_.parameters.late_bubbles != 0 &&
                        (!cells.empty() || cells_before(folder_, plan_, 0, all).empty());
  if (patch.free > 0 || searched) {
    const Surface surface = evolve(patch, step, block, cancelled, record);
    if (surface == nullptr) return false;
    BlockMesh mesh = after(patch, surface.get(), step, block);
    record.after = static_cast<int64_t>(mesh.vertex_count());
    put_back(patch, mesh);
    sort_by_id(mesh);
    cells = divided(mesh, plan_.grid, window);
  }
  demand(plc_context_memory(context_, nullptr, &record.peak_bytes));
  record.bricks_read = bricks_read() - read_before;
  record.seconds = seconds_since(start);
  using Clock = std::chrono::system_clock;
  record.ended = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
  const std::string path = block_path(folder_, plan_, step, at);
  write_record(path, record);
  write_block_file(path, cells);  // last: it says that the task is done
  return true;
}

void write_start(const std::string& folder, const BlockPlan& plan, const std::vector<double>& xyz,
                 const std::vector<uint32_t>& abc) {
  BlockMesh mesh;
  for (size_t v = 0; v < xyz.size() / 3; ++v) mesh.ids.push_back(v);
  mesh.xyz = xyz;
  mesh.abc = abc;
  const BlockGrid& grid = plan.grid;
  const Int3& blocks = grid.blocks();
  const std::map<Int3, BlockCell> cells =
      divided(mesh, grid, {{0, 0, 0}, {3 * blocks[0] - 1, 3 * blocks[1] - 1, 3 * blocks[2] - 1}});
  for (int64_t block = 0; block < grid.block_count(); ++block) {
    const Int3 at = grid.block_at(block);
    std::map<Int3, BlockCell> own;
    for (const Int3& cell : grid.own_cells(at)) {
      if (const auto found = cells.find(cell); found != cells.end()) own.insert(*found);
    }
    write_block_file(block_path(folder, plan, -1, at), own);
  }
}

}  // namespace plc::tools

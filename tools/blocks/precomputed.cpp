#include "tools/blocks/precomputed.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <utility>

#include "tools/blocks/block_task.h"
#include "tools/blocks/chunk_grid.h"
#include "tools/blocks/mesh_fragment.h"
#include "tools/blocks/precomputed_files.h"
#include "tools/blocks/vertex_clusters.h"
#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"
#include "tools/file/folder.h"
#include "tools/volume/mesh_spaces.h"

namespace plc::tools {

namespace {

using Cells = std::map<Int3, BlockCell>;

// All levels of detail on their way into one file, each in the order of the Z-curve.
class Writer {
 public:
  Writer(const ChunkGrid& grid, const std::string& folder, AtomicFile& file)
      : grid_(grid),
        file_(file),
        tables_(static_cast<size_t>(grid.lods())),
        touched_(tables_.size()) {
    for (int lod = 0; lod < grid.lods(); ++lod) {
      record_.lods.push_back({grid.chunk(lod), lod > 0 ? grid.cluster(lod) : 0});
    }
    spools_.push_back(nullptr);
    for (int lod = 1; lod <= grid.near_lods(); ++lod) {
      spools_.push_back(std::make_unique<SpoolFile>(folder));
    }
  }

  void add(int lod, const MeshFragments& fragments) {
    const auto index = static_cast<size_t>(lod);
    PrecomputedRecord::Lod& record = record_.lods[index];
    for (const auto& [at, fragment] : fragments.all()) {
      const std::string bytes = packed_fragment(fragment);
      if (index < spools_.size() && spools_[index] != nullptr) {
        spools_[index]->write(bytes);
      } else {
        file_.write(bytes);
      }
      tables_[index].add(at, static_cast<uint32_t>(bytes.size()));
      record.faces += static_cast<int64_t>(fragment.faces.size());
      record.bytes += static_cast<int64_t>(bytes.size());
      ++record.fragments;
      for (unsigned eighth = 0; lod > 0 && eighth < 8; ++eighth) {
        if ((fragment.eighths >> eighth & 1U) == 0) continue;
        touched_[index].push_back({2 * at[0] + (eighth & 1U), 2 * at[1] + (eighth >> 1U & 1U),
                                   2 * at[2] + (eighth >> 2U)});
      }
    }
  }

  // Those that come before the levels of detail of larger chunks than a box.
  void end_boxes() {
    for (const auto& spool : spools_) {
      if (spool != nullptr) spool->copy_to(file_);
    }
    spools_.clear();
  }

  // Where a coarse chunk has faces in an eighth that is empty below it, neuroglancer would draw
  // them beside the finer ones: an empty chunk stands there instead.
  std::string manifest() {
    for (size_t lod = tables_.size() - 1; lod > 0; --lod) {
      tables_[lod - 1].add_empty(std::move(touched_[lod]));
    }
    return manifest_of(grid_, tables_);
  }

  PrecomputedRecord record() const { return record_; }

 private:
  const ChunkGrid& grid_;
  AtomicFile& file_;
  std::vector<std::unique_ptr<SpoolFile>> spools_;  // none of level of detail 0
  std::vector<FragmentTable> tables_;
  std::vector<std::vector<Int3>> touched_;  // by level of detail, chunks of the one below
  PrecomputedRecord record_;
};

Place place_of(const BlockCell& cell, size_t v) {
  return {cell.xyz[3 * v], cell.xyz[3 * v + 1], cell.xyz[3 * v + 2]};
}

Cells cells_of_box(const std::string& folder, const BlockPlan& plan, const ChunkGrid& grid,
                   const Int3& box) {
  Cells cells = cells_before(folder, plan, plan.steps(), grid.cells_around(box));
  const bool mirrored = mirrors(plan.image);
  for (auto& [at, cell] : cells) {
    if (!grid.holds(at, cell)) {
      throw Failure{folder + ": a face leaves its cell by more than " +
                    std::to_string(grid.reach()) + " voxels, or the image"};
    }
    for (size_t f = 0; mirrored && f < cell.abc.size(); f += 3) {
      std::swap(cell.abc[f + 1], cell.abc[f + 2]);
    }
  }
  return cells;
}

MeshFragments fragments_of_box(const ChunkGrid& grid, int lod, const Int3& box) {
  const int64_t chunks = grid.box_chunks(lod);
  Int3 first{}, end{};
  for (size_t a = 0; a < 3; ++a) {
    first[a] = box[a] * chunks;
    end[a] = first[a] + chunks;
  }
  return {grid, lod, first, end};
}

VertexClusters clusters_of(const ChunkGrid& grid, int lod, const Cells& cells) {
  VertexClusters clusters(ChunkGrid::origin(), grid.cluster(lod));
  std::vector<uint32_t> index;
  for (const auto& [at, cell] : cells) {
    index.clear();
    for (size_t v = 0; v < cell.ids.size(); ++v) {
      index.push_back(clusters.index_at(place_of(cell, v)));
    }
    for (size_t f = 0; f < cell.abc.size(); f += 3) {
      const uint32_t* v = &cell.abc[f];
      for (size_t k = 0; k < 3; ++k) clusters.add(index[v[k]], place_of(cell, v[k]), 1);
      clusters.add_face(index[v[0]], index[v[1]], index[v[2]]);
    }
  }
  clusters.settle();
  return clusters;
}

// What belongs to the box: its clusters, and the faces whose first cube is in it.
void take_own(const ChunkGrid& grid, const Int3& box, const VertexClusters& from,
              VertexClusters& to) {
  const int64_t cubes = ChunkGrid::kClusters * grid.box_chunks(grid.near_lods());
  const auto own = [&](const Int3& cube) {
    return cube[0] / cubes == box[0] && cube[1] / cubes == box[1] && cube[2] / cubes == box[2];
  };
  for (uint32_t i = 0; i < from.size(); ++i) {
    const VertexClusters::Cluster& cluster = from.cluster(i);
    if (own(cluster.cube)) to.add(to.index_of(cluster.cube), cluster.sum, cluster.count);
  }
  for (const VertexClusters::Face& f : from.faces()) {
    const Int3 &a = from.cluster(f.a).cube, &b = from.cluster(f.b).cube,
               &c = from.cluster(f.c).cube;
    if (own(std::min({a, b, c}))) to.add_face(to.index_of(a), to.index_of(b), to.index_of(c));
  }
}

// As other segments have it, too.
void check_info(const std::string& path, const std::string& info) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return;
  std::ostringstream text;
  text << file.rdbuf();
  if (text.str() != info) {
    throw Failure{path + ": is that of another image's meshes; choose another folder"};
  }
}

}  // namespace

PrecomputedRecord write_precomputed(const std::string& folder, const BlockPlan& plan,
                                    const PrecomputedOptions& options) {
  if (!has_draco()) packed_fragment({});  // says so
  const ChunkGrid grid(plan, options.lods);
  make_folder(options.output);
  const std::string info = info_of(plan.image), info_path = options.output + "/info";
  check_info(info_path, info);

  AtomicFiles files;
  const std::string name = options.output + "/" + std::to_string(options.segment);
  Writer writer(grid, options.output, files.add(name));
  const bool far = grid.lods() > grid.near_lods() + 1;
  VertexClusters whole(ChunkGrid::origin(), grid.cluster(grid.near_lods()));
  for (size_t i = 0; i < grid.boxes().size(); ++i) {
    const Int3& box = grid.boxes()[i];
    const Cells cells = cells_of_box(folder, plan, grid, box);
    MeshFragments surface = fragments_of_box(grid, 0, box);
    for (const auto& [at, cell] : cells) {
      for (size_t f = 0; f < cell.abc.size(); f += 3) {
        surface.add({place_of(cell, cell.abc[f]), place_of(cell, cell.abc[f + 1]),
                     place_of(cell, cell.abc[f + 2])});
      }
    }
    writer.add(0, surface);
    for (int lod = 1; lod <= grid.near_lods(); ++lod) {
      const VertexClusters clusters = clusters_of(grid, lod, cells);
      MeshFragments fragments = fragments_of_box(grid, lod, box);
      for (const auto& face : clusters.faces()) fragments.add(clusters.triangle(face));
      writer.add(lod, fragments);
      if (far && lod == grid.near_lods()) take_own(grid, box, clusters, whole);
    }
    if (options.progress) options.progress(i + 1, grid.boxes().size());
  }
  if (writer.record().lods[0].faces == 0) throw Failure{folder + ": holds no surface"};
  writer.end_boxes();
  for (int lod = grid.near_lods() + 1; lod < grid.lods(); ++lod) {
    whole = whole.above();
    MeshFragments fragments(grid, lod, {0, 0, 0}, grid.chunks(lod));
    for (const auto& face : whole.faces()) fragments.add(whole.triangle(face));
    writer.add(lod, fragments);
  }
  files.add(name + ".index").write(writer.manifest());
  files.add(info_path).write(info);
  files.commit();
  return writer.record();
}

}  // namespace plc::tools

#include "tools/command/label_files.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <utility>

#include "tools/command/clock.h"
#include "tools/command/extract_job.h"
#include "tools/command/mesh_precision.h"
#include "tools/command/report.h"
#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"
#include "tools/mesh/vertex_colours.h"

namespace plc::tools {

namespace {

// Files that are renamed together, so that the disk is not waited for at each.
constexpr size_t kTogether = 64;

std::array<uint8_t, 3> rgb_of(const LabelPiece& piece) {
  return piece.entry.rgb ? *piece.entry.rgb : label_bytes(piece.label.value);
}

class LabelFiles {
 public:
  LabelFiles(const ExtractOptions& options, bool doubles, double voxel_mm3)
      : options_(options), doubles_(doubles), voxel_mm3_(voxel_mm3) {}

  void write(std::vector<LabelPiece>& pieces) {
    for (LabelPiece& piece : pieces) {
      if (piece.mesh.abc.empty()) continue;
      write(piece);
      if (!options_.merged.empty()) append(piece);
      if (!options_.table.empty()) table_ += row(piece);
      if (files_.size() >= kTogether) files_.commit();
    }
    if (!options_.merged.empty()) write_mesh(options_.merged, all_, files_);
    if (!options_.table.empty()) files_.add(options_.table).write(table_);
    files_.commit();
  }

 private:
  void write(LabelPiece& piece) {
    const double begin = now();
    const std::string output = output_of(piece);
    piece.mesh.doubles = doubles_;
    if (!doubles_) round_to_floats(piece.mesh.xyz);
    if (!output.empty()) write_mesh(output, piece.mesh, files_);
    if (!options_.report.empty()) {
      auto& seconds = piece.report["seconds"];
      const double taken = now() - begin;
      seconds["write"] = taken;
      seconds["total"] = seconds["total"].get<double>() + taken;
      piece.report["coordinates"] = precision_text(doubles_);
      write_report(named(options_.report, piece.number()), piece.report, files_);
    }
    if (options_.progress == Progress::kNone) return;
    const plc_measures& m = piece.measures;
    std::printf("%s  %" PRId64 " voxels: %" PRId64 " vertices, components %" PRId64
                ", genus %" PRId64 ", area %.1f mm2, volume %.1f mm3 (%.1f %%)%s%s\n",
                piece.text().c_str(), piece.label.voxels, m.vertices, m.components, m.genus, m.area,
                m.volume, 100 * share(piece), output.empty() ? "" : ": ", output.c_str());
  }

  std::string output_of(const LabelPiece& piece) const {
    return options_.output.empty() ? "" : named(options_.output, piece.number());
  }

  // Of the voxels' volume.
  double share(const LabelPiece& piece) const {
    return piece.measures.volume / (static_cast<double>(piece.label.voxels) * voxel_mm3_);
  }

  void append(const LabelPiece& piece) {
    const auto first = static_cast<uint32_t>(all_.xyz.size() / 3);
    const TriangleMesh& mesh = piece.mesh;
    all_.doubles = doubles_;
    all_.space = mesh.space;
    all_.xyz.insert(all_.xyz.end(), mesh.xyz.begin(), mesh.xyz.end());
    all_.normals.insert(all_.normals.end(), mesh.normals.begin(), mesh.normals.end());
    for (const uint32_t v : mesh.abc) all_.abc.push_back(first + v);
    if (all_.scalars.empty()) all_.scalars.push_back({Scalars::kLabels, {}});
    all_.scalars[0].values.insert(all_.scalars[0].values.end(), mesh.xyz.size() / 3,
                                  static_cast<float>(piece.label.value));
    all_.labels.push_back({piece.label.value, piece.entry.name, rgb_of(piece)});
  }

  std::string row(const LabelPiece& piece) const {
    const plc_measures& m = piece.measures;
    const auto rgb = rgb_of(piece);
    char line[400];
    std::snprintf(line, sizeof line,
                  "\t%d\t%d\t%d\t%" PRId64 "\t%.9g\t%" PRId64 "\t%" PRId64 "\t%" PRId64 "\t%" PRId64
                  "\t%.9g\t%.9g\t%.6g\t",
                  int{rgb[0]}, int{rgb[1]}, int{rgb[2]}, piece.label.voxels,
                  static_cast<double>(piece.label.voxels) * voxel_mm3_, m.vertices, m.faces,
                  m.components, m.genus, m.area, m.volume, share(piece));
    return piece.number() + "\t" + piece.entry.name + line + output_of(piece) + "\n";
  }

  const ExtractOptions& options_;
  bool doubles_;
  double voxel_mm3_;
  AtomicFiles files_;
  TriangleMesh all_;
  std::string table_ =
      "label\tname\tred\tgreen\tblue\tvoxels\tvoxels_mm3\tvertices\tfaces\tcomponents\tgenus\t"
      "area_mm2\tvolume_mm3\tof_voxels\tfile\n";
};

}  // namespace

void check_label_paths(const ExtractOptions& options) {
  if (!options.output.empty()) check_mesh_path(options.output);
  if (!options.merged.empty()) {
    check_mesh_path(options.merged);
    if (!holds_scalars(options.merged)) {
      throw Failure{options.merged + ": --merged needs a format that has values at vertices"};
    }
  }
  if (!options.report.empty()) check_report_path(options.report);
  if (!options.table.empty()) check_report_path(options.table);
  std::vector<std::string> paths = {options.output, options.report, options.merged, options.table};
  std::erase(paths, "");
  std::sort(paths.begin(), paths.end());
  const auto twice = std::adjacent_find(paths.begin(), paths.end());
  if (twice != paths.end()) throw Failure{*twice + ": would be written twice"};
}

void write_label_files(const ExtractOptions& options, std::vector<LabelPiece>& pieces, bool doubles,
                       double voxel_mm3) {
  LabelFiles(options, doubles, voxel_mm3).write(pieces);
}

}  // namespace plc::tools

#include "tools/command/command_labels.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "tools/command/clock.h"
#include "tools/command/engine_handles.h"
#include "tools/command/extract_job.h"
#include "tools/command/extract_volume.h"
#include "tools/command/label_files.h"
#include "tools/command/label_neighbours.h"
#include "tools/command/label_overlaps.h"
#include "tools/command/label_piece.h"
#include "tools/command/mesh_precision.h"
#include "tools/command/progress_line.h"
#include "tools/command/report.h"
#include "tools/command/surface_mesh.h"
#include "tools/file/failure.h"
#include "tools/mesh/mesh_io.h"
#include "tools/volume/labels.h"
#include "tools/volume/volume_io.h"

namespace plc::tools {

namespace {

// How many labels a line names.
constexpr size_t kNamed = 10;
constexpr double kInside = 255;  // of crop_label()

constexpr double kReach = 2;  // voxels, more than a surface grows by
using Piece = LabelPiece;

// What to try next where a piece overlaps another. False: nothing is left.
bool advance(Piece& piece, bool lost_cavity) {
  const bool wider = piece.margin + 1 < kLabelMargins.size();
  const bool weaker = piece.curvature + 1 < kLabelCurvatures.size();
  if (wider && !(lost_cavity && weaker)) {
    ++piece.margin;
  } else if (weaker) {
    ++piece.curvature;
  }
  return wider || weaker;
}

// "label 8", or "12 labels (1, 2, 3 ...)".
std::string listed(const std::string& one, const std::string& several,
                   const std::vector<std::string>& names) {
  if (names.size() == 1) return one + " " + names[0];
  std::string text = std::to_string(names.size()) + " " + several + " (";
  for (size_t i = 0; i < std::min(names.size(), kNamed); ++i) {
    if (i > 0) text += ", ";
    text += names[i];
  }
  return text + (names.size() > kNamed ? " ...)" : ")");
}

plc_parameters parameters_of(const ExtractOptions& options, const Piece& piece) {
  plc_parameters p = options.parameters;
  p.iso = (0.5 + kLabelMargins[piece.margin]) * kInside;
  p.window_low = 0;
  p.window_high = kInside;
  p.pad_value = 0;
  p.levels = 0;  // the start is the surface itself, and nothing of it is missed
  p.init = PLC_INIT_ISO;
  p.late_bubbles = 0;
  p.curvature *= kLabelCurvatures[piece.curvature];
  // Labels touch: coarse facets would keep them apart.
  if (p.mesh == PLC_MESH_AUTO) p.mesh = PLC_MESH_UNIFORM;
  return p;
}

// Voxel indices of the whole image from those of a crop; way: 1, or -1 for the other way round.
void shift(std::vector<double>& xyz, const std::array<int64_t, 3>& low, double way) {
  for (size_t i = 0; i < xyz.size(); ++i) xyz[i] += way * static_cast<double>(low[i % 3]);
}

class LabelExtraction {
 public:
  LabelExtraction(const ExtractOptions& options, InterruptGuard& interrupt)
      : options_(options), interrupt_(interrupt), line_(options.progress) {
    check_label_paths(options);
    interrupt.end_at_once();
    volume_ = read_volume_apart(options.labels, options.nifti_frame);
    print_warnings(volume_.warnings);
    plc_context_options context = options.context;
    if (options.memory) context.memory_limit = memory_limit(options, volume_.bytes.size());
    context_ = make_context(context);
    find_names();
    for (const Label& label : find_labels(options.labels, volume_.image)) {
      pieces_.push_back({label, entry_of(label)});
    }
    if (pieces_.empty()) throw Failure{options.labels + ": holds no label: every voxel is 0"};
    read_ = now() - start_;
  }

  // The exit code.
  int make() {
    interrupt_.note_first();
    for (Piece& piece : pieces_) {
      if (!extract(piece)) return interrupt_.tell();
    }
    if (!leave_out()) throw Failure{options_.labels + ": no label is large enough for a surface"};
    if (!settle() || !grow()) return interrupt_.tell();
    if (interrupt_.interrupted()) return interrupt_.tell();
    interrupt_.only_note();  // what is written from here on is whole
    line_.clear();
    write_label_files(options_, pieces_, doubles_, voxel_mm3());
    print_total();
    line_.done();
    tell_precision(doubles_, first_output());
    return 0;
  }

 private:
  static int on_progress(const plc_progress* progress, void* user) {
    auto& self = *static_cast<LabelExtraction*>(user);
    plc_progress p = *progress;
    const auto all = static_cast<double>(std::max(2 * self.pieces_.size(), self.done_ + 1));
    p.fraction = (static_cast<double>(self.done_) + p.fraction) / all;
    p.seconds = now() - self.start_;
    self.line_.update(p);
    return self.interrupt_.interrupted() ? 1 : 0;
  }

  // Of the table that the user names, or those that lie beside the image.
  void find_names() {
    std::vector<std::string> warnings;
    entries_ = options_.names.empty() ? label_names_beside(options_.labels, warnings)
                                      : read_label_names(options_.names);
    for (const std::string& line : warnings) std::fprintf(stderr, "pellicle: %s\n", line.c_str());
  }
  LabelEntry entry_of(const Label& label) const {
    const auto at = entries_.find(label.value);
    return at == entries_.end() ? LabelEntry{} : at->second;
  }
  double voxel_mm3() const {
    const auto& spacing = volume_.image.spacing;
    return spacing[0] * spacing[1] * spacing[2];
  }

  // Makes the surface of the piece with its margin of now; where that holds none the piece keeps
  // the one that it has. False: cancelled.
  bool extract(Piece& piece) {
    const double begin = now();
    const LabelCrop crop = crop_label(volume_.image, piece.label);
    const plc_parameters parameters = parameters_of(options_, piece);
    plc_extras extras;
    plc_extras_defaults(&extras);
    const plc_status status = run(piece, crop, parameters, extras, begin);
    if (status == PLC_CANCELLED) return false;
    if (status == PLC_OK) return true;
    const Failure failure = failure_of(context_.get());
    if (failure.message.rfind("no surface", 0) == 0) return true;
    throw Failure{piece.text() + ": " + failure.message};
  }

  // The piece gets the surface that comes out, if it has faces.
  plc_status run(Piece& piece, const LabelCrop& crop, const plc_parameters& parameters,
                 plc_extras& extras, double begin) {
    extras.progress = on_progress;
    extras.progress_user = this;
    plc_surface* made = nullptr;
    const plc_status status = plc_extract(context_.get(), &crop.image, &parameters, &extras, &made);
    const SurfaceHandle surface(made);
    ++done_;
    if (status != PLC_OK || plc_surface_face_count(made) == 0) return status;
    piece.mesh = mesh_of(context_.get(), made, options_.space);
    if (options_.space == PLC_SPACE_VOXEL) shift(piece.mesh.xyz, crop.low, 1);
    piece.measures = measures_of(context_.get(), made);
    plc_level_report level;
    plc_level_report_defaults(&level);
    if (plc_surface_level(context_.get(), made, 0, &level) == PLC_OK) {
      gap_mm_ = std::max(gap_mm_, kLabelGap * level.delta * level.unit);
    }
    if (!options_.report.empty()) piece.report = report_of(piece, made, begin);
    return status;
  }

  nlohmann::ordered_json report_of(const Piece& piece, const plc_surface* surface,
                                   double begin) const {
    const Timings timings{read_, 0, read_ + now() - begin};
    const Label& label = piece.label;
    auto report =
        make_report(context_.get(), volume_.image, surface, piece.measures, timings, options_);
    report["label"] = {{"value", label.value},
                       {"name", piece.entry.name},
                       {"voxels", label.voxels},
                       {"voxels_mm3", static_cast<double>(label.voxels) * voxel_mm3()},
                       {"low", label.low},
                       {"high", label.high},
                       {"margin", piece.grown ? 0 : kLabelMargins[piece.margin]},
                       {"gap_mm", gap_mm_}};
    return report;
  }

  // Labels that hold no surface. False: no other is there.
  bool leave_out() {
    line_.clear();
    std::vector<std::string> names;
    for (const Piece& piece : pieces_) {
      if (piece.mesh.abc.empty()) names.push_back(piece.number());
    }
    left_out_ = names.size();
    if (left_out_ == 0) return true;
    std::fprintf(stderr, "pellicle: %s: too small or too thin to hold a surface: left out\n",
                 listed("label", "labels", names).c_str());
    return left_out_ < pieces_.size();
  }

  const std::string& first_output() const {
    return options_.output.empty() ? options_.merged : options_.output;
  }

  // Until all surfaces are valid together, in floats or in doubles. False: cancelled.
  bool settle() {
    if (disjoint(context_.get(), meshes(), true)) return true;
    doubles_ = true;
    if (disjoint(context_.get(), meshes(), false)) return true;
    if (!separate()) return false;
    if (!open_.empty()) refuse();
    if (again_ > 0) doubles_ = !disjoint(context_.get(), meshes(), true);
    if (doubles_ && !disjoint(context_.get(), meshes(), false)) {
      throw Failure{"internal error: the labels overlap, but no two of them do"};
    }
    return true;
  }

  // Every surface in turn, among the others as they are then: the smallest first, which a neighbour
  // that is smoothed over it would cost the largest part. False: cancelled.
  bool grow() {
    std::vector<size_t> order(pieces_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      return pieces_[a].label.voxels < pieces_[b].label.voxels;
    });
    const LabelNeighbours neighbours(pieces_, reach());
    for (const size_t i : order) {
      if (!pieces_[i].mesh.abc.empty() && !grow(pieces_[i], neighbours.around(i))) return false;
    }
    if (!not_grown_.empty()) {
      std::fprintf(stderr,
                   "pellicle: %s: drawn inside of where they are, as single precision does "
                   "not hold them\n",
                   listed("label", "labels", not_grown_).c_str());
    }
    if (!doubles_) doubles_ = !disjoint(context_.get(), meshes(), true);
    if (doubles_ && !disjoint(context_.get(), meshes(), false)) {
      fail_precision(options_.space, first_output());
    }
    return true;
  }

  // In the unit of the space.
  double reach() const {
    const auto& spacing = volume_.image.spacing;
    return options_.space == PLC_SPACE_VOXEL
               ? kReach
               : kReach * std::max({spacing[0], spacing[1], spacing[2]});
  }

  // others: what it may not meet. False: cancelled.
  bool grow(Piece& piece, TriangleMesh others) {
    const double begin = now();
    const LabelCrop crop = crop_label(volume_.image, piece.label);
    plc_parameters parameters = parameters_of(options_, piece);
    parameters.iso = kInside / 2;
    parameters.init = PLC_INIT_MESH;
    TriangleMesh start = piece.mesh;
    if (options_.space == PLC_SPACE_VOXEL) {
      for (TriangleMesh* mesh : {&start, &others}) shift(mesh->xyz, crop.low, -1);
    }
    plc_extras extras;
    plc_extras_defaults(&extras);
    extras.space = options_.space;
    extras.mesh_xyz = start.xyz.data();
    extras.mesh_vertex_count = static_cast<int64_t>(start.xyz.size() / 3);
    extras.mesh_abc = start.abc.data();
    extras.mesh_face_count = static_cast<int64_t>(start.abc.size() / 3);
    extras.obstacle_xyz = others.xyz.data();
    extras.obstacle_vertex_count = static_cast<int64_t>(others.xyz.size() / 3);
    extras.obstacle_abc = others.abc.data();
    extras.obstacle_face_count = static_cast<int64_t>(others.abc.size() / 3);
    extras.obstacle_gap = kLabelGap;
    piece.grown = true;
    const plc_status status = run(piece, crop, parameters, extras, begin);
    if (status == PLC_OK || status == PLC_CANCELLED) return status == PLC_OK;
    // What rounding to single precision has made of it cannot be started from: it stays as it is.
    if (status != PLC_INVALID_DATA) {
      throw Failure{piece.text() + ": " + failure_of(context_.get()).message};
    }
    piece.grown = false;
    not_grown_.push_back(piece.number());
    return true;
  }

  std::vector<const TriangleMesh*> meshes() const {
    std::vector<const TriangleMesh*> all;
    all.reserve(pieces_.size());
    for (const Piece& piece : pieces_) all.push_back(&piece.mesh);
    return all;
  }

  // Overlapping labels are extracted again until none overlap or nothing is left to try: then
  // open_ has those left. False: cancelled.
  bool separate() {
    std::vector<char> changed(pieces_.size(), 1);
    for (;;) {
      const auto is_changed = [&](const Overlap& o) {
        return changed[o.first] != 0 || changed[o.second] != 0;
      };
      open_.erase(std::remove_if(open_.begin(), open_.end(), is_changed), open_.end());
      const auto found = find_overlaps(context_.get(), meshes(), changed);
      open_.insert(open_.end(), found.begin(), found.end());
      // The engine's surfaces are valid: it is the coordinates that do not hold this one.
      if (std::any_of(open_.begin(), open_.end(),
                      [](const Overlap& o) { return o.first == o.second; })) {
        return true;
      }
      std::vector<char> cavity(pieces_.size(), 0);
      std::vector<char> wanted(pieces_.size(), 0);
      for (const Overlap& o : open_) {
        wanted[o.outer] = 1;
        if (o.nested) {
          cavity[o.outer] = 1;
        } else {
          wanted[o.first] = wanted[o.second] = 1;
        }
      }
      std::fill(changed.begin(), changed.end(), char{0});
      bool any = false;
      for (size_t i = 0; i < pieces_.size(); ++i) {
        if (wanted[i] == 0 || !advance(pieces_[i], cavity[i] != 0)) continue;
        if (!extract(pieces_[i])) return false;
        any = true;
        changed[i] = 1;
        ++again_;
      }
      if (!any) return true;
    }
  }

  void print_total() const {
    if (options_.progress == Progress::kNone) return;
    std::printf("labels   %zu written, %zu left out, %zu tried again, neighbours %.2g mm apart\n",
                pieces_.size() - left_out_, left_out_, again_, gap_mm_);
    std::printf("time     %.2f s, peak memory %.0f MiB\n", now() - start_,
                std::ceil(static_cast<double>(peak_rss_bytes()) / (1024.0 * 1024.0)));
    std::fflush(stdout);
  }

  // Surfaces that overlap whatever is tried are not written, nor are the others.
  [[noreturn]] void refuse() const {
    std::vector<std::string> names;
    for (const Overlap& o : open_) {
      if (o.first == o.second) fail_precision(options_.space, first_output());
      names.push_back(pieces_[o.first].number() + " and " + pieces_[o.second].number());
    }
    throw Failure{options_.labels + ": " + listed("labels", "pairs of labels", names) +
                  ": their surfaces overlap, however far apart they are drawn: nothing is written"};
  }

  const ExtractOptions& options_;
  InterruptGuard& interrupt_;
  ProgressLine line_;
  double start_ = now();
  double read_ = 0;
  ContextHandle context_;
  LoadedVolume volume_{};
  std::vector<Piece> pieces_;
  LabelEntries entries_;
  std::vector<Overlap> open_;
  bool doubles_ = false;
  size_t done_ = 0;  // calls of the engine
  size_t left_out_ = 0;
  size_t again_ = 0;
  std::vector<std::string> not_grown_;
  double gap_mm_ = 0;
};

}  // namespace

void add_label_options(CLI::App& command, ExtractOptions& options) {
  CLI::Option* labels =
      command
          .add_option(
              "--labels", options.labels,
              "Label image, in place of INPUT: every value but 0 is a label, and its "
              "surface is written to OUTPUT-LABEL.SUFFIX. The surfaces do not overlap, a "
              "label inside another lies in a cavity of it, and neighbours are about 0.02 of "
              "a voxel apart. Excludes what tells the object, the start and the levels")
          ->type_name("FILE")
          ->group("Files");
  command
      .add_option("--names", options.names,
                  "With --labels: table of names and colours, as FreeSurfer, ITK-SNAP, 3D Slicer, "
                  "AAL and MRIcron have them. Those that lie beside the label image are found")
      ->type_name("FILE")
      ->group("Files")
      ->needs(labels);
  command
      .add_option(
          "--merged", options.merged,
          "With --labels: mesh of all surfaces to write, beside those of --output or alone. Its "
          "values are the labels, with names and colours (.vtp, .ply, .glb, .gii)")
      ->type_name("FILE")
      ->group("Files")
      ->needs(labels);
  command
      .add_option(
          "--table", options.table,
          "With --labels: table to write, a line for each label, separated by tabs: name, colour, "
          "voxels, area, volume, components, genus, file")
      ->type_name("FILE")
      ->group("Files")
      ->needs(labels);
  command.get_option("INPUT")->required(false);
  command.get_option("--output")->required(false);
  for (const char* other : {"--iso",
                            "--inside",
                            "--level-iso",
                            "--window",
                            "--pad",
                            "--feature",
                            "--sigma",
                            "--levels",
                            "--reduction",
                            "--init",
                            "--attach",
                            "--structure",
                            "--force",
                            "--gradient",
                            "--gradient-tangent",
                            "--gradient-bound",
                            "--no-late-bubbles",
                            "--trace",
                            "--each-level",
                            "--box",
                            "--keep",
                            "--quality"}) {
    labels->excludes(command.get_option(other));
  }
  labels->excludes(command.get_option("INPUT"));
  command.final_callback([&options] {
    if (options.input.empty() && options.labels.empty()) throw CLI::RequiredError("INPUT");
    if (options.output.empty() && options.merged.empty()) throw CLI::RequiredError("--output");
  });
}

int run_labels(const ExtractOptions& options, InterruptGuard& interrupt) {
  return LabelExtraction(options, interrupt).make();
}

}  // namespace plc::tools

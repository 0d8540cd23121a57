#include "tools/command_labels.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tools/command_check.h"
#include "tools/engine_handles.h"
#include "tools/extract_job.h"
#include "tools/label_overlaps.h"
#include "tools/labels.h"
#include "tools/mesh_io.h"
#include "tools/progress_line.h"
#include "tools/report.h"
#include "tools/surface_mesh.h"
#include "tools/volume_io.h"

namespace plc::tools {

namespace {

constexpr int kExitOverlap = 1;
constexpr double kInside = 255;  // of crop_label()

// A label's surface is drawn where its indicator is 0.5 and one of these, so that those of two
// neighbours are twice this apart, in voxels. Overlaps are tried again with the next one. From 0.5
// on single voxels vanish.
constexpr std::array<double, 3> kMargins = {0.25, 0.35, 0.45};
// The curvature as the user has it, and weaker: it rounds surfaces off and closes small cavities.
constexpr std::array<double, 4> kCurvatures = {1, 0.5, 0.25, 0};

double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

// A label and its surface as it is to be written; no faces: too small to hold one.
struct Piece {
  Label label;
  size_t margin = 0;     // of kMargins
  size_t curvature = 0;  // of kCurvatures
  TriangleMesh mesh{};
  plc_measures measures{};
  nlohmann::ordered_json report{};
};

// What to try next where a piece overlaps another. False: nothing is left.
bool advance(Piece& piece, bool lost_cavity) {
  const bool wider = piece.margin + 1 < kMargins.size();
  const bool weaker = piece.curvature + 1 < kCurvatures.size();
  if (wider && !(lost_cavity && weaker)) {
    ++piece.margin;
  } else if (weaker) {
    ++piece.curvature;
  }
  return wider || weaker;
}

std::string name_of(const Label& label) {
  return std::to_string(label.value);
}

plc_parameters parameters_of(const ExtractOptions& options, const Piece& piece) {
  plc_parameters p = options.parameters;
  p.iso = (0.5 + kMargins[piece.margin]) * kInside;
  p.window_low = 0;
  p.window_high = kInside;
  p.pad_value = 0;
  p.levels = 0;  // the start is the surface itself, and nothing of it is missed
  p.init = PLC_INIT_ISO;
  p.late_bubbles = 0;
  p.curvature *= kCurvatures[piece.curvature];
  return p;
}

// Voxel indices of the whole image, as floats again, which every format holds.
void shift(TriangleMesh& mesh, const std::array<int64_t, 3>& low) {
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    mesh.xyz[i] = static_cast<float>(mesh.xyz[i] + static_cast<double>(low[i % 3]));
  }
}

class LabelExtraction {
 public:
  LabelExtraction(const ExtractOptions& options, InterruptGuard& interrupt)
      : options_(options), interrupt_(interrupt), line_(options.progress) {
    check_mesh_path(options.output);
    if (!options.report.empty()) check_report_path(options.report);
    if (options.report == options.output)
      throw Failure{options.output + ": would be written twice"};
    interrupt.end_at_once();
    context_ = make_context(options.context);
    volume_ = read_volume(options.labels);
    for (const Label& label : find_labels(options.labels, volume_.image)) {
      pieces_.push_back({label});
    }
    if (pieces_.empty()) throw Failure{options.labels + ": holds no label: every voxel is 0"};
    read_ = now() - start_;
  }

  // The exit code.
  int run() {
    interrupt_.note_first();
    for (Piece& piece : pieces_) {
      if (!extract(piece)) return interrupted();
    }
    if (!leave_out()) throw Failure{options_.labels + ": no label is large enough for a surface"};
    if (!disjoint(context_.get(), meshes()) && !separate()) return interrupted();
    if (again_ > 0 && open_.empty() && !disjoint(context_.get(), meshes())) {
      throw Failure{"internal error: the labels overlap, but no two of them do"};
    }
    if (interrupt_.interrupted()) return interrupted();
    interrupt_.only_note();  // what is written from here on is whole
    line_.clear();
    for (Piece& piece : pieces_) write(piece);
    print_total();
    line_.done();
    return open_.empty() ? 0 : complain();
  }

 private:
  static int interrupted() {
    std::fputs("pellicle: interrupted\n", stderr);
    return kExitInterrupted;
  }

  static int on_progress(const plc_progress* progress, void* user) {
    auto& self = *static_cast<LabelExtraction*>(user);
    plc_progress p = *progress;
    const auto all = static_cast<double>(std::max(self.pieces_.size(), self.done_ + 1));
    p.fraction = (static_cast<double>(self.done_) + p.fraction) / all;
    p.seconds = now() - self.start_;
    self.line_.update(p);
    return self.interrupt_.interrupted() ? 1 : 0;
  }

  // Leaves the piece's surface as it is where there is none as it is told now. False: cancelled.
  bool extract(Piece& piece) {
    const double begin = now();
    const LabelCrop crop = crop_label(volume_.image, piece.label);
    const plc_parameters parameters = parameters_of(options_, piece);
    plc_extras extras;
    plc_extras_defaults(&extras);
    extras.progress = on_progress;
    extras.progress_user = this;
    plc_surface* made = nullptr;
    const plc_status status = plc_extract(context_.get(), &crop.image, &parameters, &extras, &made);
    const SurfaceHandle surface(made);
    ++done_;
    if (status == PLC_CANCELLED) return false;
    if (status != PLC_OK) {
      const Failure failure = failure_of(context_.get(), status);
      if (failure.message.rfind("no surface", 0) == 0) return true;
      throw Failure{"label " + name_of(piece.label) + ": " + failure.message};
    }
    if (plc_surface_face_count(made) == 0) return true;
    piece.mesh = mesh_of(context_.get(), made, options_.space);
    if (options_.space == PLC_SPACE_VOXEL) shift(piece.mesh, crop.low);
    piece.measures = measures_of(context_.get(), made);
    if (!options_.report.empty()) piece.report = report_of(piece, made, begin);
    return true;
  }

  nlohmann::ordered_json report_of(const Piece& piece, const plc_surface* surface,
                                   double begin) const {
    const Timings timings{read_, 0, read_ + now() - begin};
    const Label& label = piece.label;
    auto report =
        make_report(context_.get(), volume_.image, surface, piece.measures, timings, options_);
    report["label"] = {{"value", label.value},
                       {"voxels", label.voxels},
                       {"low", label.low},
                       {"high", label.high},
                       {"margin", kMargins[piece.margin]}};
    return report;
  }

  // Labels that hold no surface. False: no other is there.
  bool leave_out() {
    line_.clear();
    bool any = false;
    for (const Piece& piece : pieces_) {
      any = any || !piece.mesh.abc.empty();
      if (!piece.mesh.abc.empty()) continue;
      ++left_out_;
      std::fprintf(stderr,
                   "pellicle: label %" PRId32 ": %" PRId64
                   " voxel%s, too small or too thin to hold a surface: left out\n",
                   piece.label.value, piece.label.voxels, piece.label.voxels == 1 ? "" : "s");
    }
    return any;
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

  void write(Piece& piece) {
    if (piece.mesh.abc.empty()) return;
    const double begin = now();
    const std::string output = named(options_.output, name_of(piece.label));
    write_mesh(output, piece.mesh);
    if (!options_.report.empty()) {
      auto& seconds = piece.report["seconds"];
      const double taken = now() - begin;
      seconds["write"] = taken;
      seconds["total"] = seconds["total"].get<double>() + taken;
      write_report(named(options_.report, name_of(piece.label)), piece.report);
    }
    const plc_measures& m = piece.measures;
    if (options_.progress != Progress::kNone) {
      std::printf("label %" PRId32 "  %" PRId64 " voxels: %" PRId64 " vertices, components %" PRId64
                  ", genus %" PRId64 ", area %.1f mm2, volume %.1f mm3: %s\n",
                  piece.label.value, piece.label.voxels, m.vertices, m.components, m.genus, m.area,
                  m.volume, output.c_str());
    }
  }

  void print_total() const {
    if (options_.progress == Progress::kNone) return;
    std::printf("labels   %zu written, %zu left out, %zu tried again\n", pieces_.size() - left_out_,
                left_out_, again_);
    std::printf("time     %.2f s, peak memory %.0f MiB\n", now() - start_,
                std::ceil(static_cast<double>(peak_rss_bytes()) / (1024.0 * 1024.0)));
    std::fflush(stdout);
  }

  int complain() const {
    for (const Overlap& o : open_) {
      const std::string first = name_of(pieces_[o.first].label);
      if (o.first == o.second) {
        std::fprintf(stderr,
                     "pellicle: label %s: written, but not valid as `pellicle check` tells\n",
                     first.c_str());
        continue;
      }
      std::fprintf(stderr, "pellicle: labels %s and %s: written, but they overlap (one %s)\n",
                   first.c_str(), name_of(pieces_[o.second].label).c_str(),
                   o.nested ? "lies inside the other" : "meets the other");
    }
    return kExitOverlap;
  }

  const ExtractOptions& options_;
  InterruptGuard& interrupt_;
  ProgressLine line_;
  double start_ = now();
  double read_ = 0;
  ContextHandle context_;
  LoadedVolume volume_{};
  std::vector<Piece> pieces_;
  std::vector<Overlap> open_;
  size_t done_ = 0;  // calls of the engine
  size_t left_out_ = 0;
  size_t again_ = 0;
};

}  // namespace

void add_label_options(CLI::App& command, ExtractOptions& options) {
  CLI::Option* labels =
      command
          .add_option("--labels", options.labels,
                      "Label image, in place of INPUT: every value but 0 is a label, and its "
                      "surface is written to OUTPUT-LABEL.SUFFIX. The surfaces do not overlap, a "
                      "label inside another lies in a cavity of it, and neighbours are about half "
                      "a voxel apart. Excludes what tells the object, the start and the levels")
          ->type_name("FILE")
          ->group("Files");
  command.get_option("INPUT")->required(false);
  for (const char* other :
       {"--iso", "--inside", "--level-iso", "--window", "--pad", "--feature", "--sigma", "--levels",
        "--reduction", "--init", "--attach", "--structure", "--force", "--gradient",
        "--gradient-tangent", "--gradient-bound", "--no-late-bubbles", "--trace", "--each-level"}) {
    labels->excludes(command.get_option(other));
  }
  labels->excludes(command.get_option("INPUT"));
  command.final_callback([&options] {
    if (options.input.empty() && options.labels.empty()) throw CLI::RequiredError("INPUT");
  });
}

int run_labels(const ExtractOptions& options, InterruptGuard& interrupt) {
  return LabelExtraction(options, interrupt).run();
}

}  // namespace plc::tools

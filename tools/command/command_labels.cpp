#include "tools/command/command_labels.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tools/command/engine_handles.h"
#include "tools/command/extract_job.h"
#include "tools/command/label_overlaps.h"
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

// Files that are renamed together, so that the disk is not waited for at each.
constexpr size_t kTogether = 64;
// How many labels a line names.
constexpr size_t kNamed = 10;
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

// Voxel indices of the whole image.
void shift(TriangleMesh& mesh, const std::array<int64_t, 3>& low) {
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    mesh.xyz[i] += static_cast<double>(low[i % 3]);
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
    volume_ = read_volume_apart(options.labels, options.nifti_frame);
    print_warnings(volume_);
    context_ = make_context(options.context);
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
      if (!extract(piece)) return interrupt_.tell();
    }
    if (!leave_out()) throw Failure{options_.labels + ": no label is large enough for a surface"};
    if (!settle()) return interrupt_.tell();
    if (interrupt_.interrupted()) return interrupt_.tell();
    interrupt_.only_note();  // what is written from here on is whole
    line_.clear();
    write();
    print_total();
    line_.done();
    tell_precision(doubles_, options_.output);
    return 0;
  }

 private:
  static int on_progress(const plc_progress* progress, void* user) {
    auto& self = *static_cast<LabelExtraction*>(user);
    plc_progress p = *progress;
    const auto all = static_cast<double>(std::max(self.pieces_.size(), self.done_ + 1));
    p.fraction = (static_cast<double>(self.done_) + p.fraction) / all;
    p.seconds = now() - self.start_;
    self.line_.update(p);
    return self.interrupt_.interrupted() ? 1 : 0;
  }

  // Makes the surface of the piece with its margin of now; where that holds none the piece keeps
  // the one that it has. False: cancelled.
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
      const Failure failure = failure_of(context_.get());
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
    std::vector<std::string> names;
    for (const Piece& piece : pieces_) {
      if (piece.mesh.abc.empty()) names.push_back(name_of(piece.label));
    }
    left_out_ = names.size();
    if (left_out_ == 0) return true;
    std::fprintf(stderr, "pellicle: %s: too small or too thin to hold a surface: left out\n",
                 listed("label", "labels", names).c_str());
    return left_out_ < pieces_.size();
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

  void write() {
    AtomicFiles files;
    for (Piece& piece : pieces_) {
      if (piece.mesh.abc.empty()) continue;
      write(piece, files);
      if (files.size() >= kTogether) files.commit();
    }
    files.commit();
  }

  void write(Piece& piece, AtomicFiles& files) {
    const double begin = now();
    const std::string output = named(options_.output, name_of(piece.label));
    piece.mesh.doubles = doubles_;
    if (!doubles_) round_to_floats(piece.mesh.xyz);
    write_mesh(output, piece.mesh, files);
    if (!options_.report.empty()) {
      auto& seconds = piece.report["seconds"];
      const double taken = now() - begin;
      seconds["write"] = taken;
      seconds["total"] = seconds["total"].get<double>() + taken;
      piece.report["coordinates"] = precision_text(doubles_);
      write_report(named(options_.report, name_of(piece.label)), piece.report, files);
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

  // Surfaces that overlap whatever is tried are not written, nor are the others.
  [[noreturn]] void refuse() const {
    std::vector<std::string> names;
    for (const Overlap& o : open_) {
      if (o.first == o.second) fail_precision(options_.space, options_.output);
      names.push_back(name_of(pieces_[o.first].label) + " and " + name_of(pieces_[o.second].label));
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
  std::vector<Overlap> open_;
  bool doubles_ = false;
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
  });
}

int run_labels(const ExtractOptions& options, InterruptGuard& interrupt) {
  return LabelExtraction(options, interrupt).run();
}

}  // namespace plc::tools

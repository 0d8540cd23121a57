#include "tools/command/command_mesh.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "tools/command/command_check.h"
#include "tools/command/engine_handles.h"
#include "tools/command/extract_options.h"
#include "tools/command/mesh_precision.h"
#include "tools/command/option_values.h"
#include "tools/mesh/mesh_bodies.h"
#include "tools/mesh/mesh_io.h"
#include "tools/volume/mesh_spaces.h"
#include "tools/volume/volume_io.h"

namespace plc::tools {

namespace {

// Several meshes as one. Their own values are left out: not all have the same.
class Merge {
 public:
  void add(const TriangleMesh& mesh) {
    first_face_.push_back(mesh_.abc.size() / 3);
    const auto base = static_cast<uint32_t>(mesh_.xyz.size() / 3);
    mesh_.space = mesh.space;
    mesh_.xyz.insert(mesh_.xyz.end(), mesh.xyz.begin(), mesh.xyz.end());
    mesh_.normals.insert(mesh_.normals.end(), mesh.normals.begin(), mesh.normals.end());
    for (const uint32_t v : mesh.abc) mesh_.abc.push_back(base + v);
    labels_.values.resize(mesh_.xyz.size() / 3, static_cast<float>(first_face_.size()));
  }
  TriangleMesh finish() {
    if (mesh_.normals.size() != mesh_.xyz.size()) mesh_.normals.clear();
    mesh_.scalars = {std::move(labels_)};
    return std::move(mesh_);
  }
  // The number of the mesh that a face comes from.
  size_t source_of(int64_t face) const {
    const auto next =
        std::upper_bound(first_face_.begin(), first_face_.end(), static_cast<size_t>(face));
    return static_cast<size_t>(next - first_face_.begin()) - 1;
  }

 private:
  TriangleMesh mesh_;
  Scalars labels_{Scalars::kLabels, {}};
  std::vector<size_t> first_face_;
};

// A body is kept whole where one of its vertices lies in the box.
std::vector<char> in_box(const TriangleMesh& mesh, const Bodies& bodies,
                         const std::array<double, 6>& box) {
  std::vector<char> kept(bodies.volumes.size(), 0);
  for (size_t v = 0; v < bodies.of_vertex.size(); ++v) {
    bool inside = bodies.of_vertex[v] != Bodies::kNone;
    for (size_t k = 0; inside && k < 3; ++k) {
      const double x = mesh.xyz[3 * v + k];
      inside = x >= box[2 * k] && x <= box[2 * k + 1];
    }
    if (inside) kept[bodies.of_vertex[v]] = 1;
  }
  return kept;
}

class MeshWork {
 public:
  explicit MeshWork(const MeshOptions& options) : options_(options) {
    check_mesh_path(options.output);
    if (options.inputs.size() > 1 && !options.merge) {
      throw Failure{options.inputs[1] + ": a second mesh; --merge makes one of several"};
    }
    if (!options.image.empty()) {
      image_ = read_volume_apart(options.image, options.nifti_frame);
      print_warnings(image_.warnings);
    }
    plc_context_options context_options;
    plc_context_options_defaults(&context_options);
    context_ = make_context(context_options);
  }

  int run() {
    TriangleMesh mesh = read();
    mesh = part(std::move(mesh));
    settle(mesh);
    leave_out_values(mesh);
    write_mesh(options_.output, mesh);
    tell_precision(mesh.doubles, options_.output);
    const plc_check check = check_of(context_.get(), mesh);
    std::printf("written  %s: %zu vertices, %zu faces, components %lld%s, %s\n",
                options_.output.c_str(), mesh.xyz.size() / 3, mesh.abc.size() / 3,
                static_cast<long long>(check.measures.components), kept_.c_str(),
                check.valid != 0 ? "valid" : "not valid");
    if (check.valid == 0) {
      std::fprintf(stderr, "pellicle: %s: is not a valid surface, as it was; check tells why\n",
                   options_.output.c_str());
    }
    return 0;
  }

 private:
  TriangleMesh read_one(const std::string& path) {
    TriangleMesh mesh = read_mesh(path);
    if (check_of(context_.get(), mesh).valid == 0) {
      valid_ = false;
      first_invalid_ = first_invalid_.empty() ? path : first_invalid_;
    }
    const plc_space assumed = options_.from.value_or(PLC_SPACE_LPS);
    const plc_image* image = options_.image.empty() ? nullptr : &image_.image;
    if (!space_) {
      space_ = options_.space ? *options_.space : space_named(mesh.space).value_or(assumed);
    }
    bring_to(mesh, *space_, assumed, image, path);
    return mesh;
  }

  TriangleMesh read() {
    if (!options_.merge) return read_one(options_.inputs[0]);
    for (const std::string& path : options_.inputs) merge_.add(read_one(path));
    TriangleMesh mesh = merge_.finish();
    check_merged(mesh);
    return mesh;
  }

  // Walls of cavities, which are not valid alone, may be so together with what is around them.
  void check_merged(const TriangleMesh& mesh) {
    const plc_check check = check_of(context_.get(), mesh);
    const bool were_valid = valid_;
    valid_ = check.valid != 0;
    if (valid_ || !were_valid) return;
    const std::string refused = ": not merged, as the result would not be a valid surface";
    if (check.self_intersections > 0) {
      throw Failure{options_.inputs[merge_.source_of(check.first_intersection[0])] + " and " +
                    options_.inputs[merge_.source_of(check.first_intersection[1])] + refused +
                    ": they meet"};
    }
    throw Failure{options_.inputs[0] + " and others" + refused + ": " +
                  (check.wrongly_oriented_components > 0
                       ? "one lies inside another, and not in a cavity of it"
                       : "they share points")};
  }

  // How many bodies are kept; Failure where `option` leaves none.
  size_t demand_some(const std::vector<char>& kept, const std::string& option) const {
    const auto count = std::count(kept.begin(), kept.end(), char{1});
    if (count > 0) return static_cast<size_t>(count);
    throw Failure{options_.output + ": not written: " + option + " leaves none of the " +
                  std::to_string(kept.size()) + " bodies"};
  }

  // What --keep and --crop leave.
  TriangleMesh part(TriangleMesh mesh) {
    if (options_.keep.text.empty() && !options_.crop) return mesh;
    const bool keeps = !options_.keep.text.empty();
    if (!valid_) {
      throw Failure{first_invalid_ + ": is not a valid surface, of which " +
                    (keeps ? "--keep" : "--crop") + " knows no bodies; check tells why"};
    }
    const Bodies bodies = bodies_of(mesh);
    std::vector<char> kept(bodies.volumes.size(), 1);
    std::vector<double> volumes = bodies.volumes;
    if (options_.crop) {
      kept = in_box(mesh, bodies, *options_.crop);
      demand_some(kept, "--crop");
      for (size_t i = 0; i < kept.size(); ++i) volumes[i] = kept[i] != 0 ? volumes[i] : 0;
    }
    const std::vector<char> large = kept_by(options_.keep, volumes);
    for (size_t i = 0; i < kept.size(); ++i) kept[i] = kept[i] != 0 && large[i] != 0 ? 1 : 0;
    const size_t count = demand_some(kept, "--keep");
    kept_ = ", " + std::to_string(count) + " of " + std::to_string(kept.size()) + " bodies";
    return part_of(mesh, bodies, kept);
  }

  void settle(TriangleMesh& mesh) const {
    const bool valid = settle_precision(context_.get(), mesh);
    if (valid_ && !valid) fail_precision(*space_, options_.output);
  }

  void leave_out_values(TriangleMesh& mesh) const {
    if (mesh.scalars.empty() || holds_scalars(options_.output)) return;
    std::string names;
    for (const Scalars& scalars : mesh.scalars) {
      names += (names.empty() ? "" : ", ") + scalars.name;
    }
    std::fprintf(stderr, "pellicle: %s: its format holds no values at vertices: without %s\n",
                 options_.output.c_str(), names.c_str());
    mesh.scalars.clear();
  }

  const MeshOptions& options_;
  ContextHandle context_;
  LoadedVolume image_{};
  Merge merge_;
  std::optional<plc_space> space_;
  std::string first_invalid_;
  std::string kept_;
  bool valid_ = true;  // what was read
};

}  // namespace

void add_mesh_options(CLI::App& command, MeshOptions& options) {
  const auto text = [&](const std::string& name, const std::string& type,
                        const std::string& fallback, const std::string& meaning, auto read) {
    command.add_option_function<std::string>(name, read, meaning)
        ->type_name(type)
        ->default_str(fallback);
  };
  command.add_option("MESH", options.inputs, "Mesh to read: " + mesh_suffixes(MeshUse::kRead))
      ->required()
      ->type_name("");
  command
      .add_option("-o,--output", options.output,
                  "Mesh to write, by suffix: " + mesh_suffixes(MeshUse::kWritten))
      ->required()
      ->type_name("FILE");
  text("--keep", kKeepType, "all",
       "Bodies to keep, with the cavities in them: all, the largest, the N largest, or those of at "
       "least this volume, in the unit of the mesh",
       [&](const std::string& s) { options.keep = to_keep_rule("--keep", s); });
  text("--crop", "X0,X1,Y0,Y1,Z0,Z1", "",
       "Box, in the space that is written: bodies with a vertex in it are kept whole, the others "
       "left out (--box of extract cuts, and closes the surface at its border)",
       [&](const std::string& s) {
         const auto v = to_numbers("--crop", s, 6);
         if (!(v[0] <= v[1] && v[2] <= v[3] && v[4] <= v[5])) {
           refuse_value("--crop", s, "three ranges, each from the lower to the higher number");
         }
         options.crop.emplace();
         std::copy(v.begin(), v.end(), options.crop->begin());
       });
  text("--space", "lps|ras|voxel", "that of the mesh",
       "Coordinates to write: patient space in mm, or voxels of --image",
       [&](const std::string& s) { options.space = to_choice("--space", s, kSpaces); });
  text("--from", "lps|ras|voxel", "lps", "Coordinates of a mesh whose file does not name them",
       [&](const std::string& s) { options.from = to_choice("--from", s, kSpaces); });
  command.add_option("--image", options.image, "Image whose voxels are meant")->type_name("FILE");
  text("--nifti-frame", "auto|sform|qform", "auto",
       "Where --image lies if it is NIfTI: as in extract", [&](const std::string& s) {
         options.nifti_frame = to_choice("--nifti-frame", s, kNiftiFrames);
       });
  command.add_flag("--merge", options.merge,
                   "One mesh of several, with the number of each, from 1, as values Label at its "
                   "vertices; refused where they meet or lie inside each other");
}

int run_mesh(const MeshOptions& options) {
  return MeshWork(options).run();
}

}  // namespace plc::tools

#include "tools/command/command_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "tools/command/extract_options.h"
#include "tools/command/option_values.h"
#include "tools/command/rounded_text.h"
#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"
#include "tools/file/path_suffix.h"
#include "tools/file/printable.h"
#include "tools/mesh/mesh_io.h"
#include "tools/view/page_source.h"
#include "tools/view/view_page.h"
#include "tools/volume/mesh_spaces.h"
#include "tools/volume/volume_io.h"
#include "tools/volume/volume_io_memory.h"

namespace plc::tools {

namespace {

void check_page_path(const std::string& path) {
  const std::string suffix = path_suffix(path);
  if (suffix != ".html" && suffix != ".htm") {
    throw Failure{path + ": a page's name must end in .html"};
  }
  const AtomicFile probe(path);
}

// The file's name without its folder and suffix; with its folder where two would be the same.
std::vector<std::string> surface_names(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  names.reserve(paths.size());
  for (const std::string& path : paths) {
    names.push_back(std::filesystem::path(path).stem().string());
  }
  const std::vector<std::string> stems = names;
  for (size_t i = 0; i < paths.size(); ++i) {
    if (std::count(stems.begin(), stems.end(), stems[i]) > 1) names[i] = paths[i];
  }
  return names;
}

std::string text_of_dims(const std::array<int64_t, 3>& dims) {
  return dims_text(dims.data());
}

std::string grey_text(const GreyImage& grey) {
  std::string text = "values " + rounded_range(grey.window.low, grey.window.high) +
                     " of the image are shown in 256 greys, steps of " +
                     rounded(grey.window.step());
  if (grey.low < grey.window.low || grey.high > grey.window.high) {
    text +=
        "; those beyond (it has " + rounded_range(grey.low, grey.high) + ") as the nearest of them";
  }
  return text;
}

// What the page has not as the files have it, a line each.
std::vector<std::string> notes_of(const GreyImage& grey) {
  std::vector<std::string> notes;
  if (grey.reduced()) {
    notes.push_back("the image is reduced to " + text_of_dims(grey.dims) +
                    " voxels, each the mean of " + text_of_dims(grey.reduction));
  }
  if (!grey.exact) notes.push_back(grey_text(grey));
  return notes;
}

ViewedSurface read_surface(const std::string& path, const std::string& name,
                           const ViewOptions& options, const plc_image& image) {
  ViewedSurface surface{name, read_mesh(path)};
  bring_to(surface.mesh, PLC_SPACE_LPS, options.space, &image, path);
  check_surface(path, surface.mesh);
  return surface;
}

}  // namespace

void add_view_options(CLI::App& command, ViewOptions& options) {
  command
      .add_option("IMAGE", options.image,
                  "NIfTI, NRRD, MetaImage, OME-Zarr, a DICOM directory, a TIFF stack or an .inv3")
      ->required()
      ->type_name("");
  command
      .add_option("SURFACE", options.surfaces,
                  "Meshes: " + mesh_suffixes(MeshUse::kRead) +
                      "; values at their vertices, as pellicle measure writes them, can be shown "
                      "as colours")
      ->type_name("");
  command
      .add_option("-o,--output", options.output,
                  "Page to write, .html: it needs no other file and no network")
      ->type_name("FILE")
      ->capture_default_str();
  const auto text = [&](const std::string& name, const std::string& type,
                        const std::string& meaning, auto read) {
    return command.add_option_function<std::string>(name, read, meaning)->type_name(type);
  };
  text("--space", "lps|ras|voxel",
       "Coordinates of meshes whose files name no space, as of pellicle extract",
       [&](const std::string& s) { options.space = to_choice("--space", s, kSpaces); })
      ->default_str("lps");
  text("--window", "LOW,HIGH",
       "Values that the page can tell apart, in 256 steps (default: nearly all that the image has)",
       [&](const std::string& s) {
         const std::vector<double> v = to_numbers("--window", s, 2);
         if (!(v[0] < v[1]) || !std::isfinite(v[1] - v[0])) {
           refuse_value("--window", s, "two values, the lower one first");
         }
         options.window = GreyWindow{v[0], v[1]};
       });
  text("--max-voxels", "N", "An image of more is reduced: voxels of the page are means of several",
       [&](const std::string& s) {
         options.max_voxels = to_integer("--max-voxels", s);
         if (options.max_voxels < 8) refuse_value("--max-voxels", s, "8 or more");
       })
      ->default_str(std::to_string(options.max_voxels));
  text("--nifti-frame", "auto|sform|qform", "Which frame of a NIfTI image, as of pellicle extract",
       [&](const std::string& s) {
         options.nifti_frame = to_choice("--nifti-frame", s, kNiftiFrames);
       })
      ->default_str("auto");
}

int run_view(const ViewOptions& options) {
  const PageSource source = page_source();
  if (!source.missing.empty()) throw Failure{"view: " + std::string(source.missing)};
  check_page_path(options.output);
  const LoadedVolume volume = read_volume_apart(options.image, options.nifti_frame);
  print_warnings(volume.warnings);
  ViewedScene scene;
  scene.name = std::filesystem::path(options.image).filename().string();
  scene.image = volume.image;
  scene.version = plc_version_string();
  const std::vector<std::string> names = surface_names(options.surfaces);
  for (size_t i = 0; i < names.size(); ++i) {
    const std::string& path = options.surfaces[i];
    scene.surfaces.push_back(read_surface(path, names[i], options, volume.image));
    if (!is_outside(volume.image, scene.surfaces.back().mesh)) continue;
    scene.notes.push_back(printable(path) + " lies outside the image: is it in another space?");
    std::fprintf(stderr, "pellicle: %s lies outside the image: is it in another --space than %s?\n",
                 printable(path).c_str(), name_of(options.space, kSpaces));
  }
  scene.grey = grey_image(volume.image, options.window, options.max_voxels);
  const std::vector<std::string> notes = notes_of(scene.grey);
  scene.notes.insert(scene.notes.end(), notes.begin(), notes.end());
  const uint64_t size = write_page(options.output, source, scene);
  for (const std::string& note : notes) std::printf("note     %s\n", note.c_str());
  std::printf("page     %s, %.1f MB\n", options.output.c_str(), static_cast<double>(size) / 1e6);
  return 0;
}

}  // namespace plc::tools

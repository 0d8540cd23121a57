#include "tools/command/extract_options.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "tools/mesh/mesh_io.h"

namespace plc::tools {

const Choices<plc_space> kSpaces = {
    {"lps", PLC_SPACE_LPS}, {"ras", PLC_SPACE_RAS}, {"voxel", PLC_SPACE_VOXEL}};
const Choices<NiftiFrame> kNiftiFrames = {
    {"auto", NiftiFrame::kAuto}, {"sform", NiftiFrame::kSform}, {"qform", NiftiFrame::kQform}};
const Choices<plc_bound> kBounds = {{"clamp", PLC_BOUND_CLAMP}, {"scale", PLC_BOUND_SCALE}};
const Choices<plc_mesh_kind> kMeshes = {
    {"auto", PLC_MESH_AUTO}, {"uniform", PLC_MESH_UNIFORM}, {"adaptive", PLC_MESH_ADAPTIVE}};
const Choices<plc_anisotropy> kAnisotropies = {{"physical", PLC_ANISOTROPY_PHYSICAL},
                                               {"voxel", PLC_ANISOTROPY_VOXEL},
                                               {"metric", PLC_ANISOTROPY_METRIC}};
const Choices<plc_force> kForces = {
    {"iso", PLC_FORCE_ISO}, {"gradient", PLC_FORCE_GRADIENT}, {"both", PLC_FORCE_BOTH}};
const Choices<plc_feature> kFeatures = {{"none", PLC_FEATURE_NONE},
                                        {"gradient-norm", PLC_FEATURE_GRADIENT_NORM}};
const Choices<int> kInsides = {{"above", 0}, {"below", 1}};

namespace {

const Choices<plc_simd> kSimds = {{"auto", PLC_SIMD_AUTO},     {"scalar", PLC_SIMD_SCALAR},
                                  {"sse4", PLC_SIMD_SSE4},     {"avx2", PLC_SIMD_AVX2},
                                  {"avx512", PLC_SIMD_AVX512}, {"neon", PLC_SIMD_NEON}};

const Choices<plc_rest_length> kRestLengths = {{"zero", PLC_REST_ZERO}, {"mean", PLC_REST_MEAN}};

template <typename T>
std::string names_of(const Choices<T>& choices) {
  std::string names;
  for (const auto& choice : choices)
    names += (names.empty() ? "" : "|") + std::string(choice.first);
  return names;
}

// What --quality sets: see tools/README.md for what each costs. Each preset sets all that any of
// them sets, so that the one of a --structure takes the place of the one outside of it.
using Preset = void (*)(plc_parameters& p);

void normal(plc_parameters& p) {
  plc_parameters defaults;
  plc_parameters_defaults(&defaults);
  p.mesh = defaults.mesh;
  p.late_bubbles = defaults.late_bubbles;
  p.epsilon = defaults.epsilon;
}
void draft(plc_parameters& p) {
  constexpr double kSoonCalm = 1e-4;  // twenty times the default
  normal(p);
  p.mesh = PLC_MESH_UNIFORM;
  p.late_bubbles = 0;
  p.epsilon = kSoonCalm;
}
const Choices<Preset> kQualities = {{"draft", draft}, {"normal", normal}};

void read_edge_range(const std::string& text, plc_parameters& p) {
  const auto v = to_numbers("--edge-range", text, 2);
  if (!(v[0] > 0 && v[0] <= v[1])) {
    refuse_value("--edge-range", text, "a length above 0 and one that is no less");
  }
  p.edge_min = v[0];
  p.edge_max = v[1];
}

void read_rest_length(const std::string& text, plc_parameters& p) {
  for (const auto& [name, mode] : kRestLengths) {
    if (text == name) {
      p.rest_length = mode;
      return;
    }
  }
  double value = 0;
  try {
    value = to_number("--rest-length", text);
  } catch (const CLI::ValidationError&) {
    refuse_value("--rest-length", text, "zero, mean or a finite number");
  }
  p.rest_length = PLC_REST_VALUE;
  p.rest_length_value = value;
}

// The part behind "name=", or NULL.
const char* behind(const std::string& text, const std::string& name) {
  return text.rfind(name + "=", 0) == 0 ? text.c_str() + name.size() + 1 : nullptr;
}

// "x,y,z,r;x,y,z,r".
std::vector<plc_seed> read_seeds(const std::string& text) {
  std::vector<plc_seed> seeds;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(';', begin), text.size());
    const auto v = to_numbers("--init seeds", text.substr(begin, end - begin), 4);
    if (!(v[3] > 0)) refuse_value("--init seeds", text, "radii above 0");
    seeds.push_back({{v[0], v[1], v[2]}, v[3]});
    begin = end + 1;
  }
  return seeds;
}

void read_init(const std::string& text, ExtractOptions& o) {
  plc_parameters& p = o.parameters;
  if (text == "auto") {
    p.init = PLC_INIT_AUTO;
  } else if (text == "bubble") {
    p.init = PLC_INIT_BUBBLE;
  } else if (text == "iso") {
    p.init = PLC_INIT_ISO;
  } else if (const char* counts = behind(text, "bubbles")) {
    p.init = PLC_INIT_BUBBLES;
    const auto n = to_integers("--init bubbles", counts, 3);
    std::copy(n.begin(), n.end(), p.bubbles);
  } else if (const char* seeds = behind(text, "seeds")) {
    p.init = PLC_INIT_SEEDS;
    o.seeds = read_seeds(seeds);
  } else if (const char* mask = behind(text, "mask"); mask != nullptr && *mask != 0) {
    p.init = PLC_INIT_MASK;
    o.init_file = mask;
  } else if (const char* mesh = behind(text, "mesh"); mesh != nullptr && *mesh != 0) {
    p.init = PLC_INIT_MESH;
    o.init_file = mesh;
  } else {
    refuse_value("--init", text,
                 "auto, bubble, bubbles=NX,NY,NZ, seeds=X,Y,Z,R;..., iso, mask=FILE or mesh=FILE");
  }
}

void read_level_isos(const std::string& text, plc_parameters& p) {
  const auto values = to_numbers("--level-iso", text, 0);
  if (values.size() > PLC_MAX_LEVELS) {
    refuse_value("--level-iso", text, "at most " + std::to_string(PLC_MAX_LEVELS) + " numbers");
  }
  std::copy(values.begin(), values.end(), p.level_iso);
  p.level_iso_count = static_cast<int>(values.size());
}

class Declarations {
 public:
  Declarations(CLI::App& command, ExtractOptions& options)
      : command_(command), options_(options), p_(options.parameters) {}

  void files() {
    group_ = "Files";
    command_
        .add_option(
            "INPUT", options_.input,
            "NIfTI, NRRD, MetaImage, OME-Zarr, TIFF stack, InVesalius .inv3, or a directory of "
            "DICOM slices")
        ->required()
        ->type_name("");
    file("-o,--output", options_.output,
         "Mesh to write, by suffix: " + mesh_suffixes(MeshUse::kWritten))
        ->required();
    choice("--space", kSpaces, options_.space,
           "Coordinates of the mesh: patient space in mm (lps: x to the left, y to the back, z to "
           "the head; ras: x to the right, y to the front) or voxel indices");
    choice("--nifti-frame", kNiftiFrames, options_.nifti_frame,
           "Where NIfTI files lie: by their sform where it has a code, else by their qform (auto), "
           "or by the one that is named");
    file("--report", options_.report, "JSON report to write");
    file("--trace", options_.trace,
         "CSV to write: iteration, level, vertices, energy, speed, seconds and the part told to be "
         "done of every iteration (figure 17)");
    flag(
        "--each-level", [&o = options_] { o.each_level = true; },
        "Write the surface at the end of each level too, OUTPUT-levelH.SUFFIX (figures 14, 16, "
        "20)");
    CLI::Option* quiet = flag(
        "--quiet", [&o = options_] { o.progress = Progress::kNone; },
        "No progress and no summary; warnings and errors only");
    flag(
        "--slicer-progress", [&o = options_] { o.progress = Progress::kSlicer; },
        "Progress on stdout as command-line modules tell it to 3D Slicer")
        ->excludes(quiet);
  }

  // Before the options that it sets: what is told of them, too, goes on top of it.
  void quality() {
    group_ = "Mesh";
    text("--quality", "draft|normal", "normal",
         "Preset, on top of which the other options go: draft, a first look (--mesh uniform "
         "--no-late-bubbles --epsilon 1e-4: thin parts, and those beside the one the bubble meets, "
         "are missing); normal, the defaults",
         [&p = p_](const std::string& s) { to_choice("--quality", s, kQualities)(p); });
  }

  void object() {
    group_ = "Object";
    text("--iso", "VALUE[,VALUE...]", "",
         "Value of the surface, in the image's units. Several: one surface each, in this order, "
         "NAME-VALUE.SUFFIX; each starts from the last one on the full image where that is nearer "
         "than a bubble. otsu: Otsu's threshold of the image, or of its --box; p95: the value that "
         "95 % of its voxels do not exceed",
         [&o = options_](const std::string& s) {
           o.isos = to_iso_choices("--iso", s);
           const IsoChoice& first = o.isos[0];
           o.parameters.iso =
               first.is_number() ? first.number : std::numeric_limits<double>::quiet_NaN();
         });
    choice("--inside", kInsides, p_.inside_below,
           "The object is where the image is above (a bright object) or below iso");
    text("--level-iso", "V,...", "derived",
         "Value of the surface on each level from the coarsest to the full image, in the image's "
         "units; by default those at which the level's object covers that of the full image; of a "
         "noisy "
         "image, with an adaptive mesh, the last but one is that of the full image, too",
         [&p = p_](const std::string& s) { read_level_isos(s, p); });
    text("--window", "LO,HI", "derived",
         "Values that are mapped to 0 and 1, in the image's units; iso lies between them",
         [&p = p_](const std::string& s) {
           const auto v = to_numbers("--window", s, 2);
           if (!(v[0] < v[1])) refuse_value("--window", s, "a low value and a higher one");
           p.window_low = v[0];
           p.window_high = v[1];
         });
    number("--pad", p_.pad_value,
           "Value that surrounds the image, so that objects cut by its border come out closed, in "
           "the image's units, not on the object's side of --iso; by default the outside end of "
           "the window");
  }

  // Of the image and the result, not of one structure.
  void region() {
    group_ = "Object";
    text("--box", "X0,X1,Y0,Y1,Z0,Z1", "",
         "Region of the image, in voxel indices, both ends within: all else is left out as if the "
         "image ended there, and the surface is closed at its border",
         [&o = options_](const std::string& s) {
           const auto v = to_integers("--box", s, 6);
           o.box = VoxelBox{{v[0], v[2], v[4]}, {v[1], v[3], v[5]}};
         });
    text("--keep", kKeepType, "all",
         "Bodies to write, with the cavities in them: all, the largest, the N largest, or those of "
         "at "
         "least this volume, as in 500mm3",
         [&o = options_](const std::string& s) { o.keep = to_keep_rule("--keep", s); });
  }

  void feature() {
    group_ = "Feature";
    choice("--feature", kFeatures, p_.feature,
           "What is taken for the image: itself, or the norm of its gradient per mm, as snakes "
           "have it; iso, window and pad are values of it");
    number("--sigma", p_.feature_sigma, "Gaussian before --feature gradient-norm, mm; 0: none");
  }

  void pyramid() {
    group_ = "Pyramid and start";
    text("--levels", "M", "as --init has it, else 3, fewer for small images",
         "Levels of the pyramid above the full image; 0: direct, without a pyramid",
         [&p = p_](const std::string& s) {
           p.levels = to_integer("--levels", s);
           if (p.levels < 0 || p.levels >= PLC_MAX_LEVELS) {
             refuse_value("--levels", s, "within 0 .. " + std::to_string(PLC_MAX_LEVELS - 1));
           }
         });
    number("--reduction", p_.reduction, "Reduction from a level to the next, above 1, at most 2");
    choice("--anisotropy", kAnisotropies, p_.anisotropy,
           "How voxels that are no cubes are met (4.4): the mesh is regular in mm (physical), in "
           "voxels with all its forces (voxel), or in the voxels of each level with its forces in "
           "mm (metric)");
    text(
        "--init", "KIND", init_text(options_),
        "What the surface starts from: auto, iso on the full image for an adaptive mesh where "
        "noise does not make that too large, else bubble; bubble, one around the object; "
        "bubbles=NX,NY,NZ, a grid of them over the image, each count 1 .. 256; seeds=X,Y,Z,R;..., "
        "spheres (centres in "
        "--space and in the image, R in mm); iso, the iso-surface of the coarsest image; "
        "mask=FILE, the surface of the voxels "
        "of a volume that are not 0; mesh=FILE, a closed oriented mesh, in the space that its file "
        "names, else in --space",
        [&o = options_](const std::string& s) { read_init(s, o); });
    file("--attach", options_.attach,
         "File of places (in --space, radii in mm, in the image) that draw the surface near them, "
         "\"attach X Y Z RADIUS "
         "[STRENGTH]\", or in which it does not move, \"pin X Y Z RADIUS\"");
  }

  void model() {
    group_ = "Mesh";
    choice("--mesh", kMeshes, p_.mesh,
           "Edges of one length, the voxels' (uniform, the paper's), or by how much the surface in "
           "the image bends (adaptive: thin parts whole, flat ones with few vertices); auto: "
           "adaptive where --force is iso, without --spring and --edge");
    number("--edge", p_.edge,
           "Uniform: about the mean of all edges, mm, from a quarter of a voxel to a tenth of the "
           "image; 0: 1.25 voxels");
    number("--tolerance", p_.tolerance,
           "Adaptive: mean distance in mm between facets and the surface that is aimed at; 0: 1/24 "
           "of a voxel");
    text("--edge-range", "MIN,MAX", "",
         "Adaptive: mean edges lie between, mm; 0.625 and 5 voxels by default",
         [&p = p_](const std::string& s) { read_edge_range(s, p); });
    group_ = "Model";
    number("--curvature", p_.curvature,
           "alpha_c, smoothing by curvature, >= 0, relative to the attraction");
    number("--spring", p_.spring, "alpha_e, elasticity of edges, >= 0, relative to the attraction");
    text("--rest-length", "zero|mean|VALUE", rest_length_text(p_),
         "Rest length of edges: zero (shrinks), their mean, or a value in units of delta, the "
         "mesh's resolution",
         [&p = p_](const std::string& s) { read_rest_length(s, p); });
    choice("--force", kForces, p_.force,
           "Forces of the image: towards the value iso, along the gradient, or both; with gradient "
           "alone --iso may be left out");
    number("--attraction", p_.attraction, "|alpha_I|, attraction to the value of the surface, > 0");
    number("--gradient", p_.gradient,
           "alpha_gradI, attraction along the gradient in the direction of the normal; negative: "
           "towards dark");
    number("--gradient-tangent", p_.gradient_tangent,
           "beta_gradI, attraction along the gradient in the tangent plane");
    number("--gradient-bound", p_.gradient_bound,
           "Norm of the gradient at which its force stops growing, in windows per voxel of a "
           "level, > 0");
    number("--mass", p_.mass, "Mass of a vertex, > 0");
    number("--damping", p_.damping, "Friction gamma, mass per time, >= 0");
    number("--time-step", p_.time_step, "Time of an iteration, > 0; lowered where unstable");
    number("--max-move", p_.max_move,
           "Bound of a vertex's movement in an iteration, in units of delta, above 0, at most 1");
    choice(
        "--bound", kBounds, p_.bound,
        "How movements are bounded: each vertex (clamp) or the time step by the fastest (scale)");
    number("--calm-speed", p_.calm_speed,
           "A level has converged only when also no vertex is as fast as this, in units of delta "
           "per time; 0: not asked");
    number("--epsilon", p_.epsilon,
           "A level has converged when its mean kinetic energy along normals, in units of mass * "
           "(delta / time step)^2, falls below this; above 0, at most 1");
    text("--max-iterations", "N", std::to_string(p_.max_iterations),
         "Iterations of a level at most, >= 1; the full image may take as many again after late "
         "bubbles",
         [&p = p_](const std::string& s) { p.max_iterations = to_integer("--max-iterations", s); });
    flag(
        "--no-late-bubbles", [&p = p_] { p.late_bubbles = 0; },
        "Start no bubbles in parts and cavities that a level's surface has missed (the paper's "
        "behaviour); with --force gradient alone there are none");
    flag(
        "--no-sleeping", [&p = p_] { p.sleeping = 0; },
        "Move all vertices in every iteration, those too where nothing has moved for long");
  }

  void machine() {
    group_ = "Machine";
    text("--threads", "N", "one per core", "Threads, 1 .. 1024; results do not depend on it",
         [&options = options_](const std::string& s) {
           options.context.threads = to_integer("--threads", s);
           if (options.context.threads < 1) refuse_value("--threads", s, "at least 1");
         });
    text("--memory", "SIZE", "",
         "Memory of the whole process, as in 4G or 512M. OME-Zarr, and NIfTI, NRRD and MetaImage "
         "that are not packed, are then read by bricks, and may be larger than memory; other "
         "images are read whole. The same bits",
         [&options = options_](const std::string& s) { options.memory = to_bytes("--memory", s); });
    choice("--simd", kSimds, options_.context.simd, "Instruction set; results do not depend on it");
  }

 private:
  CLI::Option* text(const std::string& name, const std::string& type, const std::string& fallback,
                    const std::string& meaning,
                    const std::function<void(const std::string&)>& read) {
    return command_.add_option_function<std::string>(name, read, meaning)
        ->type_name(type)
        ->default_str(fallback)
        ->group(group_);
  }

  CLI::Option* file(const std::string& name, std::string& path, const std::string& meaning) {
    return command_.add_option(name, path, meaning)->type_name("FILE")->group(group_);
  }

  CLI::Option* flag(const std::string& name, const std::function<void()>& set,
                    const std::string& meaning) {
    return command_.add_flag_callback(name, set, meaning)->group(group_);
  }

  CLI::Option* number(const std::string& name, double& value, const std::string& meaning) {
    return text(name, "VALUE", text_of(value), meaning,
                [name, &value](const std::string& s) { value = to_number(name, s); });
  }

  template <typename T>
  void choice(const std::string& name, const Choices<T>& choices, T& value,
              const std::string& meaning) {
    text(name, names_of(choices), name_of(value, choices), meaning,
         [name, &choices, &value](const std::string& s) { value = to_choice(name, s, choices); });
  }

  CLI::App& command_;
  ExtractOptions& options_;
  plc_parameters& p_;
  std::string group_;  // of the help that the next options stand in
};

}  // namespace

ExtractOptions::ExtractOptions() {
  plc_parameters_defaults(&parameters);
  plc_context_options_defaults(&context);
}

std::string rest_length_text(const plc_parameters& parameters) {
  if (parameters.rest_length == PLC_REST_VALUE) return text_of(parameters.rest_length_value);
  return name_of(parameters.rest_length, kRestLengths);
}

std::string init_text(const ExtractOptions& o) {
  const plc_parameters& p = o.parameters;
  switch (p.init) {
    case PLC_INIT_BUBBLE:
      return "bubble";
    case PLC_INIT_BUBBLES:
      return "bubbles=" + std::to_string(p.bubbles[0]) + "," + std::to_string(p.bubbles[1]) + "," +
             std::to_string(p.bubbles[2]);
    case PLC_INIT_SEEDS: {
      std::string text;
      for (const plc_seed& s : o.seeds) {
        text += (text.empty() ? "seeds=" : ";") + text_of(s.centre[0]) + "," +
                text_of(s.centre[1]) + "," + text_of(s.centre[2]) + "," + text_of(s.radius);
      }
      return text;
    }
    case PLC_INIT_ISO:
      return "iso";
    case PLC_INIT_MASK:
      return "mask=" + o.init_file;
    case PLC_INIT_MESH:
      return "mesh=" + o.init_file;
    case PLC_INIT_AUTO:
      return "auto";
  }
  return "?";
}

void add_extract_options(CLI::App& command, ExtractOptions& options) {
  Declarations declare(command, options);
  declare.files();
  declare.quality();
  declare.object();
  declare.region();
  declare.feature();
  declare.pyramid();
  declare.model();
  declare.machine();
  command
      .add_option_function<std::vector<std::string>>(
          "--structure",
          [&options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) options.structure_texts.push_back(text);
          },
          "One of several structures of the image: NAME=OPTIONS, written to OUTPUT-NAME.SUFFIX; "
          "OPTIONS are those of extract that tell the object, the pyramid and the model, on top "
          "of the others. May be given several times")
      ->type_name("NAME=OPTIONS")
      ->expected(1)
      ->group("Object")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void read_structures(ExtractOptions& options) {
  if (!options.structure_texts.empty() && options.isos.size() > 1) {
    throw CLI::ValidationError("--structure", "not together with several values of --iso");
  }
  for (const std::string& text : options.structure_texts) {
    const size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || text.find('/') < equals) {
      refuse_value("--structure", text, "NAME=OPTIONS");
    }
    ExtractOptions own = options;
    CLI::App app;
    Declarations declare(app, own);
    declare.quality();
    declare.object();
    declare.feature();
    declare.pyramid();
    declare.model();
    const std::string name = text.substr(0, equals);
    try {
      app.parse(text.substr(equals + 1));
    } catch (const CLI::ParseError& e) {
      throw CLI::ValidationError("--structure " + name, e.what());
    }
    if (own.isos.size() > 1) refuse_value("--structure", text, "one iso-value");
    if (own.attach != options.attach || own.init_file != options.init_file ||
        own.seeds.size() != options.seeds.size()) {
      refuse_value("--structure", text, "seeds, files of --init and --attach outside of it");
    }
    options.structures.push_back(
        {name, own.parameters, own.isos.empty() ? IsoChoice{} : own.isos[0]});
  }
}

}  // namespace plc::tools

#include "tools/command/command_phantom.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "tools/command/option_values.h"
#include "tools/file/path_suffix.h"
#include "tools/volume/ome_zarr_write.h"

namespace plc::tools {

namespace {

const Choices<plc_voxel_type> kTypes = {
    {"u8", PLC_U8}, {"i16", PLC_I16}, {"u16", PLC_U16}, {"i32", PLC_I32}, {"f32", PLC_F32}};

std::string names() {
  std::string text;
  for (const std::string& name : phantom_names()) text += (text.empty() ? "" : ", ") + name;
  return text;
}

uint64_t to_seed(const std::string& text) {
  uint64_t seed = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, seed);
  if (error != std::errc() || end != last) {
    refuse_value("--seed", text, "an integer from 0 to 2^64 - 1");
  }
  return seed;
}

class Declarations {
 public:
  Declarations(CLI::App& command, PhantomArguments& arguments)
      : command_(command), arguments_(arguments), o_(arguments.options) {}

  void files() {
    command_.add_option("KIND", arguments_.kind, "One of " + names())
        ->required()
        ->type_name("")
        ->check([](const std::string& kind) -> std::string {
          const auto& known = phantom_names();
          if (std::find(known.begin(), known.end(), kind) != known.end()) return "";
          return "'" + kind + "' is not one of " + names();
        });
    command_
        .add_option("-o,--output", arguments_.output,
                    "Volume to write, by suffix: .nrrd, .mha, .mhd, .ome.zarr (packed)")
        ->required()
        ->type_name("FILE");
  }

  void grid() {
    text("--size", "NX,NY,NZ", "the phantom's own", "Voxels, or one number for a cube",
         [&o = o_](const std::string& s) {
           auto n = to_integers("--size", s, 0);
           if (n.size() == 1) n.resize(3, n[0]);
           if (n.size() != 3) refuse_value("--size", s, "one integer or three");
           for (size_t i = 0; i < 3; ++i) o.size[i] = n[i];
         });
    text("--spacing", "X,Y,Z",
         text_of(o_.spacing[0]) + "," + text_of(o_.spacing[1]) + "," + text_of(o_.spacing[2]),
         "Millimetres between voxels; the shapes are round in mm", [&o = o_](const std::string& s) {
           const auto v = to_numbers("--spacing", s, 3);
           std::copy(v.begin(), v.end(), o.spacing);
         });
    text("--type", "u8|i16|u16|i32|f32", "the phantom's own",
         "Voxel type; full scale is 255 in u8, 1000 in the other integer types, 1 in f32",
         [&o = o_](const std::string& s) { o.type = to_choice("--type", s, kTypes); });
  }

  void shape() {
    text("--noise", "SIGMA", "the phantom's own", "Noise added, in units of full scale, >= 0",
         [&o = o_](const std::string& s) { o.noise = to_number("--noise", s); });
    text("--seed", "N", std::to_string(o_.seed), "Seed of shapes and noise",
         [&o = o_](const std::string& s) { o.seed = to_seed(s); });
    text("--count", "N", "the phantom's own", "Blobs, trees of vessels, or cells of labels",
         [&o = o_](const std::string& s) { o.count = to_integer("--count", s); });
    text("--depth", "N", "the phantom's own", "Recursion of sierpinski, branching of vessels",
         [&o = o_](const std::string& s) { o.depth = to_integer("--depth", s); });
  }

 private:
  void text(const std::string& name, const std::string& type, const std::string& fallback,
            const std::string& meaning, const std::function<void(const std::string&)>& read) {
    command_.add_option_function<std::string>(name, read, meaning)
        ->type_name(type)
        ->default_str(fallback);
  }

  CLI::App& command_;
  PhantomArguments& arguments_;
  PhantomOptions& o_;
};

}  // namespace

void add_phantom_options(CLI::App& command, PhantomArguments& arguments) {
  Declarations declare(command, arguments);
  declare.files();
  declare.grid();
  declare.shape();
}

int run_phantom(const PhantomArguments& arguments) {
  if (path_suffix(arguments.output) == ".zarr") {
    // Planes by planes, whatever its size.
    PhantomOptions options = arguments.options;
    std::optional<OmeZarrWriter> writer;
    options.take_planes = [&](const plc_image& whole, std::span<const std::byte> planes) {
      if (!writer) writer.emplace(arguments.output, whole);
      writer->add(planes);
    };
    make_phantom(arguments.kind, options);
    writer->commit();
    return 0;
  }
  const LoadedVolume volume = make_phantom(arguments.kind, arguments.options);
  write_volume(arguments.output, volume.image);
  return 0;
}

}  // namespace plc::tools

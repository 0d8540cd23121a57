#include "tools/command/command_render.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "tools/command/option_values.h"
#include "tools/file/apart.h"
#include "tools/file/atomic_file.h"
#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"
#include "tools/render/render_png.h"

namespace plc::tools {

namespace {

constexpr int kMinSize = 16;
constexpr int kMaxSize = 8192;
constexpr int kMontageColumns = 3;
constexpr int kMontageRows = 2;

const Choices<View> kViews = {{"front", {0, 0}},   {"left", {90, 0}}, {"back", {180, 0}},
                              {"right", {270, 0}}, {"top", {0, 90}},  {"bottom", {0, -90}}};

Picture montage(const Renderer& renderer, int size) {
  const int tile = size / kMontageColumns;
  Picture picture(kMontageColumns * tile, kMontageRows * tile);
  int i = 0;
  for (const auto& named : kViews) {
    renderer.draw(named.second, picture, i % kMontageColumns * tile, i / kMontageColumns * tile,
                  tile);
    ++i;
  }
  return picture;
}

Picture drawn(const TriangleMesh& mesh, const RenderOptions& options) {
  const Renderer renderer(options.mesh, mesh);
  if (options.montage) return montage(renderer, options.size);
  Picture picture(options.size, options.size);
  renderer.draw(options.view, picture, 0, 0, options.size);
  return picture;
}

// Many times what they take. Memory is not limited: each of the ray tracer's threads reserves some.
ApartLimits limits_for(const TriangleMesh& mesh, const RenderOptions& options) {
  constexpr double kSecondsPerPixel = 1e-4;
  constexpr double kSecondsPerCorner = 1e-5;
  const double pixels = static_cast<double>(options.size) * options.size;
  return {10 + kSecondsPerPixel * pixels + kSecondsPerCorner * static_cast<double>(mesh.abc.size()),
          kTooLarge};
}

void check_png_path(const std::string& path) {
  const auto dot = path.rfind('.');
  if (dot == std::string::npos || path.substr(dot) != ".png") {
    throw Failure{path + ": a picture's name must end in .png"};
  }
  const AtomicFile probe(path);
}

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
  command.add_option("MESH", options.mesh, mesh_suffixes(MeshUse::kRead) + "; its z axis is up")
      ->required()
      ->type_name("");
  command.add_option("-o,--output", options.output, "Picture to write, .png")
      ->required()
      ->type_name("FILE");
  const auto text = [&](const std::string& name, const std::string& type,
                        const std::string& fallback, const std::string& meaning, auto read) {
    return command.add_option_function<std::string>(name, read, meaning)
        ->type_name(type)
        ->default_str(fallback);
  };
  auto* view = text("--view", "front|left|back|right|top|bottom", "front",
                    "Side that is looked at; front is -y",
                    [&](const std::string& s) { options.view = to_choice("--view", s, kViews); });
  text("--azimuth", "DEGREES", "0", "Direction that is looked from: 0 front, 90 left, 180 back",
       [&](const std::string& s) { options.view.azimuth = to_number("--azimuth", s); })
      ->excludes(view);
  text("--elevation", "DEGREES", "0", "90 looks from the top, -90 from the bottom",
       [&](const std::string& s) {
         options.view.elevation = to_number("--elevation", s);
         if (options.view.elevation < -90 || options.view.elevation > 90) {
           refuse_value("--elevation", s, "within -90 .. 90");
         }
       })
      ->excludes(view);
  text("--size", "PIXELS", std::to_string(options.size), "Width of the picture",
       [&](const std::string& s) {
         options.size = to_integer("--size", s);
         if (options.size < kMinSize || options.size > kMaxSize) {
           refuse_value("--size", s,
                        "within " + std::to_string(kMinSize) + " .. " + std::to_string(kMaxSize));
         }
       });
  command.add_flag("--montage", options.montage, "All six sides in one picture, 3 by 2")
      ->excludes(view);
}

int run_render(const RenderOptions& options) {
  check_png_path(options.output);
  const TriangleMesh mesh = read_mesh(options.mesh);
  Parcel parcel = apart(options.mesh, "cannot be drawn", limits_for(mesh, options), [&] {
    Picture picture = drawn(mesh, options);
    const int size[2] = {picture.width, picture.height};
    return Parcel{std::string(reinterpret_cast<const char*>(size), sizeof size),
                  std::move(picture.rgb)};
  });
  int size[2] = {0, 0};
  std::memcpy(size, parcel.text.data(), std::min(parcel.text.size(), sizeof size));
  const Picture picture(size[0], size[1], std::move(parcel.bytes));
  if (picture.rgb.empty() || picture.rgb.size() != pixel_bytes(size[0], size[1])) {
    throw Failure{options.mesh + ": cannot be drawn"};
  }
  write_png(options.output, picture);
  return 0;
}

}  // namespace plc::tools

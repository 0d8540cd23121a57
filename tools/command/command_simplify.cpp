#include "tools/command/command_simplify.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "engine/pellicle.h"
#include "tools/command/clock.h"
#include "tools/command/engine_handles.h"
#include "tools/command/mesh_precision.h"
#include "tools/command/option_values.h"
#include "tools/file/failure.h"
#include "tools/mesh/mesh_io.h"
#include "tools/volume/mesh_spaces.h"

namespace plc::tools {

namespace {

struct Telling {
  ProgressLine line;
  double start = now();
};

int on_progress(double fraction, void* user) {
  auto& telling = *static_cast<Telling*>(user);
  char text[48];
  std::snprintf(text, sizeof text, "simplified: %.0f %%", 100 * fraction);
  telling.line.update(text, fraction, now() - telling.start);
  return 0;
}

// How far coordinates can move when the result is written: not at all where those of the mesh are
// floats, as the engine makes floats of floats.
double rounding_of(const TriangleMesh& mesh, double tolerance) {
  double largest = 0;
  bool floats = true;
  for (const double x : mesh.xyz) {
    largest = std::max(largest, std::abs(x));
    floats = floats && static_cast<double>(static_cast<float>(x)) == x;
  }
  constexpr double kHalfDigit = 0x1p-24;  // of a float
  return floats ? 0 : std::sqrt(3.0) * kHalfDigit * (largest + tolerance);
}

void simplify(plc_context* context, TriangleMesh& mesh, const SimplifyOptions& options,
              plc_simplified& told) {
  const double rounding = rounding_of(mesh, options.tolerance);
  if (options.tolerance <= rounding) {
    throw Failure{
        "--tolerance: no more than what is rounded where coordinates are written as "
        "floats"};
  }
  Telling telling{ProgressLine(options.quiet ? Progress::kNone : Progress::kText)};
  plc_simplify_options how;
  plc_simplify_options_defaults(&how);
  how.tolerance = options.tolerance - rounding;
  how.one_sided = options.one_sided ? 1 : 0;
  how.progress = on_progress;
  how.progress_user = &telling;
  TriangleMesh result;
  result.space = mesh.space;
  result.xyz.resize(mesh.xyz.size());
  result.abc.resize(mesh.abc.size());
  plc_simplified_defaults(&told);
  const plc_status status = plc_mesh_simplify(
      context, mesh.xyz.data(), static_cast<int64_t>(mesh.xyz.size() / 3), mesh.abc.data(),
      static_cast<int64_t>(mesh.abc.size() / 3), &how, result.xyz.data(), result.abc.data(), &told);
  if (status != PLC_OK) throw Failure{options.mesh + ": " + plc_context_message(context)};
  result.xyz.resize(3 * static_cast<size_t>(told.vertices));
  result.abc.resize(3 * static_cast<size_t>(told.faces));
  told.from_at_most += rounding;
  told.to_at_most += rounding;
  mesh = std::move(result);
}

// As %g, but never less than the value.
double rounded_up(double value) {
  return value * (1 + 1e-5);
}

}  // namespace

void add_simplify_options(CLI::App& command, SimplifyOptions& options) {
  command
      .add_option(
          "MESH", options.mesh,
          "Closed, oriented mesh that does not meet itself: " + mesh_suffixes(MeshUse::kRead))
      ->required()
      ->type_name("");
  command
      .add_option("-o,--output", options.output,
                  "Mesh to write, by suffix: " + mesh_suffixes(MeshUse::kWritten))
      ->required()
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--tolerance",
          [&](const std::string& s) {
            options.tolerance = to_number("--tolerance", s);
            if (!(options.tolerance > 0)) refuse_value("--tolerance", s, "a number above 0");
          },
          "No place of either mesh is farther from the other one, in the unit of the mesh")
      ->required()
      ->type_name("MM");
  command.add_flag("--one-sided", options.one_sided,
                   "Places of the result alone are within the tolerance of MESH");
  command.add_flag("--quiet", options.quiet, "No progress and no summary");
}

int run_simplify(const SimplifyOptions& options) {
  check_mesh_path(options.output);
  plc_context_options context_options;
  plc_context_options_defaults(&context_options);
  const ContextHandle context = make_context(context_options);
  TriangleMesh mesh = read_mesh(options.mesh);
  const size_t vertices = mesh.xyz.size() / 3, faces = mesh.abc.size() / 3;
  if (!mesh.scalars.empty()) {
    std::fprintf(stderr, "pellicle: %s: without the values at vertices of %s\n",
                 options.output.c_str(), options.mesh.c_str());
  }
  plc_simplified told;
  simplify(context.get(), mesh, options, told);
  settle_surface(context.get(), mesh, space_named(mesh.space).value_or(PLC_SPACE_LPS),
                 options.output);
  write_mesh(options.output, mesh);
  tell_precision(mesh.doubles, options.output);
  if (options.quiet) return 0;
  std::printf("surface  %lld of %zu vertices, %lld of %zu faces\n",
              static_cast<long long>(told.vertices), vertices, static_cast<long long>(told.faces),
              faces);
  std::printf("distance at most %.6g from %s, at most %.6g from it to %s\n",
              rounded_up(told.from_at_most), options.mesh.c_str(), rounded_up(told.to_at_most),
              options.output.c_str());
  std::printf("written  %s\n", options.output.c_str());
  return 0;
}

}  // namespace plc::tools

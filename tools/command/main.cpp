// The `pellicle` command. Exit codes: 0 done, 1 a mesh or result is not valid, 2 bad usage or
// input, 130 interrupted or stdout closed early. Every error is one line on stderr.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "engine/pellicle.h"
#include "tools/command/command_blocks.h"
#include "tools/command/command_check.h"
#include "tools/command/command_cohort.h"
#include "tools/command/command_extract.h"
#include "tools/command/command_info.h"
#include "tools/command/command_labels.h"
#include "tools/command/command_measure.h"
#include "tools/command/command_mesh.h"
#include "tools/command/command_phantom.h"
#include "tools/command/command_render.h"
#include "tools/command/command_simplify.h"
#include "tools/command/command_view.h"
#include "tools/command/interrupt.h"
#include "tools/command/manual_page.h"
#include "tools/command/option_values.h"
#include "tools/command/slicer_description.h"
#include "tools/file/failure.h"

namespace {

using namespace plc::tools;

constexpr int kExitBad = 2;
constexpr size_t kHelpColumn = 34;

int fail(std::string message) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  std::fprintf(stderr, "pellicle: %s\n", message.c_str());
  return kExitBad;
}

// The exit code when all that was written to stdout has to be there, too.
int finished(int code, InterruptGuard& interrupt) {
  interrupt.end_at_once();
  errno = 0;
  std::cout.flush();
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
  if (interrupt.pipe_closed()) return interrupt.tell();
  if (written) return code;
  // Where an earlier flush failed, its cause is not known any more.
  const std::string cause = errno != 0 ? ": " + std::generic_category().message(errno) : "";
  return fail("standard output: cannot be written" + cause);
}

class Command {
 public:
  explicit Command(InterruptGuard& interrupt) : interrupt_(interrupt) {
    app_.set_version_flag("--version", plc_version_string());
    add_manual_option(app_);
    app_.require_subcommand(1);
    app_.get_formatter()->column_width(kHelpColumn);
    extract_ = add("extract", "Extract a closed surface from a volume");
    info_ = add("info", "Tell what an image or a mesh is");
    check_ = add("check", "Tell what a mesh is and whether it is a valid closed surface");
    measure_ = add("measure", "Measure a mesh: volumes, moments, curvatures, geodesics, distances");
    mesh_ = add("mesh", "Convert a mesh, keep parts of it, merge several");
    simplify_ = add("simplify", "Make a mesh of fewer vertices, within a distance that is proved");
    phantom_ = add("phantom", "Write a synthetic test volume");
    render_ = add("render", "Draw a shaded picture of a mesh");
    view_ = add("view", "Write a page that shows an image and surfaces in any browser");
    cohort_ =
        add("cohort", "Extract surfaces from many scans, in shares, on a laptop or a cluster");
    blocks_ = add("blocks", "Extract one surface from one large image in tasks, on many machines");
    add_extract_options(*extract_, extract_options_);
    add_label_options(*extract_, extract_options_);
    add_slicer_option(*extract_);
    add_info_options(*info_, info_options_);
    add_check_options(*check_, check_options_);
    add_measure_options(*measure_, measure_options_);
    add_mesh_options(*mesh_, mesh_options_);
    add_simplify_options(*simplify_, simplify_options_);
    add_phantom_options(*phantom_, phantom_arguments_);
    add_render_options(*render_, render_options_);
    add_view_options(*view_, view_options_);
    add_cohort_options(*cohort_, cohort_options_);
    add_block_options(*blocks_, block_options_);
    for (CLI::App* group : {cohort_, blocks_}) {
      for (CLI::App* command : group->get_subcommands({})) demand_file_names(*command);
    }
    for (CLI::App* command :
         {extract_, info_, check_, measure_, mesh_, simplify_, phantom_, render_, view_}) {
      demand_file_names(*command);
    }
  }

  int run(int argc, char** argv) {
    try {
      std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
      if (!arguments.empty() && arguments[0] == extract_->get_name())
        accept_slicer_names(arguments);
      std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
      app_.parse(std::move(arguments));
      read_structures(extract_options_);
    } catch (const CLI::Success& e) {
      return app_.exit(e);  // --help, --version, --xml
    } catch (const CLI::ParseError& e) {
      const auto unknown = app_.remaining();
      if (app_.get_subcommands().empty() && !unknown.empty()) {
        return fail(unknown[0] +
                    ": unknown command; extract, info, check, measure, mesh, simplify, phantom, "
                    "render, view, cohort or blocks");
      }
      if (blocks_->parsed() && blocks_->get_subcommands().empty()) {
        return fail(
            "blocks: what is to be done is one of plan, run, status, submit, check, mesh or "
            "precomputed");
      }
      if (cohort_->parsed() && cohort_->get_subcommands().empty()) {
        return fail("cohort: what is to be done is one of plan, run, status, collect or submit");
      }
      return fail(e.what());
    }
    if (extract_->parsed()) return run_extract(extract_options_, interrupt_);
    if (info_->parsed()) return run_info(info_options_);
    if (check_->parsed()) return run_check(check_options_);
    if (measure_->parsed()) return run_measure(measure_options_);
    if (mesh_->parsed()) return run_mesh(mesh_options_);
    if (simplify_->parsed()) return run_simplify(simplify_options_);
    if (phantom_->parsed()) return run_phantom(phantom_arguments_);
    if (render_->parsed()) return run_render(render_options_);
    if (cohort_->parsed()) return run_cohort_command(*cohort_, cohort_options_, interrupt_);
    if (blocks_->parsed()) return run_block_command(*blocks_, block_options_, interrupt_);
    return run_view(view_options_);
  }

 private:
  CLI::App* add(const std::string& name, const std::string& meaning) {
    return app_.add_subcommand(name, meaning);
  }

  InterruptGuard& interrupt_;
  CLI::App app_{"Closed, oriented, intersection-free triangulated surfaces from 3D images",
                "pellicle"};
  CLI::App* extract_ = nullptr;
  CLI::App* info_ = nullptr;
  CLI::App* check_ = nullptr;
  CLI::App* measure_ = nullptr;
  CLI::App* mesh_ = nullptr;
  CLI::App* simplify_ = nullptr;
  CLI::App* phantom_ = nullptr;
  CLI::App* render_ = nullptr;
  CLI::App* view_ = nullptr;
  CLI::App* cohort_ = nullptr;
  CLI::App* blocks_ = nullptr;
  ExtractOptions extract_options_;
  InfoOptions info_options_;
  CheckOptions check_options_;
  MeasureOptions measure_options_;
  MeshOptions mesh_options_;
  SimplifyOptions simplify_options_;
  PhantomArguments phantom_arguments_;
  RenderOptions render_options_;
  ViewOptions view_options_;
  CohortOptions cohort_options_;
  BlockOptions block_options_;
};

}  // namespace

int main(int argc, char** argv) {
  InterruptGuard interrupt;
  std::signal(SIGXFSZ, SIG_IGN);  // a file too large for its limit fails as a full disk does
  try {
    return finished(Command(interrupt).run(argc, argv), interrupt);
  } catch (const Failure& failure) {
    return fail(failure.message);
  } catch (const std::bad_alloc&) {
    return fail("out of memory");
  } catch (const std::exception& e) {
    return fail(e.what());
  }
}

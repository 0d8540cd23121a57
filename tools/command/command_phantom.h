// `pellicle phantom`: synthetic volumes to try things on.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/phantom/phantoms.h"

namespace plc::tools {

struct PhantomArguments {
  std::string kind;
  std::string output;
  PhantomOptions options;
};

void add_phantom_options(CLI::App& command, PhantomArguments& arguments);

// Returns the exit code. Throws Failure.
int run_phantom(const PhantomArguments& arguments);

}  // namespace plc::tools

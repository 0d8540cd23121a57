// The manual page of the command, made of its options.
#pragma once
#include <CLI/CLI.hpp>

namespace plc::tools {

// Declares --man on the whole command, which prints the page; `app` must outlive parsing.
void add_manual_option(CLI::App& app);

}  // namespace plc::tools

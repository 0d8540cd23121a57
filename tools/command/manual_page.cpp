#include "tools/command/manual_page.h"

#include <algorithm>
#include <string>
#include <vector>

#include "engine/pellicle.h"

namespace plc::tools {

namespace {

// As troff takes it: a hyphen that is one, and no line that begins with a command.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) {
      out += std::string("\\&") + c;
    } else {
      out += c;
    }
  }
  return out;
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}

std::string names_of(const CLI::Option& option) {
  std::string names;
  for (const std::string& name : option.get_snames()) names += bold("-" + name) + ", ";
  for (const std::string& name : option.get_lnames()) names += bold("--" + name) + ", ";
  if (names.empty()) return bold(option.get_single_name());
  names.resize(names.size() - 2);
  return names;
}

std::string entry_of(const CLI::Option& option) {
  std::string text = ".TP\n" + names_of(option);
  const bool takes_value = option.get_items_expected_max() != 0;
  const std::string type = takes_value ? option.get_type_name() : "";
  if (!type.empty()) text += " \\fI" + escaped(type) + "\\fR";
  text += "\n" + escaped(option.get_description()) + ".";
  const std::string fallback = takes_value ? option.get_default_str() : "";
  if (!fallback.empty()) text += " Default: " + escaped(fallback) + ".";
  return text + "\n";
}

std::string command_text(const CLI::App& command) {
  std::vector<std::string> groups;
  for (const CLI::Option* option : command.get_options()) {
    const std::string& group = option->get_positional() ? "" : option->get_group();
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  std::string text = ".SH PELLICLE " + escaped(command.get_name()) + "\n" +
                     escaped(command.get_description()) + ".\n";
  for (const std::string& group : groups) {
    if (!group.empty() && groups.size() > 2) text += ".SS " + escaped(group) + "\n";
    for (const CLI::Option* option : command.get_options()) {
      if ((option->get_positional() ? "" : option->get_group()) == group) text += entry_of(*option);
    }
  }
  return text;
}

std::string page_of(const CLI::App& app) {
  std::string text =
      ".TH PELLICLE 1 \"\" \"Pellicle " + std::string(plc_version_string()) +
      "\" \"User Commands\"\n.SH NAME\npellicle \\- " +
      "closed, oriented, intersection\\-free triangulated surfaces from 3D images\n" +
      ".SH SYNOPSIS\n";
  std::string list;
  std::string details;
  for (const CLI::App* command : app.get_subcommands({})) {
    std::string positional;
    for (const CLI::Option* option : command->get_options()) {
      if (option->get_positional()) positional += " \\fI" + option->get_single_name() + "\\fR";
    }
    text += std::string(list.empty() ? "" : ".br\n") + ".B pellicle " + command->get_name() + "\n" +
            positional.substr(positional.empty() ? 0 : 1) + " [\\fIOPTION\\fR]...\n";
    list +=
        ".TP\n" + bold(command->get_name()) + "\n" + escaped(command->get_description()) + ".\n";
    details += command_text(*command);
  }
  text += ".SH DESCRIPTION\n" + escaped(app.get_description()) + ".\n" + list + details;
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : app.get_options()) text += entry_of(*option);
  return text +
         ".SH EXIT STATUS\n.TP\n0\nDone.\n.TP\n1\nA mesh is not valid.\n.TP\n2\nBad usage or "
         "input: one line on stderr tells, and nothing half-written is "
         "left.\n.TP\n130\nInterrupted, or "
         "nobody reads stdout.\n";
}

}  // namespace

void add_manual_option(CLI::App& app) {
  app.add_flag_callback(
      "--man", [&app] { throw CLI::CallForVersion(page_of(app), 0); },
      "Print the manual page, as man reads it");
}

}  // namespace plc::tools

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

// A command and what it is called by: "cohort plan" for one that stands under another.
struct Command {
  std::string name;
  const CLI::App* app;
};

std::vector<Command> commands_of(const CLI::App& app) {
  std::vector<Command> commands;
  for (const CLI::App* command : app.get_subcommands({})) {
    const auto under = command->get_subcommands({});
    if (under.empty()) commands.push_back({command->get_name(), command});
    for (const CLI::App* verb : under) {
      commands.push_back({command->get_name() + " " + verb->get_name(), verb});
    }
  }
  return commands;
}

// Whether `extract` has the same option; of commands that pass most of those on.
bool is_of_extract(const CLI::Option& option, const CLI::App& command, const CLI::App& app) {
  const CLI::App* extract = app.get_subcommand("extract");
  if (command.get_parent() == &app || option.get_lnames().empty()) return false;
  if (option.get_lnames()[0] == "help") return false;
  const CLI::Option* same = extract->get_option_no_throw("--" + option.get_lnames()[0]);
  return same != nullptr && same->get_description() == option.get_description();
}

std::string command_text(const Command& command, const CLI::App& app) {
  std::vector<const CLI::Option*> own;
  std::string passed_on;
  for (const CLI::Option* option : command.app->get_options()) {
    if (is_of_extract(*option, *command.app, app)) {
      passed_on += (passed_on.empty() ? "" : ", ") + names_of(*option);
    } else {
      own.push_back(option);
    }
  }
  std::vector<std::string> groups;
  const auto group_of = [](const CLI::Option* option) {
    return option->get_positional() ? std::string() : option->get_group();
  };
  for (const CLI::Option* option : own) {
    if (std::find(groups.begin(), groups.end(), group_of(option)) == groups.end()) {
      groups.push_back(group_of(option));
    }
  }
  std::string text = ".SH PELLICLE " + escaped(command.name) + "\n" +
                     escaped(command.app->get_description()) + ".\n";
  for (const std::string& group : groups) {
    if (!group.empty() && groups.size() > 2) text += ".SS " + escaped(group) + "\n";
    for (const CLI::Option* option : own) {
      if (group_of(option) == group) text += entry_of(*option);
    }
  }
  if (!passed_on.empty()) text += ".PP\nAs of pellicle extract: " + passed_on + ".\n";
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
  for (const Command& command : commands_of(app)) {
    std::string positional;
    for (const CLI::Option* option : command.app->get_options()) {
      if (option->get_positional()) positional += " \\fI" + option->get_single_name() + "\\fR";
    }
    text += std::string(list.empty() ? "" : ".br\n") + ".B pellicle " + command.name + "\n" +
            positional.substr(positional.empty() ? 0 : 1) + " [\\fIOPTION\\fR]...\n";
    list += ".TP\n" + bold(command.name) + "\n" + escaped(command.app->get_description()) + ".\n";
    details += command_text(command, app);
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

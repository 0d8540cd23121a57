#include "tools/command/slicer_description.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <set>

#include "engine/pellicle.h"

namespace plc::tools {

namespace {

// Slicer makes nodes of its scene from one output, in LPS, and tells its user the rest itself. It
// hands images on as NRRD. It passes on every choice and number, so that nothing would be left of
// what --quality sets.
const std::set<std::string> kLeftOut = {"--help",    "--xml",       "--xml-labels", "--space",
                                        "--report",  "--trace",     "--quiet",      "--each-level",
                                        "--attach",  "--structure", "--labels",     "--nifti-frame",
                                        "--quality", "--names",     "--merged",     "--table"};
// What the module of label images has: a surface of each, all in one mesh. Slicer passes on all
// that it shows, and labels exclude the rest.
const std::set<std::string> kOfLabels = {
    "--slicer-progress", "--labels",    "--names",  "--merged",  "--mesh", "--tolerance",
    "--edge-range",      "--curvature", "--spring", "--threads", "--simd"};
// Where what is shown first lies.
const std::set<std::string> kBasic = {"Files", "Object"};

// Where Slicer shows a slider, which ends at values that are of use, not where the engine's do.
struct Slider {
  const char* option;
  const char* minimum;
  const char* maximum;
  const char* step;
};
constexpr std::array<Slider, 9> kSliders = {{{"--sigma", "0", "10", "0.1"},
                                             {"--curvature", "0", "2", "0.01"},
                                             {"--spring", "0", "1", "0.005"},
                                             {"--gradient", "-2", "2", "0.01"},
                                             {"--gradient-tangent", "-2", "2", "0.01"},
                                             {"--damping", "0", "5", "0.05"},
                                             {"--max-move", "0.05", "1", "0.05"},
                                             {"--calm-speed", "0", "1", "0.001"},
                                             {"--max-iterations", "1", "10000", "1"}}};

constexpr size_t kDigits = 6;  // of a number that come through Slicer

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string element(const std::string& name, const std::string& text) {
  return "<" + name + ">" + escaped(text) + "</" + name + ">";
}

// --level-iso: level_iso, which is a name to Slicer.
std::string slicer_name(const CLI::Option& option) {
  std::string name = option.get_lnames().at(0);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// --level-iso: Level iso.
std::string label_of(const CLI::Option& option) {
  std::string label = option.get_lnames().at(0);
  std::replace(label.begin(), label.end(), '-', ' ');
  label[0] = static_cast<char>(label[0] - 'a' + 'A');
  return label;
}

// A number without an exponent: Slicer counts the digits behind the point to know how many to show.
// "" where the text is no number, or one of more digits than come through.
std::string plain_number(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (text.empty() || read.ec != std::errc() || read.ptr != end) return "";
  std::array<char, 64> shortest{};
  const auto written = std::to_chars(shortest.data(), shortest.data() + shortest.size(), value,
                                     std::chars_format::scientific);
  const std::string digits(shortest.data(), written.ptr);
  if (digits.find('e') > kDigits + 1) return "";
  std::array<char, 400> fixed{};
  const auto put =
      std::to_chars(fixed.data(), fixed.data() + fixed.size(), value, std::chars_format::fixed);
  return {fixed.data(), put.ptr};
}

// zero|mean, but not zero|mean|VALUE.
bool is_enumeration(const std::string& type) {
  const auto lower = [](char c) { return (c >= 'a' && c <= 'z') || c == '|' || c == '-'; };
  const auto lower_or_digit = [&](char c) { return lower(c) || (c >= '0' && c <= '9'); };
  return type.find('|') != std::string::npos &&
         std::all_of(type.begin(), type.end(), lower_or_digit);
}

std::string elements_of(const std::string& type) {
  std::string out;
  for (size_t begin = 0; begin <= type.size();) {
    const size_t end = std::min(type.find('|', begin), type.size());
    out += element("element", type.substr(begin, end - begin));
    begin = end + 1;
  }
  return out;
}

std::string constraints_of(const std::string& name) {
  for (const Slider& s : kSliders) {
    if (name != s.option) continue;
    return "<constraints>" + element("minimum", s.minimum) + element("maximum", s.maximum) +
           element("step", s.step) + "</constraints>";
  }
  return "";
}

// What every parameter of the module has.
std::string about(const CLI::Option& option, const std::string& description) {
  const std::string name = slicer_name(option);
  return element("name", name) + element("longflag", name) + element("label", label_of(option)) +
         element("description", description);
}

std::string parameter(const CLI::Option& option) {
  const std::string name = "--" + option.get_lnames().at(0);
  const std::string& meaning = option.get_description();
  const std::string type = option.get_type_name();
  const std::string common = about(option, meaning);
  if (name == "--slicer-progress") {
    return "<boolean hidden=\"true\">" + common + element("default", "true") + "</boolean>";
  }
  if (name == "--iso") {  // one surface, and Slicer has no number that is not set
    return "<double>" + about(option, meaning.substr(0, meaning.find(". "))) +
           element("default", "0") + "</double>";
  }
  if (option.get_items_expected_max() == 0) {
    return "<boolean>" + common + element("default", "false") + "</boolean>";
  }
  if (is_enumeration(type)) {
    return "<string-enumeration>" + common + element("default", option.get_default_str()) +
           elements_of(type) + "</string-enumeration>";
  }
  const std::string number = plain_number(option.get_default_str());
  if (!number.empty() && (type == "VALUE" || type == "N")) {
    const std::string tag = type == "N" ? "integer" : "double";
    return "<" + tag + ">" + common + element("default", number) + constraints_of(name) + "</" +
           tag + ">";
  }
  // Left empty Slicer does not pass it on, and it has its default.
  const std::string shown = option.get_default_str();
  return "<string>" +
         about(option, meaning + ". " + type + (shown.empty() ? "" : "; empty: " + shown)) +
         element("default", "") + "</string>";
}

// The image, and the mesh as Slicer has meshes in files: in LPS, which is the default of --space.
std::string files_of(const CLI::App& extract) {
  const CLI::Option& input = *extract.get_option("INPUT");
  const CLI::Option& output = *extract.get_option("--output");
  return "    <image type=\"scalar\">" + element("name", "input") + element("label", "Input") +
         element("description", input.get_description()) + element("channel", "input") +
         element("index", "0") + "</image>\n    <geometry type=\"model\" " +
         "fileExtensions=\".vtp,.ply,.stl,.obj\">" + about(output, output.get_description()) +
         element("channel", "output") + "</geometry>\n";
}

// The label image, the table of names, and all surfaces in one mesh, whose values are the labels.
std::string files_of_labels(const CLI::App& extract) {
  const auto about_of = [&](const char* name) {
    const CLI::Option& option = *extract.get_option(name);
    const std::string& meaning = option.get_description();
    return about(option, meaning.substr(0, meaning.find(". ")));
  };
  return "    <image type=\"label\">" + about_of("--labels") + element("channel", "input") +
         "</image>\n    <file fileExtensions=\".txt,.ctbl,.label,.lut\">" + about_of("--names") +
         element("channel", "input") + "</file>\n    <geometry type=\"model\" " +
         "fileExtensions=\".vtp\">" + about_of("--merged") + element("channel", "output") +
         "</geometry>\n";
}

struct Module {
  const char* title;
  const char* description;  // null: that of the command
  bool (*has)(const std::string& option);
  std::string (*files)(const CLI::App& extract);
};
constexpr Module kExtract = {"Pellicle Extract", nullptr,
                             [](const std::string& option) { return kLeftOut.count(option) == 0; },
                             files_of};
constexpr Module kLabels = {
    "Pellicle Labels", "Extract a closed surface around every label of a label image",
    [](const std::string& option) { return kOfLabels.count(option) > 0; }, files_of_labels};
// Files have elements of their own.
const std::set<std::string> kFiles = {"--output", "--labels", "--names", "--merged"};

std::string description_of(const CLI::App& extract, const Module& module) {
  std::vector<std::string> groups;
  for (const CLI::Option* option : extract.get_options()) {
    const std::string& group = option->get_group();
    if (option->get_lnames().empty() || !module.has("--" + option->get_lnames()[0])) continue;
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<executable>\n  " +
      element("category", "Surface Models") + "\n  " + element("title", module.title) + "\n  " +
      element("description", module.description == nullptr ? extract.get_description()
                                                           : std::string(module.description)) +
      "\n  " + element("version", plc_version_string()) + "\n";
  for (const std::string& group : groups) {
    xml += kBasic.count(group) > 0 ? "  <parameters>\n" : "  <parameters advanced=\"true\">\n";
    xml += "    " + element("label", group) + element("description", group) + "\n";
    if (group == "Files") xml += module.files(extract);
    for (const CLI::Option* option : extract.get_options()) {
      if (option->get_lnames().empty() || option->get_group() != group) continue;
      const std::string name = "--" + option->get_lnames()[0];
      if (module.has(name) && kFiles.count(name) == 0) xml += "    " + parameter(*option) + "\n";
    }
    xml += "  </parameters>\n";
  }
  return xml + "</executable>";
}

}  // namespace

void add_slicer_option(CLI::App& extract) {
  const auto add = [&extract](const char* name, const Module& module, const char* of) {
    extract
        .add_flag_callback(
            name, [&] { throw CLI::CallForVersion(description_of(extract, module), 0); },
            std::string("Print the description by which 3D Slicer makes a module of this command") +
                of)
        ->group("Files");
  };
  add("--xml", kExtract, "");
  add("--xml-labels", kLabels, ", with --labels");
}

void accept_slicer_names(std::vector<std::string>& arguments) {
  for (std::string& argument : arguments) {
    if (argument.rfind("--", 0) != 0) continue;
    std::replace(argument.begin(),
                 argument.begin() +
                     static_cast<std::ptrdiff_t>(std::min(argument.find('='), argument.size())),
                 '_', '-');
  }
}

}  // namespace plc::tools

#include "tools/command/attach_file.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tools/file/failure.h"
#include "tools/file/printable.h"

namespace plc::tools {

namespace {

class Line {
 public:
  Line(const std::string& path, size_t number, const std::string& text) : words_(text) {
    name_ = path + ": line " + std::to_string(number) + ": ";
  }

  // False where no word is left.
  bool word(std::string& text) { return static_cast<bool>(words_ >> text); }

  double number(const char* what) {
    std::string text;
    if (!word(text)) throw Failure{name_ + "no " + what};
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() + text.size() || !std::isfinite(value)) {
      throw Failure{name_ + what + " '" + printable(text) + "' is not a finite number"};
    }
    return value;
  }

  double positive(const char* what) {
    const double value = number(what);
    if (!(value > 0)) throw Failure{name_ + what + " must be above 0"};
    return value;
  }

  [[noreturn]] void fail_word(const std::string& text, const char* what) const {
    throw Failure{name_ + "'" + printable(text) + "' " + what};
  }

 private:
  std::istringstream words_;
  std::string name_;
};

}  // namespace

AttachFile read_attach_file(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Failure{path + ": cannot be read"};
  AttachFile places;
  std::string text;
  for (size_t number = 1; std::getline(file, text); ++number) {
    text = text.substr(0, text.find('#'));
    Line line(path, number, text);
    std::string kind;
    if (!line.word(kind)) continue;
    if (kind != "attach" && kind != "pin") line.fail_word(kind, "is neither attach nor pin");
    double place[3] = {line.number("x"), line.number("y"), line.number("z")};
    const double radius = line.positive("radius");
    std::string rest;
    if (kind == "pin") {
      places.pins.push_back({{place[0], place[1], place[2]}, radius});
    } else {
      double strength = 1;
      if (line.word(rest)) {
        Line last(path, number, rest);
        strength = last.positive("strength");
      }
      places.attachments.push_back({{place[0], place[1], place[2]}, radius, strength});
    }
    if (line.word(rest)) line.fail_word(rest, "is too much");
  }
  if (file.bad()) throw Failure{path + ": cannot be read"};
  if (places.attachments.empty() && places.pins.empty()) {
    throw Failure{path + ": neither an attach nor a pin line"};
  }
  return places;
}

}  // namespace plc::tools

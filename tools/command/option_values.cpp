#include "tools/command/option_values.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

namespace plc::tools {

namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::string list_of(size_t count, const std::string& what) {
  if (count == 0) return what + "s separated by commas";
  return std::to_string(count) + " " + what + "s separated by commas";
}

template <typename T>
bool parse(const std::string& text, T& value) {
  const char* first = text.data();
  const char* last = first + text.size();
  if (first != last && *first == '+') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last;
}

template <typename T>
std::vector<T> parse_list(const std::string& option, const std::string& text, size_t count,
                          const std::string& what) {
  std::vector<T> values;
  for (const std::string& part : split(text)) {
    T value{};
    if (!parse(part, value) || !std::isfinite(static_cast<double>(value))) {
      refuse_value(option, text, list_of(count, what));
    }
    values.push_back(value);
  }
  if (count != 0 && values.size() != count) refuse_value(option, text, list_of(count, what));
  return values;
}

}  // namespace

std::string text_of(double value) {
  if (std::isnan(value)) return "";
  char buffer[40];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

void demand_file_names(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    const std::string type = option->get_type_name();
    if (!option->get_positional() && type != "FILE" && type != "OTHER") continue;
    option->check([](const std::string& name) -> std::string {
      return name.empty() ? "the name of a file is empty" : "";
    });
  }
}

void refuse_value(const std::string& option, const std::string& text, const std::string& expected) {
  throw CLI::ValidationError(option, "'" + text + "' is not " + expected);
}

double to_number(const std::string& option, const std::string& text) {
  double value = 0;
  if (!parse(text, value) || !std::isfinite(value)) refuse_value(option, text, "a finite number");
  return value;
}

int to_integer(const std::string& option, const std::string& text) {
  int value = 0;
  if (!parse(text, value)) refuse_value(option, text, "an integer");
  return value;
}

int at_least(int least, const std::string& option, const std::string& text) {
  const int value = to_integer(option, text);
  if (value < least) refuse_value(option, text, "at least " + std::to_string(least));
  return value;
}

double above_zero(const std::string& option, const std::string& text) {
  const double value = to_number(option, text);
  if (!(value > 0)) refuse_value(option, text, "above 0");
  return value;
}

void to_share(const std::string& option, const std::string& text, int& part, int& parts) {
  const size_t slash = text.find('/');
  if (slash == std::string::npos) refuse_value(option, text, "I/N, as in 3/10");
  part = at_least(1, option, text.substr(0, slash));
  parts = at_least(1, option, text.substr(slash + 1));
  if (part > parts) refuse_value(option, text, "I/N with I not above N");
}

int64_t to_bytes(const std::string& option, const std::string& text) {
  constexpr std::string_view kUnits = "KMGT";
  constexpr double kMost = 1e18;
  std::string number = text;
  double bytes = 1;
  const size_t unit = text.empty() ? std::string::npos : kUnits.find(text.back());
  if (unit != std::string::npos) {
    number.pop_back();
    for (size_t i = 0; i <= unit; ++i) bytes *= 1024;
  }
  try {
    bytes *= to_number(option, number);
  } catch (const CLI::ValidationError&) {
    bytes = 0;
  }
  if (!(bytes >= 1 && bytes <= kMost)) refuse_value(option, text, "bytes, such as 512M or 4G");
  return static_cast<int64_t>(bytes);
}

std::vector<double> to_numbers(const std::string& option, const std::string& text, size_t count) {
  return parse_list<double>(option, text, count, "number");
}

std::vector<int> to_integers(const std::string& option, const std::string& text, size_t count) {
  return parse_list<int>(option, text, count, "integer");
}

}  // namespace plc::tools

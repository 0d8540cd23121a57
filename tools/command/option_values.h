// Values of command-line options, with errors that name the option, what was found and what was
// expected. All throw CLI::ValidationError.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace plc::tools {

// The shortest text that reads back as the value; "" for NaN.
std::string text_of(double value);

// Finite numbers only; the whole text must be one.
double to_number(const std::string& option, const std::string& text);
int to_integer(const std::string& option, const std::string& text);
int at_least(int least, const std::string& option, const std::string& text);
double above_zero(const std::string& option, const std::string& text);

// "I/N": the I-th of N shares, 1 <= I <= N.
void to_share(const std::string& option, const std::string& text, int& part, int& parts);

// Bytes: "4G", "512M", "100000"; K, M, G and T are powers of 1024.
int64_t to_bytes(const std::string& option, const std::string& text);

// Separated by commas. `count` 0: any number of them, at least one.
std::vector<double> to_numbers(const std::string& option, const std::string& text, size_t count);
std::vector<int> to_integers(const std::string& option, const std::string& text, size_t count);

// The command refuses an empty name for any of its files from now on: those are its positional
// arguments, and its options of type FILE and OTHER so far.
void demand_file_names(CLI::App& command);

[[noreturn]] void refuse_value(const std::string& option, const std::string& text,
                               const std::string& expected);

template <typename T>
using Choices = std::vector<std::pair<const char*, T>>;

template <typename T>
T to_choice(const std::string& option, const std::string& text, const Choices<T>& choices) {
  std::string expected;
  for (const auto& [name, value] : choices) {
    if (text == name) return value;
    expected += (expected.empty() ? "" : ", ") + std::string(name);
  }
  refuse_value(option, text, "one of " + expected);
}

template <typename T>
const char* name_of(const T& value, const Choices<T>& choices) {
  for (const auto& [name, v] : choices) {
    if (v == value) return name;
  }
  return "?";
}

}  // namespace plc::tools

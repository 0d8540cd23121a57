// Words and numbers of text formats; binary values of any byte order.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "tools/file/atomic_file.h"

namespace plc::tools {

// Reads words separated by white space; from `comment` to the end of a line is white space too.
// Throws Failure with the line's number.
class TextReader {
 public:
  TextReader(const std::string& path, std::string_view text, char comment = '\0', int line = 1)
      : path_(path), text_(text), comment_(comment), line_(line) {}

  bool at_end() { return !skip_space(true); }
  bool at_end_of_line() { return !skip_space(false); }
  void skip_line();
  // Bytes, not more than remain, that are no text.
  void skip(size_t bytes) { next_ += bytes; }
  std::string_view word();
  double real() { return to_real(word()); }
  int64_t integer() { return to_integer(word()); }
  double to_real(std::string_view word) const;
  int64_t to_integer(std::string_view word) const;
  size_t remaining() const { return text_.size() - next_; }
  size_t position() const { return next_; }
  int line() const { return line_; }
  [[noreturn]] void fail(const std::string& message) const;

 private:
  bool skip_space(bool across_lines);  // false: nothing is left
  const std::string& path_;
  std::string_view text_;
  size_t next_ = 0;
  char comment_;
  int line_;
};

// The value whose bytes begin at data, there in big endian where `big`.
template <typename T>
T load_value(const char* data, bool big) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), data, sizeof(T));
  if (big != (std::endian::native == std::endian::big)) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

// Appends the value in little endian.
template <typename T>
void put_value(std::string& out, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  out.append(bytes.data(), bytes.size());
}

// Nine significant digits: every float is read back as it was; as many as it takes where `exact`.
void put_real(std::string& out, double value, bool exact = false);
void put_integer(std::string& out, uint64_t value);

// Writes the text when there is much of it, or in any case where `all`.
void drain(AtomicFile& file, std::string& text, bool all = false);

}  // namespace plc::tools

#include "tools/file/text.h"

#include <charconv>

#include "tools/file/failure.h"
#include "tools/file/printable.h"

namespace plc::tools {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}

}  // namespace

bool TextReader::skip_space(bool across_lines) {
  while (next_ < text_.size()) {
    const char c = text_[next_];
    if (c == '\n') {
      if (!across_lines) return false;
      ++line_;
    } else if (comment_ != '\0' && c == comment_) {
      const size_t end = text_.find('\n', next_);
      next_ = end == std::string_view::npos ? text_.size() : end;
      continue;
    } else if (!is_space(c)) {
      return true;
    }
    ++next_;
  }
  return false;
}

void TextReader::skip_line() {
  const size_t end = text_.find('\n', next_);
  if (end == std::string_view::npos) {
    next_ = text_.size();
  } else {
    next_ = end + 1;
    ++line_;
  }
}

std::string_view TextReader::word() {
  if (!skip_space(true)) fail("ends too early");
  const size_t begin = next_;
  while (next_ < text_.size() && !is_space(text_[next_])) ++next_;
  return text_.substr(begin, next_ - begin);
}

double TextReader::to_real(std::string_view word) const {
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  double value = 0;
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  // Out of range is a denormal that became 0, or an infinity: both are values.
  if (result.ptr != digits.data() + digits.size() || result.ec == std::errc::invalid_argument) {
    fail("\"" + std::string(word.substr(0, 40)) + "\" is not a number");
  }
  return value;
}

int64_t TextReader::to_integer(std::string_view word) const {
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  int64_t value = 0;
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (result.ptr != digits.data() + digits.size() || result.ec != std::errc()) {
    fail("\"" + std::string(word.substr(0, 40)) + "\" is not a whole number");
  }
  return value;
}

void TextReader::fail(const std::string& message) const {
  std::string line = path_ + ": line " + std::to_string(line_) + ": " + message;
  std::replace_if(line.begin(), line.end(), is_control, '?');
  throw Failure{line};
}

void put_real(std::string& out, double value, bool exact) {
  char text[32];
  char* const end = text + sizeof text;
  const auto result = exact ? std::to_chars(text, end, value)
                            : std::to_chars(text, end, value, std::chars_format::general, 9);
  out.append(text, result.ptr);
}

void put_integer(std::string& out, uint64_t value) {
  char text[24];
  out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

void drain(AtomicFile& file, std::string& text, bool all) {
  constexpr size_t kMuch = size_t{1} << 16;
  if (!all && text.size() < kMuch) return;
  file.write(text);
  text.clear();
}

}  // namespace plc::tools

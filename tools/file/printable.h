// Text of a file in a message: one short line, whatever stands in the file.
#pragma once
#include <algorithm>
#include <string>
#include <string_view>

namespace plc::tools {

inline bool is_control(char c) {
  return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
}

inline bool is_printable(std::string_view text) {
  return std::none_of(text.begin(), text.end(), is_control);
}

inline std::string printable(std::string_view text) {
  constexpr size_t kLongest = 40;
  std::string out(text.substr(0, kLongest));
  std::replace_if(out.begin(), out.end(), is_control, '?');
  return out + (text.size() > kLongest ? "..." : "");
}

}  // namespace plc::tools

#include "tools/file/base64.h"

#include <algorithm>
#include <cstdint>

namespace plc::tools {

namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  return -1;
}

}  // namespace

std::string encode_base64(std::string_view data) {
  std::string out;
  out.reserve((data.size() + 2) / 3 * 4);
  for (size_t i = 0; i < data.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < data.size() ? static_cast<unsigned char>(data[i + k]) : 0U);
    }
    for (size_t k = 0; k < 4; ++k) {
      out += i + k > data.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
    }
  }
  return out;
}

std::string decode_base64(std::string_view text, size_t wanted) {
  std::string out;
  out.reserve(std::min(wanted, text.size() / 4 * 3) + 3);
  uint32_t group = 0;
  int digits = 0;
  int padding = 0;
  for (const char c : text) {
    if (out.size() >= wanted) break;
    if (c == '=') {
      ++padding;
    } else {
      const int digit = base64_digit(c);
      if (digit < 0) continue;  // white space
      group |= static_cast<uint32_t>(digit) << (18 - 6 * digits);
    }
    if (++digits < 4) continue;
    for (int k = 0; k < 3 - std::min(padding, 2); ++k) {
      out += static_cast<char>((group >> (16 - 8 * k)) & 0xffU);
    }
    group = 0;
    digits = padding = 0;
  }
  if (out.size() > wanted) out.resize(wanted);
  return out;
}

}  // namespace plc::tools

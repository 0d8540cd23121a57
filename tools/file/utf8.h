// Whether bytes are text in UTF-8, which JSON, XML and glTF take alone.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace plc::tools {

// Neither overlong forms nor halves of surrogates are.
inline bool is_utf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    const auto first = static_cast<uint8_t>(text[i]);
    const size_t more = first < 0x80   ? 0
                        : first < 0xC2 ? 4
                        : first < 0xE0 ? 1
                        : first < 0xF0 ? 2
                                       : 3;
    if (more == 4 || first > 0xF4 || i + more >= text.size()) return false;
    uint32_t code = more == 0 ? first : first & (0x3FU >> more);
    for (size_t k = 1; k <= more; ++k) {
      const auto next = static_cast<uint8_t>(text[i + k]);
      if ((next & 0xC0U) != 0x80) return false;
      code = code << 6U | (next & 0x3FU);
    }
    const bool overlong = (more == 2 && code < 0x800) || (more == 3 && code < 0x10000);
    if (overlong || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return false;
    i += more + 1;
  }
  return true;
}

}  // namespace plc::tools

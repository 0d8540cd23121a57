// Base64 as XML files of meshes have it. Ours, as none of the libraries that are linked decodes it
// as VTK writes it, in pieces.
#pragma once
#include <string>
#include <string_view>

namespace plc::tools {

std::string encode_base64(std::string_view data);

// The first `wanted` bytes, or fewer where the text ends. VTK encodes lengths and data apart, so
// padding ends a group of four digits but not the text. What is no digit is passed over.
std::string decode_base64(std::string_view text, size_t wanted);

}  // namespace plc::tools

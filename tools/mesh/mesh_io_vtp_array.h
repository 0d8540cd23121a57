// The data arrays of VTK's XML files.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace plc::tools {

// How the arrays of a file are stored.
struct VtpEncoding {
  bool big_endian = false;
  bool wide_header = false;  // lengths are UInt64 instead of UInt32
  bool compressed = false;   // by zlib, in blocks
};

struct VtpArray {
  std::string name, type, format;  // as in the file: "Float32"; "ascii", "binary" or "appended"
  int components = 1;
  std::string text;   // of the element: ascii or base64
  size_t offset = 0;  // into the appended data
};

// What stands after the underscore of AppendedData.
struct VtpAppended {
  std::string_view data;
  bool base64 = false;
};

// Whether values of a type are numbers that vtp_values() reads.
bool is_vtp_number(std::string_view type);

// The values of an array, whatever its type and encoding. `left`: how many bytes of the file arrays
// may still be made of, counted down: a thousand arrays that share their bytes would make much of
// little. Throws Failure.
std::vector<double> vtp_values(const std::string& path, const VtpEncoding& encoding,
                               const VtpAppended& appended, const VtpArray& array, uint64_t& left);

}  // namespace plc::tools

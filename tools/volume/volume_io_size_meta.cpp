// Does a MetaImage hold its voxels? They follow the header, or are in a file or files beside it.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <map>
#include <sstream>

#include "tools/file/failure.h"
#include "tools/file/printable.h"
#include "tools/volume/flat_file.h"
#include "tools/volume/volume_io_size.h"

namespace plc::tools {
namespace {

using Fields = std::map<std::string, std::string>;

// The lines "Key = value" up to ElementDataFile, which ends the header.
Fields meta_fields(std::ifstream& file) {
  const auto trimmed = [](const std::string& text) {
    constexpr const char* space = " \t\r";
    const size_t begin = text.find_first_not_of(space);
    if (begin == std::string::npos) return std::string();
    return text.substr(begin, text.find_last_not_of(space) - begin + 1);
  };
  constexpr int kMaxLines = 10000;
  Fields fields;
  std::string line;
  for (int i = 0; i < kMaxLines && std::getline(file, line); ++i) {
    const size_t split = line.find_first_of("=:");
    if (split == std::string::npos) continue;
    const std::string key = trimmed(line.substr(0, split));
    fields[key] = trimmed(line.substr(split + 1));
    if (key == "ElementDataFile") break;
  }
  return fields;
}

bool is_true(const std::string& value) {
  return !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1');
}

bool is_local(const std::string& data_name) {
  return data_name == "LOCAL" || data_name == "Local" || data_name == "local";
}

// A number of the header, `fallback` where it has none of that name.
int64_t whole(const std::string& path, const std::string& text, int64_t fallback) {
  if (text.empty()) return fallback;
  int64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc()) {
    throw Failure{path + ": its header has \"" + printable(text) + "\" for a number"};
  }
  return value;
}

// "LIST [2D]": names follow, a line each. Each file must be there: what is counted can be read.
void check_list(const std::string& path, std::ifstream& file, uint64_t needed) {
  uint64_t found = 0;
  std::string name;
  while (found < needed && std::getline(file, name)) {
    while (!name.empty() && std::isspace(static_cast<unsigned char>(name.back())) != 0) {
      name.pop_back();
    }
    found += size_of(beside(path, name));
  }
  require_bytes(path, found, needed);
}

// "slice%03d.raw [FIRST [LAST [STEP]]]"
void check_pattern(const std::string& path, const std::string& text, const ItkHeader& header,
                   uint64_t needed) {
  std::istringstream words(text);
  std::string pattern;
  int64_t first = 1;
  int64_t last = header.dims.back();
  int64_t step = 1;
  words >> pattern >> first >> last >> step;
  if (!is_numbered_name(pattern)) {
    throw Failure{path + ": its files are named by \"" + printable(pattern) +
                  "\", which is no name with one %d, %3d or %03d"};
  }
  if (step < 1 || first < 0 || last < first) throw Failure{path + ": its numbered files are none"};
  uint64_t found = 0;
  for (int64_t i = 0; i <= (last - first) / step && found < needed; ++i) {
    found += size_of(beside(path, numbered_name(pattern, first + i * step)));
  }
  require_bytes(path, found, needed);
}

}  // namespace

bool is_numbered_name(const std::string& pattern) {
  const size_t percent = pattern.find('%');
  if (percent == std::string::npos) return false;
  size_t end = percent + 1;
  while (end < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[end])) != 0) ++end;
  return end < pattern.size() && pattern[end] == 'd' && end - percent <= 3 &&
         pattern.find('%', end) == std::string::npos;
}

std::string numbered_name(const std::string& pattern, int64_t number) {
  const size_t percent = pattern.find('%');
  const size_t end = pattern.find('d', percent);
  const std::string width = pattern.substr(percent + 1, end - percent - 1);
  std::string digits = std::to_string(number);
  const size_t wanted = width.empty() ? 0 : static_cast<size_t>(std::stoi(width));
  const char fill = width.starts_with('0') ? '0' : ' ';
  if (digits.size() < wanted) digits.insert(0, wanted - digits.size(), fill);
  return pattern.substr(0, percent) + digits + pattern.substr(end + 1);
}

void check_meta_axes(const std::string& path) {
  constexpr double kMost =
      10;  // as its library has it, which reads more in time that grows with it
  std::ifstream file(path, std::ios::binary);
  const std::string text = meta_fields(file)["NDims"];
  double axes = 0;
  std::from_chars(text.data(), text.data() + text.size(), axes);
  if (axes > kMost) throw Failure{path + ": is " + printable(text) + "-D; a 3-D volume is needed"};
}

std::optional<FlatFile> flat_meta(const std::string& path, const ItkHeader& header) {
  std::ifstream file(path, std::ios::binary);
  Fields fields = meta_fields(file);
  const std::string name = fields["ElementDataFile"];
  const bool text = fields.count("BinaryData") != 0 && !is_true(fields["BinaryData"]);
  const bool skips = !fields["HeaderSize"].empty() && fields["HeaderSize"] != "0";
  const bool several = name.starts_with("LIST") || name.find('%') != std::string::npos;
  if (name.empty() || text || several || skips || is_true(fields["CompressedData"])) {
    return std::nullopt;
  }
  FlatFile flat{path, 0, {}};
  if (is_local(name)) {
    flat.offset = static_cast<uint64_t>(file.tellg());
  } else {
    flat.path = beside(path, name);
  }
  flat.stored.component = header.component;
  flat.stored.big_endian =
      is_true(fields["BinaryDataByteOrderMSB"]) || is_true(fields["ElementByteOrderMSB"]);
  return flat;
}

void check_meta_size(const std::string& path, const ItkHeader& header) {
  std::ifstream file(path, std::ios::binary);
  Fields fields = meta_fields(file);
  const std::string data_name = fields["ElementDataFile"];
  if (data_name.empty()) throw Failure{path + ": is truncated (its header has no end)"};
  const bool local = is_local(data_name);
  const bool text = fields.count("BinaryData") != 0 && !is_true(fields["BinaryData"]);
  // As text a voxel takes a digit, and a space before the next one.
  const uint64_t needed = text ? product_of(header.dims, 2) - 1 : voxel_bytes(header);
  if (data_name.starts_with("LIST")) return check_list(path, file, needed);
  if (data_name.find('%') != std::string::npos) {
    return check_pattern(path, data_name, header, needed);
  }
  std::string data_path = path;
  if (!local) {
    data_path = beside(path, data_name);
    file.close();
  }
  const uint64_t size = size_of(data_path);
  if (!local) file.open(data_path, std::ios::binary);
  if (!file) throw Failure{path + ": its data file " + data_path + " cannot be read"};
  const int64_t skipped = local ? static_cast<int64_t>(file.tellg())
                                : std::max<int64_t>(whole(path, fields["HeaderSize"], 0), 0);
  const uint64_t rest = size - std::min(size, static_cast<uint64_t>(skipped));
  if (!is_true(fields["CompressedData"])) {
    require_bytes(data_path, rest, needed);
    return;
  }
  if (local && fields["CompressedDataSize"].empty()) {
    throw Failure{path + ": its header does not have CompressedDataSize"};
  }
  // So much memory is taken for it.
  const int64_t packed = whole(path, fields["CompressedDataSize"], 0);
  if (packed < 0 || static_cast<uint64_t>(packed) > rest) {
    throw Failure{data_path + ": is truncated (holds " + std::to_string(rest) +
                  " bytes of packed voxels, its header asks for " + std::to_string(packed) + ")"};
  }
  file.seekg(static_cast<std::streamoff>(skipped));
  check_zlib(data_path, file, rest, needed);
}

}  // namespace plc::tools

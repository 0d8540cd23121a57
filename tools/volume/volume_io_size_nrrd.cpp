// Can an NRRD hold its voxels? Whether it does its reader notices: here before memory is taken.
#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <sstream>

#include "tools/file/failure.h"
#include "tools/file/printable.h"
#include "tools/volume/flat_file.h"
#include "tools/volume/volume_io_size.h"

namespace plc::tools {
namespace {

struct NrrdHeader {
  std::map<std::string, std::string> fields;  // names without spaces, in lower case
  uint64_t size = 0;                          // of the header
};

// "field: value", "key:=value" and "# comment", up to an empty line or the end of the file.
NrrdHeader nrrd_header(std::ifstream& file) {
  constexpr int kMaxLines = 10000;
  NrrdHeader header;
  std::string line;
  for (int i = 0; i < kMaxLines && std::getline(file, line); ++i) {
    header.size += line.size() + 1;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) break;
    const size_t colon = line.find(':');
    if (line[0] == '#' || colon == std::string::npos || line.compare(colon, 2, ":=") == 0) continue;
    std::string name;
    for (const char c : line.substr(0, colon)) {
      if (c != ' ') name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    const size_t begin = line.find_first_not_of(" \t", colon + 1);
    header.fields[name] = begin == std::string::npos ? "" : line.substr(begin);
    if (name == "datafile" && header.fields[name].starts_with("LIST")) break;  // names follow
  }
  return header;
}

// All files together. Names that lead nowhere end in a Failure, so what is counted is there.
class DataFiles {
 public:
  explicit DataFiles(const std::string& path) : path_(path) {}

  uint64_t size_of_list(std::ifstream& file) const {
    uint64_t size = 0;
    std::string name;
    while (std::getline(file, name)) {
      while (!name.empty() && std::isspace(static_cast<unsigned char>(name.back())) != 0) {
        name.pop_back();
      }
      if (!name.empty()) size += size_of(beside(path_, name));
    }
    return size;
  }
  // "slice%03d.raw FIRST LAST STEP [DIMENSIONS]"
  uint64_t size_of_pattern(const std::string& text) const {
    std::istringstream words(text);
    std::string pattern;
    int64_t first = 0;
    int64_t last = 0;
    int64_t step = 0;
    words >> pattern >> first >> last >> step;
    constexpr int64_t kMost = 1000000000;
    for (const int64_t number : {first, last, step}) {
      if (number < -kMost || number > kMost) words.setstate(std::ios::failbit);
    }
    if (!words || step == 0 || (last - first) / step < 0) {
      throw Failure{path_ + ": its numbered files are none"};
    }
    uint64_t size = 0;
    for (int64_t i = 0; i <= (last - first) / step; ++i) {
      size += size_of(beside(path_, numbered_name(pattern, first + i * step)));
    }
    return size;
  }

 private:
  const std::string& path_;
};

// Beyond that ITK takes a size for another, smaller one, and its library reads into memory for
// that.
void check_axes(const std::string& path, const std::string& sizes) {
  std::istringstream words(sizes);
  int64_t size = 0;
  while (words >> size) {
    if (size <= std::numeric_limits<int32_t>::max()) continue;
    words.setstate(std::ios::failbit);
    break;
  }
  if (!words.eof()) throw Failure{path + ": its sizes are \"" + printable(sizes) + "\", too large"};
}

bool is_none(const std::string& number) {
  return number.empty() || number == "0";
}

}  // namespace

std::optional<FlatFile> flat_nrrd(const std::string& path, const ItkHeader& header) {
  std::ifstream file(path, std::ios::binary);
  NrrdHeader nrrd = nrrd_header(file);
  check_axes(path, nrrd.fields["sizes"]);
  const std::string data = nrrd.fields["datafile"];
  const bool several = data.starts_with("LIST") || is_numbered_name(data.substr(0, data.find(' ')));
  if (nrrd.fields["encoding"] != "raw" || several || !is_none(nrrd.fields["lineskip"]) ||
      !is_none(nrrd.fields["byteskip"])) {
    return std::nullopt;
  }
  FlatFile flat{data.empty() ? path : beside(path, data), data.empty() ? nrrd.size : 0, {}};
  flat.stored.component = header.component;
  flat.stored.big_endian = nrrd.fields["endian"] == "big";
  return flat;
}

void check_nrrd_size(const std::string& path, const ItkHeader& header) {
  std::ifstream file(path, std::ios::binary);
  NrrdHeader nrrd = nrrd_header(file);
  check_axes(path, nrrd.fields["sizes"]);
  const std::string data = nrrd.fields["datafile"];
  const DataFiles files(path);
  uint64_t size = 0;
  if (data.empty()) {
    const uint64_t whole = size_of(path);
    size = whole - std::min(whole, nrrd.size);
  } else if (data.starts_with("LIST")) {
    size = files.size_of_list(file);
  } else if (is_numbered_name(data.substr(0, data.find(' ')))) {
    size = files.size_of_pattern(data);
  } else {
    size = size_of(beside(path, data));
  }
  const std::string encoding = nrrd.fields["encoding"];
  if (encoding == "raw") return require_bytes(path, size, voxel_bytes(header));
  if (encoding == "gzip" || encoding == "gz") {
    return require_ratio(path, size, voxel_bytes(header), kZlibRatio);
  }
  if (encoding == "ascii" || encoding == "text" || encoding == "txt") {
    return require_bytes(path, size, product_of(header.dims, 2) - 1);
  }
  if (encoding == "hex") return require_bytes(path, size, times(voxel_bytes(header), 2));
  throw Failure{path + ": its encoding is \"" + printable(encoding) +
                "\"; raw, gzip, text and hex are supported"};
}

}  // namespace plc::tools

#include "tools/file/path_suffix.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace plc::tools {

std::string path_suffix(const std::string& path) {
  const auto lower = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
  };
  const std::filesystem::path name(path);
  std::string last = lower(name.extension().string());
  if (last != ".gz") return last;
  return lower(name.stem().extension().string()) + last;
}

}  // namespace plc::tools

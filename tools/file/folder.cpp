#include "tools/file/folder.h"

#include <filesystem>
#include <system_error>

#include "tools/file/failure.h"

namespace plc::tools {

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw Failure{path + ": cannot be made: " + error.message()};
}

}  // namespace plc::tools

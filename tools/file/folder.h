// Folders.
#pragma once
#include <string>

namespace plc::tools {

// With those that it lies in; nothing where it is there. Throws Failure.
void make_folder(const std::string& path);

}  // namespace plc::tools

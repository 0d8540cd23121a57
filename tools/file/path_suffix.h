// By which formats are told apart.
#pragma once
#include <string>

namespace plc::tools {

// In lower case: ".nii.gz" is one; "" where there is none.
std::string path_suffix(const std::string& path);

}  // namespace plc::tools

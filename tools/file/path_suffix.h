// Suffixes of file names, which choose the format.
#pragma once
#include <string>

namespace plc::tools {

// In lower case: ".nii.gz" is one; "" where there is none.
std::string path_suffix(const std::string& path);

}  // namespace plc::tools

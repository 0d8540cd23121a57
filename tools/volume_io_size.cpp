#include "tools/volume_io_formats.h"

namespace plc::tools {
void check_file_size(const std::string&, ItkFormat, const ItkHeader&) {}
}  // namespace plc::tools

// PNG files.
#pragma once
#include <string>

#include "tools/render/render.h"

namespace plc::tools {

// Atomically. Throws Failure.
void write_png(const std::string& path, const Picture& picture);

}  // namespace plc::tools

// A file of places that draw or hold the surface.
#pragma once
#include <string>
#include <vector>

#include "engine/pellicle.h"

namespace plc::tools {

struct AttachFile {
  std::vector<plc_attachment> attachments;
  std::vector<plc_pin> pins;
};

// A line each: "attach X Y Z RADIUS [STRENGTH]" (strength 1 where left out) or "pin X Y Z RADIUS";
// "#" begins a comment. Throws Failure, which names the line.
AttachFile read_attach_file(const std::string& path);

}  // namespace plc::tools

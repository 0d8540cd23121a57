// Whether a mesh is written in floats or in doubles: decided here, and nowhere else.
#pragma once
#include <string>

#include "engine/pellicle.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

// To floats. False: one of them is not finite.
bool round_to_floats(std::vector<double>& xyz);

// Makes the mesh what is to be written: rounded to floats, which every program reads, or marked to
// be written in doubles, where that rounding would make faces meet. False: it is not valid either
// way; doubles are for a mesh that floats make worse.
bool settle_precision(plc_context* context, TriangleMesh& mesh);

// A surface of the engine, for the file at `path`: throws Failure where it is valid neither way.
void settle_surface(plc_context* context, TriangleMesh& mesh, plc_space space,
                    const std::string& path);
[[noreturn]] void fail_precision(plc_space space, const std::string& path);

// A line on stderr where `doubles`.
void tell_precision(bool doubles, const std::string& path);
// For reports.
const char* precision_text(bool doubles);

}  // namespace plc::tools

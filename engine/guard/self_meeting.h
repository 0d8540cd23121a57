// The faces of the engine's mesh that meet elsewhere than in what they share.
#pragma once
#include <array>
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// Every face of a pair that meets, once or more, in a fixed order; empty for an embedded surface.
Vector<std::array<uint32_t, 3>> meeting_faces(const Mesh& mesh,
                                              const Executor& executor = SerialExecutor());

}  // namespace plc

// The faces of the engine's mesh that meet elsewhere than in what they share.
#pragma once
#include <array>
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// Every face of a pair that meets, once or more, in a fixed order; empty for an embedded surface.
// marked: per id, not 0 where a face of the vertex may be one of a pair; NULL: anywhere.
Vector<std::array<uint32_t, 3>> meeting_faces(const Mesh& mesh,
                                              const Executor& executor = SerialExecutor(),
                                              const uint8_t* marked = nullptr);

}  // namespace plc

// Where a surface would never have come to rest and was frozen (mesh/turns.h).
#pragma once
#include <cstdint>

#include "engine/base/vec3.h"
#include "engine/mesh/mesh.h"
#include "pyramid/memory.h"

namespace plc {

// Frozen vertices that edges connect.
struct FrozenSite {
  Vec3 place;  // mean of them, in mesh space
  int64_t vertices = 0;
};

// Those of most vertices first, equal ones by their first ids.
Vector<FrozenSite> frozen_sites(const Mesh& mesh);

}  // namespace plc

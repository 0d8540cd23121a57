// What the start of a surface calls while it works.
#pragma once
#include <functional>

#include "engine/base/go_on.h"
#include "pyramid/buffer.h"

namespace plc {

class HalfEdges;

// Both may be empty.
struct StartHooks {
  GoOn go_on;
  // Given the surface that an adaptive mesh is made of, of all its crossings, before it is thinned
  // out: to lower sizes by. xyz: three per vertex, in mesh space.
  std::function<void(const HalfEdges& surface, const Buffer<float>& xyz)> before_thinning;
};

}  // namespace plc

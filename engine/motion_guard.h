// Going past the paper: a movement that would make the surface meet itself is taken back.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/mesh.h"
#include "pyramid/executor.h"

namespace plc {

// The surface before a movement does not meet itself. Where it does after it, the vertices of the
// faces that meet go back to where they were and lose their speed; again, until none meet: in the
// worst case all are back where they started.
class MotionGuard {
 public:
  MotionGuard(Mesh& mesh, const Executor& executor) : mesh_(mesh), executor_(executor) {}
  void restart() {}
  // `before`: the positions before the movement, by id. Returns the number of vertices taken back.
  int64_t take_back(const Buffer<Packed>& before);

 private:
  Mesh& mesh_;
  const Executor& executor_;
};

}  // namespace plc

// Deletion of tetrahedra and of tiny components that turn inside out (3.3).
#pragma once

#include <functional>

#include "engine/base/state_io.h"
#include "engine/mesh/mesh.h"
#include "pyramid/memory.h"

namespace plc {

// What a component encloses: less than 0 where it is a cavity. It is summed relative to its first
// vertex.
double signed_volume(const Mesh& mesh, const Vector<uint32_t>& component);

// v and its neighbours are a whole component of four vertices.
bool is_tetrahedron(const Mesh& mesh, uint32_t v);
void delete_tetrahedron(Mesh& mesh, uint32_t v);

// Follows the components of up to kTinyComponent vertices. A flat tetrahedron, or a small bubble
// between two fronts, inverts without violating (1)-(3) and would stay for ever.
class TinyComponents {
 public:
  // Whether a component, given by its vertices, has to stay whatever becomes of it; null: none has.
  using Stays = std::function<bool(const Vector<uint32_t>& component)>;

  // Looks at every vertex: at the start of a level.
  void start(Mesh& mesh);
  // Deletes the components followed so far that a movement has turned over. Returns how many. No
  // vertex was created or deleted since the last look: a component is known by one of its vertices.
  int64_t delete_turned_over(Mesh& mesh, const Stays& stays = nullptr);
  // Looks at the components followed so far and at those of `changed`; deletes what has turned over
  // or nearly vanished. Returns how many were deleted. The sign of a component whose known vertex
  // is gone is taken anew: what the movement has turned over must have been deleted before.
  int64_t update(Mesh& mesh, const Vector<uint32_t>& changed, const Stays& stays = nullptr);
  // What is followed, for a mesh of so many ids.
  void save(StateWriter& to) const { to.add_all(watched_); }
  void restore(StateReader& from, uint32_t slots);

 private:
  struct Watched {
    uint32_t vertex;    // the smallest id of the component
    uint32_t positive;  // sign of the volume when it was first seen: 1 or 0
  };
  void start_floods(const Mesh& mesh);
  // Whether a flood since start_floods() has come across v.
  bool seen(uint32_t v) const { return seen_[v] >= first_flood_; }
  // The component of v, when v is alive and not seen() and it has at most kTinyComponent vertices;
  // else empty.
  const Vector<uint32_t>& flood(const Mesh& mesh, uint32_t v);

  Vector<Watched> watched_;
  Vector<uint32_t> seen_;  // by vertex: the last flood that came across it, counted from 1
  Vector<uint32_t> component_;
  uint32_t flood_ = 0;
  uint32_t first_flood_ = 1;  // since start_floods()
};

}  // namespace plc

// Going past the paper: a movement that would make the surface meet itself is taken back.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/meeting_search.h"
#include "engine/mesh.h"
#include "engine/spatial_hash.h"
#include "pyramid/executor.h"

namespace plc {

// The surface before a movement does not meet itself. Where it does after it, the vertices of the
// faces that meet go back to where they were and lose their speed; again, until none meet: in the
// worst case all are back where they started.
//
// Only faces with a vertex at risk are tested, against each other. Two faces that meet share a
// vertex around which the surface folds, or each has a corner within kRiskReach of the other's: an
// edge of one pierces the other, and is at most half its length from the piercing point, as a
// corner of the pierced face is at most 1/sqrt 3 of its longest edge. There a vertex v is at risk
// when
//   - the normal of one of its faces is turned by more than kRiskDot against its own, or
//   - for a vertex w within kRiskReach that is no neighbour and has a normal turned by more than
//     that, no plane across either normal keeps the faces of v and of w kRiskGap apart; w is then
//     at risk, too.
// Parts whose normals agree are one sheet, or the outer two of three sheets, and then the middle
// one is at risk with both. Like the constraints, the risk of a vertex is looked at when it is due:
// of two vertices the later look counts, and since then neither has moved by more than kCheckPath.
class MotionGuard {
 public:
  MotionGuard(Mesh& mesh, const Executor& executor) : mesh_(mesh), executor_(executor) {}

  // `before`: the positions before the movement, by id. `due`: the vertices whose risk is to be
  // looked at again; all others keep theirs. The hash holds every vertex where it is now and learns
  // of those that go back. Returns the number of vertices taken back.
  int64_t take_back(const Buffer<Packed>& before, const std::vector<uint32_t>& due,
                    SpatialHash& hash);

 private:
  void assess(const std::vector<uint32_t>& due, const SpatialHash& hash);
  bool folded(uint32_t v, const Neighbors& ring) const;
  void list_risks(uint32_t v, const SpatialHash& hash, std::vector<uint32_t>& risks) const;
  bool apart(uint32_t v, const Neighbors& ring, uint32_t w) const;
  int64_t put_back(const uint32_t* face, const Buffer<Packed>& before, SpatialHash& hash);

  Mesh& mesh_;
  const Executor& executor_;
  MeetingSearch search_;
  std::vector<std::vector<uint32_t>> risks_;  // per task
};

}  // namespace plc

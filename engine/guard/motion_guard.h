// Going past the paper: a movement that would make the surface meet itself is taken back.
#pragma once
#include <array>
#include <cstdint>

#include "engine/detect/risk.h"
#include "engine/detect/spatial_hash.h"
#include "engine/guard/meeting_search.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/vertex_bytes.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// The surface before a movement does not meet itself. Where it does after it, the vertices of the
// faces that meet go back to where they were and lose their speed; again, until none meet: in the
// worst case all are back where they started. Only faces with a vertex at risk (risk.h) are tested,
// against each other, and only where one of the two has moved. Where the mesh has obstacles every
// face that has moved is tested against those.
//
//   risk           1      flags         of risk.h; attached to the mesh
//   strays         1      id            whether created since restart(); attached, too, but not
//                                       saved: results do not depend on it
class MotionGuard {
 public:
  MotionGuard(Mesh& mesh, const Executor& executor)
      : mesh_(mesh),
        executor_(executor),
        risk_(mesh, kNearRisk, VertexBytes::Reset::kCreated),
        strays_(mesh, 1, VertexBytes::Reset::kCreated) {}

  // The ids tell where vertices are: the mesh has been renumbered.
  void restart() { strays_.fill(0); }
  // blocks: of kRingLanes vertices, with all that have moved and all their neighbours. Finds where
  // the surface folds now, against the normals of the movement's start.
  void find_folds(const Vector<uint32_t>& blocks);
  // Of the vertices around which that call found folds, those without one before it; ascending.
  const Vector<uint32_t>& newly_folded() const { return newly_folded_; }
  // due: the vertices whose risk has been looked at anew; at_risk: all vertices that it was found
  // for (Surroundings). The others keep theirs.
  void assess(const Vector<uint32_t>& due, const Vector<uint32_t>& at_risk);
  // Marks v as at risk, whatever its risk was.
  void suspect(uint32_t v) { risk_[v] = kNearRisk; }
  // `before`: the positions before the movement, by id. The hash learns of the vertices that go
  // back, which are appended to `back`. Returns how many went back.
  int64_t take_back(const Buffer<Float4>& before, SpatialHash& hash, Vector<uint32_t>& back);

  const VertexBytes& risk() const { return risk_; }
  // restore(): after that of the mesh.
  void save(StateWriter& to) const { risk_.save(to); }
  void restore(StateReader& from) { risk_.restore(from); }

 private:
  // What one task has found of the faces that have moved: those that an obstacle refuses, and those
  // that a component of the obstacles is near.
  struct Pressed {
    Vector<std::array<uint32_t, 3>> refused, near;
  };
  bool keep_clear(const Buffer<Float4>& before, SpatialHash& hash, Vector<uint32_t>& back);
  void press(size_t begin, size_t end, const Buffer<Float4>& before, Pressed& found) const;
  bool passes_over(const Buffer<Float4>& before) const;
  template <typename Visit>
  void visit_moved(size_t begin, size_t end, const Buffer<Float4>& before,
                   const Visit& visit) const;
  void put_back(const uint32_t* face, const Buffer<Float4>& before, SpatialHash& hash,
                Vector<uint32_t>& back);

  Mesh& mesh_;
  const Executor& executor_;
  VertexBytes risk_;
  VertexBytes strays_;
  Buffer<uint8_t> folds_;
  Vector<Vector<uint32_t>> found_;  // newly folded, by task
  Vector<uint32_t> newly_folded_;
  MeetingSearch search_;
  Vector<Pressed> pressed_;  // by task
};

}  // namespace plc

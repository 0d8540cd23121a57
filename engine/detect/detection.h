// Which constraints of 3.2 are to be checked, and what the check needs to know: the vertices that
// are due by the slow-vertex rule (3.6), the hash, and what is around those vertices. Asked by the
// motion guard and by the resolution.
#pragma once
#include "engine/detect/due_vertices.h"
#include "engine/detect/spatial_hash.h"
#include "engine/detect/surroundings.h"
#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

class Detection {
 public:
  Detection(Mesh& mesh, const Executor& executor);

  // New ids, new level: everything that is known about single vertices is forgotten.
  void restart() { hash_valid_ = false; }

  // Three steps, in this order. First the vertices that are due are listed, of all or of those of
  // these blocks of kRingLanes, ascending (sleep.h), or every vertex is; their periods start anew.
  // calm: for how long each vertex has been calm.
  void list_due();
  void list_due(const Vector<uint32_t>& awake, const VertexBytes& calm);
  void list_all();
  // Enters them where they are now.
  void update_hash();
  // What is around them.
  void search() { surroundings_.search(due(), hash_); }
  // The same for the motion guard: around vertices, too, that may not be due but are newly folded.
  // risk: of all vertices (risk.h).
  void search(const VertexBytes& risk, const Vector<uint32_t>& folded) {
    surroundings_.search(due(), hash_, &risk);
    surroundings_.search_folded(folded, hash_, risk);
  }

  // The three for the constraints of all vertices only: nothing has moved, or will be asked of the
  // motion guard.
  void search_near_all();

  // Ascending.
  const Vector<uint32_t>& due() const { return due_.list(); }
  // For how long the constraints of each vertex have not been checked: all that outlives a pass.
  const VertexBytes& idle() const { return due_.idle(); }
  void save(StateWriter& to) const { due_.save(to); }
  // After that of the mesh. The hash is built anew: what it finds does not depend on when it was
  // built.
  void restore(StateReader& from) {
    restart();
    due_.restore(from);
  }
  const Surroundings& surroundings() const { return surroundings_; }
  // Holds every living vertex; who moves, makes or deletes one tells it.
  SpatialHash& hash() { return hash_; }
  const SpatialHash& hash() const { return hash_; }
  // Builds the hash anew where so much has been told to it since that its searches take longer for
  // it. They find the same.
  void shorten_hash();

 private:
  void build_hash();
  bool is_many(size_t entries) const;

  Mesh& mesh_;
  const Executor& executor_;
  DueVertices due_;
  bool all_due_ = false;
  SpatialHash hash_;
  bool hash_valid_ = false;
  Surroundings surroundings_;
};

}  // namespace plc

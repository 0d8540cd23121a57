// The faces around one vertex, and whether they can meet each other.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/base/vec3.h"
#include "kernels/ring.h"

namespace plc {

// The faces (centre, place k, place k + 1) around a point, place after place.
class Fan {
 public:
  explicit Fan(const Vec3& centre) : centre_(centre) {}
  void add(const Vec3& place);
  // True only when no two of the faces meet elsewhere than in what they share. One pass instead of
  // exact tests of all pairs. Sufficient, not necessary: seen along the sum n of the faces'
  // normals, all faces turn counter-clockwise and go around the centre once, so that they project
  // one to one along n. Certain in spite of rounding; false where rounding leaves a doubt, and of
  // many faces. Neither has one of them a zero area then.
  bool is_embedded();

 private:
  // Longer ones are left to the exact tests.
  static constexpr uint32_t kMax = 32;
  bool winds_once(double nx, double ny, double nz) const;

  Vec3 centre_;
  uint32_t count_ = 0;
  double longest_ = 0;                              // edge, squared
  double x_[kMax + 1], y_[kMax + 1], z_[kMax + 1];  // edges from the centre
};

// Of the faces around v, which is alive; positions by id.
bool star_is_embedded(const RingView& rings, const Float4* positions, uint32_t v);
// Of the faces (centre, ring[k], ring[k + 1]) around a point.
bool fan_is_embedded(const Vec3& centre, const Vec3* ring, size_t count);

}  // namespace plc

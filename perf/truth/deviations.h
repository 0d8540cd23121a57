// How far a mesh is from the two truths of a scene, and they from it.
#pragma once
#include <optional>

#include "perf/truth/truth_surface.h"

namespace truth {

inline constexpr size_t kSamples = 200'000;  // of each surface

// Of distances in voxels. Signed ones are positive where the mesh lies outside of the truth.
struct Spread {
  double bias = 0;  // mean; of unsigned distances their mean
  double rms = 0;
  double p95 = 0, max = 0;  // of sizes
  double far = 0;           // part that is farther than half a voxel
};

struct Deviation {
  Spread to_truth;    // signed, from samples of the mesh
  Spread from_truth;  // unsigned, from samples of the truth to the nearest point of the mesh
};

// Of one mesh. NaN where there is none.
struct Measured {
  size_t vertices = 0, faces = 0;
  int64_t components = 0, genus = 0;  // genus -1 where a component is not closed
  double area = 0, volume = 0;
  double curvature = 0;  // median of how far the mean curvature at vertices is off the object's
  Deviation object;
  std::optional<Deviation> iso;  // none where the truth is empty
};

class Truth {
 public:
  Truth(const Scene& scene, const plc::Executor& executor);

  const Surface& object() const { return object_; }
  const Surface& iso() const { return iso_; }
  const FineField& field() const { return field_; }
  // `mesh` in places of the volume; it is turned outward where its volume is negative. Throws
  // Failure where it has no area.
  Measured measure(Surface mesh) const;

 private:
  Deviation object_deviation(const Surface& mesh) const;
  Deviation iso_deviation(const Surface& mesh) const;
  double curvature_error(const Surface& mesh) const;

  Scene scene_;
  const plc::Executor& executor_;
  FineField field_;
  Surface object_, iso_;
  std::vector<double> object_samples_, iso_samples_;  // three coordinates each
};

}  // namespace truth

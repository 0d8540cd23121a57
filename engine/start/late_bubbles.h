// Surfaces for the parts of the object, and the cavities, that the surface has missed. Past the
// paper, which says of its vessels that shrink-wrapping loses detached and thin parts (5.3).
#pragma once
#include <cstdint>

#include "engine/base/schedule.h"
#include "engine/base/statistics.h"
#include "engine/mesh/mesh.h"
#include "engine/start/missed_places.h"
#include "pyramid/image_object.h"
#include "pyramid/status.h"

namespace plc {

struct LateBubbles {
  int64_t bubbles = 0;   // components started on the object's side, outside the surface
  int64_t cavities = 0;  // on the other side, inside it
  double volume = 0;     // of all of them as they start, mesh units
};

// Finds the places of the image that are on the wrong side of the surface, apart from it by (3),
// and hold a ball of kSmallestBubble delta: what is smaller the mesh cannot resolve.
//
// `tried`: of the image's voxels, or of none yet; places with a voxel in it are left out, what is
// found is put in. Nothing of the image's size is allocated: sets of voxels are held where they
// are. The same bits for any number of threads. room: as find_missed_places() takes it.
MissedPlaces find_late_places(const Mesh& mesh, const ImageObject& object, const Executor& executor,
                              VoxelSet& tried, const VoxelRoom& room);

// Each place gets a bubble with its shape - regular_iso_surface.h, conform.h - and grows together
// with the rest from there. Spheres do not do: in a thin or faint part the curvature of one that
// fits holds it down, and it never fills the part. Bubbles around a cavity face inward. The surface
// stays embedded. `started` and `counts` grow. The same bits for any number of threads. Errors:
// those of conform.h, but for parts of which nothing is left.
Status start_late_bubbles(const ImageObject& object, const MissedPlaces& places,
                          const Schedule& schedule, Mesh& mesh, LateBubbles& started,
                          OperationCounts& counts);

}  // namespace plc

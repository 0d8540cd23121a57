// Everything that can be wrong with a surface (plc_check), of any triangle mesh, exactly.
//
// closed     every edge has an even number of faces and no face repeats a vertex
// manifold   no edge of more than two faces, no vertex with several umbrellas (sets of faces
//            connected around it), no face that repeats a vertex; borders are allowed, and so are
//            neighbours that run their edge in the same direction (see oriented)
// oriented   no edge of more than two faces, both faces of an edge run it in opposite directions,
//            no face that repeats a vertex
// outward    of closed and oriented meshes: the volume of each component is > 0, of those inside an
//            odd number of others (walls of cavities) < 0; -1 for other meshes
// valid      all of these, no face of zero area, no self-intersection, and at least one face
// valence    over the vertices that have an edge
//
// An empty mesh has no edge at fault: closed, manifold and oriented, but not valid, outward -1 and
// all measures 0. Euler's number leaves out isolated vertices and faces that repeat a vertex; each
// of the latter counts as a component. The volume of a mesh that is not closed means nothing.
#pragma once
#include <cstdint>
#include <string>

#include "engine/base/mesh_arrays.h"
#include "engine/exact/self_intersection.h"
#include "engine/measure/measures.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"
#include "pyramid/status.h"

namespace plc {

// self_intersections stops counting here: more take longer than anyone waits for and say
// no more. first_intersection is then one of those counted.
inline constexpr int64_t kMaxIntersections = 1000000;

// The fields are those of plc_check.
struct MeshCheck {
  SurfaceMeasures measures;
  int valid = 0, closed = 0, manifold = 0, oriented = 0, outward = 0;
  int64_t border_edges = 0, non_manifold_edges = 0, non_manifold_vertices = 0;
  int64_t inconsistent_edges = 0, wrongly_oriented_components = 0, degenerate_faces = 0;
  int64_t duplicate_points = 0, isolated_vertices = 0;
  int64_t self_intersections = 0, first_intersection[2] = {0, 0};
  double edge_min = 0, edge_mean = 0, edge_max = 0, min_angle = 0, max_angle = 0;
  int32_t valence_min = 0, valence_max = 0;
};

// Input and errors as check_mesh_input() has them; check is unchanged after an error. The same bits
// for any executor. intersections: null, or what becomes those that are counted.
Status check_mesh(const MeshArrays& mesh, const Executor& executor, MeshCheck& check,
                  Vector<FacePair>* intersections = nullptr);

// What is wrong with a mesh that is not valid, the gravest thing alone.
std::string fault_of(const MeshCheck& check);

// kInvalidData with that, of a mesh that is not valid.
Status demand_valid(const MeshArrays& mesh, const Executor& executor);

}  // namespace plc

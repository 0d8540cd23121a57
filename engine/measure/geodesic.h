// Lengths of shortest paths over the faces of a mesh from one vertex to all others: exact for the
// polyhedron, but for rounding.
//
// Windows: a shortest path unfolds to straight segments between vertices that it may bend at (a
// saddle, of more than 360 degrees, or a border). All paths that cross the same edges after the
// same such vertex form a window: an interval of the last edge, the vertex unfolded into its plane
// and the distance there. Windows go over faces in the order of their distance, nearest first.
//   J. Chen, Y. Han, "Shortest Paths on a Polyhedron", 1990: where windows cover the same corner of
//   a face, only the nearest goes on to both sides of it.
//   S.-Q. Xin, G.-J. Wang, "Improving Chen and Han's Algorithm on the Discrete Geodesic Problem",
//   ACM Transactions on Graphics 28(4), 2009: the order, and windows that a path by way of a vertex
//   of their face beats are dropped.
// Fast marching was not taken: it is of first order only, and needs a rule for obtuse angles.
//
// Every distance is the length of a path that exists: where a path is right at the end of a window,
// and rounding puts it outside, the path along that end is of the same length but for its square.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "pyramid/executor.h"

namespace plc {

// At most kMaxFaces faces; source is a vertex. distance: one value per vertex, infinity where no
// path leads. Paths may cross an edge of any number of faces from each to each other one. Equal
// distances are met in the order of vertices and windows: the same bits always; the executor is
// used to find the edges alone. 72 bytes per window that waits, of which there were fewer
// than vertices on every mesh tried, and 24 per corner. The bone of a head CT, 98,608 vertices,
// took 4 s, a sphere of 65,538 as well.
void geodesic_distances(const MeshArrays& mesh, uint32_t source, const Executor& executor,
                        double* distance);

// The vertex of a face nearest to the point (three values), the first of equal ones; vertex_count
// where there is no face.
size_t nearest_vertex(const MeshArrays& mesh, const double* point);

}  // namespace plc

// Global refinement (3.4): edges shrink to 1 / sqrt 3, three times the vertices.
#pragma once
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// A vertex at the centre of each face, then every old edge inverted, except where the new faces
// would meet the surface elsewhere. Valid on any mesh of ours: its graph is simple, so no two
// faces share two edges. delta is divided by sqrt 3, ids are renumbered along a Morton curve, every
// vertex is due for a check.
// renumbering: false leaves the ids as they come, without gaps; for comparisons.
void refine(Mesh& mesh, const Executor& executor, bool renumbering = true);

// The same of a part of the mesh, whose ids have no gaps: of the faces of three vertices that are
// marked. Edges between those and others stay. delta is as it was.
void refine_marked(Mesh& mesh, const Vector<uint8_t>& marked, const Executor& executor);

// How many refinements bring delta from `from` nearest to `to`, in the ratio of both; 0 where `to`
// is not smaller. from, to > 0.
int refinements_between(double from, double to);

// The living vertices along a Morton curve of cells of delta, ties by id.
Vector<uint32_t> morton_order(const Mesh& mesh, const Executor& executor = SerialExecutor());
// The indices of points along such a curve of cells of `cell`.
Vector<uint32_t> morton_order(const Vector<Vec3>& points, double cell, const Executor& executor);
// The living vertices in the order of their ids.
Vector<uint32_t> living_order(const Mesh& mesh);

}  // namespace plc

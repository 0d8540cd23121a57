#include "engine/measure/hausdorff.h"

#include <algorithm>
#include <cmath>

#include "engine/base/blocks.h"
#include "engine/measure/mesh_target.h"

namespace plc {
namespace {

constexpr size_t kBlock = 512;

struct VertexPlace {
  double squared;
  uint32_t face;
};

}  // namespace

double distance_rounding(const MeshArrays& mesh) {
  constexpr double kRounding = 1e-14;  // of the largest coordinate
  double largest = 0;
  for (size_t i = 0; i < 3 * mesh.vertex_count; ++i) {
    largest = std::max(largest, std::abs(mesh.xyz[i]));
  }
  return kRounding * largest;
}

FarthestPlace farthest_place(const MeshArrays& mesh, const MeshArrays& other, double precise,
                             const Executor& executor) {
  MeshTarget target(other, executor);
  // Vertices first: they say how far the search has to look.
  Vector<VertexPlace> places(mesh.vertex_count, {0, kNoFace});
  for (size_t i = 0; i < 3 * mesh.face_count; ++i) places[mesh.abc[i]].face = 0;
  run_blocks(executor, mesh.vertex_count, kBlock, [&](size_t, size_t begin, size_t end) {
    uint32_t face = 0;
    for (size_t v = begin; v < end; ++v) {
      if (places[v].face == kNoFace) continue;  // of no face
      places[v].squared = target.nearest(point_of(mesh.xyz, static_cast<uint32_t>(v)), face);
      places[v].face = face;
    }
  });
  double farthest = 0;
  for (const VertexPlace& place : places) farthest = std::max(farthest, place.squared);

  const double rounding = std::max(distance_rounding(mesh), distance_rounding(other));
  const double least = std::max(precise, rounding);
  const double limit = std::max(farthest, least * least);
  Vector<CoverBound> bounds(block_count(mesh.face_count, kBlock), {limit, true, farthest, 0});
  run_blocks(executor, mesh.face_count, kBlock, [&](size_t block, size_t begin, size_t end) {
    Cover cover;
    for (size_t f = begin; f < end; ++f) {
      const uint32_t* ids = mesh.abc + 3 * f;
      const Corners3 t = {point_of(mesh.xyz, ids[0]), point_of(mesh.xyz, ids[1]),
                          point_of(mesh.xyz, ids[2])};
      cover.run(target, t, places[ids[0]].face, bounds[block]);
    }
  });
  CoverBound all{limit, true, farthest, 0};
  for (const CoverBound& bound : bounds) {
    all.at_least = std::max(all.at_least, bound.at_least);
    all.at_most = std::max(all.at_most, bound.at_most);
  }
  return {std::sqrt(all.at_least),
          std::max(std::sqrt(all.at_most), std::sqrt(all.at_least)) + rounding};
}

}  // namespace plc

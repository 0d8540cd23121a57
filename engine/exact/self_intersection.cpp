#include "engine/exact/self_intersection.h"

#include <algorithm>

#include "engine/base/blocks.h"
#include "engine/exact/predicates.h"
#include "engine/exact/triangle_intersection.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

// Faces per task of the passes over all faces, leaves per task of the search.
constexpr size_t kFaceBlock = 8192;
constexpr size_t kLeafBlock = 64;
// Tasks between two looks at the limit: enough to keep threads busy, few enough to stop early.
constexpr size_t kWave = 32;

}  // namespace

Vector<uint32_t> proper_faces(const MeshArrays& mesh, const Executor& executor) {
  std::vector<Vector<uint32_t>> kept(block_count(mesh.face_count, kFaceBlock));
  run_blocks(executor, mesh.face_count, kFaceBlock, [&](size_t block, size_t begin, size_t end) {
    for (size_t f = begin; f < end; ++f) {
      const Triangle t = make_triangle(mesh.xyz, mesh.face(f));
      if (!collinear(t.corner[0], t.corner[1], t.corner[2])) {
        kept[block].push_back(static_cast<uint32_t>(f));
      }
    }
  });
  Vector<uint32_t> faces;
  faces.reserve(mesh.face_count);
  for (const Vector<uint32_t>& part : kept) {
    faces.insert(faces.end(), part.begin(), part.end());
  }
  return faces;
}

Vector<FacePair> self_intersections(const MeshArrays& mesh, const FaceTree& tree,
                                    const Executor& executor, size_t limit) {
  const size_t tasks = block_count(tree.leaf_count(), kLeafBlock);
  const size_t wave = limit == std::numeric_limits<size_t>::max() ? tasks : kWave;
  Vector<FacePair> all;
  std::vector<Vector<FacePair>> found(wave);
  for (size_t first = 0; first < tasks && all.size() < limit; first += wave) {
    executor.run(std::min(wave, tasks - first), [&](size_t task) {
      Vector<FacePair>& pairs = found[task];
      pairs.clear();
      const size_t begin = (first + task) * kLeafBlock;
      const size_t end = std::min(begin + kLeafBlock, tree.leaf_count());
      for (size_t leaf = begin; leaf < end && pairs.size() < limit; ++leaf) {
        tree.overlapping_pairs(leaf, [&](uint32_t f, uint32_t g) {
          if (pairs.size() < limit && triangles_intersect(make_triangle(mesh.xyz, mesh.face(f)),
                                                          make_triangle(mesh.xyz, mesh.face(g)))) {
            pairs.emplace_back(std::min(f, g), std::max(f, g));
          }
        });
      }
    });
    for (size_t task = 0; task < std::min(wave, tasks - first); ++task) {
      all.insert(all.end(), found[task].begin(), found[task].end());
    }
  }
  std::sort(all.begin(), all.end());
  if (all.size() > limit) all.resize(limit);
  return all;
}

Vector<FacePair> self_intersections(const MeshArrays& mesh, const Executor& executor,
                                    size_t limit) {
  const Vector<uint32_t> faces = proper_faces(mesh, executor);
  FaceTree tree;
  tree.build(mesh.xyz, mesh.abc, faces.data(), faces.size(), executor);
  return self_intersections(mesh, tree, executor, limit);
}

}  // namespace plc

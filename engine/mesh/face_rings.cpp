#include "engine/mesh/face_rings.h"

#include <algorithm>
#include <string>

#include "engine/base/blocks.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

constexpr size_t kBlock = 8192;

}  // namespace

// One face seen from one of its corners: in the ring, `to` follows `from`.
struct FaceRings::Step {
  uint32_t from, to;
};

FaceRings::FaceRings(const uint32_t* abc, size_t face_count, size_t vertex_count,
                     const Executor& executor)
    : begin_(vertex_count + 1), ring_(3 * face_count), length_(vertex_count) {
  const size_t corners = 3 * face_count;
  for (size_t c = 0; c < corners; ++c) ++begin_[abc[c] + size_t{1}];
  for (size_t v = 0; v < vertex_count; ++v) begin_[v + 1] += begin_[v];
  Buffer<Step> steps(corners);
  for (size_t c = 0; c < corners; ++c) {
    const size_t face = c / 3 * 3;
    const uint32_t v = abc[c];
    steps[begin_[v] + length_[v]++] = {abc[face + (c + 1) % 3], abc[face + (c + 2) % 3]};
  }
  run_blocks(executor, vertex_count, kBlock, [&](size_t, size_t first, size_t last) {
    for (size_t v = first; v < last; ++v) {
      Step* begin = steps.data() + begin_[v];
      Step* end = begin + faces(v);
      if (begin == end) continue;
      const auto earlier = [](const Step& l, const Step& r) { return l.from < r.from; };
      std::sort(begin, end, earlier);
      uint32_t length = 0;
      for (const Step* at = begin;;) {
        ring_[begin_[v] + length++] = at->from;
        at = std::lower_bound(begin, end, Step{at->to, 0}, earlier);
        if (at == begin || length == faces(v)) break;
      }
      length_[v] = length;
    }
  });
}

void fill_from_rings(Mesh& mesh, const float* xyz, size_t vertex_count, const FaceRings& rings) {
  mesh.clear();
  Vector<uint32_t> id(vertex_count, 0);
  uint32_t used = 0;
  for (size_t v = 0; v < vertex_count; ++v) {
    id[v] = used;
    used += rings.faces(v) != 0 ? 1 : 0;
  }
  mesh.reserve(used);
  for (size_t v = 0; v < vertex_count; ++v) {
    if (rings.faces(v) == 0) continue;
    mesh.create({xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]}, {});
  }
  for (size_t v = 0; v < vertex_count; ++v) {
    if (rings.faces(v) == 0) continue;
    Neighbors ring;
    ring.resize(rings.length(v));
    for (uint32_t k = 0; k < rings.length(v); ++k) ring[k] = id[rings.ring(v)[k]];
    mesh.set_ring(id[v], ring);
  }
}

Status too_many_vertices() {
  return {ErrorCode::kOutOfMemory, "the surface needs more than " +
                                       std::to_string(kMaxMeshVertices) +
                                       " vertices at this resolution"};
}

}  // namespace plc

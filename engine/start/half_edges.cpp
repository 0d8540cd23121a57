#include "engine/start/half_edges.h"

#include <algorithm>
#include <cassert>

#include "engine/base/blocks.h"

namespace plc {

namespace {

constexpr size_t kBlock = 8192;

}  // namespace

HalfEdges::HalfEdges(const MeshArraysOf<float>& mesh, const Executor& executor)
    : corner_(mesh.abc, mesh.abc + 3 * mesh.face_count),
      twin_(corner_.size()),
      out_(mesh.vertex_count) {
  // Those that leave a vertex lie in `leaving` from begin[v] on.
  Buffer<uint32_t> begin(mesh.vertex_count + 1), leaving(corner_.size()), filled(mesh.vertex_count);
  for (const uint32_t v : corner_) ++begin[v + size_t{1}];
  for (size_t v = 0; v < mesh.vertex_count; ++v) begin[v + 1] += begin[v];
  for (uint32_t h = 0; h < corner_.size(); ++h) {
    const uint32_t v = corner_[h];
    leaving[begin[v] + filled[v]++] = h;
  }
  run_blocks(executor, mesh.vertex_count, kBlock, [&](size_t, size_t first, size_t last) {
    for (size_t v = first; v < last; ++v) {
      assert(begin[v] != begin[v + 1]);
      out_[v] = leaving[begin[v]];
      for (uint32_t i = begin[v]; i < begin[v + 1]; ++i) {
        const uint32_t h = leaving[i], w = to(h);
        if (w < v) continue;  // found from there
        const uint32_t* back = std::find_if(&leaving[begin[w]], leaving.data() + begin[w + 1],
                                            [&](uint32_t g) { return to(g) == v; });
        assert(back != leaving.data() + begin[w + 1]);
        join(h, *back);
      }
    }
  });
}

HalfEdges::Contraction HalfEdges::contract(uint32_t h) {
  const uint32_t v = from(h), w = to(h), t = twin(h);
  const uint32_t x = from(previous(h)), y = from(previous(t));
  const Contraction done{h, v, w, {out_[v], out_[w], out_[x], out_[y]}};
  uint32_t g = t;
  do {
    corner_[g] = v;
    g = around(g);
  } while (g != t);
  // The faces on both sides of the edge go; what is beyond their other two sides is joined.
  for (const uint32_t gone : {h, t}) {
    const uint32_t to_v = twin(next(gone)), from_v = twin(previous(gone));
    join(to_v, from_v);
    out_[from(to_v)] = to_v;
    out_[v] = from_v;
  }
  remove_face(h);
  remove_face(t);
  out_[w] = kNone;
  return done;
}

// The half-edges of the two faces still know their twins.
void HalfEdges::undo(const Contraction& done) {
  const auto& [h, v, w, outs] = done;
  const uint32_t t = twin(h);
  const uint32_t x = from(twin(next(h))), y = from(twin(next(t)));
  for (const uint32_t gone : {h, t}) {
    join(next(gone), twin(next(gone)));
    join(previous(gone), twin(previous(gone)));
  }
  corner_[h] = v, corner_[next(h)] = w, corner_[previous(h)] = x;
  corner_[next(t)] = v, corner_[previous(t)] = y;
  uint32_t g = t;
  do {
    corner_[g] = w;
    g = around(g);
  } while (g != t);
  out_[v] = outs[0], out_[w] = outs[1], out_[x] = outs[2], out_[y] = outs[3];
}

void HalfEdges::remove_face(uint32_t h) {
  const uint32_t f = h / 3 * 3;
  for (uint32_t k = 0; k < 3; ++k) corner_[f + k] = kNone;
}

}  // namespace plc

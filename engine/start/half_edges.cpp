#include "engine/start/half_edges.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "engine/base/blocks.h"

namespace plc {

namespace {

constexpr size_t kBlock = 8192;

}  // namespace

HalfEdges::HalfEdges(Buffer<uint32_t>&& abc, size_t vertices, const Executor& executor)
    : corner_(std::move(abc)) {
  const size_t half_edges = corner_.size();
  // Those that leave a vertex: that with the lowest number in out_, then each in the place of the
  // one before.
  Buffer<uint32_t> following;
  for (Buffer<uint32_t>* b : {&twin_, &following}) b->resize_uninitialized(half_edges);
  out_.resize_uninitialized(vertices);
  std::fill(out_.begin(), out_.end(), kNone);
  for (auto h = static_cast<uint32_t>(half_edges); h-- > 0;) {
    following[h] = std::exchange(out_[corner_[h]], h);
  }
  run_blocks(executor, vertices, kBlock, [&](size_t, size_t first, size_t last) {
    for (auto v = static_cast<uint32_t>(first); v < last; ++v) {
      assert(out_[v] != kNone);
      for (uint32_t h = out_[v]; h != kNone; h = following[h]) {
        const uint32_t w = to(h);
        if (w < v) continue;  // found from there
        uint32_t back = out_[w];
        while (to(back) != v) back = following[back];
        join(h, back);
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

// A sort whose pieces, and merges of two, are tasks. Not tbb::parallel_sort: it must run on
// whatever executor there is, the threads that a host lends and the calling thread alone among
// them.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
#include <utility>

#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// `less` is a total order: what compares equal is the same.
template <typename T, typename Less = std::less<T>>
void parallel_sort(Vector<T>& all, const Executor& executor, const Less& less = {}) {
  constexpr size_t kPiece = 256, kMostPieces = 32;
  const size_t pieces = std::bit_floor(std::clamp<size_t>(all.size() / kPiece, 1, kMostPieces));
  const auto bound = [&](size_t piece) { return all.size() * piece / pieces; };
  executor.run(
      pieces, [&](size_t i) { std::sort(all.data() + bound(i), all.data() + bound(i + 1), less); });
  Vector<T> merged(pieces == 1 ? 0 : all.size());
  for (size_t width = 1; width < pieces; width *= 2) {
    executor.run(pieces / (2 * width), [&](size_t i) {
      const size_t first = bound(2 * i * width);
      const T* const middle = all.data() + bound((2 * i + 1) * width);
      const T* const end = all.data() + bound((2 * i + 2) * width);
      std::merge(std::as_const(all).data() + first, middle, middle, end, merged.data() + first,
                 less);
    });
    all.swap(merged);
  }
}

}  // namespace plc

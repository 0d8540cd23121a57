#include "engine/transform/strip.h"
#include "pyramid/memory.h"

#include <algorithm>
#include <limits>

namespace plc {

namespace {

// Dynamic programming over the grid (i, j), 0 <= i < d and 0 <= j <= e, where column j stands for
// q[(start - j) mod e]. Every strip comes to p[0] once, at q[start], and so is one path from (0, 0)
// to (d - 1, e), from where it closes. The only edges that two places of the grid share are (i, 0)
// and (i, e): a path visits both when it turns to j at i and stays there to the end, which would
// use the edge twice and corrupt the mesh. So there are two layers: `turning` has gone along j = 0
// and, perhaps, from there along j; `turned` has grown i again since and alone may reach j = e.
class StripSearch {
 public:
  StripSearch(const Vector<Vec3>& p, const Vector<Vec3>& q)
      : d_(static_cast<uint32_t>(p.size())), e_(static_cast<uint32_t>(q.size())) {
    rung_.resize(static_cast<size_t>(d_) * e_);
    for (uint32_t i = 0; i < d_; ++i) {
      for (uint32_t j = 0; j < e_; ++j) rung_[i * e_ + j] = length(p[i] - q[j]);
    }
    turning_.resize(static_cast<size_t>(d_) * (e_ + 1));
    turned_.resize(turning_.size());
  }

  // Length of the shortest strip that comes to p[0] at q[start].
  float solve(uint32_t start) {
    for (uint32_t i = 0; i < d_; ++i) {
      for (uint32_t j = 0; j <= e_; ++j) {
        const float rung = rung_[i * e_ + column(start, j)];
        const size_t here = at(i, j);
        if (j == 0) {
          turning_[here] = (i == 0 ? 0 : turning_[at(i - 1, 0)]) + rung;
        } else {
          turning_[here] = j == e_ ? kNone : turning_[here - 1] + rung;
        }
        turned_[here] = i == 0 || j == 0 ? kNone : best_before(i, j).length + rung;
      }
    }
    return turned_[at(d_ - 1, e_)];
  }

  // The rungs of the strip that solve(start) found.
  Vector<Rung> trace(uint32_t start) const {
    Vector<Rung> rungs;
    uint32_t i = d_ - 1;
    uint32_t j = e_;
    for (bool turned = true; turned;) {
      rungs.push_back({i, column(start, j)});
      const Before before = best_before(i, j);
      (before.along_i ? i : j) -= 1;
      turned = before.turned;
    }
    for (;; --j) {
      rungs.push_back({i, column(start, j)});
      if (j == 0) break;
    }
    while (i-- > 0) rungs.push_back({i, column(start, 0)});
    std::reverse(rungs.begin(), rungs.end());
    return rungs;
  }

 private:
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  // How a path came to a turned place.
  struct Before {
    float length;
    bool along_i, turned;
  };
  Before best_before(uint32_t i, uint32_t j) const {
    Before best{turned_[at(i - 1, j)], true, true};
    if (turning_[at(i - 1, j)] < best.length) best = {turning_[at(i - 1, j)], true, false};
    if (turned_[at(i, j - 1)] < best.length) best = {turned_[at(i, j - 1)], false, true};
    return best;
  }

  size_t at(uint32_t i, uint32_t j) const { return static_cast<size_t>(i) * (e_ + 1) + j; }
  uint32_t row(uint32_t i) const { return i == d_ ? 0 : i; }
  uint32_t column(uint32_t start, uint32_t j) const {
    const uint32_t k = start + e_ - j;
    return k < e_ ? k : k - e_;
  }

  uint32_t d_, e_;
  Vector<float> rung_;
  Vector<float> turning_, turned_;
};

}  // namespace

Vector<Rung> shortest_strip(const Vector<Vec3>& p, const Vector<Vec3>& q) {
  if (p.empty() || q.empty()) return {};
  StripSearch search(p, q);
  uint32_t best_start = 0;
  float best = std::numeric_limits<float>::infinity();
  for (uint32_t start = 0; start < q.size(); ++start) {
    const float total = search.solve(start);
    if (total < best) {
      best = total;
      best_start = start;
    }
  }
  search.solve(best_start);
  return search.trace(best_start);
}

}  // namespace plc

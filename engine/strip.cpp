#include "engine/strip.h"

#include <algorithm>
#include <limits>

namespace plc {

namespace {

// Dynamic programming over the grid (i, j), 0 <= i <= d and 0 <= j <= e, from (0, 0) to (d, e),
// where column j stands for q[(start - j) mod e]. (i, 0) and (i, e) are the same edge, as are (0,
// j) and (d, j): a strip that visited both would use an edge twice and corrupt the mesh, so the
// first half of each border belongs to the start and the second to the end.
class StripSearch {
 public:
  StripSearch(const std::vector<Vec3>& p, const std::vector<Vec3>& q)
      : d_(static_cast<uint32_t>(p.size())), e_(static_cast<uint32_t>(q.size())) {
    rung_.resize(static_cast<size_t>(d_) * e_);
    for (uint32_t i = 0; i < d_; ++i) {
      for (uint32_t j = 0; j < e_; ++j) rung_[i * e_ + j] = length(p[i] - q[j]);
    }
    cost_.resize((d_ + 1) * (e_ + 1));
  }

  // Length of the best strip from p[0]-q[start]; infinite where the borders forbid all.
  float solve(uint32_t start) {
    for (uint32_t i = 0; i <= d_; ++i) {
      for (uint32_t j = 0; j <= e_; ++j) {
        float best = i == 0 && j == 0 ? 0.0F : kNone;
        if (i > 0) best = std::min(best, at(i - 1, j));
        if (j > 0) best = std::min(best, at(i, j - 1));
        at(i, j) = allowed(i, j) ? best + rung(start, i, j) : kNone;
      }
    }
    return at(d_, e_);
  }

  // The rungs of the strip that solve(start) found, without the repeated last one.
  std::vector<Rung> trace(uint32_t start) const {
    std::vector<Rung> rungs;
    for (uint32_t i = d_, j = e_; i != 0 || j != 0;) {
      if (j == 0 || (i > 0 && at(i - 1, j) <= at(i, j - 1))) {
        --i;
      } else {
        --j;
      }
      rungs.push_back({i % d_, column(start, j)});
    }
    std::reverse(rungs.begin(), rungs.end());
    return rungs;
  }

 private:
  static constexpr float kNone = std::numeric_limits<float>::infinity();

  float& at(uint32_t i, uint32_t j) { return cost_[i * (e_ + 1) + j]; }
  float at(uint32_t i, uint32_t j) const { return cost_[i * (e_ + 1) + j]; }
  uint32_t column(uint32_t start, uint32_t j) const { return (start + 2 * e_ - j) % e_; }
  float rung(uint32_t start, uint32_t i, uint32_t j) const {
    return rung_[i % d_ * e_ + column(start, j)];
  }
  bool allowed(uint32_t i, uint32_t j) const {
    if (j == 0 && i > d_ / 2) return false;
    if (j == e_ && i <= d_ / 2) return false;
    if (i == 0 && j > e_ / 2) return false;
    return i != d_ || j > e_ / 2;
  }

  uint32_t d_, e_;
  std::vector<float> rung_;
  std::vector<float> cost_;
};

}  // namespace

std::vector<Rung> shortest_strip(const std::vector<Vec3>& p, const std::vector<Vec3>& q) {
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

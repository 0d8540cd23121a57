// What a run told of its progress, and how right that was.
#pragma once
#include <vector>

namespace samples {

// After an iteration: what the run had cost so far, and the part that was told to be done.
struct Told {
  double cost, fraction;
};

// The part of the run from 20 % on in which what was told to be left was off by more than a factor
// of two, and by more than 5 % of the run besides.
inline double part_off(const std::vector<Told>& told) {
  const double all = told.back().cost;
  double off = 0;
  for (size_t i = 0; i + 1 < told.size(); ++i) {
    const auto& [cost, fraction] = told[i];
    if (cost < 0.2 * all) continue;
    const double is = all - cost, slack = 0.05 * all;
    const double left = cost * (1 - fraction) / fraction;
    if (left > 2 * is + slack || left < is / 2 - slack) off += told[i + 1].cost - cost;
  }
  return off / (0.8 * all);
}

}  // namespace samples

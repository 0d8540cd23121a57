#include "tools/command/label_neighbours.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace plc::tools {

LabelNeighbours::LabelNeighbours(const std::vector<LabelPiece>& pieces, double reach)
    : pieces_(pieces) {
  for (const LabelPiece& piece : pieces) {
    Box box;
    box.low.fill(std::numeric_limits<double>::infinity());
    box.high.fill(-std::numeric_limits<double>::infinity());
    for (size_t i = 0; i < piece.mesh.xyz.size(); ++i) {
      box.low[i % 3] = std::min(box.low[i % 3], piece.mesh.xyz[i] - reach);
      box.high[i % 3] = std::max(box.high[i % 3], piece.mesh.xyz[i] + reach);
    }
    boxes_.push_back(box);
  }
}

bool LabelNeighbours::Box::overlaps(const Box& other) const {
  for (size_t k = 0; k < 3; ++k) {
    if (high[k] < other.low[k] || other.high[k] < low[k]) return false;
  }
  return true;
}

TriangleMesh LabelNeighbours::around(size_t own) const {
  TriangleMesh faces;
  for (size_t i = 0; i < pieces_.size(); ++i) {
    if (i != own && boxes_[own].overlaps(boxes_[i])) {
      append_within(pieces_[i].mesh, boxes_[own], faces);
    }
  }
  return faces;
}

void LabelNeighbours::append_within(const TriangleMesh& from, const Box& box, TriangleMesh& to) {
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> id(from.xyz.size() / 3, kNone);
  const auto point = [&](size_t corner) { return &from.xyz[3 * size_t{from.abc[corner]}]; };
  for (size_t f = 0; f < from.abc.size(); f += 3) {
    const double *const a = point(f), *const b = point(f + 1), *const c = point(f + 2);
    Box face;
    for (size_t k = 0; k < 3; ++k) {
      face.low[k] = std::min({a[k], b[k], c[k]});
      face.high[k] = std::max({a[k], b[k], c[k]});
    }
    if (!face.overlaps(box)) continue;
    for (size_t corner = f; corner < f + 3; ++corner) {
      uint32_t& known = id[from.abc[corner]];
      if (known == kNone) {
        known = static_cast<uint32_t>(to.xyz.size() / 3);
        to.xyz.insert(to.xyz.end(), point(corner), point(corner) + 3);
      }
      to.abc.push_back(known);
    }
  }
}

}  // namespace plc::tools

#include "tools/blocks/vertex_clusters.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace plc::tools {

uint32_t VertexClusters::index_at(const Place& place) {
  Int3 cube{};
  for (size_t a = 0; a < 3; ++a) {
    cube[a] = static_cast<int64_t>(std::floor((place[a] - origin_) / side_));
  }
  return index_of(cube);
}

uint32_t VertexClusters::index_of(const Int3& cube) {
  // 21 bits each: images have fewer voxels on an axis.
  constexpr uint64_t kMask = (uint64_t{1} << 21U) - 1;
  uint64_t key = 0;
  for (const int64_t number : cube) key = key << 21U | (static_cast<uint64_t>(number) & kMask);
  const auto [found, made] = index_.try_emplace(key, static_cast<uint32_t>(clusters_.size()));
  if (made) clusters_.push_back({cube});
  return found->second;
}

void VertexClusters::add(uint32_t cluster, const Place& sum, uint64_t count) {
  Cluster& to = clusters_[cluster];
  for (size_t a = 0; a < 3; ++a) to.sum[a] += sum[a];
  to.count += count;
}

void VertexClusters::add_face(uint32_t a, uint32_t b, uint32_t c) {
  if (a == b || b == c || c == a) return;
  if (b < a && b < c) {
    faces_.push_back({b, c, a});
  } else if (c < a && c < b) {
    faces_.push_back({c, a, b});
  } else {
    faces_.push_back({a, b, c});
  }
}

void VertexClusters::settle() {
  // Those between the same three side by side, of both orientations.
  const auto key = [](const Face& f) {
    return std::tuple(f.a, std::min(f.b, f.c), std::max(f.b, f.c));
  };
  std::sort(faces_.begin(), faces_.end(), [&](const Face& l, const Face& r) {
    return key(l) != key(r) ? key(l) < key(r) : l.b < r.b;
  });
  std::vector<Face> left;
  for (size_t i = 0; i < faces_.size();) {
    int64_t net = 0;  // how many more have b < c
    size_t end = i;
    for (; end < faces_.size() && key(faces_[end]) == key(faces_[i]); ++end) {
      net += faces_[end].b < faces_[end].c ? 1 : -1;
    }
    auto [a, b, c] = key(faces_[i]);
    if (net < 0) std::swap(b, c);
    left.insert(left.end(), static_cast<size_t>(std::abs(net)), {a, b, c});
    i = end;
  }
  faces_ = std::move(left);
}

VertexClusters VertexClusters::above() const {
  VertexClusters wide(origin_, 2 * side_);
  std::vector<uint32_t> index;
  for (const Cluster& from : clusters_) {
    index.push_back(wide.index_of({from.cube[0] >> 1, from.cube[1] >> 1, from.cube[2] >> 1}));
    wide.add(index.back(), from.sum, from.count);
  }
  for (const Face& f : faces_) wide.add_face(index[f.a], index[f.b], index[f.c]);
  wide.settle();
  return wide;
}

Place VertexClusters::place(uint32_t index) const {
  const Cluster& from = clusters_[index];
  Place at{};
  for (size_t a = 0; a < 3; ++a) {
    // Rounding must not take it out of its cube, to which its lower borders belong.
    const double low = origin_ + static_cast<double>(from.cube[a]) * side_;
    at[a] = std::clamp(from.sum[a] / static_cast<double>(from.count), low,
                       std::nextafter(low + side_, low));
  }
  return at;
}

}  // namespace plc::tools

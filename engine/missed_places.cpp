#include "engine/missed_places.h"

#include <algorithm>
#include <cmath>

#include "engine/voxel_sides.h"

namespace plc {

namespace {

constexpr uint8_t kNone = 0;

using Voxel = std::array<int32_t, 3>;

class Search {
 public:
  Search(const ImageView& image, MissedPlaces& places) : image_(image), kind_(places.kind) {
    for (size_t a = 0; a < 3; ++a) length_[a] = 1 / image.scale[a];
  }

  // Nothing within `clearance` of a vertex is missed.
  void clear_near(const Mesh& mesh, float clearance) {
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      if (!mesh.alive(v)) continue;
      const Packed& p = mesh.packed[v];
      const float at[3] = {p.x, p.y, p.z};
      Voxel low, high;
      std::array<float, 3> centre;
      for (size_t a = 0; a < 3; ++a) {
        centre[a] = image_.scale[a] * at[a] + image_.offset[a];
        const float reach = clearance / length_[a];
        low[a] = std::max(0, static_cast<int32_t>(std::ceil(centre[a] - reach)));
        high[a] = std::min(image_.dims[a] - 1, static_cast<int32_t>(std::floor(centre[a] + reach)));
      }
      for (int32_t z = low[2]; z <= high[2]; ++z) {
        for (int32_t y = low[1]; y <= high[1]; ++y) {
          for (int32_t x = low[0]; x <= high[0]; ++x) {
            const float dx = (static_cast<float>(x) - centre[0]) * length_[0];
            const float dy = (static_cast<float>(y) - centre[1]) * length_[1];
            const float dz = (static_cast<float>(z) - centre[2]) * length_[2];
            if (dx * dx + dy * dy + dz * dz < clearance * clearance)
              kind_[index({x, y, z})] = kNone;
          }
        }
      }
    }
  }

  // The set of the seed, taken out of `left`; whether one of its voxels is the middle of a ball, or
  // the corner of one between voxels.
  bool flood(size_t seed, std::vector<uint8_t>& left, std::vector<uint32_t>& set) const {
    set.assign(1, static_cast<uint32_t>(seed));
    left[seed] = 0;
    bool holds = false;
    for (size_t i = 0; i < set.size(); ++i) {
      const Voxel at = voxel(set[i]);
      holds = holds || free(at, around_) || free(at, between_);
      for (int32_t z = -1; z <= 1; ++z) {
        for (int32_t y = -1; y <= 1; ++y) {
          for (int32_t x = -1; x <= 1; ++x) {
            const Voxel next{at[0] + x, at[1] + y, at[2] + z};
            if (!within(next)) continue;
            const size_t n = index(next);
            if (left[n] == 0 || kind_[n] != kind_[seed]) continue;
            left[n] = 0;
            set.push_back(static_cast<uint32_t>(n));
          }
        }
      }
    }
    return holds;
  }

  // The voxels whose boxes a ball touches, about a voxel's centre and about a corner of voxels.
  void list_ball(float radius) {
    Voxel most;
    for (size_t a = 0; a < 3; ++a) {
      most[a] = static_cast<int32_t>(std::ceil(radius / length_[a])) + 1;
    }
    for (int32_t z = -most[2]; z <= most[2]; ++z) {
      for (int32_t y = -most[1]; y <= most[1]; ++y) {
        for (int32_t x = -most[0]; x <= most[0]; ++x) {
          const Voxel offset{x, y, z};
          if (box_distance(offset, 0) < radius) around_.push_back(offset);
          if (box_distance(offset, 0.5F) < radius) between_.push_back(offset);
        }
      }
    }
  }

  Voxel voxel(uint32_t i) const {
    const auto row = static_cast<uint32_t>(image_.dims[0]);
    const auto rows = static_cast<uint32_t>(image_.dims[1]);
    return {static_cast<int32_t>(i % row), static_cast<int32_t>(i / row % rows),
            static_cast<int32_t>(i / row / rows)};
  }

 private:
  size_t index(const Voxel& v) const { return voxel_index(image_, v); }
  bool within(const Voxel& v) const {
    for (size_t a = 0; a < 3; ++a) {
      if (v[a] < 0 || v[a] >= image_.dims[a]) return false;
    }
    return true;
  }

  float box_distance(const Voxel& offset, float shift) const {
    float squared = 0;
    for (size_t a = 0; a < 3; ++a) {
      const float away = std::abs(static_cast<float>(offset[a]) - shift) - 0.5F;
      const float gap = std::max(away, 0.0F) * length_[a];
      squared += gap * gap;
    }
    return std::sqrt(squared);
  }

  bool free(const Voxel& at, const std::vector<Voxel>& ball) const {
    const uint8_t own = kind_[index(at)];
    return std::all_of(ball.begin(), ball.end(), [&](const Voxel& o) {
      const Voxel v{at[0] + o[0], at[1] + o[1], at[2] + o[2]};
      return within(v) && kind_[index(v)] == own;
    });
  }

  const ImageView& image_;
  Buffer<uint8_t>& kind_;
  std::array<float, 3> length_{};  // of a voxel, mesh units
  std::vector<Voxel> around_, between_;
};

}  // namespace

MissedPlaces find_missed_places(const Mesh& mesh, const ImageView& image, float iso,
                                bool inside_above, float clearance, float radius,
                                const Executor& executor, Buffer<uint8_t>& tried) {
  MissedPlaces places;
  voxel_sides(mesh, image, executor, places.kind);
  const size_t voxels = places.kind.size();
  const auto slice = static_cast<size_t>(image.dims[0]) * static_cast<size_t>(image.dims[1]);
  executor.run(static_cast<size_t>(image.dims[2]), [&](size_t z) {
    for (size_t i = z * slice; i < (z + 1) * slice; ++i) {
      const bool object = inside_above ? image.data[i] >= iso : image.data[i] <= iso;
      const bool inside = places.kind[i] != 0;
      const Missed kind = object ? Missed::kPart : Missed::kCavity;
      places.kind[i] = object == inside ? kNone : static_cast<uint8_t>(1 + static_cast<int>(kind));
    }
  });
  Search search(image, places);
  search.clear_near(mesh, clearance);
  search.list_ball(radius);
  places.low.fill({image.dims[0], image.dims[1], image.dims[2]});
  places.high.fill({-1, -1, -1});
  if (tried.empty()) {
    tried.resize(voxels);
    std::fill(tried.begin(), tried.end(), uint8_t{0});
  }
  std::vector<uint8_t> left(places.kind.begin(), places.kind.end());
  std::vector<uint32_t> set;
  std::vector<uint32_t> dropped;
  for (size_t seed = 0; seed < voxels; ++seed) {
    if (left[seed] == 0) continue;
    const bool holds = search.flood(seed, left, set);
    const bool fresh =
        std::none_of(set.begin(), set.end(), [&](uint32_t i) { return tried[i] != 0; });
    if (!holds || !fresh) {
      dropped.insert(dropped.end(), set.begin(), set.end());
      continue;
    }
    const auto k = static_cast<size_t>(places.kind[seed] - 1);
    ++places.count[k];
    for (const uint32_t i : set) {
      tried[i] = 1;
      const Voxel v = search.voxel(i);
      for (size_t a = 0; a < 3; ++a) {
        places.low[k][a] = std::min(places.low[k][a], v[a]);
        places.high[k][a] = std::max(places.high[k][a], v[a]);
      }
    }
  }
  // Only now: the places are judged in scan order, by what all of them were.
  for (const uint32_t i : dropped) places.kind[i] = kNone;
  return places;
}

}  // namespace plc

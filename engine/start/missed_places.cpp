#include "engine/start/missed_places.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "engine/base/constants.h"
#include "engine/start/joined_voxels.h"
#include "engine/start/thickness.h"
#include "kernels/image_value.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

using Sets = std::array<VoxelSet, 2>;  // by Missed

// Slices that a task clears around the mesh, and voxels on a side of the squares of what is left.
constexpr size_t kSlab = 8, kSquare = 4;

// The voxels on which the image and the surface disagree.
class Disagreement {
 public:
  Disagreement(const Mesh& mesh, const ImageObject& object, const VoxelRoom& room)
      : image_(object.image),
        iso_(object.iso),
        above_(object.above),
        room_(room),
        sides_(mesh, object.image, room) {}

  bool known() const { return sides_.known(); }

  void add(int32_t z, Sets& missed) const {
    constexpr size_t kWord = sizeof(uint64_t);
    const int32_t first = room_.low[0];
    const size_t width = room_.width(0);
    Vector<float> values(width);
    Vector<uint8_t> inside(width), differ((width + kWord - 1) / kWord * kWord, 0);
    for (int32_t y = room_.low[1]; y <= room_.high[1]; ++y) {
      sides_.row(y, z, inside.data());
      image_row(image_, y, z, first, room_.high[0] + 1, values.data());
      if (above_) {
        for (size_t x = 0; x < width; ++x) differ[x] = inside[x] ^ uint8_t { values[x] >= iso_ };
      } else {
        for (size_t x = 0; x < width; ++x) differ[x] = inside[x] ^ uint8_t { values[x] <= iso_ };
      }
      for (size_t x = 0; x < width; x += kWord) {
        uint64_t word = 0;
        std::memcpy(&word, differ.data() + x, kWord);
        if (word == 0) continue;
        for (size_t i = x; i < x + kWord; ++i) {
          if (differ[i] == 0) continue;
          const Missed kind = inside[i] != 0 ? Missed::kCavity : Missed::kPart;
          missed[static_cast<size_t>(kind)].insert({first + static_cast<int32_t>(i), y, z});
        }
      }
    }
  }

 private:
  const ImageView& image_;
  float iso_;
  bool above_;
  VoxelRoom room_;
  VoxelSides sides_;
};

// What a place was found to be.
struct Place {
  bool holds = false;  // a ball
  bool tried = false;
  bool joined = false;  // a voxel of it to kPlaceVoxels of the object
  int64_t voxels = 0;
};

// Voxels of which no kPlaceVoxels on their side of iso are joined by faces: of noise there is no
// end of them, and by edges and corners they all hang together.
void leave_out_specks(const ImageObject& object, const Executor& executor, Sets& missed) {
  const ImageView& image = object.image;
  executor.run(static_cast<size_t>(image.dims[2]), [&](size_t slice) {
    const auto z = static_cast<int32_t>(slice);
    for (size_t k = 0; k < 2; ++k) {
      const bool of_object = k == static_cast<size_t>(Missed::kPart);
      const auto is_side = [&](const Voxel& v) {
        return is_within(image.dims, v) &&
               object.has(image_value(image, v[0], v[1], v[2])) == of_object;
      };
      for (int32_t y = 0; y < image.dims[1]; ++y) {
        missed[k].visit_row(y, z, 0, image.dims[0], [&](int32_t x) {
          if (!is_joined({x, y, z}, kPlaceVoxels, is_side)) missed[k].erase({x, y, z});
        });
      }
    }
  });
}

class Search {
 public:
  Search(const ImageObject& object, Sets& missed)
      : object_(object), image_(object.image), missed_(missed) {
    for (size_t a = 0; a < 3; ++a) length_[a] = 1 / image_.scale[a];
  }

  // Nothing within `clearance` of a vertex is missed; nor of a face, which may be larger, where
  // `apart` is not 0: between the places of it that are looked at are no more than that.
  void clear_near(const Mesh& mesh, float apart, float clearance, const Executor& executor) {
    const auto slabs = (static_cast<size_t>(image_.dims[2]) + kSlab - 1) / kSlab;
    std::vector<Vector<uint32_t>> vertices(slabs), faces(slabs);
    const float reach = clearance / length_[2] + 1;  // places on a face are rounded
    const auto list = [&](std::vector<Vector<uint32_t>>& lists, float low, float high,
                          uint32_t what) {
      const float last = static_cast<float>(image_.dims[2] - 1);
      const auto begin = static_cast<size_t>(std::clamp(low - reach, 0.0F, last)) / kSlab;
      const auto end = static_cast<size_t>(std::clamp(high + reach, 0.0F, last)) / kSlab;
      for (size_t slab = begin; slab <= end; ++slab) lists[slab].push_back(what);
    };
    const auto z_of = [&](uint32_t v) { return voxel_of(mesh.at(v))[2]; };
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      if (mesh.alive(v) && !mesh.is_absent(v)) list(vertices, z_of(v), z_of(v), v);
    }
    const Vector<uint32_t> corners = apart > 0 ? mesh.faces(executor) : Vector<uint32_t>();
    for (size_t c = 0; c < corners.size(); c += 3) {
      const auto [low, high] =
          std::minmax({z_of(corners[c]), z_of(corners[c + 1]), z_of(corners[c + 2])});
      list(faces, low, high, static_cast<uint32_t>(c));
    }
    executor.run(slabs, [&](size_t index) {
      const auto first = static_cast<int32_t>(index * kSlab);
      const Slab slab{first, std::min(first + static_cast<int32_t>(kSlab), image_.dims[2]),
                      clearance};
      const Columns missed = columns_left(slab);
      for (const uint32_t v : vertices[index]) clear_near(mesh.at(v), slab, missed);
      if (faces[index].empty()) return;
      const Columns left = columns_left(slab);
      for (const uint32_t c : faces[index]) {
        clear_near_face({mesh.at(corners[c]), mesh.at(corners[c + 1]), mesh.at(corners[c + 2])},
                        apart, slab, left);
      }
    });
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

  // The place of the seed, taken out of `left`. asks_joined: whether `joined` is asked for.
  Place examine(const Voxel& seed, const VoxelSet& kind, const VoxelSet& tried, bool asks_joined,
                VoxelSet& left) {
    Place place;
    const auto is_object = [&](const Voxel& v) {
      return is_within(image_.dims, v) && object_.has(image_value(image_, v[0], v[1], v[2]));
    };
    left.erase(seed);
    flood(
        seed,
        [&](const Voxel& v) {
          ++place.voxels;
          place.tried = place.tried || tried.has(v);
          place.holds = place.holds || free(v, kind, around_) || free(v, kind, between_);
          place.joined = place.joined || (asks_joined && is_joined(v, kPlaceVoxels, is_object));
        },
        [&](const Voxel& v) {
          const bool found = left.has(v);
          if (found) left.erase(v);
          return found;
        });
    return place;
  }

  // Puts the place of the seed into `tried`, and into `kept`, whose box grows by it, what is to get
  // a bubble: where the place is as thick as `thinnest` on every axis, and the voxels beside that.
  // False where it is so nowhere.
  bool keep(const Voxel& seed, const VoxelSet& kind, float thinnest, VoxelSet& tried,
            VoxelSet& kept, Voxel& low, Voxel& high) {
    bool any = false;
    tried.insert(seed);
    flood(
        seed,
        [&](const Voxel& v) {
          if (!is_thick(v, kind, thinnest)) return;
          any = true;
          visit_around(v, [&](const Voxel& w) {
            if (!kind.has(w)) return;
            kept.insert(w);
            for (size_t a = 0; a < 3; ++a) {
              low[a] = std::min(low[a], w[a]);
              high[a] = std::max(high[a], w[a]);
            }
          });
        },
        [&](const Voxel& v) {
          const bool found = kind.has(v) && !tried.has(v);
          if (found) tried.insert(v);
          return found;
        });
    return any;
  }

 private:
  // Slices first .. end - 1, of which one task clears voxels.
  struct Slab {
    int32_t first, end;
    float clearance;
  };
  struct VoxelBox {
    Voxel low, high;
  };
  // Whether anything is missed in the slab, by squares of kSquare voxels of x and y: most of the
  // mesh is far from all of that.
  using Columns = Vector<uint8_t>;

  std::array<float, 3> voxel_of(Vec3 p) const {
    return {image_.scale[0] * p.x + image_.offset[0], image_.scale[1] * p.y + image_.offset[1],
            image_.scale[2] * p.z + image_.offset[2]};
  }
  // The voxels of the slab within its clearance of low .. high on every axis.
  VoxelBox box_around(const std::array<float, 3>& low, const std::array<float, 3>& high,
                      const Slab& slab) const {
    VoxelBox box;
    for (size_t a = 0; a < 3; ++a) {
      const float reach = slab.clearance / length_[a];
      box.low[a] = std::max(0, static_cast<int32_t>(std::ceil(low[a] - reach)));
      box.high[a] = std::min(image_.dims[a] - 1, static_cast<int32_t>(std::floor(high[a] + reach)));
    }
    box.low[2] = std::max(box.low[2], slab.first);
    box.high[2] = std::min(box.high[2], slab.end - 1);
    return box;
  }
  void clear_near(Vec3 p, const Slab& slab, const Columns& left) {
    const std::array<float, 3> centre = voxel_of(p);
    const VoxelBox box = box_around(centre, centre, slab);
    if (!any_left(box, left)) return;
    clear(box, [&](const Voxel& v) { return is_near(v, centre, slab.clearance); });
  }
  // Those of what is missed in the box for which near(voxel).
  template <typename Near>
  void clear(const VoxelBox& box, const Near& near) {
    for (int32_t z = box.low[2]; z <= box.high[2]; ++z) {
      for (int32_t y = box.low[1]; y <= box.high[1]; ++y) {
        for (VoxelSet& set : missed_) {
          set.visit_row(y, z, box.low[0], box.high[0] + 1, [&](int32_t x) {
            if (near({x, y, z})) set.erase({x, y, z});
          });
        }
      }
    }
  }
  bool is_near(const Voxel& v, const std::array<float, 3>& place, float clearance) const {
    const float dx = (static_cast<float>(v[0]) - place[0]) * length_[0];
    const float dy = (static_cast<float>(v[1]) - place[1]) * length_[1];
    const float dz = (static_cast<float>(v[2]) - place[2]) * length_[2];
    return dx * dx + dy * dy + dz * dz < clearance * clearance;
  }
  Columns columns_left(const Slab& slab) const {
    Columns left(squares(0) * squares(1), 0);
    for (int32_t z = slab.first; z < slab.end; ++z) {
      for (int32_t y = 0; y < image_.dims[1]; ++y) {
        for (const VoxelSet& set : missed_) {
          set.visit_row(y, z, 0, image_.dims[0], [&](int32_t x) { left[square(x, y)] = 1; });
        }
      }
    }
    return left;
  }
  size_t squares(size_t axis) const { return static_cast<size_t>(image_.dims[axis]) / kSquare + 1; }
  size_t square(int32_t x, int32_t y) const {
    return static_cast<size_t>(y) / kSquare * squares(0) + static_cast<size_t>(x) / kSquare;
  }
  void clear_near_face(const std::array<Vec3, 3>& p, float apart, const Slab& slab,
                       const Columns& left) {
    const Vec3 a = p[0], b = p[1], c = p[2];
    const float longest = std::max(std::max(length(b - a), length(c - b)), length(a - c));
    const int steps = static_cast<int>(std::ceil(longest / apart));
    if (steps <= 1) return;
    const VoxelBox box = box_around_face(p, slab);
    if (!any_left(box, left)) return;
    clear(box, [&](const Voxel& v) {
      for (int i = 0; i <= steps; ++i) {
        for (int j = 0; i + j <= steps; ++j) {
          const float u = static_cast<float>(i) / static_cast<float>(steps);
          const float w = static_cast<float>(j) / static_cast<float>(steps);
          if (is_near(v, voxel_of(a + (b - a) * u + (c - a) * w), slab.clearance)) return true;
        }
      }
      return false;
    });
  }
  // A voxel more, as places on a face are rounded.
  VoxelBox box_around_face(const std::array<Vec3, 3>& p, const Slab& slab) const {
    const std::array<float, 3> q[3] = {voxel_of(p[0]), voxel_of(p[1]), voxel_of(p[2])};
    std::array<float, 3> low, high;
    for (size_t a = 0; a < 3; ++a) {
      low[a] = std::min({q[0][a], q[1][a], q[2][a]}) - 1;
      high[a] = std::max({q[0][a], q[1][a], q[2][a]}) + 1;
    }
    return box_around(low, high, slab);
  }
  bool any_left(const VoxelBox& box, const Columns& left) const {
    constexpr auto kStep = static_cast<int32_t>(kSquare);
    for (int32_t y = box.low[1] / kStep * kStep; y <= box.high[1]; y += kStep) {
      for (int32_t x = box.low[0] / kStep * kStep; x <= box.high[0]; x += kStep) {
        if (left[square(x, y)] != 0) return true;
      }
    }
    return false;
  }

  // visit(voxel) for the seed and what is connected to it; take(voxel) tells whether a neighbour is
  // of the place and new. Only the front is kept in memory.
  template <typename Visit, typename Take>
  void flood(const Voxel& seed, const Visit& visit, const Take& take) {
    front_.assign(1, seed);
    while (!front_.empty()) {
      next_.clear();
      for (const Voxel& at : front_) {
        visit(at);
        visit_around(at, [&](const Voxel& v) {
          if (take(v)) next_.push_back(v);
        });
      }
      front_.swap(next_);
    }
  }

  // visit(voxel) for a voxel of the image and those around it.
  template <typename Visit>
  void visit_around(const Voxel& at, const Visit& visit) const {
    for (int32_t z = -1; z <= 1; ++z) {
      for (int32_t y = -1; y <= 1; ++y) {
        for (int32_t x = -1; x <= 1; ++x) {
          const Voxel v{at[0] + x, at[1] + y, at[2] + z};
          if (is_within(image_.dims, v)) visit(v);
        }
      }
    }
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

  bool free(const Voxel& at, const VoxelSet& kind, const Vector<Voxel>& ball) const {
    return std::all_of(ball.begin(), ball.end(), [&](const Voxel& o) {
      const Voxel v{at[0] + o[0], at[1] + o[1], at[2] + o[2]};
      return is_within(image_.dims, v) && kind.has(v);
    });
  }

  // Whether the iso-surface is `thinnest` apart on the two sides of a voxel, along each axis.
  bool is_thick(const Voxel& at, const VoxelSet& kind, float thinnest) const {
    const auto goes_on = [&](const Voxel& v) { return kind.has(v); };
    for (size_t axis = 0; axis < 3; ++axis) {
      if (extent_along(object_, at, axis, thinnest, goes_on) < thinnest) return false;
    }
    return true;
  }

  const ImageObject& object_;
  const ImageView& image_;
  Sets& missed_;
  std::array<float, 3> length_{};  // of a voxel, mesh units
  Vector<Voxel> around_, between_;
  Vector<Voxel> front_, next_;
};

}  // namespace

MissedPlaces find_missed_places(const Mesh& mesh, const ImageObject& object,
                                const PlaceLimits& limits, const Executor& executor,
                                VoxelSet& tried, const VoxelRoom& room) {
  const ImageView& image = object.image;
  Sets missed{VoxelSet(image.dims), VoxelSet(image.dims)};
  if (const Disagreement disagreement(mesh, object, room); disagreement.known()) {
    executor.run(room.width(2), [&](size_t k) {
      disagreement.add(room.low[2] + static_cast<int32_t>(k), missed);
    });
  }
  Search search(object, missed);
  const float apart = mesh.sizing == nullptr
                          ? 0
                          : kMaxEdge * mesh.sizing->field.finest() * static_cast<float>(mesh.delta);
  search.clear_near(mesh, apart, limits.clearance, executor);
  if (mesh.sizing != nullptr && mesh.sizing->field.noise() > kNoisy) {
    leave_out_specks(object, executor, missed);
  }
  search.list_ball(limits.radius);
  MissedPlaces places;
  places.low.fill({image.dims[0], image.dims[1], image.dims[2]});
  places.high.fill({-1, -1, -1});
  if (!tried.has_image()) tried = VoxelSet(image.dims);
  for (size_t k = 0; k < 2; ++k) {
    places.voxels[k] = VoxelSet(image.dims);
    VoxelSet left(missed[k]);
    left.visit([&](const Voxel& seed) {
      const bool asks_joined = mesh.sizing != nullptr && k == static_cast<size_t>(Missed::kPart);
      const Place place = search.examine(seed, missed[k], tried, asks_joined, left);
      const bool thin = mesh.sizing != nullptr && place.voxels >= kPlaceVoxels;
      if (!(place.holds || thin) || place.tried || (asks_joined && !place.joined)) return;
      if (search.keep(seed, missed[k], limits.thinnest, tried, places.voxels[k], places.low[k],
                      places.high[k])) {
        ++places.count[k];
      }
    });
  }
  return places;
}

}  // namespace plc

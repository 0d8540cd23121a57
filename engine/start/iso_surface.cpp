#include "engine/start/iso_surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "engine/base/blocks.h"
#include "engine/mesh/face_rings.h"
#include "engine/start/cell_faces.h"
#include "engine/start/small_parts.h"
#include "kernels/image_value.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// Layers of cells per task; each task holds two slices of ids.
constexpr size_t kLayers = 8;
// Edges from a lattice point to larger coordinates: direction d = 1 .. 7, bit a of d is axis a.
constexpr size_t kDirections = 7;

constexpr uint32_t kAllCorners = 255;

// The lattice: the voxels, and one point more on every side that is outside.
class Lattice {
 public:
  Lattice(const ImageObject& object, const LatticeValues& values)
      : object_(object), image_(object.image), values_(values) {
    for (size_t a = 0; a < 3; ++a) size_[a] = static_cast<size_t>(image_.dims[a]) + 2;
  }

  size_t slices() const { return size_[2]; }
  size_t slice_points() const { return size_[0] * size_[1]; }
  size_t columns() const { return size_[0]; }
  size_t rows() const { return size_[1]; }
  size_t point(size_t x, size_t y) const { return y * size_[0] + x; }

  // A byte per point of slice z: 1 inside.
  void classify(size_t z, Vector<uint8_t>& inside) const {
    inside.assign(slice_points(), 0);
    if (z == 0 || z + 1 >= size_[2]) return;
    for (size_t y = 1; y + 1 < size_[1]; ++y) {
      values_.sides(voxel(y), voxel(z), inside.data() + point(1, y));
    }
  }

  // Where the surface crosses the edge from (x, y, z) in direction d, in mesh space.
  Vec3 crossing(size_t x, size_t y, size_t z, size_t d) const {
    const std::array<size_t, 3> from{x, y, z};
    const std::array<size_t, 3> to{x + (d & 1), y + (d >> 1 & 1), z + (d >> 2 & 1)};
    double t = 0.5;  // beyond the border there is no value to go by
    if (is_voxel(from) && is_voxel(to)) {
      const double a = values_.at(voxel(from[0]), voxel(from[1]), voxel(from[2]));
      const double b = values_.at(voxel(to[0]), voxel(to[1]), voxel(to[2]));
      t = (static_cast<double>(object_.iso) - a) / (b - a);
      t = t > kIsoMargin ? std::min(t, 1 - kIsoMargin) : kIsoMargin;  // a NaN is put at the margin
    }
    std::array<float, 3> p{};
    for (size_t a = 0; a < 3; ++a) {
      const double c = static_cast<double>(from[a]) - 1 + (to[a] != from[a] ? t : 0);
      p[a] = static_cast<float>((c - static_cast<double>(image_.offset[a])) /
                                static_cast<double>(image_.scale[a]));
    }
    return {p[0], p[1], p[2]};
  }

 private:
  bool is_voxel(const std::array<size_t, 3>& p) const {
    return p[0] != 0 && p[1] != 0 && p[2] != 0 && p[0] + 1 != size_[0] && p[1] + 1 != size_[1] &&
           p[2] + 1 != size_[2];
  }
  static int32_t voxel(size_t point) { return static_cast<int32_t>(point) - 1; }

  const ImageObject& object_;
  const ImageView& image_;
  const LatticeValues& values_;
  std::array<size_t, 3> size_{};
};

// Whether the corners of the kCells cells of a row that begin with a point all are on one side;
// above: the same point in the next slice.
constexpr size_t kCells = 8;
bool on_one_side(const uint8_t* inside, const uint8_t* above, size_t row) {
  constexpr uint64_t kAllInside = 0x0101010101010101;
  uint64_t any = 0, all = kAllInside;
  for (const uint8_t* corner : {inside, inside + 1, inside + row, inside + row + 1, above,
                                above + 1, above + row, above + row + 1}) {
    uint64_t word = 0;
    std::memcpy(&word, corner, kCells);
    any |= word;
    all &= word;
  }
  return any == 0 || all == kAllInside;
}

// visit(x, y) for the cells between a slice and the next, `above`, but for many of those that the
// surface does not cross.
template <typename Visit>
void visit_cells(const Lattice& lattice, const Vector<uint8_t>& inside,
                 const Vector<uint8_t>& above, const Visit& visit) {
  const size_t cells = lattice.columns() - 1;
  for (size_t y = 0; y + 1 < lattice.rows(); ++y) {
    for (size_t begin = 0; begin < cells; begin += kCells) {
      const size_t i = lattice.point(begin, y);
      const size_t end = std::min(begin + kCells, cells);
      if (end - begin == kCells && on_one_side(&inside[i], &above[i], lattice.columns())) continue;
      for (size_t x = begin; x < end; ++x) visit(x, y);
    }
  }
}

// visit(x, y, inside) for the points of a slice at which edges begin that are crossed, in the order
// of ids: bit c of `inside` is set where corner c of the cell is. above: the next slice. Points of
// the last row and column are outside, and so are those that they would lead to.
template <typename Visit>
void visit_crossed(const Lattice& lattice, const Vector<uint8_t>& inside,
                   const Vector<uint8_t>& above, const Visit& visit) {
  const size_t nx = lattice.columns();
  visit_cells(lattice, inside, above, [&](size_t x, size_t y) {
    const size_t i = lattice.point(x, y);
    const uint8_t corners[kDirections + 1] = {inside[i],          inside[i + 1],    inside[i + nx],
                                              inside[i + nx + 1], above[i],         above[i + 1],
                                              above[i + nx],      above[i + nx + 1]};
    uint32_t bits = 0;
    for (uint32_t c = 0; c <= kDirections; ++c) bits |= static_cast<uint32_t>(corners[c]) << c;
    if (bits != 0 && bits != kAllCorners) visit(x, y, bits);
  });
}

size_t count_of(uint32_t bits) {
  return static_cast<size_t>(std::popcount(bits));
}

// The points of one slice. Of those at which crossed edges begin: which, and the id of the first.
struct Slice {
  Vector<uint8_t> inside;
  Vector<uint8_t> crossed;
  Vector<uint32_t> first;

  uint32_t id(size_t point, uint32_t d) const {
    const uint32_t before = crossed[point] & ((1U << (d - 1)) - 1);
    return first[point] + static_cast<uint32_t>(count_of(before));
  }
};

class Builder {
 public:
  Builder(const ImageObject& object, const LatticeValues& values, const CellFaces& cell,
          const Executor& executor)
      : lattice_(object, values),
        cell_(cell),
        executor_(executor),
        layers_(lattice_.slices() - 1),
        first_id_(layers_ + 1, 0),
        first_face_(layers_ + 1, 0) {}

  Status count() {
    for_layers([&](size_t, size_t begin, size_t end) {
      Vector<uint8_t> inside, above;
      lattice_.classify(begin, inside);
      for (size_t z = begin; z < end; ++z) {
        lattice_.classify(z + 1, above);
        visit_crossed(lattice_, inside, above, [&](size_t, size_t, uint32_t corners) {
          first_id_[z + 1] += count_of(crossed_edges(corners));
          first_face_[z + 1] += cell_.first[corners + 1] - cell_.first[corners];
        });
        inside.swap(above);
      }
    });
    for (size_t z = 0; z < layers_; ++z) {
      first_id_[z + 1] += first_id_[z];
      first_face_[z + 1] += first_face_[z];
    }
    if (vertex_count() == 0) {
      return {ErrorCode::kInvalidData,
              "no iso-surface: no voxel of the image is inside; check the iso-value"};
    }
    if (vertex_count() > kMaxMeshVertices) {
      return {ErrorCode::kOutOfMemory, "the iso-surface has " + std::to_string(vertex_count()) +
                                           " vertices, at most " +
                                           std::to_string(kMaxMeshVertices) + " are possible"};
    }
    return {};
  }

  // voxel: as iso_surface() has it; NULL: not asked for.
  void build(Mesh& mesh, Vector<uint64_t>* voxel) {
    voxel_ = voxel;
    if (voxel_ != nullptr) voxel_->resize(vertex_count());
    march_all();
    const FaceRings rings(all_.abc.data(), all_.abc.size() / 3, vertex_count(), executor_);
    fill_from_rings(mesh, all_.xyz.data(), vertex_count(), rings);
  }

  // As iso_crossings() has it.
  Crossings crossings(int64_t least) {
    if (least > 0) points_.resize(vertex_count());
    march_all();
    if (least > 0) leave_out_small_parts(points_, least, executor_, all_);
    return std::move(all_);
  }

 private:
  size_t vertex_count() const { return first_id_[layers_]; }

  void march_all() {
    all_.xyz.resize_uninitialized(3 * vertex_count());
    all_.abc.resize_uninitialized(3 * first_face_[layers_]);
    for_layers([&](size_t, size_t begin, size_t end) {
      uint32_t* abc = all_.abc.data() + 3 * first_face_[begin];
      Slice lower, upper;
      Vector<uint8_t> above;
      lattice_.classify(begin, lower.inside);
      lattice_.classify(begin + 1, upper.inside);
      number(begin, lower, upper.inside);
      for (size_t z = begin; z < end; ++z) {
        place(z, lower, upper.inside);
        lattice_.classify(z + 2, above);
        number(z + 1, upper, above);
        abc = march(lower, upper, abc);
        std::swap(lower, upper);
        upper.inside.swap(above);
      }
    });
  }

  // body(block, begin, end) over layers of cells; layer z lies between the slices z and z + 1.
  template <typename Body>
  void for_layers(const Body& body) {
    run_blocks(executor_, layers_, kLayers, body);
  }

  // The ids of the edges that begin in slice z, below `above`.
  void number(size_t z, Slice& slice, const Vector<uint8_t>& above) const {
    slice.crossed.resize(lattice_.slice_points());
    slice.first.resize(lattice_.slice_points());
    auto id = static_cast<uint32_t>(first_id_[z]);
    visit_crossed(lattice_, slice.inside, above, [&](size_t x, size_t y, uint32_t corners) {
      const uint32_t crossed = crossed_edges(corners);
      const size_t point = lattice_.point(x, y);
      slice.crossed[point] = static_cast<uint8_t>(crossed);
      slice.first[point] = id;
      id += static_cast<uint32_t>(count_of(crossed));
    });
  }

  // The positions of the vertices of slice z.
  void place(size_t z, const Slice& slice, const Vector<uint8_t>& above) {
    size_t id = first_id_[z];
    visit_crossed(lattice_, slice.inside, above, [&](size_t x, size_t y, uint32_t corners) {
      const bool here = (corners & 1) != 0;
      for (uint32_t crossed = crossed_edges(corners); crossed != 0; crossed &= crossed - 1, ++id) {
        const auto d = static_cast<size_t>(std::countr_zero(crossed)) + 1;
        const Vec3 p = lattice_.crossing(x, y, z, d);
        float* xyz = all_.xyz.data() + 3 * id;
        xyz[0] = p.x, xyz[1] = p.y, xyz[2] = p.z;
        if (d == 1 && !points_.empty()) {
          points_[id] = static_cast<int32_t>(here ? x + 1 : -(x + 1));
        }
        if (voxel_ == nullptr) continue;
        const size_t in_slice =
            here ? lattice_.point(x, y) : lattice_.point(x + (d & 1), y + (d >> 1 & 1));
        const size_t slices_up = here ? 0 : d >> 2 & 1;
        (*voxel_)[id] = uint64_t{z + slices_up} * lattice_.slice_points() + in_slice;
      }
    });
  }

  // Writes the faces between two slices; what is behind them.
  uint32_t* march(const Slice& lower, const Slice& upper, uint32_t* out) const {
    const size_t nx = lattice_.columns();
    visit_crossed(lattice_, lower.inside, upper.inside, [&](size_t x, size_t y, uint32_t inside) {
      const size_t i = lattice_.point(x, y);
      const size_t at[4] = {i, i + 1, i + nx, i + nx + 1};
      for (uint32_t f = cell_.first[inside]; f < cell_.first[inside + 1]; ++f) {
        for (const uint8_t vertex : cell_.faces[f]) {
          const uint32_t corner = CellFaces::corner(vertex);
          const Slice& slice = corner < 4 ? lower : upper;
          *out++ = slice.id(at[corner & 3], CellFaces::direction(vertex));
        }
      }
    });
    return out;
  }

  // Bit d - 1: the edge of direction d from the first corner of a cell has a vertex.
  uint32_t crossed_edges(uint32_t inside) const {
    return ((inside & 1) != 0 ? ~inside & kAllCorners : inside) >> 1 & cell_.directions;
  }

  Lattice lattice_;
  const CellFaces& cell_;
  const Executor& executor_;
  size_t layers_;
  Vector<size_t> first_id_, first_face_;  // per slice
  Crossings all_;
  Vector<uint64_t>* voxel_ = nullptr;
  Buffer<int32_t> points_;  // as leave_out_small_parts() takes them; empty: not asked for
};

}  // namespace

Status iso_surface(const ImageObject& object, const LatticeValues& values, const Executor& executor,
                   Mesh& mesh, Vector<uint64_t>* voxel) {
  Builder builder(object, values, tetrahedron_faces(), executor);
  if (Status s = builder.count(); !s.ok()) return s;
  builder.build(mesh, voxel);
  return {};
}

Status iso_crossings(const ImageObject& object, const LatticeValues& values, int64_t least,
                     const Executor& executor, Crossings& crossings) {
  Builder builder(object, values, cube_faces(), executor);
  if (Status s = builder.count(); !s.ok()) return s;
  crossings = builder.crossings(least);
  return {};
}

LatticeValues values_of(const ImageObject& object) {
  return {
      [&object](int32_t y, int32_t z, uint8_t* inside) {
        Vector<float> row(static_cast<size_t>(object.image.dims[0]));
        image_row(object.image, y, z, row.data());
        for (size_t x = 0; x < row.size(); ++x) inside[x] = object.has(row[x]);
      },
      [&object](int32_t x, int32_t y, int32_t z) { return image_value(object.image, x, y, z); }};
}

Status iso_surface(const ImageObject& object, const Executor& executor, Mesh& mesh) {
  return iso_surface(object, values_of(object), executor, mesh);
}

}  // namespace plc

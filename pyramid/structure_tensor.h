// The structure tensor of an image, tile by tile, and the noise that is taken out of it.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "kernels/image.h"
#include "kernels/simd.h"
#include "pyramid/memory.h"

namespace plc {

// The structure tensor of a part of the image: xx, yy, zz, xy, xz, yz.
struct Tensor {
  std::array<float, 6> j{};
  float weight = 0;  // of its gradients, summed
  // Takes away what noise has put there: along each axis its variance, of gradients.
  void clear_of(const std::array<float, 3>& variance) {
    for (size_t a = 0; a < 3; ++a) j[a] = std::max(0.0F, j[a] - weight * variance[a]);
  }
  // The part of the turning across the first eigenvector in that along it, r = (l2 + l3) / l1, from
  // the invariants of the tensor; at most 1.
  double turning() const {
    const float trace = j[0] + j[1] + j[2];
    if (!(trace > 1e-12F)) return 0;
    const float minors =
        j[0] * j[1] + j[0] * j[2] + j[1] * j[2] - j[3] * j[3] - j[4] * j[4] - j[5] * j[5];
    // minors / trace^2 = r / (1 + r)^2, but for l2 l3.
    const auto q = std::max(0.0, static_cast<double>(minors / (trace * trace)));
    if (q < 1e-9) return q;
    return q >= 0.25 ? 1.0 : (1 - 2 * q - std::sqrt(1 - 4 * q)) / (2 * q);
  }
};

// A tile of cells, each a cube of voxels. Not thread-safe; buffers are kept from tile to tile.
class TensorTile {
 public:
  static constexpr int32_t kCell = 2;   // voxels on a side
  static constexpr int32_t kCells = 8;  // on a side
  // Variance of the window that a cell's tensor is of, along an axis, voxels squared: of the taps
  // that smooth it, and of the two voxels of a cell.
  static constexpr double kWindow = 1.25;

  explicit TensorTile(SimdTarget simd);

  // Half of a difference over two voxels along each axis, per delta.
  static std::array<float, 3> half_differences(const ImageView& image, double delta);

  // Reads the tile from the voxel `first` on; where the iso-surface passes, visit(cell, its tensor
  // without noise) for `count` cells from its first on, and what noise moves the surface by, in
  // delta, goes to `noises`. half: of half_differences(); padding: voxels on each side of the image
  // that nobody measured.
  template <typename Visit>
  void visit(const ImageView& image, int32_t padding, const std::array<int32_t, 3>& first,
             const std::array<int32_t, 3>& count, const std::array<float, 3>& half, float iso,
             Vector<float>& noises, const Visit& visit) {
    if (!measure(image, padding, first, half, iso)) return;
    float weight = 0;
    std::array<float, 3> squares{};
    for (int32_t z = 0; z < count[2]; ++z) {
      for (int32_t y = 0; y < count[1]; ++y) {
        for (int32_t x = 0; x < count[0]; ++x) {
          Tensor tensor = this->tensor(x, y, z);
          tensor.clear_of(variance_);
          weight += tensor.weight;
          for (size_t a = 0; a < 3; ++a) squares[a] += tensor.j[a];
          visit({x, y, z}, tensor);
        }
      }
    }
    const auto squared = static_cast<double>(squares[0] + squares[1] + squares[2]);
    if (!(squared > 0)) return;
    noises.push_back(static_cast<float>(noise_ * std::sqrt(static_cast<double>(weight) / squared)));
  }

 private:
  bool measure(const ImageView& image, int32_t padding, const std::array<int32_t, 3>& first,
               const std::array<float, 3>& half, float iso);
  void read(const ImageView& image, int32_t padding, const std::array<int32_t, 3>& first);
  bool crosses(float iso) const;
  double measure_noise();
  float median();
  void find_tensors(const std::array<float, 3>& half, float iso);
  Tensor tensor(int32_t x, int32_t y, int32_t z) const;

  SimdTarget simd_;
  std::array<std::pair<int32_t, int32_t>, 3> measured_{};  // begin and end of what is no padding
  double noise_ = 0;                                       // of a voxel, in the values' unit
  std::array<float, 3> variance_{};                        // of gradients, by noise
  Vector<float> value_, scratch_, magnitudes_;
  Vector<uint32_t> counts_;
  std::array<Vector<float>, 6> tensor_;
  Vector<float> weight_;
};

}  // namespace plc

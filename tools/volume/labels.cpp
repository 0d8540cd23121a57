#include "tools/volume/labels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <unordered_map>

#include "tools/file/failure.h"
#include "tools/volume/voxels.h"

namespace plc::tools {

namespace {

constexpr uint8_t kInside = 255;

template <typename T>
int32_t label_value(const std::string& path, T voxel) {
  if constexpr (std::is_floating_point_v<T>) {
    const double value = voxel;
    constexpr double kMost = std::numeric_limits<int32_t>::max();
    if (!(std::abs(value) <= kMost) || value != std::trunc(value)) {
      throw Failure{path + ": a label must be an integer of 32 bits, but a voxel is " +
                    std::to_string(value)};
    }
  }
  return static_cast<int32_t>(voxel);
}

class Table {
 public:
  explicit Table(const std::string& path) : path_(path) {}

  // Voxels first .. last of the row (y, z).
  void add(int32_t value, int64_t first, int64_t last, int64_t y, int64_t z) {
    const auto [at, is_new] =
        labels_.try_emplace(value, Label{value, 0, {first, y, z}, {last, y, z}});
    if (is_new && labels_.size() > kMaxLabels) {
      throw Failure{path_ + ": more than " + std::to_string(kMaxLabels) + " labels"};
    }
    Label& label = at->second;
    label.voxels += last - first + 1;
    const std::array<int64_t, 3> low = {first, y, z};
    const std::array<int64_t, 3> high = {last, y, z};
    for (size_t axis = 0; axis < 3; ++axis) {
      label.low[axis] = std::min(label.low[axis], low[axis]);
      label.high[axis] = std::max(label.high[axis], high[axis]);
    }
  }

  std::vector<Label> sorted() const {
    std::vector<Label> labels;
    labels.reserve(labels_.size());
    for (const auto& entry : labels_) labels.push_back(entry.second);
    std::sort(labels.begin(), labels.end(),
              [](const Label& a, const Label& b) { return a.value < b.value; });
    return labels;
  }

 private:
  const std::string& path_;
  std::unordered_map<int32_t, Label> labels_;
};

// Labels are looked up once for each run of equal voxels.
template <typename T>
void add_row(const std::string& path, const T* row, int64_t size, int64_t y, int64_t z,
             Table& table) {
  for (int64_t first = 0; first < size;) {
    int64_t end = first + 1;
    while (end < size && row[end] == row[first]) ++end;
    const int32_t value = label_value(path, row[first]);
    if (value != 0) table.add(value, first, end - 1, y, z);
    first = end;
  }
}

}  // namespace

std::vector<Label> find_labels(const std::string& path, const plc_image& image) {
  Table table(path);
  with_voxels(image, [&](const auto* voxels, const auto* /*last*/) {
    const int64_t* n = image.dims;
    for (int64_t z = 0; z < n[2]; ++z) {
      for (int64_t y = 0; y < n[1]; ++y) {
        add_row(path, voxels + n[0] * (y + n[1] * z), n[0], y, z, table);
      }
    }
  });
  return table.sorted();
}

LabelCrop crop_label(const plc_image& image, const Label& label) {
  LabelCrop crop{};
  crop.image = image;
  crop.image.type = PLC_U8;
  int64_t count = 1;
  for (size_t axis = 0; axis < 3; ++axis) {
    crop.low[axis] = label.low[axis] - 1;
    crop.image.dims[axis] = label.high[axis] - label.low[axis] + 3;
    count *= crop.image.dims[axis];
  }
  for (size_t row = 0; row < 3; ++row) {
    for (size_t axis = 0; axis < 3; ++axis) {
      crop.image.origin[row] += image.direction[3 * row + axis] * image.spacing[axis] *
                                static_cast<double>(crop.low[axis]);
    }
  }
  crop.voxels.resize(static_cast<size_t>(count));
  with_voxels(image, [&](const auto* voxels, const auto* /*last*/) {
    const int64_t* n = image.dims;
    const int64_t* m = crop.image.dims;
    using Voxel = std::remove_cv_t<std::remove_pointer_t<decltype(voxels)>>;
    const auto value = static_cast<Voxel>(label.value);
    for (int64_t z = label.low[2]; z <= label.high[2]; ++z) {
      for (int64_t y = label.low[1]; y <= label.high[1]; ++y) {
        const auto* from = voxels + n[0] * (y + n[1] * z);
        uint8_t* to = crop.voxels.data() + m[0] * (y - crop.low[1] + m[1] * (z - crop.low[2]));
        for (int64_t x = label.low[0]; x <= label.high[0]; ++x) {
          to[x - crop.low[0]] = from[x] == value ? kInside : 0;
        }
      }
    }
  });
  crop.image.voxels = crop.voxels.data();
  return crop;
}

}  // namespace plc::tools

#include "tools/volume/zarr_gather.h"

#include <algorithm>
#include <cstring>

namespace plc::tools {

ZarrGather::ZarrGather(const OmeZarrImage& image, const VoxelBox& box, std::byte* voxels)
    : image_(image), voxels_(voxels), size_(component_size(image.array.component)) {
  const size_t axes = image.array.shape.size();
  step_.assign(axes, 0);
  low_.assign(axes, 0);
  high_.assign(axes, 0);
  size_t next = size_;
  for (size_t i = 0; i < 3; ++i) {
    const size_t axis = image.space[i];
    step_[axis] = next;
    low_[axis] = box.low[i];
    high_[axis] = box.high[i];
    next *= static_cast<size_t>(box.high[i] - box.low[i] + 1);
  }
  for (size_t axis = 0; axis < axes; ++axis) {
    first_.push_back(low_[axis] / image.array.chunk[axis]);
    last_.push_back(high_[axis] / image.array.chunk[axis]);
  }
}

void ZarrGather::put(const std::vector<int64_t>& index, const std::byte* chunk) const {
  const ZarrArray& array = image_.array;
  const size_t axes = array.shape.size();
  std::vector<int64_t> length(axes), at(axes, 0);
  std::vector<size_t> from_step(axes);
  size_t next = size_, to = 0, from = 0;
  for (size_t axis = axes; axis-- > 0;) {
    const int64_t first = index[axis] * array.chunk[axis];
    const int64_t begin = std::max(first, low_[axis]);
    length[axis] = std::min(first + array.chunk[axis], high_[axis] + 1) - begin;
    to += step_[axis] * static_cast<size_t>(begin - low_[axis]);
    from_step[axis] = next;
    from += next * static_cast<size_t>(begin - first);
    next *= static_cast<size_t>(array.chunk[axis]);
  }
  const size_t run_axis = axes - 1;
  const auto run = static_cast<size_t>(length[run_axis]);
  for (;;) {
    put_run(chunk == nullptr ? nullptr : chunk + from, from_step[run_axis], voxels_ + to,
            step_[run_axis], run);
    size_t axis = run_axis;
    for (;;) {
      if (axis == 0) return;
      --axis;
      to += step_[axis];
      from += from_step[axis];
      if (++at[axis] < length[axis]) break;
      to -= step_[axis] * static_cast<size_t>(length[axis]);
      from -= from_step[axis] * static_cast<size_t>(length[axis]);
      at[axis] = 0;
    }
  }
}

void ZarrGather::put_run(const std::byte* from, size_t from_step, std::byte* to, size_t to_step,
                         size_t count) const {
  if (from != nullptr && from_step == size_ && to_step == size_) {
    std::memcpy(to, from, count * size_);
    return;
  }
  const std::byte* fill = image_.array.fill.data();
  if (from == nullptr && to_step == size_ && size_ > 0 &&
      std::all_of(fill, fill + size_, [fill](std::byte b) { return b == fill[0]; })) {
    std::memset(to, static_cast<int>(fill[0]), count * size_);
    return;
  }
  for (size_t i = 0; i < count; ++i) {
    std::memcpy(to + i * to_step, from == nullptr ? fill : from + i * from_step, size_);
  }
}

}  // namespace plc::tools

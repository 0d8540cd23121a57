#include "tests/campaign/campaign_host.h"

#include <cstdlib>
#include <cstring>

namespace campaign {

namespace {

// In front of every block, as far as its alignment asks for.
struct Head {
  size_t size, alignment;
};

size_t room_for_head(size_t alignment) {
  return alignment > sizeof(Head) ? alignment : sizeof(Head);
}

void fill(void* data, unsigned char value, size_t size) {
  if (size > 0) std::memset(data, value, size);
}

}  // namespace

void* HostMemory::allocate(size_t size, size_t alignment, void* user) {
  const size_t room = room_for_head(alignment);
  const size_t whole = (room + size + room - 1) / room * room;
  void* const block = std::aligned_alloc(room, whole);
  if (block == nullptr) return nullptr;
  ++static_cast<HostMemory*>(user)->blocks_;
  auto* const data = static_cast<std::byte*>(block) + room;
  fill(data, 0xa5, size);  // as a float about -3e-16, as a count far too many
  const Head head{size, alignment};
  std::memcpy(data - sizeof head, &head, sizeof head);
  return data;
}

void HostMemory::release(void* data, size_t size, size_t alignment, void* user) {
  auto* const self = static_cast<HostMemory*>(user);
  if (data == nullptr) return;
  Head head{};
  std::memcpy(&head, static_cast<std::byte*>(data) - sizeof head, sizeof head);
  if (head.size != size || head.alignment != alignment) self->wrong_size_ = true;
  fill(data, 0x5a, head.size);
  --self->blocks_;
  std::free(static_cast<std::byte*>(data) - room_for_head(head.alignment));
}

void HostMemory::lend(plc_context_options& options) {
  options.allocate = allocate;
  options.release = release;
  options.allocator_user = this;
}

std::string HostMemory::fault() const {
  if (wrong_size_) return "memory given back with another size or alignment";
  if (blocks_ != 0) return std::to_string(blocks_) + " blocks of memory never given back";
  return {};
}

void lend_backward_loops(plc_context_options& options) {
  options.parallel_for = [](size_t tasks, plc_task_fn task, void* data, void*) {
    for (size_t i = tasks; i-- > 0;) task(i, data);
  };
}

plc_image strided(const plc_image& image, std::vector<std::byte>& bytes) {
  constexpr size_t kSizes[] = {1, 2, 2, 4, 4};
  plc_image result = image;
  if (image.voxels == nullptr || image.type > PLC_F32) return result;
  for (const int64_t n : image.dims) {
    if (n < 1) return result;
  }
  const size_t voxel = kSizes[image.type];
  const auto row = static_cast<size_t>(image.dims[0]) * voxel;
  const size_t pitch = row + 2 * voxel;
  const auto rows = static_cast<size_t>(image.dims[1] * image.dims[2]);
  bytes.assign(rows * pitch, std::byte{0x7f});
  for (size_t r = 0; r < rows; ++r) {
    std::memcpy(bytes.data() + (rows - 1 - r) * pitch,
                static_cast<const std::byte*>(image.voxels) + r * row, row);
  }
  result.voxels = bytes.data() + (rows - 1) * pitch;
  result.strides[0] = static_cast<int64_t>(voxel);
  result.strides[1] = -static_cast<int64_t>(pitch);
  result.strides[2] = -static_cast<int64_t>(pitch) * image.dims[1];
  return result;
}

}  // namespace campaign

// The voxels of a box from the chunks of a Zarr array.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/volume/ome_zarr.h"
#include "tools/volume/volume_box.h"

namespace plc::tools {

class ZarrGather {
 public:
  // voxels: of the box, x fastest, as the array stores them, which are to be gathered.
  ZarrGather(const OmeZarrImage& image, const VoxelBox& box, std::byte* voxels);

  // The first and the last chunk along each axis of the array that have some of the box.
  const std::vector<int64_t>& first() const { return first_; }
  const std::vector<int64_t>& last() const { return last_; }
  // What the chunk has of the box. chunk: null where all its values are the fill value. Threads may
  // put different chunks.
  void put(const std::vector<int64_t>& index, const std::byte* chunk) const;

 private:
  void put_run(const std::byte* from, size_t from_step, std::byte* to, size_t to_step,
               size_t count) const;

  const OmeZarrImage& image_;
  std::byte* voxels_;
  size_t size_;
  std::vector<size_t> step_;  // in the box, of each axis of the array; 0 where it has one place
  std::vector<int64_t> low_, high_;  // the box, along each axis of the array
  std::vector<int64_t> first_, last_;
};

}  // namespace plc::tools

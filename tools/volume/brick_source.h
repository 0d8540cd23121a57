// Volumes that are read box by box: what plc_volume_create_bricks asks a host for.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/pellicle.h"
#include "tools/volume/nifti_frame.h"
#include "tools/volume/volume_box.h"

namespace plc::tools {

class ZarrStore;

// Thread-safe.
class BrickSource {
 public:
  using Side = std::array<int64_t, 3>;

  // image: as read_volume() would have it, but its voxels. brick: voxels of what is best read at
  // once.
  BrickSource(const plc_image& image, const Side& brick) : image_(image), brick_(brick) {
    image_.voxels = nullptr;
  }
  virtual ~BrickSource() = default;
  BrickSource(const BrickSource&) = delete;
  BrickSource& operator=(const BrickSource&) = delete;

  const plc_image& image() const { return image_; }
  const Side& brick() const { return brick_; }
  // The voxels of a box that lies in the image, x fastest, in the image's type. Throws Failure.
  virtual void read(const VoxelBox& box, std::byte* voxels) const = 0;

  std::vector<std::string> warnings;  // as those of LoadedVolume

 private:
  plc_image image_;
  Side brick_;
};

// Of OME-Zarr, and of NIfTI, NRRD and MetaImage that are not packed; null where the file is none of
// these, or has voxels that the engine does not take by bricks (32-bit integers and larger ones).
// Before the process starts threads; see apart.h. Throws Failure.
std::unique_ptr<BrickSource> open_bricks(const std::string& path,
                                         NiftiFrame frame = NiftiFrame::kAuto);
// Of a folder of OME-Zarr; a path may lead to one of its resolutions. Or of any store.
std::unique_ptr<BrickSource> open_zarr_bricks(const std::string& path);
std::unique_ptr<BrickSource> open_zarr_bricks(std::shared_ptr<const ZarrStore> store,
                                              const std::string& dataset);

// The region alone, as cut_out() of volume_box.h.
std::unique_ptr<BrickSource> cut_out(const std::string& path, std::unique_ptr<BrickSource> source,
                                     const VoxelBox& box);

// The brick as the engine has it: whole, what lies beyond the image is left as it is.
void read_brick(const BrickSource& source, const int64_t at[3], std::byte* voxels);

}  // namespace plc::tools

// Files in which voxels lie one behind the other, not packed: they need not be read whole.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/volume/brick_source.h"
#include "tools/volume/nifti_frame.h"
#include "tools/volume/stored_voxels.h"

namespace plc::tools {

// Where the voxels are.
struct FlatFile {
  std::string path;
  uint64_t offset = 0;
  StoredVoxels stored;
};

// Of one format each; nothing where the voxels are packed, or in several files. `header` is what
// ITK says of the file. Throw Failure.
std::optional<FlatFile> flat_nrrd(const std::string& path, const ItkHeader& header);
std::optional<FlatFile> flat_meta(const std::string& path, const ItkHeader& header);
// Also gives the header.
std::optional<FlatFile> flat_nifti(const std::string& path, NiftiFrame frame, ItkHeader& header,
                                   std::vector<std::string>& warnings);

// Null where the file is none such. Throws Failure.
std::unique_ptr<BrickSource> open_flat_bricks(const std::string& path, NiftiFrame frame);

}  // namespace plc::tools

// What an extraction starts from and is drawn to, read from the files that the options name.
#pragma once
#include "tools/command/attach_file.h"
#include "tools/command/extract_options.h"
#include "tools/mesh/mesh_io.h"
#include "tools/volume/volume_io.h"

namespace plc::tools {

// Owns what plc_extras borrow.
class ExtractInputs {
 public:
  // Reads the files; throws Failure. Mask and coordinates in voxels are those of the whole image,
  // of which the box, where there is one, is cut out.
  ExtractInputs(const ExtractOptions& options, const plc_image& image);
  // For a start from another mesh, in `space`.
  void start_from(TriangleMesh mesh) { mesh_ = std::move(mesh); }
  // Everything but callbacks. Valid as long as this lives and is not changed.
  plc_extras extras() const;
  // Bytes of voxels in memory.
  size_t held() const { return mask_.bytes.size(); }

 private:
  void move_to(const VoxelBox& box);

  plc_space space_;
  std::vector<plc_seed> seeds_;
  AttachFile attach_;
  LoadedVolume mask_{};
  TriangleMesh mesh_;
};

}  // namespace plc::tools

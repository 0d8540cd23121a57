#include "tools/command/extract_inputs.h"

#include "tools/volume/mesh_spaces.h"

namespace plc::tools {

ExtractInputs::ExtractInputs(const ExtractOptions& options, const plc_image& image)
    : space_(options.space), seeds_(options.seeds) {
  if (!options.attach.empty()) attach_ = read_attach_file(options.attach);
  if (options.parameters.init == PLC_INIT_MASK) {
    mask_ = read_volume_apart(options.init_file, options.nifti_frame);
    print_warnings(mask_.warnings);
    if (options.box) mask_ = cut_out(options.init_file, mask_, *options.box);
  }
  if (options.parameters.init == PLC_INIT_MESH) {
    mesh_ = read_mesh(options.init_file);
    bring_to(mesh_, space_, space_, &image, options.init_file);
  }
  if (options.box && space_ == PLC_SPACE_VOXEL) move_to(*options.box);
}

// From voxels of the whole image to those of the box.
void ExtractInputs::move_to(const VoxelBox& box) {
  for (size_t k = 0; k < 3; ++k) {
    const auto low = static_cast<double>(box.low[k]);
    for (plc_seed& seed : seeds_) seed.centre[k] -= low;
    for (plc_attachment& a : attach_.attachments) a.place[k] -= low;
    for (plc_pin& pin : attach_.pins) pin.place[k] -= low;
    for (size_t i = k; i < mesh_.xyz.size(); i += 3) mesh_.xyz[i] -= low;
  }
}

plc_extras ExtractInputs::extras() const {
  plc_extras e;
  plc_extras_defaults(&e);
  e.space = space_;
  e.seeds = seeds_.data();
  e.seed_count = static_cast<int64_t>(seeds_.size());
  e.mask = mask_.bytes.empty() ? nullptr : &mask_.image;
  e.mesh_xyz = mesh_.xyz.data();
  e.mesh_vertex_count = static_cast<int64_t>(mesh_.xyz.size() / 3);
  e.mesh_abc = mesh_.abc.data();
  e.mesh_face_count = static_cast<int64_t>(mesh_.abc.size() / 3);
  e.attachments = attach_.attachments.data();
  e.attachment_count = static_cast<int64_t>(attach_.attachments.size());
  e.pins = attach_.pins.data();
  e.pin_count = static_cast<int64_t>(attach_.pins.size());
  return e;
}

}  // namespace plc::tools

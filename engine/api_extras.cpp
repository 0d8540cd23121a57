#include "engine/api_extras.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace plc {

namespace {

Status bad(const std::string& line) {
  return {ErrorCode::kInvalidArgument, line};
}

bool finite(const double* xyz) {
  return std::isfinite(xyz[0]) && std::isfinite(xyz[1]) && std::isfinite(xyz[2]);
}

// What places with a radius have in common.
Status check_ball(const std::string& name, const double* place, double radius) {
  if (!finite(place)) return bad(name + ": its place is not finite");
  if (!(radius > 0) || !std::isfinite(radius)) {
    return bad(name + ": radius " + std::to_string(radius) + " is not a positive length");
  }
  return {};
}

Status check_array(const char* name, const void* data, int64_t count) {
  if (count < 0) return bad(std::string(name) + ": a negative count");
  if (count > 0 && data == nullptr) return bad(std::string(name) + ": must not be NULL");
  return {};
}

Status check_mask(const plc_extras& extras, const plc_image& image) {
  const plc_image* mask = extras.mask;
  if (mask == nullptr) return bad("mask: none given for PLC_INIT_MASK");
  if (mask->struct_size != sizeof *mask)
    return bad("mask: struct_size is not that of this version");
  if (mask->voxels == nullptr) return bad("mask: no voxels");
  if (mask->type < PLC_U8 || mask->type > PLC_F32) return bad("mask: type is not a plc_voxel_type");
  const auto dims = [](const plc_image& i) {
    return std::to_string(i.dims[0]) + " x " + std::to_string(i.dims[1]) + " x " +
           std::to_string(i.dims[2]);
  };
  if (!std::equal(mask->dims, mask->dims + 3, image.dims)) {
    return bad("mask of " + dims(*mask) + " voxels: the image has " + dims(image));
  }
  return {};
}

Status check_start(const plc_extras& extras, const plc_parameters& p, const plc_image& image) {
  if (p.init == PLC_INIT_MASK) return check_mask(extras, image);
  if (p.init == PLC_INIT_SEEDS && extras.seed_count == 0) return bad("seeds: none given");
  if (p.init == PLC_INIT_MESH && extras.mesh_face_count == 0) return bad("mesh: none given");
  return {};
}

constexpr double kMaxStrength = 1e6;

}  // namespace

Status check_extras(const plc_extras& e, const plc_parameters& p, const plc_image& image) {
  if (e.space < PLC_SPACE_LPS || e.space > PLC_SPACE_VOXEL) return bad("space: not a plc_space");
  for (const Status& s : {check_array("seeds", e.seeds, e.seed_count),
                          check_array("mesh vertices", e.mesh_xyz, e.mesh_vertex_count),
                          check_array("mesh faces", e.mesh_abc, e.mesh_face_count),
                          check_array("attachments", e.attachments, e.attachment_count),
                          check_array("pins", e.pins, e.pin_count), check_start(e, p, image)}) {
    if (!s.ok()) return s;
  }
  for (int64_t i = 0; i < e.seed_count; ++i) {
    const std::string name = "seed " + std::to_string(i);
    if (Status s = check_ball(name, e.seeds[i].centre, e.seeds[i].radius); !s.ok()) return s;
  }
  for (int64_t i = 0; i < e.pin_count; ++i) {
    const std::string name = "pin " + std::to_string(i);
    if (Status s = check_ball(name, e.pins[i].place, e.pins[i].radius); !s.ok()) return s;
  }
  for (int64_t i = 0; i < e.attachment_count; ++i) {
    const std::string name = "attachment " + std::to_string(i);
    const plc_attachment& a = e.attachments[i];
    if (Status s = check_ball(name, a.place, a.radius); !s.ok()) return s;
    if (!(a.strength >= 0 && a.strength <= kMaxStrength)) {
      return bad(name + ": strength " + std::to_string(a.strength) + " is not within 0 .. 1e6");
    }
  }
  return {};
}

void take_extras(const plc_extras& e, const Frame& frame, RecoverySpec& spec) {
  const Affine to_space = frame.to(e.space);
  const Affine to_voxel = to_space.inverse();
  const auto place = [&](const double* xyz) {
    const auto p = to_voxel.point({xyz[0], xyz[1], xyz[2]});
    return Vec3{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  };
  for (int64_t i = 0; i < e.seed_count; ++i) {
    const plc_seed& s = e.seeds[i];
    Seed seed;
    seed.centre = to_voxel.point({s.centre[0], s.centre[1], s.centre[2]});
    for (size_t a = 0; a < 3; ++a) seed.radii[a] = s.radius / frame.spacing[a];
    spec.start.seeds.push_back(seed);
  }
  for (int64_t i = 0; i < e.attachment_count; ++i) {
    const plc_attachment& a = e.attachments[i];
    spec.user.attachments.push_back(
        {place(a.place), static_cast<float>(a.radius), static_cast<float>(a.strength)});
  }
  for (int64_t i = 0; i < e.pin_count; ++i) {
    spec.user.pins.push_back({place(e.pins[i].place), static_cast<float>(e.pins[i].radius)});
  }
  if (spec.start.init != Init::kMesh) return;
  const auto vertices = static_cast<size_t>(e.mesh_vertex_count);
  spec.start.xyz.resize(3 * vertices);
  for (size_t v = 0; v < 3 * vertices; v += 3) {
    const auto p = to_voxel.point({e.mesh_xyz[v], e.mesh_xyz[v + 1], e.mesh_xyz[v + 2]});
    std::copy(p.begin(), p.end(), spec.start.xyz.begin() + static_cast<std::ptrdiff_t>(v));
  }
  spec.start.abc.assign(e.mesh_abc, e.mesh_abc + 3 * e.mesh_face_count);
  if (!to_space.mirrors()) return;
  for (size_t f = 0; f < spec.start.abc.size(); f += 3) {
    std::swap(spec.start.abc[f + 1], spec.start.abc[f + 2]);
  }
}

}  // namespace plc

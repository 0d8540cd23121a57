#include "engine/api/api_extras.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/api/handles.h"
#include "engine/exact/triangle_intersection.h"
#include "pyramid/check_volume.h"

namespace plc {

namespace {

bool finite(const double* xyz) {
  return std::isfinite(xyz[0]) && std::isfinite(xyz[1]) && std::isfinite(xyz[2]);
}

std::string place_text(const std::array<double, 3>& p) {
  std::string text(1, '(');
  text.append(number_text(p[0])).append(", ").append(number_text(p[1])).append(", ");
  return text.append(number_text(p[2])).append(")");
}

// What the voxels of an image fill: half a voxel more than their centres on every side.
class Bounds {
 public:
  Bounds(const VolumeView& image, const Frame& frame, plc_space space)
      : dims_(image.dims), space_(space), to_space_(frame.to(space)) {}

  bool hold(const double* place) const {
    constexpr double kRounding = 1e-6;  // voxels
    const auto p = to_space_.inverse().point({place[0], place[1], place[2]});
    for (size_t a = 0; a < 3; ++a) {
      const double end = static_cast<double>(dims_[a]) - 0.5;
      if (!(p[a] >= -0.5 - kRounding && p[a] <= end + kRounding)) return false;
    }
    return true;
  }

  // The box around the image in the space.
  std::string text() const {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::array<double, 3> low{kFar, kFar, kFar};
    std::array<double, 3> high{-kFar, -kFar, -kFar};
    for (unsigned corner = 0; corner < 8; ++corner) {
      std::array<double, 3> p{};
      for (unsigned a = 0; a < 3; ++a) {
        p[a] = -0.5 + ((corner >> a & 1U) != 0 ? static_cast<double>(dims_[a]) : 0);
      }
      p = to_space_.point(p);
      for (size_t a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], p[a]);
        high[a] = std::max(high[a], p[a]);
      }
    }
    const char* const names[] = {"LPS, mm", "RAS, mm", "voxels"};
    return "which reaches from " + place_text(low) + " to " + place_text(high) + " (" +
           names[space_] + ")";
  }

 private:
  std::array<int64_t, 3> dims_;
  plc_space space_;
  Affine to_space_;
};

// What places with a radius have in common.
Status check_ball(const std::string& name, const double* place, double radius,
                  const Bounds& bounds) {
  if (!finite(place)) return bad_argument(name + ": its place is not finite");
  if (!bounds.hold(place)) {
    return bad_argument(name + ": lies at " + place_text({place[0], place[1], place[2]}) +
                        ", outside the image, " + bounds.text());
  }
  if (!(radius > 0) || !std::isfinite(radius)) {
    return bad_argument(name + ": radius " + std::to_string(radius) + " is not a positive length");
  }
  return {};
}

constexpr int64_t kMostPlaces = int64_t{1} << 24U;
constexpr int64_t kMostOfMesh = int64_t{1} << 32U;
constexpr double kFarthest = 1e30;  // of obstacles: far beyond any image

// Before anything of it is read.
Status check_array(const char* name, const void* data, int64_t count, int64_t most) {
  if (count < 0) return bad_argument(std::string(name) + ": a negative count");
  if (count > most) {
    return bad_argument(std::string(name) + ": more than " + std::to_string(most));
  }
  if (count > 0 && data == nullptr) return bad_argument(std::string(name) + ": must not be NULL");
  return {};
}

template <typename Dims>
std::string dims_text(const Dims& dims) {
  return std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " +
         std::to_string(dims[2]);
}

// Its voxels are looked at when they are taken.
Status check_mask(const plc_image* given, const VolumeView& image, plc_image& mask) {
  if (given == nullptr) return bad_argument("mask: none given for PLC_INIT_MASK");
  if (Status s = take_struct(given, plc_image_defaults, "mask", mask); !s.ok()) return s;
  if (!std::equal(mask.dims, mask.dims + 3, image.dims.begin())) {
    return bad_argument("mask of " + dims_text(mask.dims) + " voxels: the image has " +
                        dims_text(image.dims));
  }
  return {};
}

Status check_start(const plc_extras& e, const plc_parameters& p) {
  if (p.init == PLC_INIT_SEEDS && e.seed_count == 0) return bad_argument("seeds: none given");
  if (p.init == PLC_INIT_MESH && e.mesh_face_count == 0 && e.mesh_held == nullptr) {
    return bad_argument("mesh: none given");
  }
  return {};
}

// All but what is said of whole arrays.
Status check_obstacles(const plc_extras& e, const plc_parameters& p) {
  if (!(e.obstacle_gap >= 0 && e.obstacle_gap <= 1)) {
    return bad_argument("obstacle gap " + number_text(e.obstacle_gap) + " is not within 0 .. 1");
  }
  if (e.obstacle_face_count == 0) return {};
  if (p.levels != 0 || p.late_bubbles != 0) {
    return bad_argument("obstacles: levels and late_bubbles must be 0 with them");
  }
  for (int64_t i = 0; i < 3 * e.obstacle_vertex_count; ++i) {
    if (!(std::abs(e.obstacle_xyz[i]) <= kFarthest)) {
      return bad_argument("obstacles: vertex " + std::to_string(i / 3) + " lies at " +
                          number_text(e.obstacle_xyz[i]));
    }
  }
  for (int64_t f = 0; f < e.obstacle_face_count; ++f) {
    const uint32_t* abc = e.obstacle_abc + 3 * f;
    for (int k = 0; k < 3; ++k) {
      if (abc[k] < e.obstacle_vertex_count) continue;
      return bad_argument("obstacles: face " + std::to_string(f) + " refers to vertex " +
                          std::to_string(abc[k]) + " of " +
                          std::to_string(e.obstacle_vertex_count));
    }
    const Triangle t = make_triangle(e.obstacle_xyz, abc);
    if (collinear(t.corner[0], t.corner[1], t.corner[2])) {
      return bad_argument("obstacles: face " + std::to_string(f) + " has no area");
    }
  }
  return {};
}

Status check_patch(const plc_extras& e, const plc_parameters& p) {
  if (e.mesh_held == nullptr) return {};
  if (p.init != PLC_INIT_MESH) return bad_argument("mesh_held: init must be PLC_INIT_MESH with it");
  for (int64_t v = 0; v < e.mesh_vertex_count; ++v) {
    if (e.mesh_held[v] <= 2) continue;
    return bad_argument("mesh_held: is " + std::to_string(e.mesh_held[v]) + " of vertex " +
                        std::to_string(v) + ", expected 0, 1 or 2");
  }
  for (int a = 0; a < 3; ++a) {
    if (e.room_low[a] < e.room_high[a]) continue;
    return bad_argument("room: from " + number_text(e.room_low[a]) + " to " +
                        number_text(e.room_high[a]) + " on an axis");
  }
  return {};
}

constexpr double kMaxStrength = 1e6;

// Of the angles between the axes x and y, y and z, z and x: 0 where only roundings part them from
// right angles.
std::array<float, 3> cosines_of(const Frame& frame) {
  constexpr double kRounding = 1e-3;
  std::array<float, 3> cosines{};
  for (size_t a = 0; a < 3; ++a) {
    double product = 0;
    for (size_t i = 0; i < 9; i += 3) {
      product += frame.direction[i + a] * frame.direction[i + (a + 1) % 3];
    }
    if (std::abs(product) > kRounding) cosines[a] = static_cast<float>(product);
  }
  return cosines;
}

}  // namespace

Status check_extras(const plc_extras* given, const plc_parameters& p, const VolumeView& image,
                    const Frame& frame, plc_extras& e, plc_image& mask) {
  plc_extras_defaults(&e);
  if (given != nullptr) {
    if (Status s = take_struct(given, plc_extras_defaults, "extras", e); !s.ok()) return s;
  }
  if (p.init == PLC_INIT_MASK) {
    if (Status s = check_mask(e.mask, image, mask); !s.ok()) return s;
    e.mask = &mask;
  }
  if (e.space < PLC_SPACE_LPS || e.space > PLC_SPACE_VOXEL)
    return bad_argument("space: not a plc_space");
  for (const Status& s :
       {check_array("seeds", e.seeds, e.seed_count, kMostPlaces),
        check_array("mesh vertices", e.mesh_xyz, e.mesh_vertex_count, kMostOfMesh),
        check_array("mesh faces", e.mesh_abc, e.mesh_face_count, kMostOfMesh),
        check_array("attachments", e.attachments, e.attachment_count, kMostPlaces),
        check_array("pins", e.pins, e.pin_count, kMostPlaces),
        check_array("obstacle vertices", e.obstacle_xyz, e.obstacle_vertex_count, kMostOfMesh),
        check_array("obstacle faces", e.obstacle_abc, e.obstacle_face_count, kMostOfMesh - 1),
        check_start(e, p)}) {
    if (!s.ok()) return s;
  }
  if (Status s = check_obstacles(e, p); !s.ok()) return s;
  if (Status s = check_patch(e, p); !s.ok()) return s;
  const Bounds bounds(image, frame, e.space);
  for (int64_t i = 0; i < e.seed_count; ++i) {
    const std::string name = "seed " + std::to_string(i);
    if (Status s = check_ball(name, e.seeds[i].centre, e.seeds[i].radius, bounds); !s.ok())
      return s;
  }
  for (int64_t i = 0; i < e.pin_count; ++i) {
    const std::string name = "pin " + std::to_string(i);
    if (Status s = check_ball(name, e.pins[i].place, e.pins[i].radius, bounds); !s.ok()) return s;
  }
  for (int64_t i = 0; i < e.attachment_count; ++i) {
    const std::string name = "attachment " + std::to_string(i);
    const plc_attachment& a = e.attachments[i];
    if (Status s = check_ball(name, a.place, a.radius, bounds); !s.ok()) return s;
    if (!(a.strength >= 0 && a.strength <= kMaxStrength)) {
      return bad_argument(name + ": strength " + std::to_string(a.strength) +
                          " is not within 0 .. 1e6");
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
  spec.user.cosines = cosines_of(frame);
  if (e.obstacle_face_count > 0) {
    VoxelMesh obstacles = in_voxels(to_space, mesh_arrays(e.obstacle_xyz, e.obstacle_vertex_count,
                                                          e.obstacle_abc, e.obstacle_face_count));
    spec.obstacle_xyz = std::move(obstacles.xyz);
    spec.obstacle_abc = std::move(obstacles.abc);
    spec.obstacle_gap = e.obstacle_gap;
  }
  if (spec.start.init != Init::kMesh) return;
  VoxelMesh mesh = in_voxels(
      to_space, mesh_arrays(e.mesh_xyz, e.mesh_vertex_count, e.mesh_abc, e.mesh_face_count));
  spec.start.xyz = std::move(mesh.xyz);
  spec.start.as_given.assign(e.mesh_xyz, e.mesh_xyz + 3 * e.mesh_vertex_count);
  spec.start.abc = std::move(mesh.abc);
  if (e.mesh_held != nullptr) {
    spec.start.patch = true;
    spec.start.held.assign(e.mesh_held, e.mesh_held + e.mesh_vertex_count);
    spec.room_inside = e.room_inside != 0;
    std::copy_n(e.room_low, 3, spec.room_low.begin());
    std::copy_n(e.room_high, 3, spec.room_high.begin());
  }
}

VoxelMesh in_voxels(const Affine& to_space, const MeshArrays& mesh) {
  const Affine to_voxel = to_space.inverse();
  VoxelMesh out;
  out.xyz.reserve(3 * mesh.vertex_count);
  for (size_t v = 0; v < mesh.vertex_count; ++v) {
    const double* given = mesh.point(v);
    const auto p = to_voxel.point({given[0], given[1], given[2]});
    out.xyz.insert(out.xyz.end(), p.begin(), p.end());
  }
  out.abc.assign(mesh.abc, mesh.face(mesh.face_count));
  if (to_space.mirrors()) {
    for (size_t f = 0; f < out.abc.size(); f += 3) std::swap(out.abc[f + 1], out.abc[f + 2]);
  }
  return out;
}

}  // namespace plc

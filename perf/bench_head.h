// What the passes are measured on: bone of the head CT, in states that an extraction goes through.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "engine/api/parameters.h"
#include "engine/base/constants.h"
#include "engine/recover/recovery.h"
#include "perf/bench_copy.h"
#include "tools/file/failure.h"
#include "tools/volume/volume_io.h"

namespace bench {

inline void demand(const plc::Status& status) {
  if (!status.ok()) throw plc::tools::Failure{status.message()};
}

inline constexpr double kBone = 226;  // HU

// The head CT, and the parameters of `pellicle extract --iso 226 --mesh uniform` for it.
struct HeadVolume {
  plc::tools::LoadedVolume file;
  plc::VolumeView volume;
  plc_parameters parameters{};
  plc::DerivedWindow window;

  // Throws Failure.
  HeadVolume(const std::string& path, const plc::Schedule& schedule)
      : file(plc::tools::read_volume(path)) {
    volume.type = static_cast<plc::VoxelType>(file.image.type);
    volume.voxels = file.image.voxels;
    for (size_t a = 0; a < 3; ++a) {
      volume.dims[a] = file.image.dims[a];
      volume.spacing[a] = file.image.spacing[a];
    }
    plc_parameters_defaults(&parameters);
    parameters.iso = kBone;
    parameters.mesh = PLC_MESH_UNIFORM;
    const auto range = plc::voxel_range(volume, schedule);
    demand(plc::derive_parameters(volume, range, schedule, 0, parameters, window));
    plc_extras extras;
    plc_extras_defaults(&extras);
    plc::derive_init(extras, parameters);
  }

  // The pyramid of p, which differ from `parameters` in what is no value of the image, and what is
  // done on it.
  plc::RecoverySpec prepare(const plc_parameters& p, const plc::Schedule& schedule,
                            plc::Pyramid& pyramid) const {
    demand(plc::build_pyramid(volume, plc::pyramid_spec(p), schedule, pyramid));
    plc::RecoverySpec spec = plc::recovery_spec(p, pyramid.levels[0].unit);
    spec.isos = plc::covering_isos(pyramid, plc::normalised(p, kBone), true,
                                   plc::level_iso_bound(p, window.background), schedule);
    return spec;
  }
};

// The level above I_0 of a pyramid of reduction 1.19: 65,000 vertices, which is the size that the
// paper gives its seconds for, in images about as large as those of the whole CT.
struct Head {
  static constexpr double kReduction = 1.19;
  static constexpr int kLevels = 7;
  static constexpr int kMoving = 10;  // iterations after which the surface is taken while it moves

  HeadVolume ct;
  plc::PyramidSpec pyramid_spec;  // that of `pellicle extract`, rho = sqrt 3 and 3 levels
  plc::Pyramid pyramid;           // of reduction 1.19
  plc::RecoverySpec recovery;
  plc::Guide guide;  // of level 1
  plc::Mesh calm;    // converged
  plc::Mesh moving;

  // Throws Failure.
  Head(const std::string& path, const plc::Schedule& schedule)
      : ct(path, schedule), pyramid_spec(plc::pyramid_spec(ct.parameters)) {
    plc_parameters p = ct.parameters;
    p.reduction = kReduction;
    p.levels = kLevels;
    p.late_bubbles = 0;
    recovery = ct.prepare(p, schedule, pyramid);
    recover(schedule);
    guide.image = plc::image_view(pyramid, 1, recovery.pad_voxels,
                                  plc::mesh_space(pyramid, 1, recovery.scale.anisotropy));
    guide.iso = static_cast<float>(recovery.isos[1]);
  }

 private:
  void recover(const plc::Schedule& schedule) {
    plc::Mesh mesh;
    plc::RecoveryHooks hooks;
    hooks.progress = [&](const plc::RecoveryProgress& p) {
      if (p.level == 1 && p.iteration == kMoving) copy_mesh(mesh, moving);
      return true;
    };
    hooks.level = [](const plc::LevelRecord& record) {
      return record.level == 1 ? plc::LevelVerdict::kStop : plc::LevelVerdict::kAccept;
    };
    std::vector<plc::LevelRecord> records;
    demand(plc::pyramidal_recover_shape(pyramid, recovery, schedule, hooks, mesh, records));
    copy_mesh(mesh, calm);
  }
};

}  // namespace bench

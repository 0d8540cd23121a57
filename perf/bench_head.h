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

// The level above I_0 of a pyramid of reduction 1.19: 65,000 vertices, which is the size that the
// paper gives its seconds for, in images about as large as those of the whole CT.
struct Head {
  static constexpr double kIso = 226;  // HU
  static constexpr double kReduction = 1.19;
  static constexpr int kLevels = 7;
  static constexpr int kMoving = 10;  // iterations after which the surface is taken while it moves

  plc::tools::LoadedVolume ct;
  plc::VolumeView volume;
  plc::PyramidSpec pyramid_spec;  // that of `pellicle extract`, rho = sqrt 3 and 3 levels
  plc::Pyramid pyramid;           // of reduction 1.19
  plc::RecoverySpec recovery;
  plc::Guide guide;  // of level 1
  plc::Mesh calm;    // converged
  plc::Mesh moving;

  // Throws Failure.
  Head(const std::string& path, const plc::Schedule& schedule) : ct(plc::tools::read_volume(path)) {
    volume.type = static_cast<plc::VoxelType>(ct.image.type);
    volume.voxels = ct.image.voxels;
    for (size_t a = 0; a < 3; ++a) {
      volume.dims[a] = ct.image.dims[a];
      volume.spacing[a] = ct.image.spacing[a];
    }
    plc_parameters p;
    plc_parameters_defaults(&p);
    p.iso = kIso;
    const plc::SimdTarget simd = plc::best_simd_target();
    double background = 0;
    const auto range = plc::voxel_range(volume, schedule, simd);
    demand(plc::derive_parameters(volume, range, schedule, p, background));
    pyramid_spec = plc::pyramid_spec(p);
    p.reduction = kReduction;
    p.levels = kLevels;
    p.late_bubbles = 0;
    demand(plc::build_pyramid(volume, plc::pyramid_spec(p), schedule, simd, pyramid));
    recovery = plc::recovery_spec(p);
    recovery.isos = plc::covering_isos(pyramid, plc::normalised(p, kIso), true,
                                       plc::level_iso_bound(p, background), schedule, simd);
    recover(schedule, simd);
    guide.image = plc::image_view(pyramid, 1, recovery.pad_voxels,
                                  plc::mesh_space(pyramid, 1, recovery.anisotropy));
    guide.iso = static_cast<float>(recovery.isos[1]);
  }

 private:
  static void demand(const plc::Status& status) {
    if (!status.ok()) throw plc::tools::Failure{status.message()};
  }

  void recover(const plc::Schedule& schedule, plc::SimdTarget simd) {
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
    demand(plc::pyramidal_recover_shape(pyramid, recovery, schedule, simd, hooks, mesh, records));
    copy_mesh(mesh, calm);
  }
};

}  // namespace bench

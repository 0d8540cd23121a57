#include "engine/recovery.h"

#include <algorithm>
#include <cmath>

#include "engine/constants.h"
#include "engine/evolution.h"
#include "engine/refinement.h"

namespace plc {

namespace {

// The box of mesh space that the part of an image on the object's side of iso fills; false when it
// is empty.
bool object_extent(const PyramidLevel& level, const ImageView& view, float iso, bool inside_above,
                   Extent& box) {
  std::array<int64_t, 3> low = level.dims;
  std::array<int64_t, 3> high{-1, -1, -1};
  size_t i = 0;
  for (int64_t z = 0; z < level.dims[2]; ++z) {
    for (int64_t y = 0; y < level.dims[1]; ++y) {
      for (int64_t x = 0; x < level.dims[0]; ++x, ++i) {
        if (inside_above ? level.values[i] < iso : level.values[i] > iso) continue;
        const std::array<int64_t, 3> at{x, y, z};
        for (size_t a = 0; a < 3; ++a) {
          low[a] = std::min(low[a], at[a]);
          high[a] = std::max(high[a], at[a]);
        }
      }
    }
  }
  for (size_t a = 0; a < 3; ++a) {
    if (high[a] < 0) return false;
    // Half a voxel more: where the iso-surface may lie.
    const auto at = [&](double voxel) {
      return (voxel - static_cast<double>(view.offset[a])) / static_cast<double>(view.scale[a]);
    };
    box.low[a] = at(static_cast<double>(low[a]) - 0.5);
    box.high[a] = at(static_cast<double>(high[a]) + 0.5);
  }
  return true;
}

class Recovery {
 public:
  Recovery(const Pyramid& pyramid, const RecoverySpec& spec, const Schedule& schedule,
           SimdTarget simd, const RecoveryProgressFn& progress, Mesh& mesh)
      : pyramid_(pyramid),
        spec_(spec),
        schedule_(schedule),
        progress_(progress),
        mesh_(mesh),
        evolution_(mesh, schedule, simd, spec.model),
        levels_(static_cast<int>(pyramid.levels.size()) - 1) {}

  Status run(std::vector<LevelRecord>& records) {
    for (int h = levels_; h >= 0; --h) {
      records.emplace_back();
      records.back().level = h;
      if (Status s = recover_level(h, records.back()); !s.ok()) return s;
    }
    mesh_.renumber(morton_order(mesh_));
    return {};
  }

 private:
  // U_h / delta_h is the same on every level, within (14).
  double delta_of(int h) const { return unit_of(h) / kUnitPerDelta; }
  // U_h in mesh units.
  double unit_of(int h) const {
    return pyramid_.levels[static_cast<size_t>(h)].unit / pyramid_.levels[0].unit;
  }
  float iso_of(int h) const { return static_cast<float>(spec_.isos[static_cast<size_t>(h)]); }

  // A level on which the object does not show, or cannot hold the surface, is passed over: the
  // surface then starts on the next finer one.
  Status recover_level(int h, LevelRecord& record) {
    if (mesh_.vertex_count() == 0) {
      if (Status s = start(h); !s.ok()) return s;
    }
    if (mesh_.vertex_count() != 0) {
      if (Status s = recover_shape(h, record); !s.ok()) return s;
    }
    if (h > 0 || mesh_.vertex_count() != 0) return {};
    return {ErrorCode::kInvalidData,
            "no surface: nothing in the image holds one at this iso-value; check the iso-value, or "
            "use weaker internal forces"};
  }

  // The initial surface, on the image of level h; none where no voxel is on the object's side.
  Status start(int h) {
    mesh_.clear();
    Extent box;
    if (!object_extent(pyramid_.levels[static_cast<size_t>(h)], image_view(pyramid_, h, spec_),
                       iso_of(h), spec_.inside_above, box)) {
      return {};
    }
    if (spec_.init == Init::kBubble) {
      make_bubble(mesh_, box, delta_of(h), schedule_);
      return {};
    }
    // The grid of bubbles spans the unpadded image.
    const PyramidLevel& finest = pyramid_.levels[0];
    for (size_t a = 0; a < 3; ++a) {
      const auto voxels = static_cast<double>(finest.dims[a] - 2 * spec_.pad_voxels);
      box.low[a] = -0.5 * spec_.space.step[a];
      box.high[a] = (voxels - 0.5) * spec_.space.step[a];
    }
    return make_bubbles(mesh_, box, spec_.bubbles, delta_of(h), schedule_);
  }

  // Figure 12, first loop: refine until the density fits the image. With rho = sqrt 3 that is one
  // refinement per level; for other factors delta is set to fit afterwards, and creations and
  // deletions do the rest.
  void adapt(int h, LevelRecord& record) {
    const double target = delta_of(h);
    const auto steps = std::lround(std::log(mesh_.delta / target) / std::log(kRefinement));
    for (long i = 0; i < steps; ++i) {
      refine(mesh_, schedule_);
      ++record.operations.refinement;
    }
    mesh_.delta = target;
    for (uint32_t v = 0; v < mesh_.slots(); ++v) mesh_.wake(v);
    evolution_.restart();
  }

  Status recover_shape(int h, LevelRecord& record) {
    const double start = now();
    adapt(h, record);
    record.delta = mesh_.delta;
    record.seconds.topology += now() - start;
    record.seconds.total += now() - start;
    const ImageView view = image_view(pyramid_, h, spec_);
    int calm = 0;
    double first_energy = 0;
    for (int i = 1; i <= spec_.max_iterations && !record.converged; ++i) {
      evolution_.iterate(view, iso_of(h), record.seconds, record.operations);
      record.iterations = i;
      if (mesh_.vertex_count() == 0) return {};
      record.energy = evolution_.energy();
      first_energy = std::max(first_energy, record.energy);
      calm = record.energy < spec_.epsilon ? calm + 1 : 0;
      record.converged = i >= kMinIterations && calm >= kCalmIterations;
      if (progress_ && !progress_(progress(h, record, first_energy))) {
        return {ErrorCode::kCancelled, "cancelled"};
      }
      renumber_if_scattered();
    }
    evolution_.check_all(record.seconds, record.operations);
    record.vertices = mesh_.vertex_count();
    return verify(view, h, record);
  }

  // The guards keep the surface from meeting itself; that they did is tested on every level, and
  // told where they failed.
  Status verify(const ImageView& view, int h, LevelRecord& record) {
    constexpr int kRepairs = 50;
    for (int i = 0; i < kRepairs; ++i) {
      if (evolution_.embedded()) return {};
      evolution_.iterate(view, iso_of(h), record.seconds, record.operations);
    }
    return {ErrorCode::kInternal,
            "level " + std::to_string(h) + ": the surface meets itself and could not be parted"};
  }

  // Neighbours that are far apart in memory cost three times as much, and boxes over runs of ids
  // grow: when the new vertices are a sixteenth of all.
  void renumber_if_scattered() {
    if (mesh_.created() <= mesh_.vertex_count() / 16) return;
    mesh_.renumber(morton_order(mesh_));
    evolution_.restart();
  }

  // An estimate: levels cost about 3 times their predecessor, and within a level the energy falls
  // exponentially to epsilon.
  RecoveryProgress progress(int h, const LevelRecord& record, double first_energy) {
    double before = 0;
    double all = 0;
    for (int l = levels_; l >= 0; --l) {
      const double cost = std::pow(kRefinement, 2 * (levels_ - l));
      all += cost;
      if (l > h) before += cost;
    }
    const double own = std::pow(kRefinement, 2 * (levels_ - h));
    const double fallen = std::log(first_energy / std::max(record.energy, 1e-30)) /
                          std::max(1e-9, std::log(first_energy / spec_.epsilon));
    const double estimate = (before + own * std::clamp(fallen, 0.0, 1.0)) / all;
    fraction_ = std::max(fraction_, std::min(estimate, 1.0));
    return {
        h,        levels_, static_cast<int>(record.iterations), mesh_.vertex_count(), record.energy,
        fraction_};
  }

  const Pyramid& pyramid_;
  const RecoverySpec& spec_;
  const Schedule& schedule_;
  const RecoveryProgressFn& progress_;
  Mesh& mesh_;
  Evolution evolution_;
  int levels_;
  double fraction_ = 0;
};

}  // namespace

// Voxel i of the unpadded I_0 is voxel i + pad of the padded one and lies at (i + pad + 1/2) of its
// voxels from the border: (10).
ImageView image_view(const Pyramid& pyramid, int h, const RecoverySpec& spec) {
  const PyramidLevel& level = pyramid.levels[static_cast<size_t>(h)];
  ImageView view;
  view.data = level.values.data();
  for (size_t a = 0; a < 3; ++a) {
    const double voxels_per_voxel = pyramid.levels[0].voxel[a] / level.voxel[a];
    view.dims[a] = static_cast<int32_t>(level.dims[a]);
    view.scale[a] = static_cast<float>(voxels_per_voxel / spec.space.step[a]);
    view.offset[a] = static_cast<float>((spec.pad_voxels + 0.5) * voxels_per_voxel - 0.5);
  }
  return view;
}

Status pyramidal_recover_shape(const Pyramid& pyramid, const RecoverySpec& spec,
                               const Schedule& schedule, SimdTarget simd,
                               const RecoveryProgressFn& progress, Mesh& mesh,
                               std::vector<LevelRecord>& records) {
  Recovery recovery(pyramid, spec, schedule, simd, progress, mesh);
  return recovery.run(records);
}

}  // namespace plc

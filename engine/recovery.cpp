#include "engine/recovery.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/constants.h"
#include "engine/evolution.h"
#include "engine/refinement.h"
#include "pyramid/gradient.h"

namespace plc {

namespace {

EvolutionOptions evolution_options(const RecoverySpec& spec) {
  EvolutionOptions options;
  // The speed along the normal that every vertex would have at the energy epsilon.
  const double speed = std::sqrt(2 * spec.epsilon / static_cast<double>(spec.model.mass)) *
                       static_cast<double>(stable_time_step(spec.model));
  if (spec.sleeping) options.calm_speed = static_cast<float>(kCalmSpeed * speed);
  options.slow_vertices = spec.slow_vertices;
  return options;
}

class Recovery {
 public:
  Recovery(Pyramid pyramid, const RecoverySpec& spec, const Schedule& schedule, SimdTarget simd,
           const RecoveryHooks& hooks, Mesh& mesh)
      : pyramid_(std::move(pyramid)),
        spec_(spec),
        schedule_(schedule),
        simd_(simd),
        hooks_(hooks),
        mesh_(mesh),
        evolution_(mesh, schedule, simd, spec.model, evolution_options(spec)),
        levels_(static_cast<int>(pyramid_.levels.size()) - 1) {
    evolution_.set_observer(hooks.pass);
  }

  Status run(std::vector<LevelRecord>& records) {
    for (int h = levels_; h >= 0 && !stopped_; --h) {
      records.emplace_back();
      records.back().level = h;
      if (Status s = recover_level(h, records.back()); !s.ok()) return s;
      pyramid_.levels[static_cast<size_t>(h)].values = Buffer<float>();  // not needed any more
    }
    if (!mesh_.in_order()) renumber();
    return {};
  }

 private:
  void renumber() {
    mesh_.renumber(spec_.renumbering ? morton_order(mesh_, schedule_) : living_order(mesh_),
                   schedule_);
    evolution_.passed("ids");
  }
  // U_h / delta_h is the same on every level, within (14).
  double delta_of(int h) const { return unit_of(h) / kUnitPerDelta; }
  // U_h in mesh units.
  double unit_of(int h) const { return image_of(h).unit / pyramid_.levels[0].unit; }
  float iso_of(int h) const { return static_cast<float>(spec_.isos[static_cast<size_t>(h)]); }
  const PyramidLevel& image_of(int h) const { return pyramid_.levels[static_cast<size_t>(h)]; }

  // A level on which the object does not show, or cannot hold the surface, is passed over: the
  // surface then starts on the next finer one.
  Status recover_level(int h, LevelRecord& record) {
    enter(h);
    const bool fresh = mesh_.vertex_count() == 0;
    if (fresh) {
      const LevelImage level{pyramid_, h, spec_.pad_voxels, space_, iso_of(h), spec_.inside_above};
      if (Status s = start_surface(spec_.start, level, delta_of(h), schedule_, simd_, mesh_,
                                   record.operations);
          !s.ok()) {
        return s;
      }
      evolution_.passed("start");
    }
    if (mesh_.vertex_count() != 0) {
      if (Status s = recover_shape(h, fresh, record); !s.ok()) return s;
    }
    if (h > 0 || mesh_.vertex_count() != 0) return {};
    return {ErrorCode::kInvalidData,
            "no surface: nothing in the image holds one at this iso-value; check the iso-value, or "
            "use weaker internal forces"};
  }

  // The space and the guide of level h.
  void enter(int h) {
    const MeshSpace before = space_;
    space_ = mesh_space(pyramid_, h, spec_.anisotropy);
    if (mesh_.vertex_count() != 0) change_space(mesh_, before, space_);
    guide_.image = image_view(pyramid_, h, spec_.pad_voxels, space_);
    guide_.iso = iso_of(h);
    guide_.metric = space_.metric;
    user_ = spec_.user;
    const auto place = [this](Vec3 voxel) {
      const auto& s = space_.step;
      return Vec3{voxel.x * static_cast<float>(s[0]), voxel.y * static_cast<float>(s[1]),
                  voxel.z * static_cast<float>(s[2])};
    };
    for (Attachment& a : user_.attachments) a.place = place(a.place);
    for (Pin& p : user_.pins) p.place = place(p.place);
    for (size_t a = 0; a < 3; ++a) {
      user_.millimetres[a] = static_cast<float>(pyramid_.levels[0].voxel[a] / space_.step[a]);
    }
    if (spec_.force) {
      user_.force = [this, h](const Mesh& mesh, const Packed* position, Streams3& force) {
        return spec_.force(h, space_, mesh, position, force);
      };
    }
    guide_.user = &user_;
  }

  // (8) on level h: per U_h, in the lengths of the forces.
  Status build_gradient_image(int h) {
    const Model& model = spec_.model;
    if (model.gradient_normal == 0 && model.gradient_tangent == 0) return {};
    const float metric[3] = {space_.metric.x, space_.metric.y, space_.metric.z};
    std::array<double, 3> voxel;
    for (size_t a = 0; a < 3; ++a) {
      voxel[a] =
          static_cast<double>(metric[a]) / static_cast<double>(guide_.image.scale[a]) / unit_of(h);
      guide_.gradient.dims[a] = guide_.image.dims[a];
      guide_.gradient.scale[a] = guide_.image.scale[a];
      guide_.gradient.offset[a] = guide_.image.offset[a];
    }
    Status s =
        build_gradient(image_of(h), voxel, spec_.gradient_bound, schedule_, simd_, gradient_);
    guide_.gradient.data = gradient_.data();
    return s;
  }

  // Figure 12, first loop: refine until the density fits the image. With rho = sqrt 3 that is one
  // refinement per level; for other factors delta is set to fit afterwards, and creations and
  // deletions do the rest.
  void adapt(int h, LevelRecord& record) {
    const double start = now();
    const double target = delta_of(h);
    const auto steps = std::lround(std::log(mesh_.delta / target) / std::log(kRefinement));
    for (long i = 0; i < steps; ++i) {
      refine(mesh_, schedule_, spec_.renumbering);
      ++record.operations.refinement;
    }
    mesh_.delta = target;
    for (uint32_t v = 0; v < mesh_.slots(); ++v) mesh_.wake(v);
    evolution_.restart();
    evolution_.passed("refinement");
    record.delta = target;
    record.seconds.topology += now() - start;
    record.seconds.total += now() - start;
  }

  Status recover_shape(int h, bool fresh, LevelRecord& record) {
    adapt(h, record);
    if (Status s = build_gradient_image(h); !s.ok()) return s;
    tried_ = VoxelSet();
    bool added = false;
    if (!fresh) {
      if (Status s = add_late_bubbles(record, added); !s.ok()) return s;
    }
    for (int round = 0; !stopped_; ++round) {
      if (Status s = evolve(h, record); !s.ok()) return s;
      // What is missed on a coarse image the next finer one shows.
      if (h == 0 && round < kLateRounds) {
        if (Status s = add_late_bubbles(record, added); !s.ok()) return s;
        if (added) continue;
      }
      if (mesh_.vertex_count() == 0) return {};
      renumber();
      evolution_.restart();
      const LevelVerdict verdict = hooks_.level ? hooks_.level(record) : LevelVerdict::kAccept;
      stopped_ = verdict == LevelVerdict::kStop;
      if (verdict != LevelVerdict::kMore) break;
    }
    return {};
  }

  // Until the level has converged, or for max_iterations.
  Status evolve(int h, LevelRecord& record) {
    int calm = 0;
    Confirmation confirmation;
    double first_energy = 0;
    record.converged = false;
    for (int i = 1; i <= spec_.max_iterations && !record.converged; ++i) {
      if (mesh_.vertex_count() == 0) return {};
      if (Status s = evolution_.iterate(guide_, record.seconds, record.operations); !s.ok()) {
        return s;
      }
      ++record.iterations;
      record.energy = energy_ = evolution_.energy();
      record.speed = evolution_.speed();
      first_energy = std::max(first_energy, record.energy);
      const bool slow = spec_.calm_speed == 0 || record.speed < spec_.calm_speed;
      calm = record.energy < spec_.epsilon && slow ? calm + 1 : 0;
      record.converged = confirmed(i, calm, confirmation);
      if (hooks_.progress && !hooks_.progress(progress(h, record, first_energy))) {
        return {ErrorCode::kCancelled, "cancelled"};
      }
      renumber_if_scattered();
    }
    evolution_.check_all(record.seconds, record.operations);
    record.vertices = mesh_.vertex_count();
    return verify(h, record);
  }

  // What sleeps tells nothing: all are woken, and only when they are calm the level has converged.
  struct Confirmation {
    int since = 0;       // iteration in which all were woken; 0: they were not
    int not_before = 0;  // iteration in which they may be woken again
  };
  bool confirmed(int iteration, int calm, Confirmation& c) {
    if (c.since != 0 && calm < iteration - c.since) {
      c = {0, iteration + kConfirmPause};
    }
    if (calm < kCalmIterations) return false;
    if (c.since != 0) {
      return iteration >= kMinIterations && iteration - c.since >= kConfirmIterations;
    }
    if (!evolution_.any_asleep()) return iteration >= kMinIterations;
    if (iteration < std::max(c.not_before, kMinIterations - kConfirmIterations)) return false;
    evolution_.wake_all();
    c.since = iteration;
    return false;
  }

  // `added`: whether something had been missed.
  Status add_late_bubbles(LevelRecord& record, bool& added) {
    added = false;
    const bool at_rest = mesh_.vertex_count() == 0 || energy_ <= kLateEnergy * spec_.epsilon;
    if (!spec_.late_bubbles || std::isnan(guide_.iso) || !at_rest) return {};
    const double start = now();
    const uint32_t before = mesh_.vertex_count();
    LateBubbles late;
    if (Status s = start_late_bubbles(guide_.image, guide_.iso, spec_.inside_above, schedule_,
                                      simd_, mesh_, tried_, late, record.operations);
        !s.ok()) {
      return s;
    }
    evolution_.passed("late bubbles");
    const auto& mm = user_.millimetres;
    record.late.bubbles += late.bubbles;
    record.late.cavities += late.cavities;
    record.late.volume += late.volume * static_cast<double>(mm[0]) * static_cast<double>(mm[1]) *
                          static_cast<double>(mm[2]);
    added = mesh_.vertex_count() != before;
    if (added) {
      renumber();
      evolution_.restart();
    }
    record.seconds.topology += now() - start;
    record.seconds.total += now() - start;
    return {};
  }

  // The guards keep the surface from meeting itself; that they did is tested on every level, and
  // told where they failed.
  Status verify(int h, LevelRecord& record) {
    constexpr int kRepairs = 50;
    for (int i = 0; i < kRepairs; ++i) {
      if (evolution_.embedded()) return {};
      if (Status s = evolution_.iterate(guide_, record.seconds, record.operations); !s.ok()) {
        return s;
      }
    }
    return {ErrorCode::kInternal,
            "level " + std::to_string(h) + ": the surface meets itself and could not be parted"};
  }

  // Neighbours that are far apart in memory cost three times as much, and boxes over runs of ids
  // grow: when the new vertices are a sixteenth of all.
  void renumber_if_scattered() {
    if (!spec_.renumbering || mesh_.created() <= mesh_.vertex_count() / 16) return;
    renumber();
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
    return {h,
            levels_,
            static_cast<int>(record.iterations),
            mesh_.vertex_count(),
            record.energy,
            record.speed,
            fraction_};
  }

  Pyramid pyramid_;
  const RecoverySpec& spec_;
  const Schedule& schedule_;
  SimdTarget simd_;
  const RecoveryHooks& hooks_;
  Mesh& mesh_;
  Evolution evolution_;
  int levels_;
  MeshSpace space_;
  Guide guide_;
  UserConstraints user_;     // in the space of the level
  Buffer<Packed> gradient_;  // of the level
  VoxelSet tried_;           // voxels of the level's late bubbles
  double energy_ = 0;        // of the last iteration on any level
  bool stopped_ = false;
  double fraction_ = 0;
};

}  // namespace

Status pyramidal_recover_shape(Pyramid pyramid, const RecoverySpec& spec, const Schedule& schedule,
                               SimdTarget simd, const RecoveryHooks& hooks, Mesh& mesh,
                               std::vector<LevelRecord>& records) {
  Recovery recovery(std::move(pyramid), spec, schedule, simd, hooks, mesh);
  return recovery.run(records);
}

}  // namespace plc

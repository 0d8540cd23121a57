#include "engine/motion/dynamics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "kernels/gradient_force.h"
#include "kernels/image_force.h"
#include "kernels/ring_forces.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

bool stretched(const Metric& m) {
  return m.x != 1 || m.y != 1 || m.z != 1;
}

kernels::Float3s raw(Streams3& s) {
  return {s.x.data(), s.y.data(), s.z.data()};
}
kernels::ConstFloat3s raw(const Streams3& s) {
  return {s.x.data(), s.y.data(), s.z.data()};
}

// body(begin, end) for every run of successive blocks.
template <typename Body>
void split_runs(const Blocks& blocks, const Body& body) {
  for (size_t i = 0; i < blocks.count;) {
    const uint32_t begin = blocks.begin(i);
    uint32_t end = begin;
    for (; i < blocks.count && blocks.begin(i) == end; ++i) end += kRingLanes;
    body(begin, end);
  }
}

}  // namespace

// (8) changes by at most 2 over U_h, and U_h is kUnitPerDelta delta.
float stable_time_step(const Model& model, float stiffness) {
  const double gradient =
      std::max(std::abs(model.gradient_normal), std::abs(model.gradient_tangent));
  const double stiffest = kernels::kBendStiffness * static_cast<double>(model.curvature) +
                          12.0 * static_cast<double>(model.spring) +
                          std::abs(static_cast<double>(model.attraction)) +
                          2 / kUnitPerDelta * gradient + static_cast<double>(stiffness);
  const double mass = static_cast<double>(model.mass);
  const double longest = kStableFrequency * std::sqrt(mass / stiffest);
  const double damped = kStableDecay * mass / static_cast<double>(model.damping);
  return std::min(model.time_step, static_cast<float>(std::min(longest, damped)));
}

Model complying(Model model) {
  model.damping *= kComplyingDamping;
  model.time_step *= kComplyingStep;
  model.curvature = 0;
  model.attraction = 1;
  for (float* f : {&model.spring, &model.gradient_normal, &model.gradient_tangent}) {
    *f *= kernels::kMostCompliance;
  }
  return model;
}

Dynamics::Dynamics(Mesh& mesh, const Schedule& schedule, const Model& model, float counted)
    : mesh_(mesh),
      schedule_(schedule),
      model_(model),
      counted_(counted),
      damping_(model.damping),
      time_step_(stable_time_step(model)) {}

void Dynamics::resize(const Guide& guide) {
  const size_t n = mesh_.padded(), room = mesh_.room();
  for (Streams3* s : {&speed_, &rate_}) s->resize(n, room);
  laplacian_.reserve(room);
  laplacian_.resize(n);
  // As many as the mesh has: they are swapped.
  for (Buffer<Float4>& b : stage_) {
    b.reserve(room);
    b.resize(mesh_.position.size());
  }
  if (mesh_.sizing != nullptr) {
    from_star_.resize(n);
    compliance_.resize(n);
  }
  if (!only_surface_forces(guide)) force_.resize(n);
  if (!stretched(guide.metric)) return;
  for (Streams3* s : {&metric_normal_, &metric_step_}) s->resize(n);
}

// Neighbours read the positions and Laplacians of blocks that sleep: they are the same in the mesh
// and both stages, and those of when it fell asleep.
void Dynamics::choose_blocks(const Sleep* sleep) {
  if (sleep == nullptr) {
    blocks_.resize(mesh_.padded() / kRingLanes);
    std::iota(blocks_.begin(), blocks_.end(), 0U);
  } else {
    blocks_ = sleep->awake();
    const Blocks fallen{sleep->fallen().data(), sleep->fallen().size()};
    split_runs(fallen, [&](uint32_t begin, uint32_t end) {
      for (Buffer<Float4>& stage : stage_) {
        std::copy(mesh_.position.begin() + begin, mesh_.position.begin() + end,
                  stage.begin() + begin);
      }
    });
    kernels::laplacian(schedule_.simd(), mesh_.rings(), mesh_.position.data(), fallen,
                       laplacian_.data());
  }
  movement_.assign(tasks(), {});
}

size_t Dynamics::tasks() const {
  return (blocks_.size() + kTaskBlocks - 1) / kTaskBlocks;
}

Blocks Dynamics::task(size_t index) const {
  const size_t begin = index * kTaskBlocks;
  const size_t end = std::min(begin + kTaskBlocks, blocks_.size());
  return Blocks::of(blocks_.data(), blocks_.size(), begin, end);
}

void Dynamics::for_tasks(const std::function<void(size_t, const Blocks&)>& body) const {
  schedule_.run(tasks(), [&](size_t i) { body(i, task(i)); });
}

void Dynamics::for_runs(const std::function<void(uint32_t, uint32_t)>& body) const {
  for_tasks([&](size_t, const Blocks& blocks) { split_runs(blocks, body); });
}

bool Dynamics::only_surface_forces(const Guide& guide) const {
  return model_.curvature > 0 && model_.attraction != 0 && model_.spring <= 0 &&
         guide.gradient.data == nullptr &&
         (guide.user == nullptr || (guide.user->attachments.empty() && !guide.user->force));
}

bool Dynamics::moves_at_once(const Guide& guide) const {
  return only_surface_forces(guide) && model_.bound == Bound::kClamp && !mesh_.is_patch() &&
         (guide.user == nullptr || guide.user->pins.empty());
}

Status Dynamics::step(const Guide& guide, Seconds& seconds) {
  std::vector<Pass> table;
  append_passes(guide, nullptr, seconds, table);
  return schedule_.run_passes(table, in_order(guide));
}

bool Dynamics::in_order(const Guide& guide) const {
  return (guide.user != nullptr && guide.user->force) || mesh_.padded() <= kGrain;
}

void Dynamics::begin_step(const Guide& guide, const Sleep* sleep) {
  resize(guide);
  choose_blocks(sleep);
  complies_ = mesh_.sizing != nullptr && model_.attraction != 0 &&
              (guide.user == nullptr || guide.user->attachments.empty());
  Model model = complies_ ? complying(model_) : model_;
  if (!complies_) model.curvature = curvature() + smoothing();
  damping_ = model.damping;
  time_step_ = stable_time_step(model, guide.user == nullptr ? 0 : guide.user->stiffness());
}

void Dynamics::save(StateWriter& to) const {
  to.add(energy_);
  to.add(speed_of_fastest_);
  to.add_all(laplacian_);
}

void Dynamics::restore(StateReader& from) {
  from.read(energy_);
  from.read(speed_of_fastest_);
  from.read_all(laplacian_);
  for (Buffer<Float4>& b : stage_) b = mesh_.position;
}

void Dynamics::append_passes(const Guide& guide, const Sleep* sleep, Seconds& seconds,
                             std::vector<Pass>& table) {
  table.push_back({"begin", kAwake | kRings | kPositions,
                   kAwake | kStep | kNormals | kStages | kLaplacians, &seconds.dynamics,
                   [this, guide, sleep] { begin_step(guide, sleep); }});
  table.push_back({"normals", kAwake | kRings | kPositions, kNormals | kLaplacians,
                   &seconds.normals, [this, guide] { normals(guide); }});
  if (model_.spring > 0) {
    table.push_back({"rest length", kRings | kPositions, kRestLength, &seconds.dynamics,
                     [this, guide] { measure_rest_length(guide); }});
  }
  for (int stage = 0; stage < 4; ++stage) add_stage(stage, guide, seconds, table);
  if (!moves_at_once(guide)) {
    table.push_back({"bound", kRings | kPositions | kVelocities | kNormals | kRestLength,
                     kDisplacements | kStages | kLaplacians | kStep, &seconds.dynamics,
                     [this, guide] {
                       Status s;
                       if (model_.bound == Bound::kScale) s = scale_time_step(guide);
                       if (guide.user != nullptr && !guide.user->pins.empty()) hold_pinned(guide);
                       if (mesh_.is_patch()) hold_patch(guide);
                       return s;
                     }});
    table.push_back({"move", kAwake | kNormals | kCalm,
                     kStages | kDisplacements | kPositions | kVelocities | kDue | kStep,
                     &seconds.dynamics, [this] { move(); }});
  }
}

void Dynamics::add_stage(int stage, const Guide& guide, Seconds& seconds,
                         std::vector<Pass>& table) {
  const auto numbered = [stage](std::string name) { return name += std::to_string(stage + 1); };
  if (model_.curvature > 0 && stage > 0) {
    table.push_back({numbered("laplacian "), kAwake | kRings | kPositions | kStages, kLaplacians,
                     &seconds.dynamics, [this, stage] { laplacians(stage); }});
  }
  if (guide.user != nullptr && guide.user->force) {
    table.push_back({numbered("user force "), kRings | kPositions | kNormals | kStages, kUserForce,
                     &seconds.dynamics, [this, stage, guide] { return user_force(stage, guide); }});
  }
  constexpr uint32_t kRead = kAwake | kRings | kPositions | kVelocities | kNormals | kRestLength |
                             kLaplacians | kUserForce | kStep;
  if (stage == 3 && moves_at_once(guide)) {
    table.push_back({"stage 4 and move", kRead | kCalm,
                     kStages | kDisplacements | kPositions | kVelocities | kDue | kStep,
                     &seconds.dynamics, [this, guide] { last_stage_and_move(guide); }});
    return;
  }
  table.push_back({numbered("stage "), kRead, kStages | kDisplacements, &seconds.dynamics,
                   [this, stage, guide] { run_stage(stage, guide); }});
}

// With the Laplacians of the first stage, which walk the same rings.
void Dynamics::normals(const Guide& guide) {
  const kernels::Float3s n = raw(mesh_.normal);
  const Float4* position = mesh_.position.data();
  for_tasks([&](size_t, const Blocks& blocks) {
    if (model_.curvature > 0) {
      kernels::normals_and_laplacian(schedule_.simd(), mesh_.rings(), position, blocks, n,
                                     laplacian_.data());
    } else {
      kernels::normals(schedule_.simd(), mesh_.rings(), position, blocks, n);
    }
    if (!stretched(guide.metric)) return;
    const kernels::Float3s m = raw(metric_normal_);
    const kernels::Float3s step = raw(metric_step_);
    split_runs(blocks, [&](uint32_t begin, uint32_t end) {
      kernels::metric_normals(schedule_.simd(), guide.metric, n, begin, end, m, step);
    });
  });
}

Status Dynamics::user_force(int stage, const Guide& guide) {
  user_force_.resize(mesh_.padded());
  for (Buffer<float>* f : {&user_force_.x, &user_force_.y, &user_force_.z}) {
    std::fill(f->begin(), f->end(), 0.0F);
  }
  return guide.user->force(mesh_, stage_position(stage), user_force_);
}

void Dynamics::laplacians(int stage) {
  for_tasks([this, stage](size_t, const Blocks& blocks) {
    kernels::laplacian(schedule_.simd(), mesh_.rings(), stage_position(stage), blocks,
                       laplacian_.data());
  });
}

void Dynamics::run_stage(int stage, const Guide& guide) {
  const bool fused = only_surface_forces(guide);
  for_tasks([&](size_t, const Blocks& blocks) {
    if (fused) {
      kernels::guided_stage(schedule_.simd(), stage, coefficients(), surface_forces(stage, guide),
                            streams(stage), blocks);
      return;
    }
    split_runs(blocks,
               [&](uint32_t begin, uint32_t end) { gather_forces(stage, guide, begin, end); });
    kernels::rk4_stage(schedule_.simd(), stage, coefficients(), streams(stage),
                       raw(std::as_const(force_)), blocks);
  });
}

void Dynamics::last_stage_and_move(const Guide& guide) {
  for_tasks([&](size_t index, const Blocks& blocks) {
    movement_[index] =
        kernels::guided_move(schedule_.simd(), coefficients(), surface_forces(3, guide), streams(3),
                             move_bound(), move_streams(), blocks);
  });
  end_step();
}

// The position of stage s: that of the mesh, then what stage s - 1 wrote.
const Float4* Dynamics::stage_position(int stage) const {
  return stage == 0 ? mesh_.position.data() : stage_[stage % 2].data();
}

void Dynamics::gather_forces(int stage, const Guide& guide, uint32_t begin, uint32_t end) {
  const kernels::Float3s force = raw(force_);
  if (model_.curvature > 0) {
    kernels::curvature_force(schedule_.simd(), mesh_.rings(), laplacian_.data(),
                             mesh_.sizing == nullptr ? model_.curvature : 1, begin, end, force);
    if (mesh_.sizing != nullptr) scale_by_size(begin, end);
  } else {
    for (float* f : {force.x, force.y, force.z}) std::fill(f + begin, f + end, 0.0F);
  }
  if (model_.spring > 0) {
    kernels::spring_force(schedule_.simd(), mesh_.rings(), stage_position(stage),
                          {model_.spring, rest_length_, guide.metric}, begin, end, force);
  }
  image_forces(stage, guide, begin, end);
  if (complies_) {
    for (uint32_t v = begin; v < end; ++v) force_.set(v, force_.at(v) * compliance_[v]);
  }
  if (guide.user == nullptr) return;
  const Motion motion{stage == 0 ? mesh_.velocity : speed_, model_.mass, damping_};
  attach(*guide.user, motion, stage_position(stage), mesh_.normal, begin, end, force_);
  if (!guide.user->force) return;
  for (uint32_t v = begin; v < end; ++v) {
    const Vec3 f = user_force_.at(v);
    force_.set(v, force_.at(v) + (complies_ ? f * compliance_[v] : f));
  }
}

// alpha_c of the mesh, and what comes to it in an adaptive one, where it is small, for noise.
float Dynamics::curvature() const {
  return (mesh_.sizing == nullptr ? 1 : kSizedCurvature) * model_.curvature;
}
float Dynamics::smoothing() const {
  if (mesh_.sizing == nullptr) return 0;
  const float noise = std::min(mesh_.sizing->field.noise(), kMostNoise);
  return kNoiseCurvature * noise * noise * model_.curvature;
}

// Of an adaptive mesh: the bits of guided_stage.h.
void Dynamics::scale_by_size(uint32_t begin, uint32_t end) {
  const float alpha = curvature(), more = smoothing();
  for (uint32_t v = begin; v < end; ++v) {
    const float size = std::max(1.0F, 1.0F + mesh_.position[v].w);
    const float part = 1.0F / (size * size);
    force_.set(v, force_.at(v) * ((alpha * part + more) * part));
  }
}

// (7) and (8), both normalised by delta (3.8).
void Dynamics::image_forces(int stage, const Guide& guide, uint32_t begin, uint32_t end) {
  const kernels::Float3s force = raw(force_);
  const auto delta = static_cast<float>(mesh_.delta);
  if (model_.attraction != 0) {
    if (mesh_.sizing != nullptr) {
      kernels::sized_iso_force(schedule_.simd(), stage, surface_forces(stage, guide),
                               mesh_.position.data(), begin, end, force);
    } else {
      kernels::iso_force(schedule_.simd(), guide.image, stage_position(stage),
                         raw(image_normal(guide)), {delta * model_.attraction, guide.iso}, begin,
                         end, force);
    }
  }
  if (guide.gradient.data != nullptr) {
    const Streams3& normal = stretched(guide.metric) ? metric_normal_ : mesh_.normal;
    const Metric& m = guide.metric;
    kernels::gradient_force(schedule_.simd(), guide.gradient, stage_position(stage), raw(normal),
                            {delta * model_.gradient_normal,
                             delta * model_.gradient_tangent,
                             {1 / m.x, 1 / m.y, 1 / m.z}},
                            begin, end, force);
  }
}

const Streams3& Dynamics::image_normal(const Guide& guide) const {
  return stretched(guide.metric) ? metric_step_ : mesh_.normal;
}

kernels::Rk4Coefficients Dynamics::coefficients() const {
  return {1.0F / model_.mass, damping_, time_step_};
}

kernels::Rk4Streams Dynamics::streams(int stage) {
  return {mesh_.position.data(),
          raw(std::as_const(mesh_.velocity)),
          raw(speed_),
          raw(mesh_.displacement),
          raw(rate_),
          stage_[(stage + 1) % 2].data()};
}

kernels::SurfaceForces Dynamics::surface_forces(int stage, const Guide& guide) {
  return {mesh_.rings(),
          laplacian_.data(),
          curvature(),
          guide.image,
          stage_position(stage),
          raw(image_normal(guide)),
          static_cast<float>(mesh_.delta) * model_.attraction,
          guide.iso,
          mesh_.sizing != nullptr,
          smoothing(),
          kFacets,
          kStar,
          kComplianceReach * static_cast<float>(mesh_.delta),
          from_star_.data(),
          compliance_.data()};
}

// The last stage reads its positions from the other buffer.
kernels::MoveStreams Dynamics::move_streams() {
  return {mesh_.position.data(), stage_[0].data(),
          raw(mesh_.velocity),   raw(std::as_const(mesh_.normal)),
          mesh_.path.data(),     mesh_.turns.data()};
}

kernels::MoveBound Dynamics::move_bound() const {
  const float longest = model_.max_move * static_cast<float>(mesh_.delta);
  return {longest, longest / time_step_, kFreeTurns, kSwingingTurns,
          counted_ * static_cast<float>(mesh_.delta)};
}

void Dynamics::measure_rest_length(const Guide& guide) {
  rest_length_ = 0;
  if (model_.rest_length == RestLength::kZero) return;
  if (model_.rest_length == RestLength::kValue) {
    rest_length_ = model_.rest_length_value * static_cast<float>(mesh_.delta);
    return;
  }
  // Of the whole mesh, whatever sleeps.
  Vector<double> part(block_count(mesh_.padded(), kGrain));
  run_blocks(schedule_, mesh_.padded(), kGrain, [&](size_t index, size_t begin, size_t end) {
    part[index] = kernels::edge_length_sum(schedule_.simd(), mesh_.rings(), mesh_.position.data(),
                                           guide.metric, static_cast<uint32_t>(begin),
                                           static_cast<uint32_t>(end));
  });
  const double sum = std::accumulate(part.begin(), part.end(), 0.0);
  // Twice the edges of a closed mesh: the sum of the valences.
  uint64_t ends = 0;
  for (uint32_t v = 0; v < mesh_.slots(); ++v) ends += mesh_.valence(v);
  rest_length_ = ends == 0 ? 0 : static_cast<float>(sum / static_cast<double>(ends));
}

// The longest displacement of this step.
float Dynamics::longest_move() const {
  Vector<float> part(tasks(), 0.0F);
  for_tasks([&](size_t index, const Blocks& blocks) {
    part[index] =
        kernels::max_squared(schedule_.simd(), raw(std::as_const(mesh_.displacement)), blocks);
  });
  return part.empty() ? 0.0F : std::sqrt(*std::max_element(part.begin(), part.end()));
}

// Second method of 3.6: the displacement is about linear in the time step, so again with a shorter
// one until the fastest vertex is within the bound; what is left is clamped.
Status Dynamics::scale_time_step(const Guide& guide) {
  constexpr int kTries = 8;
  const float longest = move_bound().length;
  for (int i = 0; i < kTries; ++i) {
    const float moved = longest_move();
    if (moved <= longest) break;
    time_step_ = time_step_ * (longest / moved) * 0.95F;
    for (int stage = 0; stage < 4; ++stage) {
      if (model_.curvature > 0) laplacians(stage);
      if (guide.user != nullptr && guide.user->force) {
        if (Status s = user_force(stage, guide); !s.ok()) return s;
      }
      run_stage(stage, guide);
    }
  }
  return {};
}

// Those for which hold(v) neither move nor get any speed.
template <typename Hold>
void Dynamics::hold_where(const Hold& hold) {
  for_runs([&](uint32_t begin, uint32_t end) {
    for (uint32_t v = begin; v < std::min(end, mesh_.slots()); ++v) {
      if (!hold(v)) continue;
      mesh_.displacement.set(v, {});
      rate_.set(v, {});
    }
  });
}

void Dynamics::hold_pinned(const Guide& guide) {
  hold_where([&](uint32_t v) { return pinned(*guide.user, mesh_.at(v)); });
}

// What is held, and what would leave the box that it may move in.
void Dynamics::hold_patch(const Guide& guide) {
  hold_where([&](uint32_t v) {
    return mesh_.is_held(v) || !guide.room.contains(mesh_.at(v) + mesh_.displacement.at(v));
  });
}

void Dynamics::move() {
  for_tasks([&](size_t index, const Blocks& blocks) {
    movement_[index] = kernels::move(schedule_.simd(), move_bound(), raw(mesh_.displacement),
                                     raw(std::as_const(rate_)), move_streams(), blocks);
  });
  end_step();
}

// The positions are what was moved to, and the energy what was measured on the way.
void Dynamics::end_step() {
  mesh_.position.swap(stage_[0]);
  double sum = 0;
  float longest2 = 0;
  for (const kernels::Movement& m : movement_) {
    sum += m.energy;
    longest2 = std::max(longest2, m.longest2);
  }
  const double scale = mesh_.delta * static_cast<double>(time_step_);
  const double count = std::max(1.0, static_cast<double>(mesh_.free_count()));
  energy_ = static_cast<double>(model_.mass) * sum / (2 * count * scale * scale);
  speed_of_fastest_ = static_cast<double>(std::sqrt(longest2)) / scale;
}

}  // namespace plc

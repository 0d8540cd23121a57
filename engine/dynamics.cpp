#include "engine/dynamics.h"

#include <algorithm>
#include <cmath>

#include "engine/constants.h"
#include "kernels/gradient_force.h"
#include "kernels/image_force.h"
#include "kernels/ring_forces.h"

namespace plc {

namespace {

bool stretched(const Metric& m) {
  return m.x != 1 || m.y != 1 || m.z != 1;
}

}  // namespace

// (8) changes by at most 2 over U_h, and U_h is kUnitPerDelta delta.
float stable_time_step(const Model& model, float stiffness) {
  const double gradient =
      std::max(std::abs(model.gradient_normal), std::abs(model.gradient_tangent));
  const double stiffest = 2.6 * static_cast<double>(model.curvature) +
                          12.0 * static_cast<double>(model.spring) +
                          std::abs(static_cast<double>(model.attraction)) +
                          2 / kUnitPerDelta * gradient + static_cast<double>(stiffness);
  const double longest = kStableFrequency * std::sqrt(static_cast<double>(model.mass) / stiffest);
  return std::min(model.time_step, static_cast<float>(longest));
}

Dynamics::Dynamics(Mesh& mesh, const Schedule& schedule, SimdTarget simd, const Model& model)
    : mesh_(mesh),
      schedule_(schedule),
      simd_(simd),
      model_(model),
      time_step_(stable_time_step(model)) {}

void Dynamics::resize() {
  const size_t n = mesh_.padded();
  for (Streams3* s : {&force_, &speed_, &rate_}) s->resize(n);
  for (Buffer<Packed>* b : {&stage_[0], &stage_[1], &laplacian_, &before_}) b->resize(n);
}

void Dynamics::blocks(const std::function<void(uint32_t, uint32_t)>& body) const {
  const size_t per = kGrain / kRingLanes;
  const size_t tasks = (awake_.size() + per - 1) / per;
  const auto block = [&](size_t i) {
    const size_t end = std::min((i + 1) * per, awake_.size());
    for (size_t k = i * per; k < end;) {
      const uint32_t first = awake_[k];
      uint32_t last = first;
      for (++k; k < end && awake_[k] == last + 1; ++k) ++last;
      body(first * kRingLanes, (last + 1) * kRingLanes);
    }
  };
  if (awake_.size() * kRingLanes < kSerialBelow) {
    for (size_t i = 0; i < tasks; ++i) block(i);
  } else {
    schedule_.run(tasks, block);
  }
}

double Dynamics::block_sum(const std::function<double(uint32_t, uint32_t)>& body) const {
  std::vector<double> part(mesh_.padded() / kRingLanes, 0.0);
  blocks([&](uint32_t begin, uint32_t end) { part[begin / kRingLanes] = body(begin, end); });
  double sum = 0;
  for (const double p : part) sum += p;
  return sum;
}

Status Dynamics::step(const Guide& guide, Seconds& seconds, const Sleep* sleep) {
  resize();
  awake_.clear();
  for (uint32_t b = 0; b < mesh_.padded() / kRingLanes && sleep == nullptr; ++b) awake_.push_back(b);
  if (sleep != nullptr) awake_ = sleep->awake();
  for (const uint32_t block : sleep == nullptr ? std::vector<uint32_t>{} : sleep->fallen()) {
    for (uint32_t v = block * kRingLanes; v < (block + 1) * kRingLanes; ++v) {
      stage_[0][v] = stage_[1][v] = mesh_.packed[v];
    }
    kernels::laplacian(simd_, mesh_.rings(), mesh_.packed.data(), block * kRingLanes,
                       (block + 1) * kRingLanes, laplacian_.data());
  }
  std::copy(mesh_.packed.begin(), mesh_.packed.begin() + mesh_.padded(), before_.begin());
  const bool user_force = guide.user != nullptr && guide.user->force;
  if (stretched(guide.metric)) {
    for (Streams3* s : {&metric_normal_, &metric_step_}) s->resize(mesh_.padded());
  }
  time_step_ = stable_time_step(model_, guide.user == nullptr ? 0 : guide.user->stiffness());
  status_ = {};
  // In order, the user's force is called on the calling thread.
  schedule_.run_passes(passes(guide, seconds), user_force || mesh_.padded() < kSerialBelow);
  return status_;
}

std::vector<Pass> Dynamics::passes(const Guide& guide, Seconds& seconds) {
  std::vector<Pass> table;
  table.push_back({"normals", kRings | kPositions, kNormals, &seconds.normals,
                   [this, guide] { normals(guide); }});
  table.push_back({"rest length", kRings | kPositions, kRestLength, &seconds.dynamics,
                   [this, guide] { measure_rest_length(guide); }});
  for (int stage = 0; stage < 4; ++stage) add_stage(stage, guide, seconds, table);
  table.push_back({"bound", kRings | kPositions | kNormals | kRestLength,
                   kDisplacements | kVelocities | kStages | kLaplacians, &seconds.dynamics,
                   [this, guide] { bound(guide); }});
  table.push_back({"energy", kDisplacements | kNormals, kEnergy, &seconds.dynamics,
                   [this] { measure_energy(); }});
  table.push_back({"move", kDisplacements, kPositions, &seconds.dynamics, [this] { move(); }});
  return table;
}

void Dynamics::add_stage(int stage, const Guide& guide, Seconds& seconds,
                         std::vector<Pass>& table) {
  if (model_.curvature > 0) {
    table.push_back({"laplacian", kRings | kPositions | kStages, kLaplacians, &seconds.dynamics,
                     [this, stage] { laplacians(stage); }});
  }
  if (guide.user != nullptr && guide.user->force) {
    table.push_back({"user force", kRings | kPositions | kNormals | kStages, kUserForce,
                     &seconds.dynamics, [this, stage, guide] { user_force(stage, guide); }});
  }
  table.push_back(
      {"forces and stage",
       kRings | kPositions | kVelocities | kNormals | kRestLength | kLaplacians | kUserForce,
       kStages | kDisplacements, &seconds.dynamics,
       [this, stage, guide] { forces_and_stage(stage, guide); }});
}

void Dynamics::normals(const Guide& guide) {
  blocks([&](uint32_t begin, uint32_t end) {
    Streams3& n = mesh_.normal;
    kernels::normals(simd_, mesh_.rings(), mesh_.packed.data(), begin, end, n.x.data(), n.y.data(),
                     n.z.data());
    if (!stretched(guide.metric)) return;
    Streams3& m = metric_normal_;
    Streams3& s = metric_step_;
    kernels::metric_normals(simd_, guide.metric, n.x.data(), n.y.data(), n.z.data(), begin, end,
                            m.x.data(), m.y.data(), m.z.data(), s.x.data(), s.y.data(), s.z.data());
  });
}

void Dynamics::user_force(int stage, const Guide& guide) {
  user_force_.resize(mesh_.padded());
  for (Buffer<float>* f : {&user_force_.x, &user_force_.y, &user_force_.z}) {
    std::fill(f->begin(), f->end(), 0.0F);
  }
  if (status_.ok()) status_ = guide.user->force(mesh_, stage_position(stage), user_force_);
}

void Dynamics::laplacians(int stage) {
  blocks([this, stage](uint32_t begin, uint32_t end) {
    kernels::laplacian(simd_, mesh_.rings(), stage_position(stage), begin, end, laplacian_.data());
  });
}

void Dynamics::forces_and_stage(int stage, const Guide& guide) {
  blocks([&](uint32_t begin, uint32_t end) {
    stage_forces(stage, guide, begin, end);
    kernels::rk4_stage(simd_, stage, {1.0F / model_.mass, model_.damping, time_step_},
                       streams(stage), begin, end);
  });
}

// The position of stage s: that of the mesh, then what stage s - 1 wrote.
const Packed* Dynamics::stage_position(int stage) const {
  return stage == 0 ? mesh_.packed.data() : stage_[stage % 2].data();
}

void Dynamics::stage_forces(int stage, const Guide& guide, uint32_t begin, uint32_t end) {
  float* fx = force_.x.data();
  float* fy = force_.y.data();
  float* fz = force_.z.data();
  if (model_.curvature > 0) {
    kernels::curvature_force(simd_, mesh_.rings(), laplacian_.data(), model_.curvature, begin, end,
                             fx, fy, fz);
  } else {
    for (float* f : {fx, fy, fz}) std::fill(f + begin, f + end, 0.0F);
  }
  if (model_.spring > 0) {
    kernels::spring_force(simd_, mesh_.rings(), stage_position(stage), model_.spring, rest_length_,
                          guide.metric, begin, end, fx, fy, fz);
  }
  image_forces(stage, guide, begin, end);
  if (guide.user == nullptr) return;
  const Motion motion{stage == 0 ? mesh_.velocity : speed_, model_.mass, model_.damping};
  attach(*guide.user, motion, stage_position(stage), mesh_.normal, begin, end, force_);
  if (!guide.user->force) return;
  for (uint32_t v = begin; v < end; ++v) force_.set(v, force_.at(v) + user_force_.at(v));
}

// (7) and (8), both normalised by delta (3.8).
void Dynamics::image_forces(int stage, const Guide& guide, uint32_t begin, uint32_t end) {
  float* fx = force_.x.data();
  float* fy = force_.y.data();
  float* fz = force_.z.data();
  const bool metric = stretched(guide.metric);
  const auto delta = static_cast<float>(mesh_.delta);
  if (model_.attraction != 0) {
    const Streams3& n = metric ? metric_step_ : mesh_.normal;
    kernels::iso_force(simd_, guide.image, stage_position(stage), n.x.data(), n.y.data(),
                       n.z.data(), delta * model_.attraction, guide.iso, begin, end, fx, fy, fz);
  }
  if (guide.gradient.data != nullptr) {
    const Streams3& n = metric ? metric_normal_ : mesh_.normal;
    const Metric& m = guide.metric;
    kernels::gradient_force(simd_, guide.gradient, stage_position(stage), n.x.data(), n.y.data(),
                            n.z.data(), delta * model_.gradient_normal,
                            delta * model_.gradient_tangent, {1 / m.x, 1 / m.y, 1 / m.z}, begin,
                            end, fx, fy, fz);
  }
}

kernels::Rk4Streams Dynamics::streams(int stage) {
  const auto& p = mesh_.position;
  const auto& v = mesh_.velocity;
  auto& d = mesh_.displacement;
  return {p.x.data(),
          p.y.data(),
          p.z.data(),
          v.x.data(),
          v.y.data(),
          v.z.data(),
          force_.x.data(),
          force_.y.data(),
          force_.z.data(),
          speed_.x.data(),
          speed_.y.data(),
          speed_.z.data(),
          d.x.data(),
          d.y.data(),
          d.z.data(),
          rate_.x.data(),
          rate_.y.data(),
          rate_.z.data(),
          stage_[(stage + 1) % 2].data()};
}

void Dynamics::measure_rest_length(const Guide& guide) {
  rest_length_ = 0;
  if (model_.spring <= 0 || model_.rest_length == RestLength::kZero) return;
  if (model_.rest_length == RestLength::kValue) {
    rest_length_ = model_.rest_length_value * static_cast<float>(mesh_.delta);
    return;
  }
  const double sum = block_sum([&](uint32_t begin, uint32_t end) {
    return kernels::edge_length_sum(simd_, mesh_.rings(), mesh_.packed.data(), guide.metric, begin,
                                    end);
  });
  // Twice the edges of a closed mesh: the sum of the valences.
  uint64_t ends = 0;
  for (uint32_t v = 0; v < mesh_.slots(); ++v) ends += mesh_.valence(v);
  rest_length_ = ends == 0 ? 0 : static_cast<float>(sum / static_cast<double>(ends));
}

// The longest displacement of this step.
float Dynamics::fastest() const {
  const auto& d = mesh_.displacement;
  std::vector<float> part(mesh_.padded() / kRingLanes, 0.0F);
  blocks([&](uint32_t begin, uint32_t end) {
    part[begin / kRingLanes] =
        kernels::max_squared(simd_, d.x.data(), d.y.data(), d.z.data(), begin, end);
  });
  return part.empty() ? 0.0F : std::sqrt(*std::max_element(part.begin(), part.end()));
}

// Second method of 3.6: the displacement is about linear in the time step, so again with a shorter
// one until the fastest vertex is within the bound; what is left is clamped.
void Dynamics::scale_time_step(const Guide& guide, float longest) {
  constexpr int kTries = 8;
  for (int i = 0; i < kTries; ++i) {
    const float moved = fastest();
    if (moved <= longest) return;
    time_step_ = time_step_ * (longest / moved) * 0.95F;
    for (int stage = 0; stage < 4; ++stage) {
      if (model_.curvature > 0) laplacians(stage);
      if (guide.user != nullptr && guide.user->force) user_force(stage, guide);
      forces_and_stage(stage, guide);
    }
  }
}

// Afterwards the velocity of the mesh is the new one.
void Dynamics::bound(const Guide& guide) {
  auto& d = mesh_.displacement;
  const float longest = model_.max_move * static_cast<float>(mesh_.delta);
  if (model_.bound == Bound::kScale) scale_time_step(guide, longest);
  blocks([&](uint32_t begin, uint32_t end) {
    auto& v = rate_;
    kernels::clamp_movement(simd_, longest, longest / time_step_, d.x.data(), d.y.data(),
                            d.z.data(), v.x.data(), v.y.data(), v.z.data(), begin, end);
    const auto carry = [&](const Buffer<float>& from, Buffer<float>& to) {
      std::copy(from.begin() + begin, from.begin() + end, to.begin() + begin);
    };
    carry(v.x, mesh_.velocity.x);
    carry(v.y, mesh_.velocity.y);
    carry(v.z, mesh_.velocity.z);
  });
  if (guide.user != nullptr && !guide.user->pins.empty()) hold_pinned(guide);
}

void Dynamics::hold_pinned(const Guide& guide) {
  blocks([&](uint32_t begin, uint32_t end) {
    for (uint32_t v = begin; v < end; ++v) {
      if (!pinned(*guide.user, mesh_.at(v))) continue;
      mesh_.displacement.set(v, {});
      mesh_.velocity.set(v, {});
    }
  });
}

void Dynamics::move() {
  const auto& d = mesh_.displacement;
  blocks([&](uint32_t begin, uint32_t end) {
    kernels::move(simd_, d.x.data(), d.y.data(), d.z.data(), mesh_.position.x.data(),
                  mesh_.position.y.data(), mesh_.position.z.data(), mesh_.packed.data(),
                  mesh_.path.data(), begin, end);
  });
}

void Dynamics::measure_energy() {
  const auto& d = mesh_.displacement;
  const auto& n = mesh_.normal;
  const double sum = block_sum([&](uint32_t begin, uint32_t end) {
    return kernels::normal_energy_sum(simd_, d.x.data(), d.y.data(), d.z.data(), n.x.data(),
                                      n.y.data(), n.z.data(), begin, end);
  });
  const double scale = mesh_.delta * static_cast<double>(time_step_);
  const double count = std::max(1.0, static_cast<double>(mesh_.vertex_count()));
  energy_ = static_cast<double>(model_.mass) * sum / (2 * count * scale * scale);
  speed_of_fastest_ = static_cast<double>(fastest()) / scale;
}

}  // namespace plc

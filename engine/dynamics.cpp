#include "engine/dynamics.h"

#include <algorithm>
#include <cmath>

#include "engine/constants.h"
#include "kernels/image_force.h"
#include "kernels/ring_forces.h"

namespace plc {

float stable_time_step(const Model& model) {
  const double stiffness = 2.6 * static_cast<double>(model.curvature) +
                           12.0 * static_cast<double>(model.spring) +
                           std::abs(static_cast<double>(model.attraction));
  const double longest = kStableFrequency * std::sqrt(static_cast<double>(model.mass) / stiffness);
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
  const uint32_t n = mesh_.padded();
  const size_t tasks = (n + kGrain - 1) / kGrain;
  const auto block = [&](size_t i) {
    const auto begin = static_cast<uint32_t>(i) * kGrain;
    body(begin, std::min(begin + kGrain, n));
  };
  if (n < kSerialBelow) {
    for (size_t i = 0; i < tasks; ++i) block(i);
  } else {
    schedule_.run(tasks, block);
  }
}

double Dynamics::block_sum(const std::function<double(uint32_t, uint32_t)>& body) const {
  std::vector<double> part((mesh_.padded() + kGrain - 1) / kGrain, 0.0);
  blocks([&](uint32_t begin, uint32_t end) { part[begin / kGrain] = body(begin, end); });
  double sum = 0;
  for (const double p : part) sum += p;
  return sum;
}

void Dynamics::step(const ImageView& image, float iso, Seconds& seconds) {
  resize();
  time_step_ = stable_time_step(model_);
  schedule_.run_passes(passes(image, iso, seconds), mesh_.padded() < kSerialBelow);
}

std::vector<Pass> Dynamics::passes(const ImageView& image, float iso, Seconds& seconds) {
  std::vector<Pass> table;
  table.push_back({"normals", kRings | kPositions, kNormals, &seconds.normals, [this] {
                     blocks([this](uint32_t begin, uint32_t end) {
                       kernels::normals(simd_, mesh_.rings(), mesh_.packed.data(), begin, end,
                                        mesh_.normal.x.data(), mesh_.normal.y.data(),
                                        mesh_.normal.z.data());
                     });
                   }});
  table.push_back({"rest length", kRings | kPositions, kRestLength, &seconds.dynamics,
                   [this] { measure_rest_length(); }});
  for (int stage = 0; stage < 4; ++stage) add_stage(stage, image, iso, seconds, table);
  table.push_back({"bound", kRings | kPositions | kNormals | kRestLength,
                   kDisplacements | kVelocities | kStages | kLaplacians, &seconds.dynamics,
                   [this, image, iso] { bound(image, iso); }});
  table.push_back({"energy", kDisplacements | kNormals, kEnergy, &seconds.dynamics,
                   [this] { measure_energy(); }});
  table.push_back({"move", kDisplacements, kPositions, &seconds.dynamics, [this] { move(); }});
  return table;
}

void Dynamics::add_stage(int stage, const ImageView& image, float iso, Seconds& seconds,
                         std::vector<Pass>& table) {
  if (model_.curvature > 0) {
    table.push_back({"laplacian", kRings | kPositions | kStages, kLaplacians, &seconds.dynamics,
                     [this, stage] { laplacians(stage); }});
  }
  table.push_back({"forces and stage",
                   kRings | kPositions | kVelocities | kNormals | kRestLength | kLaplacians,
                   kStages | kDisplacements, &seconds.dynamics,
                   [this, stage, image, iso] { forces_and_stage(stage, image, iso); }});
}

void Dynamics::laplacians(int stage) {
  blocks([this, stage](uint32_t begin, uint32_t end) {
    kernels::laplacian(simd_, mesh_.rings(), stage_position(stage), begin, end, laplacian_.data());
  });
}

void Dynamics::forces_and_stage(int stage, const ImageView& image, float iso) {
  blocks([&](uint32_t begin, uint32_t end) {
    stage_forces(stage, image, iso, begin, end);
    kernels::rk4_stage(simd_, stage, {1.0F / model_.mass, model_.damping, time_step_},
                       streams(stage), begin, end);
  });
}

// The position of stage s: that of the mesh, then what stage s - 1 wrote.
const Packed* Dynamics::stage_position(int stage) const {
  return stage == 0 ? mesh_.packed.data() : stage_[stage % 2].data();
}

void Dynamics::stage_forces(int stage, const ImageView& image, float iso, uint32_t begin,
                            uint32_t end) {
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
                          {}, begin, end, fx, fy, fz);
  }
  kernels::iso_force(simd_, image, stage_position(stage), mesh_.normal.x.data(),
                     mesh_.normal.y.data(), mesh_.normal.z.data(),
                     static_cast<float>(mesh_.delta) * model_.attraction, iso, begin, end, fx, fy,
                     fz);
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

void Dynamics::measure_rest_length() {
  rest_length_ = 0;
  if (model_.spring <= 0 || model_.rest_length == RestLength::kZero) return;
  if (model_.rest_length == RestLength::kValue) {
    rest_length_ = model_.rest_length_value * static_cast<float>(mesh_.delta);
    return;
  }
  const double sum = block_sum([this](uint32_t begin, uint32_t end) {
    return kernels::edge_length_sum(simd_, mesh_.rings(), mesh_.packed.data(), {}, begin, end);
  });
  // Twice the edges of a closed mesh: the sum of the valences.
  uint64_t ends = 0;
  for (uint32_t v = 0; v < mesh_.slots(); ++v) ends += mesh_.valence(v);
  rest_length_ = ends == 0 ? 0 : static_cast<float>(sum / static_cast<double>(ends));
}

// The longest displacement of this step.
float Dynamics::fastest() const {
  const auto& d = mesh_.displacement;
  std::vector<float> part((mesh_.padded() + kGrain - 1) / kGrain, 0.0F);
  blocks([&](uint32_t begin, uint32_t end) {
    part[begin / kGrain] =
        kernels::max_squared(simd_, d.x.data(), d.y.data(), d.z.data(), begin, end);
  });
  return part.empty() ? 0.0F : std::sqrt(*std::max_element(part.begin(), part.end()));
}

// Second method of 3.6: the displacement is about linear in the time step, so again with a shorter
// one until the fastest vertex is within the bound; what is left is clamped.
void Dynamics::scale_time_step(const ImageView& image, float iso, float longest) {
  constexpr int kTries = 8;
  for (int i = 0; i < kTries; ++i) {
    const float moved = fastest();
    if (moved <= longest) return;
    time_step_ = time_step_ * (longest / moved) * 0.95F;
    for (int stage = 0; stage < 4; ++stage) {
      if (model_.curvature > 0) laplacians(stage);
      forces_and_stage(stage, image, iso);
    }
  }
}

// Afterwards the velocity of the mesh is the new one.
void Dynamics::bound(const ImageView& image, float iso) {
  auto& d = mesh_.displacement;
  const float longest = model_.max_move * static_cast<float>(mesh_.delta);
  if (model_.bound == Bound::kScale) scale_time_step(image, iso, longest);
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
}

void Dynamics::move() {
  const auto& d = mesh_.displacement;
  blocks([&](uint32_t begin, uint32_t end) {
    std::copy(mesh_.packed.begin() + begin, mesh_.packed.begin() + end, before_.begin() + begin);
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
}

}  // namespace plc

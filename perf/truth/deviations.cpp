#include "perf/truth/deviations.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/blocks.h"
#include "engine/base/mesh_arrays.h"
#include "engine/measure/curvature.h"
#include "engine/measure/measures.h"
#include "perf/truth/even_samples.h"

namespace truth {
namespace {

using plc::Double3;

constexpr size_t kBlock = 1024;

std::vector<double> samples_of(const Surface& surface) {
  const auto corners = [&](size_t face) {
    Corners p{};
    for (size_t k = 0; k < 3; ++k) {
      std::copy_n(surface.xyz.data() + 3 * static_cast<size_t>(surface.abc[3 * face + k]), 3,
                  p[k].data());
    }
    return p;
  };
  std::vector<double> xyz;
  for (const auto& p : even_samples(surface.abc.size() / 3, corners, kSamples)) {
    xyz.insert(xyz.end(), p.begin(), p.end());
  }
  return xyz;
}

// Of the samples, to the nearest points of the surface: the vertices of a mesh without faces.
std::vector<double> distances(const std::vector<double>& samples, const Surface& surface,
                              const plc::Executor& executor) {
  std::vector<double> result(samples.size() / 3);
  plc::surface_distances({samples.data(), result.size(), nullptr, 0}, surface.arrays(), executor,
                         result.data());
  return result;
}

// of(place) for every sample.
template <typename Of>
std::vector<double> at_samples(const std::vector<double>& samples, const plc::Executor& executor,
                               const Of& of) {
  std::vector<double> result(samples.size() / 3);
  plc::run_blocks(executor, result.size(), kBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      result[i] = of({samples[3 * i], samples[3 * i + 1], samples[3 * i + 2]});
    }
  });
  return result;
}

Spread spread(std::vector<double> distance) {
  Spread s;
  const auto n = static_cast<double>(distance.size());
  for (double& d : distance) {
    s.bias += d / n;
    s.rms += d * d / n;
    d = std::abs(d);
    if (d > 0.5) s.far += 1 / n;
  }
  s.rms = std::sqrt(s.rms);
  std::sort(distance.begin(), distance.end());
  s.p95 = distance[distance.size() * 95 / 100];
  s.max = distance.back();
  return s;
}

// Of the object at p, by second differences of the signed distance; NaN at edges, where it depends
// on the step.
double mean_curvature(const Scene& scene, const Double3& p) {
  const auto differences = [&](double step) {
    const Double3 ways[3] = {{step, 0, 0}, {0, step, 0}, {0, 0, step}};
    double sum = -6 * scene.signed_distance(p);
    for (const Double3& way : ways) {
      sum += scene.signed_distance(p + way) + scene.signed_distance(p - way);
    }
    return sum / (2 * step * step);
  };
  const double fine = differences(0.05), coarse = differences(0.1);
  const bool smooth = std::abs(fine - coarse) <= 0.02 + 0.1 * std::abs(fine);
  return smooth ? fine : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Truth::Truth(const Scene& scene, const plc::Executor& executor)
    : scene_(scene),
      executor_(executor),
      field_(scene, executor),
      object_(object_surface(scene, field_, executor)),
      iso_(iso_surface(field_, executor)) {
  if (object_.abc.empty()) throw plc::tools::Failure{"the object lies between the nodes"};
  object_samples_ = samples_of(object_);
  for (size_t i = 0; i < object_samples_.size(); i += 3) {
    double* xyz = object_samples_.data() + i;
    const Double3 p{xyz[0], xyz[1], xyz[2]};
    const Double3 q = p - object_normal(scene, p) * scene.signed_distance(p);
    xyz[0] = q.x, xyz[1] = q.y, xyz[2] = q.z;
  }
  if (!iso_.abc.empty()) iso_samples_ = samples_of(iso_);
}

Deviation Truth::object_deviation(const Surface& mesh) const {
  return {spread(at_samples(samples_of(mesh), executor_,
                            [&](const Double3& p) { return scene_.signed_distance(p); })),
          spread(distances(object_samples_, mesh, executor_))};
}

Deviation Truth::iso_deviation(const Surface& mesh) const {
  const std::vector<double> samples = samples_of(mesh);
  std::vector<double> far = distances(samples, iso_, executor_);
  const std::vector<double> value =
      at_samples(samples, executor_, [&](const Double3& p) { return field_.at(p); });
  for (size_t i = 0; i < far.size(); ++i) {
    if (value[i] > 0.5) far[i] = -far[i];
  }
  return {spread(std::move(far)), spread(distances(iso_samples_, mesh, executor_))};
}

double Truth::curvature_error(const Surface& mesh) const {
  const size_t count = mesh.xyz.size() / 3;
  std::vector<double> mean(count), off;
  plc::vertex_curvature(plc::arrays_of(mesh.xyz, mesh.abc), executor_, mean.data(), nullptr,
                        nullptr);
  const size_t step = std::max<size_t>(1, count / 20'000);
  for (size_t v = 0; v < count; v += step) {
    const double* xyz = mesh.xyz.data() + 3 * v;
    const Double3 p{xyz[0], xyz[1], xyz[2]};
    const Double3 foot = p - object_normal(scene_, p) * scene_.signed_distance(p);
    const double error = std::abs(mean[v] - mean_curvature(scene_, foot));
    if (std::isfinite(error)) off.push_back(error);
  }
  if (off.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return *middle;
}

Measured Truth::measure(Surface mesh) const {
  Measured m;
  m.vertices = mesh.xyz.size() / 3;
  m.faces = mesh.abc.size() / 3;
  plc::SurfaceMeasures whole = plc::surface_measures(plc::arrays_of(mesh.xyz, mesh.abc), executor_);
  if (whole.volume < 0) {
    for (size_t i = 0; i < mesh.abc.size(); i += 3) std::swap(mesh.abc[i + 1], mesh.abc[i + 2]);
    whole.volume = -whole.volume;
  }
  m.components = whole.components;
  m.genus = whole.genus;
  m.area = whole.area;
  m.volume = whole.volume;
  m.object = object_deviation(mesh);
  if (!iso_.abc.empty()) m.iso = iso_deviation(mesh);
  m.curvature = curvature_error(mesh);
  return m;
}

}  // namespace truth

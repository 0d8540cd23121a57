#include "perf/truth/truth_surface.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/base/blocks.h"
#include "engine/start/iso_surface.h"
#include "tools/file/failure.h"

namespace truth {
namespace {

using plc::Double3;

constexpr int kSteps = 4;  // of Newton
constexpr float kHalf = 0.5F;

uint8_t is_inside(float value) {
  return value >= kHalf;
}

// Where `values`, one per node, are 1/2, inside above it; vertices brought to the surface by
// step(), which tells where to from a place.
Surface marched(const FineField& field, const plc::LatticeValues& values,
                const plc::Executor& executor, const std::function<Double3(const Double3&)>& step) {
  plc::ImageView image;
  for (size_t a = 0; a < 3; ++a) image.dims[a] = static_cast<int32_t>(field.nodes()[a]);
  plc::Mesh mesh;
  const plc::Status status = plc::iso_surface({image, kHalf, true}, values, executor, mesh);
  if (status.code() == plc::ErrorCode::kInvalidData) return {};
  if (!status.ok()) throw plc::tools::Failure{status.message()};

  Surface surface;
  const plc::Vector<uint32_t> faces = mesh.faces();
  surface.abc.assign(faces.begin(), faces.end());
  surface.xyz.resize(3 * static_cast<size_t>(mesh.slots()));
  constexpr size_t kBlock = 4096;
  plc::run_blocks(executor, mesh.slots(), kBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      const plc::Vec3 at = mesh.at(static_cast<uint32_t>(v));
      Double3 p = field.place(
          {static_cast<double>(at.x), static_cast<double>(at.y), static_cast<double>(at.z)});
      for (int i = 0; i < kSteps; ++i) p = step(p);
      double* xyz = surface.xyz.data() + 3 * v;
      xyz[0] = p.x, xyz[1] = p.y, xyz[2] = p.z;
    }
  });
  return surface;
}

// 1/2 minus the signed distance at every node; only its sign where that is more than a voxel.
std::vector<float> distance_nodes(const Scene& scene, const FineField& field,
                                  const plc::Executor& executor) {
  const auto& nodes = field.nodes();
  std::vector<float> values(nodes[0] * nodes[1] * nodes[2]);
  const std::array<int, 3>& fine = field.fine();
  const double reach = length(Double3{scene.spacing[0], scene.spacing[1], scene.spacing[2]});
  executor.run(nodes[2], [&](size_t z) {
    for (size_t y = 0; y < nodes[1]; ++y) {
      float* row = values.data() + (z * nodes[1] + y) * nodes[0];
      double far = 0;  // of the node where the next few were last measured
      for (size_t x = 0; x < nodes[0]; ++x) {
        const bool first = x % static_cast<size_t>(fine[0]) == 0;
        if (first || std::abs(far) < reach) {
          const double at = scene.signed_distance(field.place(
              {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
          if (first) far = at;
          row[x] = static_cast<float>(0.5 - at);
        } else {
          row[x] = static_cast<float>(0.5 - far);
        }
      }
    }
  });
  return values;
}

}  // namespace

Double3 object_normal(const Scene& scene, const Double3& p) {
  constexpr double kStep = 1e-4;  // mm
  const auto along = [&](const Double3& step) {
    return scene.signed_distance(p + step) - scene.signed_distance(p - step);
  };
  const Double3 g{along({kStep, 0, 0}), along({0, kStep, 0}), along({0, 0, kStep})};
  const double size = length(g);
  return size > 0 ? g * (1 / size) : Double3{0, 0, 1};
}

Surface object_surface(const Scene& scene, const FineField& field, const plc::Executor& executor) {
  const std::vector<float> values = distance_nodes(scene, field, executor);
  const auto& nodes = field.nodes();
  const auto row = [&](int32_t y, int32_t z) {
    return values.data() + (static_cast<size_t>(z) * nodes[1] + static_cast<size_t>(y)) * nodes[0];
  };
  const plc::LatticeValues lattice{[&](int32_t y, int32_t z, uint8_t* inside) {
                                     std::transform(row(y, z), row(y, z) + nodes[0], inside,
                                                    is_inside);
                                   },
                                   [&](int32_t x, int32_t y, int32_t z) { return row(y, z)[x]; }};
  return marched(field, lattice, executor, [&](const Double3& p) {
    return p - object_normal(scene, p) * scene.signed_distance(p);
  });
}

Surface iso_surface(const FineField& field, const plc::Executor& executor) {
  const auto row = [&](int32_t y, int32_t z) {
    return field.row(static_cast<size_t>(y), static_cast<size_t>(z));
  };
  const plc::LatticeValues lattice{[&](int32_t y, int32_t z, uint8_t* inside) {
                                     std::transform(row(y, z), row(y, z) + field.nodes()[0], inside,
                                                    is_inside);
                                   },
                                   [&](int32_t x, int32_t y, int32_t z) { return row(y, z)[x]; }};
  return marched(field, lattice, executor, [&](const Double3& p) {
    constexpr double kLongestStep = 0.1;  // mm
    const Double3 gradient = field.gradient(p);
    const double square = dot(gradient, gradient);
    if (!(square > 0)) return p;
    const Double3 way = gradient * ((0.5 - field.at(p)) / square);
    const double far = length(way);
    return p + way * (far > kLongestStep ? kLongestStep / far : 1);
  });
}

}  // namespace truth

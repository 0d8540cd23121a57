#include "tools/phantom/phantoms.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tools/file/failure.h"
#include "tools/file/memory.h"
#include "tools/phantom/phantoms_canvas.h"
#include "tools/phantom/phantoms_random.h"
#include "tools/volume/volume_io_memory.h"

namespace plc::tools {
namespace {

template <typename T>
void store(double value, std::byte* at) {
  T converted;
  if constexpr (std::is_integral_v<T>) {
    const double low = std::numeric_limits<T>::min();
    const double high = std::numeric_limits<T>::max();
    converted = static_cast<T>(std::clamp(std::floor(value + 0.5), low, high));
  } else {
    converted = static_cast<T>(value);
  }
  std::memcpy(at, &converted, sizeof converted);
}

void store(plc_voxel_type type, double value, std::byte* at) {
  switch (type) {
    case PLC_U8:
      return store<uint8_t>(value, at);
    case PLC_I16:
      return store<int16_t>(value, at);
    case PLC_U16:
      return store<uint16_t>(value, at);
    case PLC_I32:
      return store<int32_t>(value, at);
    case PLC_F32:
      return store<float>(value, at);
  }
}

double length(double x, double y, double z) {
  return std::sqrt(x * x + y * y + z * z);
}

// (1 - t^2)^2 within |t| < 1, else 0: smooth, and the same bits everywhere.
double bump(double t_squared) {
  const double u = 1 - t_squared;
  return u > 0 ? u * u : 0;
}

}  // namespace

double full_scale(plc_voxel_type type) {
  if (type == PLC_U8) return 255;
  return type == PLC_F32 ? 1 : 1000;
}

Canvas::Canvas(const char* name_of, const PhantomOptions& options, const Defaults& defaults)
    : noise(options.noise.value_or(defaults.noise)),
      seed(options.seed),
      type(options.type.value_or(defaults.type)),
      name(name_of),
      take_planes_(options.take_planes) {
  for (int axis = 0; axis < 3; ++axis) {
    size[axis] = options.size[axis].value_or(defaults.size[axis]);
    spacing[axis] = options.spacing[axis];
    if (!(spacing[axis] > 0) || !std::isfinite(spacing[axis])) {
      throw Failure{name + ": the spacing must be above 0"};
    }
  }
  constexpr double kMaxNoise = 1000;
  if (!(noise >= 0 && noise <= kMaxNoise)) {
    throw Failure{name + ": the noise must be within 0 .. 1000"};
  }
  checked_voxel_count(name, size);
}

double Canvas::smallest_extent() const {
  return std::min({extent(0), extent(1), extent(2)});
}

Point Canvas::centre() const {
  return {(extent(0) - spacing[0]) / 2, (extent(1) - spacing[1]) / 2, (extent(2) - spacing[2]) / 2};
}

std::vector<double> Canvas::field(double value) const {
  const auto count = static_cast<uint64_t>(checked_voxel_count(name, size));
  require_memory(name, count * (sizeof(double) + voxel_size(type)));
  return std::vector<double>(count, value);
}

LoadedVolume Canvas::made(const std::function<double(size_t)>& next) const {
  // Of a volume that is handed over in parts, one part: as few planes as make some megabytes.
  constexpr int64_t kPart = int64_t{1} << 24;
  const int64_t plane = size[0] * size[1];
  const int64_t planes = take_planes_ ? std::clamp<int64_t>(kPart / plane, 2, size[2]) : size[2];
  const int64_t part[3] = {size[0], size[1], planes};
  LoadedVolume result = make_volume(name, type, part);
  std::copy(spacing, spacing + 3, result.image.spacing);
  std::copy(size, size + 3, result.image.dims);
  const double scale = full_scale(type);
  const size_t bytes = voxel_size(type);
  const auto count = static_cast<size_t>(plane * size[2]);
  const size_t room = result.bytes.size() / bytes;
  Random random(seed ^ 0x6e6f697365U);  // apart from the shapes' numbers
  for (size_t i = 0; i < count; ++i) {
    const double value = next(i);
    const double added = noise > 0 ? noise * random.normal() : 0;
    const size_t at = i % room;
    store(type, scale * (value + added), result.bytes.data() + at * bytes);
    if (take_planes_ && (at + 1 == room || i + 1 == count)) {
      take_planes_(result.image, {result.bytes.data(), (at + 1) * bytes});
    }
  }
  if (take_planes_) {
    result.bytes = {};
    result.image.voxels = nullptr;
  }
  return result;
}

LoadedVolume Canvas::volume(const std::vector<double>& field) const {
  return made([&](size_t voxel) { return field[voxel]; });
}

LoadedVolume Canvas::volume(const std::function<double(const Point&)>& value) const {
  int64_t at[3] = {-1, 0, 0};  // x fastest
  return made([&](size_t) {
    for (int axis = 0; axis < 3 && ++at[axis] == size[axis] && axis < 2; ++axis) at[axis] = 0;
    return value({static_cast<double>(at[0]) * spacing[0], static_cast<double>(at[1]) * spacing[1],
                  static_cast<double>(at[2]) * spacing[2]});
  });
}

int checked_count(const char* name, const char* what, const std::optional<int>& value, int fallback,
                  int limit) {
  const int count = value.value_or(fallback);
  if (count < 1 || count > limit) {
    throw Failure{std::string(name) + ": the " + what + " must be within 1 .. " +
                  std::to_string(limit)};
  }
  return count;
}

LoadedVolume chain_phantom(const PhantomOptions& options) {
  const Canvas canvas("chain", options, {{64, 64, 64}, PLC_F32, 0});
  // The shape of section 3.9 in a cube of 64 mm.
  const double scale = canvas.smallest_extent() / 64;
  const double ring = 14 * scale;
  const double tube = 3.57 * scale;
  const Point c = canvas.centre();
  return canvas.volume([=](const Point& p) {
    const double x = p.x - c.x;
    const double y = p.y - c.y;
    const double z = p.z - c.z;
    const double a = length(length(x + ring / 2, y, 0) - ring, z, 0);
    const double b = length(length(x - ring / 2, z, 0) - ring, y, 0);
    return std::max(0.0, 1 - std::min(a, b) / (2 * tube));
  });
}

LoadedVolume sierpinski_phantom(const PhantomOptions& options) {
  const int depth = checked_count("sierpinski", "depth", options.depth, 4, 12);
  int64_t cells = 1;
  for (int i = 0; i < depth; ++i) cells *= 3;
  const Canvas canvas("sierpinski", options, {{cells, cells, cells}, PLC_U8, 0});
  std::vector<double> field = canvas.field(0);
  const int64_t* size = canvas.size;
  const auto cell = [&](int64_t voxel, int axis) { return voxel * cells / size[axis]; };
  size_t voxel = 0;
  for (int64_t k = 0; k < size[2]; ++k) {
    for (int64_t j = 0; j < size[1]; ++j) {
      for (int64_t i = 0; i < size[0]; ++i) {
        int64_t x = cell(i, 0);
        int64_t y = cell(j, 1);
        int64_t z = cell(k, 2);
        bool solid = true;
        for (int level = 0; level < depth && solid; ++level) {
          // A hole goes through where two of the three digits are the middle one.
          solid = int{x % 3 == 1} + int{y % 3 == 1} + int{z % 3 == 1} < 2;
          x /= 3;
          y /= 3;
          z /= 3;
        }
        field[voxel++] = solid ? 1 : 0;
      }
    }
  }
  return canvas.volume(field);
}

LoadedVolume shell_phantom(const PhantomOptions& options) {
  const Canvas canvas("shell", options, {{80, 80, 80}, PLC_U8, 0.1});
  const double radius = 0.36 * canvas.smallest_extent();
  const double reach = 0.05 * canvas.smallest_extent();
  const Point c = canvas.centre();
  return canvas.volume([=](const Point& p) {
    const double t = (length(p.x - c.x, p.y - c.y, p.z - c.z) - radius) / reach;
    return bump(t * t);
  });
}

LoadedVolume blobs_phantom(const PhantomOptions& options) {
  const Canvas canvas("blobs", options, {{64, 64, 64}, PLC_F32, 0});
  const int count = checked_count("blobs", "number of blobs", options.count, 8, 10000);
  struct Ball {
    Point centre;
    double radius;
  };
  Random random(options.seed);
  std::vector<Ball> balls;
  const double extent = canvas.smallest_extent();
  for (int i = 0; i < count; ++i) {
    Ball ball{};
    // Half of the ball's reach is what is seen at 0.5 (it ends at 0.54 of it), and stays inside.
    ball.radius = extent * random.uniform(0.15, 0.35);
    double position[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double margin = 0.6 * ball.radius;
      position[axis] = random.uniform(margin, canvas.extent(axis) - margin);
    }
    ball.centre = {position[0], position[1], position[2]};
    balls.push_back(ball);
  }
  return canvas.volume([&](const Point& p) {
    double sum = 0;
    for (const Ball& ball : balls) {
      const double d = length(p.x - ball.centre.x, p.y - ball.centre.y, p.z - ball.centre.z);
      sum += bump(d * d / (ball.radius * ball.radius));
    }
    return std::min(sum, 1.0);
  });
}

const std::vector<std::string>& phantom_names() {
  static const std::vector<std::string> names = {"chain",   "sierpinski", "shell",
                                                 "vessels", "blobs",      "labels"};
  return names;
}

LoadedVolume make_phantom(const std::string& name, const PhantomOptions& options) {
  if (name == "chain") return chain_phantom(options);
  if (name == "sierpinski") return sierpinski_phantom(options);
  if (name == "shell") return shell_phantom(options);
  if (name == "vessels") return vessels_phantom(options);
  if (name == "blobs") return blobs_phantom(options);
  if (name == "labels") return labels_phantom(options);
  throw Failure{"unknown phantom \"" + name +
                "\" (known are chain, sierpinski, shell, vessels, blobs and labels)"};
}

}  // namespace plc::tools

#include "perf/truth/scene.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "perf/truth/numbers.h"
#include "tools/file/failure.h"

namespace truth {
namespace {

using plc::Double3;
using plc::tools::Failure;

// What is left around the object in voxels, before the blur, and how far the blur reaches.
constexpr double kMargin = 3, kReach = 4;

// About x, then y, then z, by degrees.
Matrix turned(const std::vector<double>& angles) {
  double c[3], s[3];
  for (size_t a = 0; a < 3; ++a) {
    c[a] = std::cos(angles[a] * kPi / 180);
    s[a] = std::sin(angles[a] * kPi / 180);
  }
  return {c[1] * c[2],
          s[0] * s[1] * c[2] - c[0] * s[2],
          c[0] * s[1] * c[2] + s[0] * s[2],
          c[1] * s[2],
          s[0] * s[1] * s[2] + c[0] * c[2],
          c[0] * s[1] * s[2] - s[0] * c[2],
          -s[1],
          s[0] * c[1],
          c[0] * c[1]};
}

struct Words {
  std::vector<double> voxels{1, 1, 1}, turn{20, 35, 10}, offset{0.3, 0.1, -0.2};
  std::optional<std::string> shape;
  bool oblique = false;
};

double within(const std::string& name, const std::string& text, double most) {
  const double value = to_numbers(name, text, 1, 1)[0];
  if (!(value >= 0 && value <= most)) {
    const std::string limit = std::to_string(static_cast<int>(most));
    std::string message = name;
    message.append(" ").append(text).append(": 0 to ").append(limit).append(" is expected");
    throw Failure{message};
  }
  return value;
}

// False where the option is not one of a scene.
bool take_option(const std::string& name, const std::string& value, Words& words, Scene& scene) {
  if (name == "--sigma") {
    scene.sigma = within(name, value, 10);
  } else if (name == "--noise") {
    scene.noise = within(name, value, 10);
  } else if (name == "--seed") {
    scene.seed = static_cast<uint64_t>(within(name, value, 1'000'000));
  } else if (name == "--voxels") {
    words.voxels = to_numbers(name, value, 3, 3);
    const auto fits = [](double side) { return side >= 1 && side <= 8; };
    if (!std::all_of(words.voxels.begin(), words.voxels.end(), fits)) {
      throw Failure{name + " " + value + ": 1 to 8 is expected"};
    }
  } else if (name == "--turn") {
    words.turn = to_numbers(name, value, 3, 3);
  } else if (name == "--offset") {
    words.offset = to_numbers(name, value, 3, 3);
  } else {
    return false;
  }
  return true;
}

// The size of the volume, and the shape within it.
void place(const Words& words, Scene& scene) {
  const std::vector<double>& v = words.voxels;
  const double mean = std::cbrt(v[0] * v[1] * v[2]);
  scene.turn = turned(words.turn);
  double centre[3];
  for (size_t a = 0; a < 3; ++a) {
    scene.spacing[a] = v[a] / mean;
    double half = 0;  // of the turned box, mm
    for (size_t b = 0; b < 3; ++b) half += std::abs(scene.turn[3 * a + b]) * scene.shape.half[b];
    const double offset = words.offset[a];
    if (!(std::abs(offset) <= 4)) throw Failure{"--offset: at most 4 voxels are expected"};
    const double reach =
        half / scene.spacing[a] + std::abs(offset) + kMargin + kReach * scene.sigma;
    scene.dims[a] = 2 * static_cast<int>(std::ceil(reach)) + 1;
    centre[a] = ((scene.dims[a] - 1) / 2.0 + offset) * scene.spacing[a];
  }
  scene.centre = {centre[0], centre[1], centre[2]};
  if (!words.oblique) return;
  scene.direction = turned({12, -25, 8});
  scene.origin = {-31.5, 12.25, 40};
}

}  // namespace

const char* const kSceneHelp =
    "a scene: SHAPE [--sigma VOXELS] [--noise OF_CONTRAST] [--seed N] [--voxels X,Y,Z]\n"
    "  [--turn X,Y,Z] [--offset X,Y,Z] [--oblique]";

Double3 times(const Matrix& m, const Double3& p) {
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z, m[3] * p.x + m[4] * p.y + m[5] * p.z,
          m[6] * p.x + m[7] * p.y + m[8] * p.z};
}

Double3 transposed_times(const Matrix& m, const Double3& p) {
  return {m[0] * p.x + m[3] * p.y + m[6] * p.z, m[1] * p.x + m[4] * p.y + m[7] * p.z,
          m[2] * p.x + m[5] * p.y + m[8] * p.z};
}

Scene take_scene(std::vector<std::string>& given) {
  Scene scene;
  Words words;
  std::vector<std::string> rest;
  for (size_t i = 0; i < given.size(); ++i) {
    const std::string& word = given[i];
    if (word == "--oblique") {
      words.oblique = true;
    } else if (word.rfind('-', 0) == 0) {
      const bool last = i + 1 == given.size();
      if (!last && take_option(word, given[i + 1], words, scene)) {
        ++i;
      } else if (last && word.rfind("--", 0) == 0) {
        throw Failure{word + ": an option that is not known, or without its value"};
      } else {
        rest.push_back(word);
      }
    } else if (words.shape) {
      rest.push_back(word);
    } else {
      words.shape = word;
    }
  }
  if (!words.shape) throw Failure{"a shape is expected"};
  scene.shape = make_shape(*words.shape);
  place(words, scene);
  given = rest;
  return scene;
}

}  // namespace truth

// The image of a scene, in floats, 0 outside and 1 inside:
//   truth_render SCENE -o FILE    .nrrd, .mha or .mhd
#include "engine/base/schedule.h"
#include "perf/truth/fine_field.h"
#include "perf/truth/program.h"
#include "tools/phantom/phantoms_random.h"
#include "tools/volume/volume_io.h"

namespace {

void render(std::vector<std::string> words) {
  const truth::Scene scene = truth::take_scene(words);
  if (words.size() != 2 || words[0] != "-o") {
    throw plc::tools::Failure{
        (words.empty() || words[0] == "-o" ? std::string() : words[0] + ": not known; ") +
        "-o FILE is expected"};
  }
  const plc::Schedule schedule(truth::threads());
  std::vector<float> values = truth::FineField(scene, schedule).voxels();
  if (scene.noise > 0) {
    plc::tools::Random random(scene.seed);
    for (float& value : values) value += static_cast<float>(scene.noise * random.normal());
  }
  plc_image image{};
  image.struct_size = sizeof image;
  image.type = PLC_F32;
  image.voxels = values.data();
  for (size_t a = 0; a < 3; ++a) {
    image.dims[a] = scene.dims[a];
    image.spacing[a] = scene.spacing[a];
  }
  const double origin[3] = {scene.origin.x, scene.origin.y, scene.origin.z};
  std::copy_n(origin, 3, image.origin);
  std::copy(scene.direction.begin(), scene.direction.end(), image.direction);
  plc::tools::write_volume(words[1], image);
}

}  // namespace

int main(int argc, char** argv) {
  return truth::run_program(argc, argv, "truth_render", "truth_render SCENE -o FILE", render);
}

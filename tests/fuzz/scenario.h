// A small phantom, parameters within their ranges and a start, taken from bytes: what an evolution
// needs. Nearly every input makes one that runs.
#pragma once
#include <vector>

#include "tests/fuzz/host.h"
#include "tests/samples/sample_volumes.h"

namespace fuzz {

// The pointers of image and extras lead into it: it does not move.
class Scenario {
 public:
  explicit Scenario(Input& input);
  Scenario(const Scenario&) = delete;
  Scenario& operator=(const Scenario&) = delete;

  const plc_image& image() const { return image_; }
  const plc_parameters& parameters() const { return parameters_; }
  plc_extras extras() const { return extras_; }  // without callbacks

 private:
  void make_image(Input& input);
  void choose_object(Input& input);
  void choose_pyramid(Input& input);
  void choose_model(Input& input);
  void choose_pace(Input& input);
  void choose_start(Input& input);
  void choose_places(Input& input);

  samples::Volume volume_;
  std::vector<uint8_t> bytes_;  // the volume's values, or in 0 .. 255
  std::vector<uint8_t> mask_voxels_;
  plc_image image_{};
  plc_image mask_{};
  plc_parameters parameters_{};
  plc_extras extras_{};
  std::vector<plc_seed> seeds_;
  std::vector<double> xyz_;
  std::vector<uint32_t> abc_;
  std::vector<plc_attachment> attachments_;
  std::vector<plc_pin> pins_;
};

}  // namespace fuzz

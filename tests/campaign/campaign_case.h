// A case of the campaign: an image, parameters, a start and what the engine may say to them. All of
// it follows from the seed, on any machine.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/api/frame.h"
#include "engine/pellicle.h"
#include "tests/samples/sample_meshes.h"
#include "tests/samples/sample_volumes.h"

namespace campaign {

using samples::Point;
using samples::Random;

// Each part of a case draws numbers of its own: what one part draws more changes no other.
enum class Part : uint64_t {
  kImage,
  kValues,
  kFrame,
  kModel,
  kPyramid,
  kStart,
  kExtras,
  kRuns,
  kFault,
  kRest,
  kMesh
};
inline Random draws(uint64_t seed, Part part) {
  return Random(seed * 16 + static_cast<uint64_t>(part));
}

// In one of `of` cases.
inline bool once_in(Random& random, int64_t of) {
  return random.integer(1, of) == 1;
}

// A status other than PLC_OK that is right for the case, its message beginning with or holding the
// phrase.
struct Refusal {
  plc_status status;
  std::string phrase;
};

enum class UserForce { kNone, kPressure, kCentre, kNotFinite };

// How a run is made. The first is plc_extract on one thread and the best target; the second must
// end with the same bits.
struct Way {
  int threads = 1;
  plc_simd simd = PLC_SIMD_AUTO;
  bool steps = false;  // a volume, a pyramid and a run, as below
  plc_ownership ownership = PLC_BORROW;
  plc_amount amount = PLC_ALL_LEVELS;  // of every call
  int pause_at = 0;         // iteration of the whole run after which progress cancels once; 0: none
  int save_at = -1;         // ... from which on the run goes on in another context; -1: none
  int look_every = 0;       // iterations between looks at the surface; 0: none
  bool strided = false;     // the image has gaps
  bool own_memory = false;  // HostMemory
  bool backwards = false;   // the host's loops, from the last task to the first
  double memory_part = 0;   // a limit: of what the first run had at most; 0: none. May end in
                            // PLC_OUT_OF_MEMORY
};

struct Case {
  uint64_t seed = 0;
  std::string phantom;
  plc_image image{};  // of `voxels`
  std::vector<std::byte> voxels;
  plc_parameters parameters{};

  plc_space space = PLC_SPACE_LPS;  // of the extras, and of the result that is checked
  std::vector<plc_seed> seeds;
  plc_image mask{};  // of mask_voxels
  std::vector<std::byte> mask_voxels;
  samples::Soup mesh;
  std::vector<plc_attachment> attachments;
  std::vector<plc_pin> pins;
  UserForce force = UserForce::kNone;
  Point force_centre{};
  double force_strength = 0;
  int more_level = -1;  // which gets PLC_VERDICT_MORE once
  int stop_level = -1;  // which gets PLC_VERDICT_STOP
  int cancel_at = 0;    // iteration of the whole run after which progress cancels; 0: never
  // Vertices times iterations after which the level is the last one, and after twice of which
  // progress cancels: strong springs, as long as edges may be, let a mesh grow for ever.
  int64_t work = 0;
  bool rests = false;  // the shipped model and epsilon: every level is to converge
  bool without_seeds = false, without_mask = false, without_mesh = false;  // of a fault
  bool bad_count = false;                                                  // of a fault

  std::string fault;  // what is wrong with the input on purpose; empty: nothing
  std::vector<Refusal> refusals;

  Way second;

  Case() = default;
  Case(Case&&) = default;
  Case& operator=(Case&&) = default;

  plc::Frame frame() const;
  plc_extras extras() const;
};

Case make_case(uint64_t seed);

// Everything about it, several lines.
std::string description(const Case& c);

const char* init_name(plc_init init);

// The volume as NRRD and, unless empty, the mesh as OFF. False when they cannot be written.
bool write_nrrd(const Case& c, const std::string& path);
bool write_off(const samples::Soup& mesh, const std::string& path);

}  // namespace campaign

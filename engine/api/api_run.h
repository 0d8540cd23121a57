// An evolution in progress (plc_run): a pyramid, what the host adds to it, and the recovery.
#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "engine/api/api_pyramid.h"
#include "engine/api/handles.h"
#include "engine/recover/recovery.h"

namespace plc {

// Whether the host's mask is borrowed for the call, or needed as long as the run.
enum class Lasting { kCall, kRun };

// Not for several threads at a time.
class Run {
 public:
  explicit Run(std::shared_ptr<Host> host) : host_(std::move(host)) {}

  // Up to the initial surface. images: those of the pyramid, borrowed or given away. parameters and
  // extras: checked; of the latter callbacks and their users are kept, arrays are copied.
  Status prepare(std::shared_ptr<const PyramidData> pyramid, Pyramid images, Lasting lasting,
                 const plc_parameters& parameters, const plc_extras& extras);
  // The initial surface.
  Status start();
  Status advance(Amount amount);
  void save(StateWriter& to) const;
  // Instead of start().
  Status restore(const uint8_t* state, size_t size);
  // A copy as it is now.
  std::unique_ptr<plc_surface> surface() const;
  // The surface itself: the run is over.
  std::unique_ptr<plc_surface> release();
  plc_run_state state() const;
  // Not while it is busy, nor after it has failed.
  Status usable() const;
  Status can_be_saved() const;  // and restored

 private:
  Status check_cost(const Pyramid& images, const RecoverySpec& spec) const;
  Status build_mask(const plc_image& mask, Lasting lasting, Pyramid& pyramid);
  RecoveryHooks hooks();
  LevelVerdict ask_user();
  void tell(const LevelRecord& record) const;
  Status guard(const std::function<Status()>& body);
  plc_progress progress(const RecoveryProgress& p) const;
  uint64_t fingerprint() const;

  std::shared_ptr<Host> host_;  // first, as in all handles
  std::shared_ptr<const PyramidData> pyramid_;
  std::unique_ptr<plc_surface> surface_;
  plc_extras extras_{};              // without arrays
  Buffer<uint8_t> own_mask_, mask_;  // what the recovery's mask borrows
  uint64_t given_hash_ = 0;          // of what extras were given for the start and on the way
  mutable std::optional<uint64_t> fingerprint_;  // once somebody has asked
  std::optional<Recovery> recovery_;
  bool patch_ = false;
  bool failed_ = false;
  bool busy_ = false;
  double since_ = 0;  // when the call at hand began
};

// Of parameters against those that a pyramid was made with: what it reads of them must be the same,
// as given or as derived.
Status check_agreement(const PyramidData& pyramid, const plc_parameters& parameters);

}  // namespace plc

struct plc_run {
  explicit plc_run(std::shared_ptr<plc::Host> host) : run(std::move(host)) {}
  plc::Run run;
};

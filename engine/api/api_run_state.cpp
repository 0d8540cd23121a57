// A run as bytes and back: the recovery's, within what tells whether they are whole and of this
// run.
#include <string>

#include "engine/api/api_run.h"
#include "engine/api/fingerprint.h"
#include "engine/base/fnv.h"
#include "engine/base/state_io.h"

namespace plc {

namespace {

constexpr uint64_t kMagic = 0x45544154534C4350;  // "PLCSTATE"

}  // namespace

// Of all that a saved state does not hold and goes on with.
uint64_t Run::fingerprint() const {
  if (!fingerprint_) {
    Fnv hash;
    hash.add(voxels_hash(pyramid_->volume->view, host_->schedule));
    hash.add(frame_hash(pyramid_->volume->frame));
    hash.add(parameters_hash(surface_->parameters));
    hash.add(given_hash_);
    if (extras_.force != nullptr) hash.add(static_cast<uint32_t>(extras_.space));
    fingerprint_ = hash.value();
  }
  return *fingerprint_;
}

void Run::save(StateWriter& to) const {
  to.add(kMagic);
  to.add(static_cast<int32_t>(PLC_VERSION));
  to.add(fingerprint());
  to.add(surface_->seconds.evolution);
  recovery_->save(to);
  to.add(to.data() == nullptr ? uint64_t{0} : words_hash(to.data(), to.size()));
}

Status Run::restore(const uint8_t* state, size_t size) {
  const auto refuse = [](const char* what) {
    return Status(ErrorCode::kInvalidData, std::string("state: ") + what);
  };
  uint64_t magic = 0;
  uint64_t fingerprint_there = 0;
  uint64_t sum = 0;
  int32_t version = 0;
  if (size < sizeof sum) return refuse("truncated");
  StateReader from(state, size - sizeof sum);
  StateReader(state + size - sizeof sum, sizeof sum).read(sum);
  from.read(magic);
  from.read(version);
  from.read(fingerprint_there);
  from.read(surface_->seconds.evolution);
  if (!from.ok() || magic != kMagic) return refuse("not one of a run");
  if (version != PLC_VERSION) return refuse("of another version of the library");
  if (sum != words_hash(state, size - sizeof sum)) return refuse("truncated or altered");
  if (fingerprint_there != fingerprint()) {
    return refuse("of another image, other parameters or other extras");
  }
  return guard([&] { return recovery_->restore(from); });
}

}  // namespace plc

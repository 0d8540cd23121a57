// Scalar twin of kernels/hash_entries.h.
#include "kernels/scalar.h"

namespace plc::kernels::scalar {

uint32_t entries_within(const uint32_t* ids, const CoarsePlace* places, const EntryRun* runs,
                        size_t count, const CoarseBox& box, uint32_t* out) {
  uint32_t found = 0;
  for (const EntryRun* run = runs; run != runs + count; ++run) {
    for (uint32_t i = run->first; i < run->last; ++i) {
      out[found] = ids[i];
      found += static_cast<uint32_t>(may_be_within(places[i], box));
    }
  }
  return found;
}

}  // namespace plc::kernels::scalar

// By which faces of the changing mesh each face of the original has been proved to be near it.
//
// A proof lasts as long as its faces do: when some of them change, those originals alone have to be
// proved again that used one. An original is in the list of every face that its proof has used;
// entries of earlier proofs stay until their list is cleared, and are told by their version.
//
//   per face        4   the first entry of its list
//   per original    4   the version of its proof
//   per entry      12   original, version, next
#pragma once
#include <cstddef>
#include <cstdint>

#include "pyramid/buffer.h"

namespace plc {

class Proofs {
 public:
  // Every face is the proof of itself.
  explicit Proofs(size_t faces) : first_(faces), version_(faces), entries_(faces) {
    for (uint32_t f = 0; f < faces; ++f) {
      first_[f] = f;
      entries_[f] = {f, 0, kEnd};
    }
  }

  // visit(original) for every one whose proof uses the face.
  template <typename Visit>
  void of(uint32_t face, const Visit& visit) const {
    for (uint32_t e = first_[face]; e != kEnd; e = entries_[e].next) {
      if (entries_[e].version == version_[entries_[e].original]) visit(entries_[e].original);
    }
  }
  // No proof uses the face any more.
  void clear(uint32_t face) {
    uint32_t e = first_[face];
    while (e != kEnd) {
      const uint32_t next = entries_[e].next;
      entries_[e].next = free_;
      free_ = e;
      e = next;
    }
    first_[face] = kEnd;
  }
  // The original is proved anew, by faces that are told after this.
  void renew(uint32_t original) { ++version_[original]; }
  void use(uint32_t original, uint32_t face) {
    uint32_t e = free_;
    if (e == kEnd) {
      e = static_cast<uint32_t>(entries_.size());
      entries_.push_back({});
    } else {
      free_ = entries_[e].next;
    }
    entries_[e] = {original, version_[original], first_[face]};
    first_[face] = e;
  }

 private:
  static constexpr uint32_t kEnd = 0xffffffffU;
  struct Entry {
    uint32_t original, version, next;
  };

  Buffer<uint32_t> first_, version_;
  Buffer<Entry> entries_;
  uint32_t free_ = kEnd;
};

}  // namespace plc

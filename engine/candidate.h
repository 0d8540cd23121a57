// A transformation that a violated constraint asks for, found by reading only.
#pragma once
#include <cstdint>
#include <tuple>

#include "engine/edge.h"

namespace plc {

// In the order in which they are resolved: annular before axial (3.3).
enum class Operation : uint8_t {
  kAnnular,    // cycle u, v, a
  kDeletion,   // of edge u-v
  kInversion,  // of edge u-v
  kCreation,   // on edge u-v
  kAxial       // between u and v
};

struct Candidate {
  Operation operation;
  float key;  // squared length or distance; negated where the longest comes first
  Edge edge;

  // The total order of a pass: no two candidates of a pass compare equal.
  friend bool operator<(const Candidate& l, const Candidate& r) {
    return std::tie(l.operation, l.key, l.edge.u, l.edge.v) <
           std::tie(r.operation, r.key, r.edge.u, r.edge.v);
  }
};

}  // namespace plc

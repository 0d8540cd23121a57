// Oriented neighbour rings of a mesh, as the kernels read them (paper, 3.1).
#pragma once
#include <cstdint>

namespace plc {

// Vertices come in blocks of kRingLanes; all vertex streams are padded to a multiple of it.
inline constexpr uint32_t kRingLanes = 16;
// Ring slots that have a fixed column; a vertex of higher valence keeps the rest in the tail arena.
inline constexpr uint32_t kRingSlots = 11;
// The columns of a block: kRingSlots slots, then the offset of the vertex's tail in the arena.
inline constexpr uint32_t kRingColumns = kRingSlots + 1;

// Slot k of vertex v (k < valence[v]), counter-clockwise seen from outside; faces are
// (v, slot k, slot k+1 mod valence).
//
//   columns: uint32 [block = v / 16][column = 0..11][lane = v % 16]   48 bytes per vertex
//            columns 0..10 are slots, column 11 the tail offset (read only when valence > 11);
//            slots at and past the valence hold v itself, so that any slot may be gathered from
//   valence: uint16 per vertex, 0 for a deleted vertex and for padding
//   tail:    uint32 arena; slot k >= 11 of v is tail[column 11 of v + (k - 11)]
struct RingView {
  const uint32_t* columns = nullptr;
  const uint16_t* valence = nullptr;
  const uint32_t* tail = nullptr;

  // Where column `column` of vertex v is, in columns.
  static uint32_t place(uint32_t v, uint32_t column) {
    return (v / kRingLanes * kRingColumns + column) * kRingLanes + v % kRingLanes;
  }
  uint32_t column(uint32_t v, uint32_t column) const { return columns[place(v, column)]; }
  // Slot k < valence[v] of vertex v.
  uint32_t slot(uint32_t v, uint32_t k) const {
    return k < kRingSlots ? column(v, k) : tail[column(v, kRingSlots) + (k - kRingSlots)];
  }
};

// A diagonal metric: how long a unit of each axis of mesh space is (4.4, third method).
struct Metric {
  float x = 1, y = 1, z = 1;
};

// A record that is fetched by neighbour index: one aligned 16-byte load. w is 0, but for positions
// at the start of a step: there it is by how much the size that edges are to have is above delta,
// in delta; 0 in a uniform mesh.
struct alignas(16) Float4 {
  float x, y, z, w;
};

}  // namespace plc

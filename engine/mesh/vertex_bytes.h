// A byte for every vertex that belongs to the algorithm that writes it, and follows the ids of the
// mesh.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/base/state_io.h"
#include "pyramid/buffer.h"
#include "pyramid/memory.h"

namespace plc {

class Mesh;

// The mesh that it is attached to moves the bytes along with its ids and makes room for new ones;
// the padding's are zero at first. It sets a vertex's byte to `first` when the vertex is created,
// and if its owner asks for it, also when the vertex is woken or touched. 1 byte per vertex.
class VertexBytes {
 public:
  // The least of what sets a byte to `first`. Creating a vertex is more than waking it, which is
  // more than touching it.
  enum class Reset : uint8_t { kTouched, kWoken, kCreated };

  VertexBytes(Mesh& mesh, uint8_t first, Reset reset);
  ~VertexBytes();
  VertexBytes(const VertexBytes&) = delete;
  VertexBytes& operator=(const VertexBytes&) = delete;

  uint8_t& operator[](size_t v) { return bytes_[v]; }
  uint8_t operator[](size_t v) const { return bytes_[v]; }
  uint8_t* data() { return bytes_.data(); }
  const uint8_t* data() const { return bytes_.data(); }
  // Padding included, and more where the mesh has reserved it.
  const Buffer<uint8_t>& all() const { return bytes_; }
  void fill(uint8_t value);

  // restore(): after that of the mesh.
  void save(StateWriter& to) const;
  void restore(StateReader& from);

 private:
  friend class Mesh;
  friend class AttachedBytes;

  Mesh* mesh_;  // null: it is gone
  uint8_t first_;
  Reset reset_;
  Buffer<uint8_t> bytes_;
};

// Those of a mesh. They are attached to the object and not to the surface in it: a copy has none,
// and a surface that is moved brings none along.
class AttachedBytes {
 public:
  AttachedBytes() = default;
  ~AttachedBytes();
  AttachedBytes(const AttachedBytes& /*other*/) {}
  AttachedBytes(AttachedBytes&& /*other*/) noexcept {}
  AttachedBytes& operator=(const AttachedBytes& /*other*/) { return *this; }
  AttachedBytes& operator=(AttachedBytes&& /*other*/) noexcept { return *this; }

  void add(VertexBytes& bytes) { list_.push_back(&bytes); }
  void remove(VertexBytes& bytes) { std::erase(list_, &bytes); }
  auto begin() const { return list_.begin(); }
  auto end() const { return list_.end(); }
  size_t size() const { return list_.size(); }

 private:
  Vector<VertexBytes*> list_;
};

}  // namespace plc

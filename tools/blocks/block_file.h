// The file of a task: the surface in each of the cells that it has written.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/blocks/block_grid.h"

namespace plc::tools {

// The faces of a cell, with all of their corners: a vertex is in every cell that has a face of it,
// at the same place in all.
struct BlockCell {
  std::vector<uint64_t> ids;  // ascending
  std::vector<double> xyz;    // three voxel indices for each
  std::vector<uint32_t> abc;  // three of them for each face, counter-clockwise seen from outside
};

// Atomically; the same cells make the same bytes. Throws Failure.
void write_block_file(const std::string& path, const std::map<Int3, BlockCell>& cells);

// Reads one cell after the other.
class BlockFile {
 public:
  // Throws Failure where it is no such file, or not whole.
  explicit BlockFile(const std::string& path);
  ~BlockFile();
  BlockFile(const BlockFile&) = delete;
  BlockFile& operator=(const BlockFile&) = delete;

  // Empty where the file has no such cell: nothing is in it. Throws Failure.
  BlockCell read(const Int3& cell) const;
  // Of all that is in it.
  uint64_t hash() const { return hash_; }

 private:
  struct Entry {
    uint64_t offset = 0, vertices = 0, faces = 0, hash = 0;
  };
  [[noreturn]] void damaged() const;
  void read_at(uint64_t offset, void* data, size_t size) const;

  std::string path_;
  int descriptor_ = -1;
  uint64_t hash_ = 0;
  std::map<Int3, Entry> entries_;
};

}  // namespace plc::tools

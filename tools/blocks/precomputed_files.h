// The files of a multi-resolution mesh for neuroglancer.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tools/blocks/chunk_grid.h"
#include "tools/blocks/mesh_fragment.h"
#include "tools/file/atomic_file.h"

namespace plc::tools {

// Which chunks a level of detail has and how many bytes each takes in the file of the fragments, 0:
// nothing is drawn there. In the order of the Z-curve.
struct FragmentTable {
  std::vector<Int3> chunks;
  std::vector<uint32_t> sizes;

  void add(const Int3& chunk, uint32_t size);
  // Those that are not there yet, with nothing in them.
  void add_empty(std::vector<Int3> wanted);
};

// The manifest, SEGMENT.index. Adds parents without faces to the tables, as every chunk is found
// from the one above it.
std::string manifest_of(const ChunkGrid& grid, std::vector<FragmentTable>& tables);

// From voxels to nm along the axes of LPS, the matrix by rows.
std::string info_of(const plc_image& image);

// Bytes that wait on the disk until what comes before them is there. Gone with the process.
class SpoolFile {
 public:
  // Somewhere in the folder.
  explicit SpoolFile(const std::string& folder);
  ~SpoolFile();
  SpoolFile(const SpoolFile&) = delete;
  SpoolFile& operator=(const SpoolFile&) = delete;

  void write(const std::string& bytes);
  void copy_to(AtomicFile& file) const;

 private:
  [[noreturn]] void fail(const std::string& what) const;

  std::string folder_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
};

}  // namespace plc::tools

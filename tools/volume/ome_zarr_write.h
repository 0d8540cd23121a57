// Writing of OME-Zarr 0.4 planes by planes, for volumes that no memory holds.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/pellicle.h"

namespace plc::tools {

// A folder under another name beside its target, which takes the target's place at commit() and is
// removed when that is not reached. One resolution, in chunks of kChunk voxels a side, packed on
// all processors; chunks of zeros are left out. Everything throws Failure.
class OmeZarrWriter {
 public:
  static constexpr int64_t kChunk = 64;

  // image: what the volume is; its voxels are not looked at. Axes other than those of LPS cannot be
  // told in the format. A target that is there must be a Zarr hierarchy or an empty folder.
  OmeZarrWriter(const std::string& path, const plc_image& image);
  ~OmeZarrWriter();
  OmeZarrWriter(const OmeZarrWriter&) = delete;
  OmeZarrWriter& operator=(const OmeZarrWriter&) = delete;

  // The next planes of the volume, whole ones.
  void add(std::span<const std::byte> planes);
  void commit();

 private:
  size_t plane_bytes() const;
  void make_folder();
  void write_slab();
  void write_chunk(int64_t x, int64_t y, std::vector<std::byte>& chunk) const;
  void write_file(const std::string& name, std::span<const std::byte> bytes) const;
  void write_text(const std::string& name, const std::string& text) const;
  [[noreturn]] void fail(int error) const;

  std::string path_;
  plc_image image_;
  std::string folder_;             // that is written
  int lock_ = -1;                  // of it: tells it from what a killed process has left
  int64_t slab_ = 0;               // slabs of kChunk planes that are written
  std::vector<std::byte> planes_;  // of the next slab
};

}  // namespace plc::tools

// Does a file hold the voxels its header speaks of? ITK's reader of MetaImage leaves what is
// missing as it happens to be, its reader of TIFF drops the pages it does not find, and none looks
// before the memory is taken.
#pragma once
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tools/file/checked_sizes.h"
#include "tools/volume/volume_io_formats.h"

namespace plc::tools {

// No stream of zlib unpacks to more than 1032 times its size: what claims more is not unpacked.
constexpr uint64_t kZlibRatio = 1040;

// `bytes` for each of dims[0] x dims[1] x ... voxels; of a header's voxels.
uint64_t product_of(const std::vector<int64_t>& dims, uint64_t bytes);
uint64_t voxel_bytes(const ItkHeader& header);

// All throw Failure.
uint64_t size_of(const std::string& path);  // of a regular file
void require_bytes(const std::string& path, uint64_t found, uint64_t needed);
void require_ratio(const std::string& path, uint64_t packed, uint64_t needed, uint64_t ratio);
// Unpacks the rest of the file, `packed` bytes at most, without keeping it: the reader unpacks it
// once more, but does not say where a stream ends early.
void check_zlib(const std::string& path, std::ifstream& file, uint64_t packed, uint64_t needed);

// The path of a file of that name in the folder of `path`.
std::string beside(const std::string& path, const std::string& name);

// "slice%03d.raw": a name with one number in it. ITK's libraries print with what a header gives:
// anything else must not reach them. The name for a number.
bool is_numbered_name(const std::string& pattern);
std::string numbered_name(const std::string& pattern, int64_t number);

void check_meta_axes(const std::string& path);
void check_tiff_pages(const std::string& path);
void check_meta_size(const std::string& path, const ItkHeader& header);
void check_nrrd_size(const std::string& path, const ItkHeader& header);
void check_tiff_size(const std::string& path, const ItkHeader& header);

}  // namespace plc::tools

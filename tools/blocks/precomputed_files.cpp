#include "tools/blocks/precomputed_files.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <system_error>

#include "tools/file/failure.h"
#include "tools/file/text.h"

namespace plc::tools {

void FragmentTable::add(const Int3& chunk, uint32_t size) {
  chunks.push_back(chunk);
  sizes.push_back(size);
}

void FragmentTable::add_empty(std::vector<Int3> wanted) {
  std::sort(wanted.begin(), wanted.end(), ZOrder());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  FragmentTable all;
  size_t next = 0;
  for (const Int3& chunk : wanted) {
    for (; next < chunks.size() && z_before(chunks[next], chunk); ++next) {
      all.add(chunks[next], sizes[next]);
    }
    if (next == chunks.size() || chunks[next] != chunk) all.add(chunk, 0);
  }
  for (; next < chunks.size(); ++next) all.add(chunks[next], sizes[next]);
  *this = std::move(all);
}

std::string manifest_of(const ChunkGrid& grid, std::vector<FragmentTable>& tables) {
  for (size_t lod = 1; lod < tables.size(); ++lod) {
    std::vector<Int3> parents;
    for (const Int3& at : tables[lod - 1].chunks) {
      parents.push_back({at[0] >> 1, at[1] >> 1, at[2] >> 1});
    }
    tables[lod].add_empty(std::move(parents));
  }
  std::string bytes;
  const auto put_float = [&](double value) { put_value(bytes, static_cast<float>(value)); };
  for (int a = 0; a < 3; ++a) put_float(grid.chunk(0));
  for (int a = 0; a < 3; ++a) put_float(ChunkGrid::origin());
  put_value(bytes, static_cast<uint32_t>(tables.size()));
  // How coarse it is, voxels: neuroglancer takes the coarsest one that is finer than its pixels.
  for (int lod = 0; lod < grid.lods(); ++lod) put_float(lod > 0 ? grid.cluster(lod) : 1);
  for (int i = 0; i < 3 * grid.lods(); ++i) put_float(0);  // offsets of vertices
  for (const FragmentTable& table : tables) {
    put_value(bytes, static_cast<uint32_t>(table.chunks.size()));
  }
  for (const FragmentTable& table : tables) {
    for (size_t a = 0; a < 3; ++a) {
      for (const Int3& at : table.chunks) put_value(bytes, static_cast<uint32_t>(at[a]));
    }
    for (const uint32_t size : table.sizes) put_value(bytes, size);
  }
  return bytes;
}

std::string info_of(const plc_image& image) {
  constexpr double kNanometres = 1e6;  // of a millimetre
  nlohmann::ordered_json transform = nlohmann::ordered_json::array();
  for (size_t i = 0; i < 3; ++i) {
    for (size_t a = 0; a < 3; ++a) {
      transform.push_back(image.direction[3 * i + a] * image.spacing[a] * kNanometres);
    }
    transform.push_back(image.origin[i] * kNanometres);
  }
  const nlohmann::ordered_json info = {{"@type", "neuroglancer_multilod_draco"},
                                       {"vertex_quantization_bits", kPositionBits},
                                       {"transform", transform},
                                       {"lod_scale_multiplier", 1}};
  return info.dump() + "\n";
}

SpoolFile::SpoolFile(const std::string& folder) : folder_(folder) {
  std::string name = folder + "/.pellicle-XXXXXX";
  descriptor_ = mkstemp(name.data());
  if (descriptor_ < 0) fail("cannot be written");
  unlink(name.c_str());
}

SpoolFile::~SpoolFile() {
  close(descriptor_);
}

void SpoolFile::fail(const std::string& what) const {
  throw Failure{folder_ + ": " + what + ": " + std::generic_category().message(errno)};
}

void SpoolFile::write(const std::string& bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) fail("cannot be written");
    if (count > 0) done += static_cast<size_t>(count);
  }
  size_ += bytes.size();
}

void SpoolFile::copy_to(AtomicFile& file) const {
  std::string bytes;
  for (uint64_t done = 0; done < size_; done += bytes.size()) {
    bytes.resize(std::min<uint64_t>(size_ - done, 1U << 20U));
    ssize_t count = -1;
    do {
      count = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(done));
    } while (count < 0 && errno == EINTR);
    if (count <= 0) fail("cannot be read");
    bytes.resize(static_cast<size_t>(count));
    file.write(bytes);
  }
}

}  // namespace plc::tools

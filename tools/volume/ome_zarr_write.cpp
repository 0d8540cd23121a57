#include "tools/volume/ome_zarr_write.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "tools/file/failure.h"
#include "tools/volume/ome_zarr.h"
#include "tools/volume/volume_io_memory.h"
#include "tools/volume/zarr_codecs.h"

namespace plc::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::vector<int64_t> slowest_first(const int64_t dims[3]) {
  return {dims[2], dims[1], dims[0]};
}

Json array_metadata(const plc_image& image) {
  static const char* const types[] = {"|u1", "<i2", "<u2", "<i4", "<f4"};
  constexpr int64_t kChunk = OmeZarrWriter::kChunk;
  Json json;
  json["zarr_format"] = 2;
  json["shape"] = slowest_first(image.dims);
  json["chunks"] = {kChunk, kChunk, kChunk};
  json["dtype"] = types[image.type];
  json["compressor"] = Json::parse(zarr_compressor());
  json["fill_value"] = 0;
  json["order"] = "C";
  json["filters"] = nullptr;
  json["dimension_separator"] = "/";
  return json;
}

Json image_metadata(const plc_image& image) {
  Json axes = Json::array();
  for (const char* const name : {"z", "y", "x"}) {
    axes.push_back({{"name", name}, {"type", "space"}, {"unit", "millimeter"}});
  }
  const double* s = image.spacing;
  const double* o = image.origin;
  const Json transformations = {{{"type", "scale"}, {"scale", {s[2], s[1], s[0]}}},
                                {{"type", "translation"}, {"translation", {o[2], o[1], o[0]}}}};
  Json dataset;
  dataset["path"] = "0";
  dataset["coordinateTransformations"] = transformations;
  Json multiscale;
  multiscale["version"] = "0.4";
  multiscale["axes"] = axes;
  multiscale["datasets"] = Json::array({dataset});
  Json json;
  json["multiscales"] = Json::array({multiscale});
  return json;
}

bool is_along_lps(const plc_image& image) {
  for (int i = 0; i < 9; ++i) {
    if (image.direction[i] != (i % 4 == 0 ? 1 : 0)) return false;
  }
  return true;
}

// body(0) .. body(tasks - 1), each once, on all processors. The first Failure ends it.
template <typename Body>
void on_all_processors(int64_t tasks, const Body& body) {
  std::atomic<int64_t> next{0};
  std::mutex lock;
  std::optional<Failure> failure;
  const auto work = [&] {
    try {
      std::vector<std::byte> scratch;
      for (int64_t task = next++; task < tasks; task = next++) body(task, scratch);
    } catch (const Failure& thrown) {
      const std::lock_guard<std::mutex> guard(lock);
      failure = thrown;
      next = tasks;
    } catch (const std::bad_alloc&) {
      const std::lock_guard<std::mutex> guard(lock);
      failure = Failure{"not enough memory to pack a volume"};
      next = tasks;
    }
  };
  std::vector<std::thread> more;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) more.emplace_back(work);
  work();
  for (std::thread& thread : more) thread.join();
  if (failure) throw Failure(*failure);
}

}  // namespace

OmeZarrWriter::OmeZarrWriter(const std::string& path, const plc_image& image)
    : path_(path), image_(image) {
  while (path_.size() > 1 && path_.back() == '/') path_.pop_back();
  checked_voxel_count(path_, image.dims);
  if (!is_along_lps(image)) {
    throw Failure{path_ + ": OME-Zarr has no place for the direction of the volume's axes"};
  }
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (fs::exists(status) &&
      !(fs::is_directory(status) && (is_zarr_folder(path_) || fs::is_empty(path_, error)))) {
    throw Failure{path_ + ": is there, and is no Zarr hierarchy that could be replaced"};
  }
  make_folder();
  planes_.reserve(plane_bytes() * static_cast<size_t>(kChunk));
}

OmeZarrWriter::~OmeZarrWriter() {
  std::error_code error;
  if (!folder_.empty()) fs::remove_all(folder_, error);
  if (lock_ >= 0) close(lock_);
}

size_t OmeZarrWriter::plane_bytes() const {
  return static_cast<size_t>(image_.dims[0] * image_.dims[1]) * voxel_size(image_.type);
}

void OmeZarrWriter::fail(int error) const {
  throw Failure{path_ + ": cannot be written: " + std::generic_category().message(error)};
}

// Names as those of temporary files, with the same meaning of their locks.
void OmeZarrWriter::make_folder() {
  const fs::path target(path_);
  constexpr int kMost = 100;
  for (int number = 0; number < kMost; ++number) {
    std::string name = target.filename().string();
    name.insert(0, 1, '.').append(".pellicle-").append(std::to_string(number));
    const fs::path folder = target.parent_path() / name;
    std::error_code error;
    const bool made = fs::create_directory(folder, error);
    if (error) fail(error.value());
    lock_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0) fail(errno);
    if (flock(lock_, LOCK_EX | LOCK_NB) == 0) {
      folder_ = folder.string();
      if (!made) {
        for (const auto& entry : fs::directory_iterator(folder, error)) {
          fs::remove_all(entry.path(), error);
        }
      }
      return;
    }
    close(std::exchange(lock_, -1));
  }
  fail(EEXIST);
}

void OmeZarrWriter::write_file(const std::string& name, std::span<const std::byte> bytes) const {
  const std::string path = folder_ + '/' + name;
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  if (error) fail(error.value());
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail(errno);
  size_t done = 0;
  int failed = 0;
  while (done < bytes.size() && failed == 0) {
    const ssize_t put = ::write(file, bytes.data() + done, bytes.size() - done);
    if (put >= 0) {
      done += static_cast<size_t>(put);
    } else if (errno != EINTR) {
      failed = errno;
    }
  }
  if (close(file) != 0 && failed == 0) failed = errno;
  if (failed != 0) fail(failed);
}

void OmeZarrWriter::write_text(const std::string& name, const std::string& text) const {
  write_file(name, std::as_bytes(std::span(text)));
}

// A chunk at the end of an axis is whole, too: what it has beyond the volume is 0.
void OmeZarrWriter::write_chunk(int64_t x, int64_t y, std::vector<std::byte>& chunk) const {
  const size_t size = voxel_size(image_.type);
  const size_t row_bytes = static_cast<size_t>(image_.dims[0]) * size;
  const auto planes = static_cast<int64_t>(planes_.size() / plane_bytes());
  const int64_t rows = std::min(kChunk, image_.dims[1] - y * kChunk);
  const auto width = static_cast<size_t>(std::min(kChunk, image_.dims[0] - x * kChunk)) * size;
  chunk.assign(static_cast<size_t>(kChunk * kChunk * kChunk) * size, std::byte{0});
  for (int64_t k = 0; k < planes; ++k) {
    for (int64_t j = 0; j < rows; ++j) {
      const std::byte* from = planes_.data() + static_cast<size_t>(k) * plane_bytes() +
                              static_cast<size_t>(y * kChunk + j) * row_bytes +
                              static_cast<size_t>(x * kChunk) * size;
      std::memcpy(chunk.data() + static_cast<size_t>((k * kChunk + j) * kChunk) * size, from,
                  width);
    }
  }
  if (std::all_of(chunk.begin(), chunk.end(), [](std::byte b) { return b == std::byte{0}; })) {
    return;
  }
  std::string name = "0";
  for (const int64_t index : {slab_, y, x}) name.append("/").append(std::to_string(index));
  write_file(name, zarr_compress(path_, chunk, size));
}

void OmeZarrWriter::write_slab() {
  const int64_t across = (image_.dims[0] + kChunk - 1) / kChunk;
  const int64_t along = (image_.dims[1] + kChunk - 1) / kChunk;
  on_all_processors(across * along, [&](int64_t task, std::vector<std::byte>& chunk) {
    write_chunk(task % across, task / across, chunk);
  });
  ++slab_;
  planes_.clear();
}

void OmeZarrWriter::add(std::span<const std::byte> planes) {
  const size_t whole = plane_bytes() * static_cast<size_t>(kChunk);
  while (!planes.empty()) {
    const size_t some = std::min(planes.size(), whole - planes_.size());
    planes_.insert(planes_.end(), planes.begin(), planes.begin() + static_cast<ptrdiff_t>(some));
    planes = planes.subspan(some);
    if (planes_.size() == whole) write_slab();
  }
}

void OmeZarrWriter::commit() {
  if (!planes_.empty()) write_slab();
  write_text("0/.zarray", array_metadata(image_).dump(2) + '\n');
  write_text(".zattrs", image_metadata(image_).dump(2) + '\n');
  write_text(".zgroup", "{\"zarr_format\": 2}\n");
  if (syncfs(lock_) != 0 && errno != ENOSYS) fail(errno);
  if (std::rename(folder_.c_str(), path_.c_str()) == 0) {
    folder_.clear();
    return;
  }
  if (errno != ENOTEMPTY && errno != EEXIST) fail(errno);
  // A target that is there changes places with the new folder, and goes with it.
  if (renameat2(AT_FDCWD, folder_.c_str(), AT_FDCWD, path_.c_str(), RENAME_EXCHANGE) != 0) {
    fail(errno);
  }
}

}  // namespace plc::tools

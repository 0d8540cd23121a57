#include "tools/blocks/block_file.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>

#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"
#include "tools/file/text.h"

namespace plc::tools {

namespace {

// Little endian: magic, version, cells; per cell its three numbers, offset, vertices, faces and
// hash, 56 bytes; the hash of all before; then per cell ids, coordinates and corners.
constexpr char kMagic[8] = {'P', 'L', 'C', 'B', 'L', 'O', 'C', 'K'};
constexpr uint32_t kVersion = 1;
constexpr size_t kHead = 16, kEntry = 56, kEnd = 8;
constexpr uint64_t kMostCells = 125;
constexpr size_t kVertex = 32, kFace = 12;

static_assert(std::endian::native == std::endian::little, "block files are little endian");

template <typename T>
void append(std::string& to, const std::vector<T>& values) {
  to.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

}  // namespace

void write_block_file(const std::string& path, const std::map<Int3, BlockCell>& cells) {
  std::string head(kMagic, sizeof kMagic), body;
  put_value(head, kVersion);
  uint32_t count = 0;
  for (const auto& [at, cell] : cells) count += cell.abc.empty() ? 0 : 1;
  put_value(head, count);
  const uint64_t start = kHead + count * kEntry + kEnd;
  for (const auto& [at, cell] : cells) {
    if (cell.abc.empty()) continue;
    const size_t offset = body.size();
    append(body, cell.ids);
    append(body, cell.xyz);
    append(body, cell.abc);
    for (const int64_t number : at) put_value(head, number);
    put_value(head, start + offset);
    put_value(head, static_cast<uint64_t>(cell.ids.size()));
    put_value(head, static_cast<uint64_t>(cell.abc.size() / 3));
    put_value(head, static_cast<uint64_t>(XXH64(body.data() + offset, body.size() - offset, 0)));
  }
  put_value(head, static_cast<uint64_t>(XXH64(head.data(), head.size(), 0)));
  AtomicFile file(path);
  file.write(head);
  file.write(body);
  file.commit();
}

BlockFile::BlockFile(const std::string& path) : path_(path) {
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) {
    throw Failure{path + ": cannot be read: " + std::generic_category().message(errno)};
  }
  try {
    struct stat status {};
    fstat(descriptor_, &status);
    const auto size = static_cast<uint64_t>(status.st_size);
    std::string head(kHead, '\0');
    if (size < kHead) damaged();
    read_at(0, head.data(), kHead);
    const uint32_t version = load_value<uint32_t>(head.data() + 8, false);
    const uint32_t count = load_value<uint32_t>(head.data() + 12, false);
    if (std::memcmp(head.data(), kMagic, sizeof kMagic) != 0 || version != kVersion ||
        count > kMostCells || size < kHead + count * kEntry + kEnd) {
      damaged();
    }
    head.resize(kHead + count * kEntry + kEnd);
    read_at(0, head.data(), head.size());
    hash_ = load_value<uint64_t>(head.data() + head.size() - kEnd, false);
    if (XXH64(head.data(), head.size() - kEnd, 0) != hash_) damaged();
    uint64_t end = head.size();
    for (uint32_t i = 0; i < count; ++i) {
      const char* at = head.data() + kHead + i * kEntry;
      const auto value = [&](size_t k) { return load_value<uint64_t>(at + 8 * k, false); };
      const Entry entry{value(3), value(4), value(5), value(6)};
      if (entry.offset != end || entry.vertices > size || entry.faces > size) damaged();
      end += entry.vertices * kVertex + entry.faces * kFace;
      entries_[{static_cast<int64_t>(value(0)), static_cast<int64_t>(value(1)),
                static_cast<int64_t>(value(2))}] = entry;
    }
    if (end != size) damaged();
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

BlockFile::~BlockFile() {
  close(descriptor_);
}

void BlockFile::damaged() const {
  throw Failure{path_ + ": is no file of blocks, or not whole: remove it, and run or plan again"};
}

void BlockFile::read_at(uint64_t offset, void* data, size_t size) const {
  auto* to = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = pread(descriptor_, to, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      throw Failure{path_ + ": cannot be read: " + std::generic_category().message(errno)};
    }
    if (got == 0) damaged();
    to += got;
    offset += static_cast<uint64_t>(got);
    size -= static_cast<size_t>(got);
  }
}

BlockCell BlockFile::read(const Int3& at) const {
  BlockCell cell;
  const auto found = entries_.find(at);
  if (found == entries_.end()) return cell;
  const Entry& entry = found->second;
  std::string bytes(entry.vertices * kVertex + entry.faces * kFace, '\0');
  read_at(entry.offset, bytes.data(), bytes.size());
  if (XXH64(bytes.data(), bytes.size(), 0) != entry.hash) damaged();
  cell.ids.resize(entry.vertices);
  cell.xyz.resize(3 * entry.vertices);
  cell.abc.resize(3 * entry.faces);
  const char* from = bytes.data();
  const auto take = [&](auto& values) {
    const size_t size = values.size() * sizeof(values[0]);
    if (size != 0) std::memcpy(values.data(), from, size);
    from += size;
  };
  take(cell.ids);
  take(cell.xyz);
  take(cell.abc);
  for (const uint32_t v : cell.abc) {
    if (v >= entry.vertices) damaged();
  }
  for (const double x : cell.xyz) {
    if (!std::isfinite(x)) damaged();
  }
  return cell;
}

}  // namespace plc::tools

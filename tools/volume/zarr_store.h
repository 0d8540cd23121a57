// Where the values of a Zarr hierarchy lie: under keys, such as "0/zarr.json" or "0/c/1/2/3".
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace plc::tools {

// Thread-safe. All throw Failure, which begins with the name of the value.
class ZarrStore {
 public:
  virtual ~ZarrStore() = default;
  // How messages call the value of a key; "" is the hierarchy itself.
  virtual std::string name(const std::string& key) const = 0;
  // In bytes; nothing where there is no such value.
  virtual std::optional<uint64_t> size(const std::string& key) const = 0;
  // The bytes from `offset` on, all of which the value must have.
  virtual void read(const std::string& key, uint64_t offset, std::span<std::byte> to) const = 0;
};

// A folder: keys are paths in it.
class ZarrFolder final : public ZarrStore {
 public:
  explicit ZarrFolder(std::string path) : path_(std::move(path)) {}
  std::string name(const std::string& key) const override;
  std::optional<uint64_t> size(const std::string& key) const override;
  void read(const std::string& key, uint64_t offset, std::span<std::byte> to) const override;

 private:
  std::string path_;
};

}  // namespace plc::tools

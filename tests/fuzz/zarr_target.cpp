// A Zarr hierarchy of any values. The bytes are a list of keys and values, each ended by a line
// of "----": what libFuzzer puts together from those of good hierarchies.
#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/input.h"
#include "tests/fuzz/refusal.h"
#include "tests/samples/sample_zarr.h"
#include "tools/volume/brick_source.h"
#include "tools/volume/ome_zarr.h"

namespace fuzz {

namespace {

constexpr std::string_view kEnd = "\n----\n";

std::string_view next_part(std::string_view& rest) {
  const size_t end = rest.find(kEnd);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + kEnd.size());
  return part;
}

}  // namespace

void volume_zarr(Bytes bytes) {
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  samples::ZarrMemory store;
  while (!rest.empty()) {
    const std::string key(next_part(rest));
    store.values[key] = next_part(rest);
  }
  read_or_refuse("memory", [&] {
    const plc::tools::OmeZarrImage image = plc::tools::open_ome_zarr(store);
    // Larger ones are as good, and take long.
    constexpr int64_t kMost = int64_t{1} << 22;
    int64_t voxels = 1;
    for (const int64_t dim : image.header.dims) voxels *= dim < kMost ? dim : kMost;
    if (voxels > kMost) return;
    const plc::tools::LoadedVolume volume = plc::tools::read_ome_zarr(store, image, 1);
    require(volume.image.voxels == volume.bytes.data(), "an image without its voxels");
    const auto source =
        plc::tools::open_zarr_bricks(std::make_shared<const samples::ZarrMemory>(store), "");
    if (source == nullptr) return;
    require(source->image().type == volume.image.type, "bricks of another type");
    plc::tools::VoxelBox all{};
    for (size_t a = 0; a < 3; ++a) all.high[a] = volume.image.dims[a] - 1;
    std::vector<std::byte> bricks(volume.bytes.size());
    source->read(all, bricks.data());
    require(std::equal(bricks.begin(), bricks.end(), volume.bytes.begin()),
            "other voxels by bricks");
  });
}

}  // namespace fuzz

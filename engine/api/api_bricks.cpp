// The C API: volumes of bricks, which the host fetches.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/api/handles.h"
#include "pyramid/brick_cache.h"
#include "pyramid/check_volume.h"

namespace plc {

namespace {

constexpr int64_t kLeastSide = 16, kMostSide = 4096, kMostVoxels = int64_t{1} << 26;
constexpr int64_t kDefaultCache = int64_t{1} << 30;
constexpr double kMostBricks = 1 << 30;  // each has a place in some tables

class HostBricks final : public CachedBricks {
 public:
  HostBricks(std::shared_ptr<BrickCache> cache, const plc_bricks& given)
      : CachedBricks(std::move(cache), static_cast<VoxelType>(given.type),
                     std::to_array(given.dims), std::to_array(given.brick)),
        fetch_(given.fetch),
        user_(given.user) {}

 private:
  void fill(const std::array<int64_t, 3>& at, void* voxels) const override {
    std::array<char, 512> message{};
    if (fetch_(at.data(), voxels, message.data(), message.size(), user_) == 0) return;
    message.back() = '\0';
    std::string line = message.data();
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    if (!line.empty()) throw BrickFailure(line);
    throw BrickFailure("brick (" + std::to_string(at[0]) + ", " + std::to_string(at[1]) + ", " +
                       std::to_string(at[2]) + ") could not be fetched");
  }

  plc_brick_fn fetch_;
  void* user_;
};

Status check_bricks(const plc_bricks& given) {
  if (given.fetch == nullptr) return bad_argument("bricks: fetch must not be NULL");
  if (given.type != PLC_U8 && given.type != PLC_I16 && given.type != PLC_U16 &&
      given.type != PLC_F32) {
    return bad_argument("bricks: type is not PLC_U8, PLC_I16, PLC_U16 or PLC_F32");
  }
  double bricks = 1;
  int64_t voxels = 1;
  for (int a = 0; a < 3; ++a) {
    if (given.brick[a] < kLeastSide || given.brick[a] > kMostSide) {
      return bad_argument("bricks: of " + std::to_string(given.brick[a]) +
                          " voxels on an axis, expected 16 to 4096");
    }
    voxels *= given.brick[a];
    bricks *= std::ceil(static_cast<double>(given.dims[a]) / static_cast<double>(given.brick[a]));
  }
  if (voxels > kMostVoxels) return bad_argument("bricks: of more than 2^26 voxels");
  if (bricks > kMostBricks) return bad_argument("bricks: more than 2^30, use larger ones");
  if (std::isnan(given.low) != std::isnan(given.high) || given.low > given.high ||
      std::isinf(given.low) || std::isinf(given.high)) {
    return bad_argument("bricks: low and high must be the range of the voxels, or NAN");
  }
  if (given.cache < 0) {
    return bad_argument("bricks: cache " + std::to_string(given.cache) +
                        ", expected 0 or more bytes");
  }
  return {};
}

// All but voxels.
plc_image image_of(const plc_bricks& given) {
  plc_image image;
  plc_image_defaults(&image);
  image.type = given.type;
  std::copy_n(given.dims, 3, image.dims);
  std::copy_n(given.spacing, 3, image.spacing);
  std::copy_n(given.origin, 3, image.origin);
  std::copy_n(given.direction, 9, image.direction);
  return image;
}

Status make_volume(const plc_bricks& given, VolumeData& data) {
  const plc_image image = image_of(given);
  if (Status s = check_frame(image); !s.ok()) return s;
  data.frame = frame_of(image);
  VolumeView& view = data.view;
  view.type = static_cast<VoxelType>(given.type);
  view.dims = std::to_array(given.dims);
  view.spacing = data.frame.spacing;
  if (!std::isnan(given.low)) data.range = VoxelRange{given.low, given.high, 0};
  if (!is_volume_size(view.dims) || *std::min_element(view.dims.begin(), view.dims.end()) < 2) {
    return {ErrorCode::kInvalidData, "bricks of " + voxels_text(view.dims) +
                                         ": expected at least 2 on every axis, fewer than 2^31 in "
                                         "a plane, fewer than 2^40 in all"};
  }
  if (Status s = check_bricks(given); !s.ok()) return s;
  const int64_t limit = data.host->memory.limit();
  const int64_t cache = given.cache != 0 ? given.cache : limit != 0 ? limit / 2 : kDefaultCache;
  view.bricks =
      std::make_shared<HostBricks>(std::make_shared<BrickCache>(data.host->memory, cache), given);
  return check_volume(view);
}

}  // namespace

}  // namespace plc

using plc::Status;

extern "C" {

plc_status plc_volume_create_bricks(plc_context* context, const plc_bricks* bricks,
                                    plc_volume** volume) {
  if (volume != nullptr) *volume = nullptr;
  return plc::guarded(context, [&]() -> Status {
    if (volume == nullptr) return plc::bad_argument("volume: must not be NULL");
    plc_bricks given;
    if (Status s = plc::take_struct(bricks, plc_bricks_defaults, "bricks", given); !s.ok()) {
      return s;
    }
    const auto data = plc::new_volume(context->host);
    if (Status s = plc::make_volume(given, *data); !s.ok()) return s;
    *volume = new plc_volume{data};
    return {};
  });
}

plc_status plc_volume_brick_counts(plc_context* context, const plc_volume* volume,
                                   plc_brick_counts* counts) {
  return plc::guarded(context, [&]() -> Status {
    if (volume == nullptr) return plc::bad_argument("volume: must not be NULL");
    if (Status s = plc::check_output(counts, "counts"); !s.ok()) return s;
    const auto& bricks = volume->data->view.bricks;
    if (bricks == nullptr) return plc::bad_argument("volume: it has no bricks");
    const plc::CachedBricks::Counts all = bricks->counts();
    const plc_brick_counts out{sizeof(plc_brick_counts), all.bricks, all.read, all.read_again};
    plc::give_struct(out, counts);
    return {};
  });
}

}  // extern "C"

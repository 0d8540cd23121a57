#include "tools/command/extract_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tools/file/failure.h"
#include "tools/file/memory.h"

namespace plc::tools {

namespace {

int fetch(const int64_t at[3], void* voxels, char* message, size_t size, void* user) {
  try {
    read_brick(*static_cast<const BrickSource*>(user), at, static_cast<std::byte*>(voxels));
    return 0;
  } catch (const Failure& failure) {
    std::snprintf(message, size, "%s", failure.message.c_str());
  } catch (const std::bad_alloc&) {
    std::snprintf(message, size, "not enough memory for a brick of the image");
  }
  return 1;
}

plc_bricks bricks_of(const BrickSource& source) {
  plc_bricks bricks;
  plc_bricks_defaults(&bricks);
  const plc_image& image = source.image();
  bricks.type = image.type;
  std::copy_n(image.dims, 3, bricks.dims);
  std::copy_n(source.brick().data(), 3, bricks.brick);
  std::copy_n(image.spacing, 3, bricks.spacing);
  std::copy_n(image.origin, 3, bricks.origin);
  std::copy_n(image.direction, 9, bricks.direction);
  bricks.fetch = fetch;
  bricks.user = const_cast<BrickSource*>(&source);  // only read
  return bricks;
}

}  // namespace

ExtractVolume::ExtractVolume(const ExtractOptions& options) {
  if (options.memory) source_ = open_bricks(options.input, options.nifti_frame);
  if (source_ == nullptr) {
    loaded_ = read_volume_apart(options.input, options.nifti_frame);
    print_warnings(loaded_.warnings);
    whole_ = loaded_.image;
    if (options.box) loaded_ = cut_out(options.input, loaded_, *options.box);
    return;
  }
  print_warnings(source_->warnings);
  whole_ = source_->image();
  if (options.box) source_ = cut_out(options.input, std::move(source_), *options.box);
}

plc_status ExtractVolume::extract(plc_context* context, const plc_parameters& parameters,
                                  const plc_extras& extras, plc_surface** surface) {
  if (source_ == nullptr) {
    return plc_extract(context, &loaded_.image, &parameters, &extras, surface);
  }
  if (volume_ == nullptr) volume_ = volume_of(context, *source_, NAN, NAN);
  return plc_extract_volume(context, volume_.get(), &parameters, &extras, surface);
}

VolumeHandle volume_of(plc_context* context, const BrickSource& source, double low, double high) {
  plc_bricks bricks = bricks_of(source);
  bricks.low = low;
  bricks.high = high;
  plc_volume* made = nullptr;
  demand(context, plc_volume_create_bricks(context, &bricks, &made));
  return VolumeHandle(made);
}

std::optional<plc_brick_counts> ExtractVolume::brick_counts(plc_context* context) const {
  if (volume_ == nullptr) return std::nullopt;
  plc_brick_counts counts;
  plc_brick_counts_defaults(&counts);
  demand(context, plc_volume_brick_counts(context, volume_.get(), &counts));
  return counts;
}

int64_t memory_limit(const ExtractOptions& options, size_t held) {
  // What the process needs beside the memory that the engine counts: oneTBB and what is unpacked,
  // and a part of all for what heaps leave between their blocks.
  constexpr int64_t kOwn = int64_t{64} << 20;
  constexpr int64_t kPart = 16;
  const auto available = static_cast<int64_t>(available_memory());
  if (!options.memory) return available;
  const int64_t own =
      static_cast<int64_t>(unshared_memory() + held) + kOwn + *options.memory / kPart;
  const int64_t left = *options.memory - own;
  if (left <= 0) {
    throw Failure{"--memory: more is in use before the surface is begun with; give more"};
  }
  return available == 0 ? left : std::min(left, available);
}

}  // namespace plc::tools

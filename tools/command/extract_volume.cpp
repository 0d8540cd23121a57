#include "tools/command/extract_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <string>
#include <utility>

#include "tools/command/clock.h"
#include "tools/file/failure.h"
#include "tools/file/memory.h"

namespace plc::tools {

namespace {

int fetch(const int64_t at[3], void* voxels, char* message, size_t size, void* user) {
  try {
    const auto& bricks = *static_cast<const BrickFetch*>(user);
    read_brick(*bricks.source, at, static_cast<std::byte*>(voxels));
    if (bricks.fetched) bricks.fetched();
    return 0;
  } catch (const Failure& failure) {
    std::snprintf(message, size, "%s", failure.message.c_str());
  } catch (const std::bad_alloc&) {
    std::snprintf(message, size, "not enough memory for a brick of the image");
  }
  return 1;
}

plc_bricks bricks_of(const BrickFetch& fetcher) {
  const BrickSource& source = *fetcher.source;
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
  bricks.user = const_cast<BrickFetch*>(&fetcher);  // only read
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

namespace {

int64_t brick_count(const BrickSource& source) {
  int64_t count = 1;
  for (size_t a = 0; a < 3; ++a) {
    count *= (source.image().dims[a] + source.brick()[a] - 1) / source.brick()[a];
  }
  return count;
}

// Tells how many bricks have been read until all have been, once: before that no surface evolves.
class Reading {
 public:
  Reading(int64_t bricks, ProgressLine& line) : bricks_(bricks), line_(line) {}
  void add() {
    const std::lock_guard lock(mutex_);
    if (++read_ > bricks_) return;
    line_.update_part(
        "reading, " + std::to_string(read_) + " of " + std::to_string(bricks_) + " bricks",
        static_cast<double>(read_) / static_cast<double>(bricks_), now() - start_);
  }

 private:
  std::mutex mutex_;
  double start_ = now();
  int64_t bricks_, read_ = 0;
  ProgressLine& line_;
};

}  // namespace

plc_status ExtractVolume::extract(plc_context* context, const plc_parameters& parameters,
                                  const plc_extras& extras, ProgressLine& line,
                                  plc_surface** surface) {
  if (source_ == nullptr) {
    return plc_extract(context, &loaded_.image, &parameters, &extras, surface);
  }
  if (volume_ != nullptr) {
    return plc_extract_volume(context, volume_.get(), &parameters, &extras, surface);
  }
  Reading reading(brick_count(*source_), line);
  fetch_ = {source_.get(), [&reading] { reading.add(); }};
  volume_ = volume_of(context, fetch_, NAN, NAN);
  const plc_status status =
      plc_extract_volume(context, volume_.get(), &parameters, &extras, surface);
  fetch_.fetched = nullptr;
  return status;
}

VolumeHandle volume_of(plc_context* context, const BrickFetch& fetch, double low, double high) {
  plc_bricks bricks = bricks_of(fetch);
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

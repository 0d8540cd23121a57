// The image that `extract` works on: in memory, or by bricks.
#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "tools/command/engine_handles.h"
#include "tools/command/extract_options.h"
#include "tools/command/progress_line.h"
#include "tools/volume/brick_source.h"
#include "tools/volume/volume_io.h"
#include "tools/volume/voxels.h"

namespace plc::tools {

// What the engine fetches bricks by.
struct BrickFetch {
  const BrickSource* source = nullptr;
  std::function<void()> fetched{};  // after each brick, on any thread; may be empty
};

// The engine's volume by bricks; the context, the fetch and its source must outlive it. low, high:
// the range of the voxels where it is known, else NAN. Throws Failure.
VolumeHandle volume_of(plc_context* context, const BrickFetch& fetch, double low, double high);

class ExtractVolume {
 public:
  // By bricks where --memory is given and the file can be read so. Before there are threads. Tells
  // the image's warnings; throws Failure.
  explicit ExtractVolume(const ExtractOptions& options);

  // Of the region of --box; voxels is NULL where they come by bricks.
  const plc_image& image() const { return source_ ? source_->image() : loaded_.image; }
  // The image without --box.
  const plc_image& whole() const { return whole_; }
  Voxels voxels() const { return source_ ? Voxels(*source_) : Voxels(loaded_.image); }

  // Bytes of voxels in memory.
  size_t held() const { return loaded_.bytes.size(); }

  // plc_extract. The context must outlive this. line: told how much has been read, where that comes
  // by bricks.
  plc_status extract(plc_context* context, const plc_parameters& parameters,
                     const plc_extras& extras, ProgressLine& line, plc_surface** surface);
  // Of an image by bricks that has been extracted from.
  std::optional<plc_brick_counts> brick_counts(plc_context* context) const;

 private:
  std::unique_ptr<BrickSource> source_;
  LoadedVolume loaded_;
  plc_image whole_{};
  BrickFetch fetch_;     // of the source
  VolumeHandle volume_;  // by it
};

// Of the context: what --memory leaves of it for the engine beside `held` bytes of images in
// memory, and what the machine has. Throws Failure.
int64_t memory_limit(const ExtractOptions& options, size_t held);

}  // namespace plc::tools

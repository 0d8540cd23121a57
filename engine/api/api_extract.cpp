// The C API: extraction of a surface from an image in one call.
#include <functional>

#include "engine/api/api_extras.h"
#include "engine/api/api_run.h"
#include "engine/api/parameters.h"

namespace plc {

namespace {

// Where the voxels are to come from, once the parameters are known to be right.
using TakeVolume = std::function<Status(std::shared_ptr<const VolumeData>&)>;

Status extract(plc_context& context, const TakeVolume& take, const plc_parameters* parameters,
               const plc_extras* extras, plc_surface** surface) {
  if (surface == nullptr) return bad_argument("surface: must not be NULL");
  plc_parameters p;
  plc_extras e;
  plc_image mask;
  if (Status s = take_struct(parameters, plc_parameters_defaults, "parameters", p); !s.ok()) {
    return s;
  }
  if (Status s = check_parameters(p); !s.ok()) return s;
  std::shared_ptr<const VolumeData> volume;
  if (Status s = take(volume); !s.ok()) return s;
  if (Status s = check_extras(extras, p, volume->view, volume->frame, e, mask); !s.ok()) return s;
  const auto pyramid = std::make_shared<PyramidData>();
  pyramid->host = context.host;
  if (Status s = build(volume, p, *pyramid); !s.ok()) return s;
  // The run's own: a level's image goes as the surface leaves it.
  Pyramid images = std::move(pyramid->images);
  pyramid->images = without_values(images);
  Run run(context.host);
  if (Status s = run.prepare(pyramid, std::move(images), Lasting::kCall, p, e); !s.ok()) return s;
  if (Status s = run.start(); !s.ok()) return s;
  if (Status s = run.advance(Amount::kAll); !s.ok()) return s;
  *surface = run.release().release();
  return {};
}

Status borrow(const plc_image* image, const std::shared_ptr<Host>& host,
              std::shared_ptr<const VolumeData>& volume) {
  plc_image i;
  if (Status s = take_struct(image, plc_image_defaults, "image", i); !s.ok()) return s;
  if (Status s = check_frame(i); !s.ok()) return s;
  const auto made = new_volume(host);
  made->frame = frame_of(i);
  volume = made;
  return take_voxels("image", i, false, host->schedule, made->view, made->own);
}

}  // namespace

}  // namespace plc

using plc::Status;

extern "C" {

plc_status plc_extract(plc_context* context, const plc_image* image,
                       const plc_parameters* parameters, const plc_extras* extras,
                       plc_surface** surface) {
  if (surface != nullptr) *surface = nullptr;
  return plc::guarded(context, [&] {
    const auto take = [&](auto& volume) { return plc::borrow(image, context->host, volume); };
    return plc::extract(*context, take, parameters, extras, surface);
  });
}

plc_status plc_extract_volume(plc_context* context, const plc_volume* volume,
                              const plc_parameters* parameters, const plc_extras* extras,
                              plc_surface** surface) {
  if (surface != nullptr) *surface = nullptr;
  return plc::guarded(context, [&] {
    const auto take = [&](auto& taken) -> Status {
      if (volume == nullptr) return plc::bad_argument("volume: must not be NULL");
      taken = volume->data;
      return {};
    };
    return plc::extract(*context, take, parameters, extras, surface);
  });
}

}  // extern "C"

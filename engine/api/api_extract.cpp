// The C API: extraction of a surface from an image in one call.
#include "engine/api/api_extras.h"
#include "engine/api/api_run.h"
#include "engine/api/parameters.h"

namespace plc {

namespace {

Status extract(plc_context& context, const plc_image* image, const plc_parameters* parameters,
               const plc_extras* extras, plc_surface** surface) {
  if (surface == nullptr) return bad_argument("surface: must not be NULL");
  plc_image i;
  plc_parameters p;
  plc_extras e;
  plc_image mask;
  if (Status s = take_struct(image, plc_image_defaults, "image", i); !s.ok()) return s;
  if (Status s = take_struct(parameters, plc_parameters_defaults, "parameters", p); !s.ok()) {
    return s;
  }
  if (Status s = check_parameters(p); !s.ok()) return s;
  if (Status s = check_frame(i); !s.ok()) return s;
  const auto volume = new_volume(context.host);
  volume->frame = frame_of(i);
  if (Status s = take_voxels("image", i, false, context.host->schedule, volume->view, volume->own);
      !s.ok()) {
    return s;
  }
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

}  // namespace

}  // namespace plc

extern "C" plc_status plc_extract(plc_context* context, const plc_image* image,
                                  const plc_parameters* parameters, const plc_extras* extras,
                                  plc_surface** surface) {
  if (surface != nullptr) *surface = nullptr;
  return plc::guarded(context,
                      [&] { return plc::extract(*context, image, parameters, extras, surface); });
}

// The C API: pyramids.
#include "engine/api/api_pyramid.h"

#include <algorithm>
#include <cmath>

#include "engine/api/parameters.h"
#include "engine/base/constants.h"
#include "engine/mesh/mesh_space.h"
#include "kernels/image_rows.h"
#include "pyramid/border.h"
#include "pyramid/check_volume.h"
#include "pyramid/feature.h"
#include "pyramid/size_field.h"

namespace plc {

namespace {

// On I_0, a voxel of just this value is at it; strictly inside the window, as `value` is.
double base_iso(const VolumeView& volume, const plc_parameters& p, double value) {
  const double iso = static_cast<double>(base_value(volume, pyramid_spec(p), value));
  return iso > 0 && iso < 1 ? iso : normalised(p, value);
}

// Of I_0, for the adaptive mesh.
bool is_noisy(const VolumeView& volume, const PyramidData& pyramid) {
  const plc_parameters& p = pyramid.parameters;
  const Pyramid& images = pyramid.images;
  const MeshScale scale{static_cast<Anisotropy>(p.anisotropy), 1};
  ImageView image = image_view(images, 0, kPadVoxels, mesh_space(images, 0, scale.anisotropy));
  image.form.beyond = kBeyondWindow;
  return surface_noise(image, static_cast<float>(base_iso(volume, p, p.iso)),
                       level_delta(images, 0, scale), pyramid.host->schedule) > kNoisy;
}

// From levels and window to images: those of an image that would start by itself on I_0, but is
// noisy, have the usual levels. noisy: where levels or their iso-values depend on it.
Status build_images(const VolumeView& volume, bool derives_levels, bool& noisy,
                    PyramidData& pyramid) {
  plc_parameters& p = pyramid.parameters;
  const Executor& executor = pyramid.host->schedule;
  PyramidSpec spec = pyramid_spec(p);
  spec.sparse = pyramid.volume->range.has_value() && pyramid.given.level_iso_count > 0;
  if (Status s = build_pyramid(volume, spec, executor, pyramid.images); !s.ok()) return s;
  const bool derives_isos = !std::isnan(p.iso) && p.level_iso_count == 0;
  const bool asks = is_adaptive(p) && derives_isos && (derives_levels || p.levels > 0);
  noisy = asks && is_noisy(volume, pyramid);
  if (!noisy || p.levels > 0) return {};
  spec.levels = p.levels = usual_levels(volume, p);
  return build_pyramid(volume, spec, executor, pyramid.images);
}

// Derived values go into the parameters, too.
void choose_isos(const VolumeView& volume, double background, bool noisy, PyramidData& pyramid) {
  plc_parameters& p = pyramid.parameters;
  std::vector<double>& isos = pyramid.isos;
  const Host& host = *pyramid.host;
  if (std::isnan(p.iso)) {
    std::fill_n(p.level_iso, pyramid.images.levels.size(), NAN);
  } else if (p.level_iso_count == 0) {
    isos = covering_isos(pyramid.images, base_iso(volume, p, p.iso), p.inside_below == 0,
                         level_iso_bound(p, background), host.schedule);
    if (noisy && p.levels > 0) isos[1] = isos[0];
    for (int h = p.levels; h > 0; --h) {
      p.level_iso[p.levels - h] = denormalised(p, isos[static_cast<size_t>(h)]);
    }
    p.level_iso[p.levels] = p.iso;
  } else {
    isos.push_back(base_iso(volume, p, p.level_iso[p.levels]));
    for (int h = 1; h <= p.levels; ++h) isos.push_back(normalised(p, p.level_iso[p.levels - h]));
  }
  p.level_iso_count = std::isnan(p.iso) ? 0 : p.levels + 1;
}

void close_borders(PyramidData& pyramid) {
  const plc_parameters& p = pyramid.parameters;
  if (std::isnan(p.iso) || p.force == PLC_FORCE_GRADIENT) return;
  const double outside = std::clamp(normalised(p, p.pad_value), 0.0, 1.0);
  for (size_t h = 1; h < pyramid.isos.size(); ++h) {
    close_border(pyramid.images.levels[h], pyramid.isos[h], outside);
  }
}

}  // namespace

Status check_range(const VoxelRange& range) {
  if (range.not_finite == 0) return {};
  return {ErrorCode::kInvalidData,
          "image: " + std::to_string(range.not_finite) + " voxels are NaN or infinite"};
}

Status build(const std::shared_ptr<const VolumeData>& source, const plc_parameters& parameters,
             PyramidData& pyramid) {
  const double start = now();
  const Host& host = *pyramid.host;
  pyramid.volume = source;
  pyramid.given = pyramid.parameters = parameters;
  plc_parameters& p = pyramid.parameters;
  VolumeView volume = source->view;
  // Before all its voxels are looked at.
  if (Status s = check_padded(volume, kPadVoxels); !s.ok()) return s;
  if (p.feature == PLC_FEATURE_GRADIENT_NORM) {
    if (volume.bricks != nullptr) {
      return bad_argument("feature: the gradient's norm is not made of a volume of bricks");
    }
    if (Status s = gradient_norm(volume, p.feature_sigma, host.schedule, pyramid.feature);
        !s.ok()) {
      return s;
    }
    volume.type = VoxelType::kF32;
    volume.voxels = pyramid.feature.data();
  }
  pyramid.range = source->range ? *source->range : voxel_range(volume, host.schedule);
  if (Status s = check_range(pyramid.range); !s.ok()) return s;
  DerivedWindow window;
  if (Status s =
          derive_parameters(volume, pyramid.range, host.schedule, host.memory.limit(), p, window);
      !s.ok()) {
    return s;
  }
  const double images_start = now();
  bool noisy = false;
  if (Status s = build_images(volume, parameters.levels < 0, noisy, pyramid); !s.ok()) return s;
  pyramid.seconds_images = now() - images_start;
  choose_isos(volume, window.background, noisy, pyramid);
  close_borders(pyramid);
  // Of which an adaptive mesh may start (PLC_INIT_AUTO); not counted where nothing is derived of
  // it.
  const std::string surface = window.at_surface == 0 ? ""
                                                     : ", " + std::to_string(window.at_surface) +
                                                           " voxels of the object at its surface";
  host.log(PLC_LOG_INFO, "window " + number_text(p.window_low) + " .. " +
                             number_text(p.window_high) + ", surrounded by " +
                             number_text(p.pad_value) + ", " + std::to_string(p.levels) +
                             " levels above the image" + surface);
  pyramid.seconds = now() - start;
  return {};
}

Pyramid borrowed(const Pyramid& pyramid) {
  Pyramid out = without_values(pyramid);
  for (size_t h = 0; h < out.levels.size(); ++h) {
    const PyramidLevel& level = pyramid.levels[h];
    out.levels[h].borrowed = level.values.empty() ? level.borrowed : level.values.data();
    out.levels[h].bricks = level.bricks;
    out.levels[h].form = level.form;
  }
  return out;
}

std::array<double, 3> level_origin(const PyramidData& pyramid, int h) {
  const PyramidLevel& base = pyramid.images.levels[0];
  const PyramidLevel& level = pyramid.images.levels[static_cast<size_t>(h)];
  const Frame& frame = pyramid.volume->frame;
  std::array<double, 3> at{};
  for (size_t a = 0; a < 3; ++a) {
    // From the centre of the first voxel of the image to the corner of the padded one, and back in.
    at[a] = 0.5 * level.voxel[a] - (0.5 + kPadVoxels) * base.voxel[a];
  }
  std::array<double, 3> origin = frame.origin;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t a = 0; a < 3; ++a) origin[i] += frame.direction[3 * i + a] * at[a];
  }
  return origin;
}

}  // namespace plc

using plc::Status;

namespace {

Status check_level(const plc_pyramid* pyramid, int h) {
  if (pyramid == nullptr) return plc::bad_argument("pyramid: must not be NULL");
  const int levels = plc_pyramid_levels(pyramid);
  if (h >= 0 && h <= levels) return {};
  return plc::bad_argument("level " + std::to_string(h) + ": the pyramid has 0 .. " +
                           std::to_string(levels));
}

}  // namespace

extern "C" {

plc_status plc_pyramid_create(plc_context* context, const plc_volume* volume,
                              const plc_parameters* parameters, plc_pyramid** pyramid) {
  if (pyramid != nullptr) *pyramid = nullptr;
  return plc::guarded(context, [&]() -> Status {
    if (volume == nullptr || pyramid == nullptr) {
      return plc::bad_argument("volume, pyramid: must not be NULL");
    }
    plc_parameters used;
    if (Status s = plc::take_struct(parameters, plc_parameters_defaults, "parameters", used);
        !s.ok()) {
      return s;
    }
    if (Status s = plc::check_parameters(used); !s.ok()) return s;
    const auto data = std::make_shared<plc::PyramidData>();
    data->host = context->host;
    if (Status s = plc::build(volume->data, used, *data); !s.ok()) return s;
    *pyramid = new plc_pyramid{data};
    return {};
  });
}

void plc_pyramid_destroy(plc_pyramid* pyramid) {
  delete pyramid;
}

plc_status plc_pyramid_parameters(plc_context* context, const plc_pyramid* pyramid,
                                  plc_parameters* parameters) {
  return plc::guarded(context, [&]() -> Status {
    if (pyramid == nullptr) return plc::bad_argument("pyramid: must not be NULL");
    if (Status s = plc::check_output(parameters, "parameters"); !s.ok()) return s;
    plc::give_struct(pyramid->data->parameters, parameters);
    return {};
  });
}

int plc_pyramid_levels(const plc_pyramid* pyramid) {
  return pyramid == nullptr ? -1 : static_cast<int>(pyramid->data->images.levels.size()) - 1;
}

plc_status plc_pyramid_level_info(plc_context* context, const plc_pyramid* pyramid, int h,
                                  plc_pyramid_level* level) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = check_level(pyramid, h); !s.ok()) return s;
    if (Status s = plc::check_output(level, "level"); !s.ok()) return s;
    const plc::PyramidLevel& image = pyramid->data->images.levels[static_cast<size_t>(h)];
    plc_pyramid_level out{};
    std::copy(image.dims.begin(), image.dims.end(), out.dims);
    std::copy(image.voxel.begin(), image.voxel.end(), out.spacing);
    const auto origin = plc::level_origin(*pyramid->data, h);
    std::copy(origin.begin(), origin.end(), out.origin);
    out.unit = image.unit;
    out.iso = pyramid->data->parameters.level_iso[plc_pyramid_levels(pyramid) - h];
    plc::give_struct(out, level);
    return {};
  });
}

plc_status plc_pyramid_values(plc_context* context, const plc_pyramid* pyramid, int h,
                              float* values, int64_t capacity) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = check_level(pyramid, h); !s.ok()) return s;
    const plc::PyramidLevel& level = pyramid->data->images.levels[static_cast<size_t>(h)];
    const int64_t plane = level.dims[0] * level.dims[1];
    if (Status s = plc::check_room("values", values, capacity, plane * level.dims[2]); !s.ok()) {
      return s;
    }
    const plc::Host& host = *context->host;
    host.schedule.run(static_cast<size_t>(level.dims[2]), [&](size_t z) {
      const auto plane_z = static_cast<int64_t>(z);
      plc::kernels::image_rows(host.schedule.simd(), plc::level_image(level), plane_z, 0,
                               level.dims[1], values + plane_z * plane);
    });
    return {};
  });
}

}  // extern "C"

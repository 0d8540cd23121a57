// The C API: extraction of a surface from an image.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/api_extras.h"
#include "engine/api_force.h"
#include "engine/handles.h"
#include "engine/parameters.h"
#include "pyramid/feature.h"
#include "pyramid/mask.h"

namespace plc {

namespace {

Status check_image(const plc_image& image) {
  if (image.voxels == nullptr) return {ErrorCode::kInvalidArgument, "image: no voxels"};
  if (image.type < PLC_U8 || image.type > PLC_F32) {
    return {ErrorCode::kInvalidArgument, "image: type is not a plc_voxel_type"};
  }
  for (int i = 0; i < 3; ++i) {
    if (image.dims[i] < 2) {
      return {ErrorCode::kInvalidData, "image of " + std::to_string(image.dims[0]) + " x " +
                                           std::to_string(image.dims[1]) + " x " +
                                           std::to_string(image.dims[2]) +
                                           " voxels: at least 2 are needed on every axis"};
    }
    if (!(image.spacing[i] > 0) || !std::isfinite(image.spacing[i])) {
      return {ErrorCode::kInvalidData,
              "image: spacing " + std::to_string(image.spacing[i]) + " is not a positive length"};
    }
    if (!std::isfinite(image.origin[i])) {
      return {ErrorCode::kInvalidData, "image: the origin is not finite"};
    }
  }
  const double* d = image.direction;
  const double det = d[0] * (d[4] * d[8] - d[5] * d[7]) - d[1] * (d[3] * d[8] - d[5] * d[6]) +
                     d[2] * (d[3] * d[7] - d[4] * d[6]);
  if (!(std::abs(det) > 1e-6) || !std::isfinite(det)) {
    return {ErrorCode::kInvalidData, "image: the direction cosines are singular or not finite"};
  }
  return {};
}

VolumeView view_of(const plc_image& image) {
  VolumeView volume;
  volume.type = static_cast<VoxelType>(image.type);
  volume.voxels = image.voxels;
  for (size_t i = 0; i < 3; ++i) {
    volume.dims[i] = image.dims[i];
    volume.spacing[i] = image.spacing[i];
  }
  return volume;
}

class Extraction {
 public:
  Extraction(plc_context& context, const plc_image& image, const plc_parameters& parameters,
             const plc_extras& extras)
      : context_(context), extras_(extras), surface_(std::make_unique<plc_surface>()) {
    surface_->parameters = parameters;
    volume_ = view_of(image);
    Frame& frame = surface_->frame;
    frame.spacing = volume_.spacing;
    std::copy(image.origin, image.origin + 3, frame.origin.begin());
    std::copy(image.direction, image.direction + 9, frame.direction.begin());
  }

  Status run() {
    if (Status s = build(); !s.ok()) return s;
    const double start = now();
    RecoveryHooks hooks;
    if (extras_.progress != nullptr) {
      hooks.progress = [&](const RecoveryProgress& p) {
        const plc_progress out{sizeof(plc_progress), p.level,  p.levels, p.iteration,
                               p.vertices,           p.energy, p.speed,  p.fraction,
                               now() - start};
        return extras_.progress(&out, extras_.progress_user) == 0;
      };
    }
    if (extras_.level != nullptr) {
      hooks.level = [&](const LevelRecord&) { return ask_user(); };
    }
    Status s = pyramidal_recover_shape(std::move(images_), spec_, context_.schedule, context_.simd,
                                       hooks, surface_->mesh, surface_->records);
    surface_->seconds_evolution = now() - start;
    if (s.ok()) surface_->space = space_of_last_level();
    return s;
  }

  plc_surface* release() { return surface_.release(); }

 private:
  MeshSpace space_of_last_level() const {
    return mesh_space(pyramid_, surface_->records.back().level, spec_.anisotropy);
  }

  LevelVerdict ask_user() {
    surface_->space = space_of_last_level();
    plc_level_report report{};
    report.struct_size = sizeof report;
    plc_surface_level(surface_.get(), plc_surface_level_count(surface_.get()) - 1, &report);
    switch (extras_.level(&report, surface_.get(), extras_.level_user)) {
      case PLC_VERDICT_MORE:
        return LevelVerdict::kMore;
      case PLC_VERDICT_STOP:
        return LevelVerdict::kStop;
      default:
        return LevelVerdict::kAccept;
    }
  }

  // Everything up to the evolution. The caller's voxels are borrowed throughout.
  Status build() {
    const double start = now();
    plc_parameters& p = surface_->parameters;
    if (p.feature == PLC_FEATURE_GRADIENT_NORM) {
      if (Status s =
              gradient_norm(volume_, p.feature_sigma, context_.schedule, context_.simd, feature_);
          !s.ok()) {
        return s;
      }
      volume_.type = VoxelType::kF32;
      volume_.voxels = feature_.data();
    }
    surface_->range = voxel_range(volume_, context_.schedule, context_.simd);
    if (surface_->range.not_finite > 0) {
      return {ErrorCode::kInvalidData, "image: " + std::to_string(surface_->range.not_finite) +
                                           " voxels are NaN or infinite"};
    }
    double background = 0;
    if (Status s = derive_parameters(volume_, surface_->range, context_.schedule, p, background);
        !s.ok()) {
      return s;
    }
    const double images_start = now();
    if (Status s =
            build_pyramid(volume_, pyramid_spec(p), context_.schedule, context_.simd, images_);
        !s.ok()) {
      return s;
    }
    surface_->seconds_images = now() - images_start;
    pyramid_ = without_values(images_);
    spec_ = recovery_spec(p);
    take_extras(extras_, surface_->frame, spec_);
    spec_.force = level_force(extras_, surface_->frame, context_.schedule);
    if (Status s = build_mask_pyramid(); !s.ok()) return s;
    choose_isos(background);
    surface_->seconds_pyramid = now() - start;
    return {};
  }

  // 1 where the mask is not 0.
  Status build_mask_pyramid() {
    const plc_parameters& p = surface_->parameters;
    if (p.init != PLC_INIT_MASK) return {};
    VolumeView volume = view_of(*extras_.mask);
    if (!is_any_set(volume, context_.schedule)) {
      return {ErrorCode::kInvalidData, "mask: every voxel is 0"};
    }
    // Clipped at 1, voxels without a sign are 0 or 1 as they are.
    if (volume.type != VoxelType::kU8 && volume.type != VoxelType::kU16) {
      set_voxels(volume, context_.schedule, mask_);
      volume.type = VoxelType::kU8;
      volume.voxels = mask_.data();
    }
    volume.spacing = volume_.spacing;
    PyramidSpec spec = pyramid_spec(p);
    spec.window_low = 0;
    spec.window_high = 1;
    spec.pad_value = 0;
    return build_pyramid(volume, spec, context_.schedule, context_.simd, spec_.start.mask);
  }

  // On I_0, a voxel of just this value is at it; strictly inside the window, as `value` is.
  double base_iso(double value) const {
    const PyramidSpec spec = pyramid_spec(surface_->parameters);
    const double iso = static_cast<double>(base_value(volume_, spec, value));
    return iso > 0 && iso < 1 ? iso : normalised(surface_->parameters, value);
  }

  void choose_isos(double background) {
    plc_parameters& p = surface_->parameters;
    const bool above = p.inside_below == 0;
    if (std::isnan(p.iso)) {
      spec_.isos.assign(pyramid_.levels.size(), NAN);
      std::fill_n(p.level_iso, spec_.isos.size(), NAN);
    } else if (p.level_iso_count == 0) {
      const double iso = base_iso(p.iso);
      spec_.isos = covering_isos(images_, iso, above, level_iso_bound(p, background),
                                 context_.schedule, context_.simd);
      p.level_iso[0] = p.iso;
      for (size_t h = 1; h < spec_.isos.size(); ++h) {
        p.level_iso[h] = denormalised(p, spec_.isos[h]);
      }
    } else {
      spec_.isos.push_back(base_iso(p.level_iso[0]));
      for (int h = 1; h <= p.levels; ++h) spec_.isos.push_back(normalised(p, p.level_iso[h]));
    }
    p.level_iso_count = std::isnan(p.iso) ? 0 : p.levels + 1;
    for (size_t h = pyramid_.levels.size(); h-- > 0;) {
      surface_->level_dims.push_back(pyramid_.levels[h].dims);
      surface_->level_units.push_back(pyramid_.levels[h].unit);
      surface_->level_isos.push_back(p.level_iso[h]);
    }
  }

  plc_context& context_;
  const plc_extras& extras_;
  std::unique_ptr<plc_surface> surface_;
  VolumeView volume_;
  Buffer<float> feature_;  // what volume_ then is
  Buffer<uint8_t> mask_;   // what spec_.start.mask may borrow
  Pyramid images_;         // until the evolution takes it
  Pyramid pyramid_;        // without values
  RecoverySpec spec_;
};

}  // namespace

}  // namespace plc

extern "C" plc_status plc_extract(plc_context* context, const plc_image* image,
                                  const plc_parameters* parameters, const plc_extras* extras,
                                  plc_surface** surface) {
  using plc::ErrorCode;
  using plc::Status;
  if (context == nullptr) return PLC_INVALID_ARGUMENT;
  return plc::guarded(context, [&]() -> Status {
    if (surface == nullptr || image == nullptr || parameters == nullptr) {
      return {ErrorCode::kInvalidArgument, "image, parameters, surface: must not be NULL"};
    }
    *surface = nullptr;
    plc_extras none;
    plc_extras_defaults(&none);
    const plc_extras& used = extras == nullptr ? none : *extras;
    if (image->struct_size != sizeof *image || parameters->struct_size != sizeof *parameters ||
        used.struct_size != sizeof used) {
      return {ErrorCode::kInvalidArgument, "struct_size is not that of this version"};
    }
    if (Status s = plc::check_image(*image); !s.ok()) return s;
    if (Status s = plc::check_parameters(*parameters); !s.ok()) return s;
    if (Status s = plc::check_extras(used, *parameters, *image); !s.ok()) return s;
    plc::Extraction extraction(*context, *image, *parameters, used);
    if (Status s = extraction.run(); !s.ok()) return s;
    *surface = extraction.release();
    return {};
  });
}

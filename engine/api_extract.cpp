// The C API: extraction of a surface from an image.
#include <cmath>
#include <memory>

#include "engine/constants.h"
#include "engine/handles.h"
#include "engine/parameters.h"

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

class Extraction {
 public:
  Extraction(plc_context& context, const plc_image& image, const plc_parameters& parameters)
      : context_(context), surface_(std::make_unique<plc_surface>()) {
    surface_->parameters = parameters;
    volume_.type = static_cast<VoxelType>(image.type);
    volume_.voxels = image.voxels;
    for (size_t i = 0; i < 3; ++i) {
      volume_.dims[i] = image.dims[i];
      volume_.spacing[i] = image.spacing[i];
      surface_->spacing[i] = image.spacing[i];
      surface_->origin[i] = image.origin[i];
    }
    std::copy(image.direction, image.direction + 9, surface_->direction.begin());
  }

  Status run(plc_progress_fn progress, void* user) {
    if (Status s = build(); !s.ok()) return s;
    const double start = now();
    const auto forward = [&](const RecoveryProgress& p) {
      if (progress == nullptr) return true;
      const plc_progress out{sizeof(plc_progress), p.level,  p.levels,   p.iteration,
                             p.vertices,           p.energy, p.fraction, now() - start};
      return progress(&out, user) == 0;
    };
    surface_->space = spec_.space;
    Status s = pyramidal_recover_shape(pyramid_, spec_, context_.schedule, context_.simd, forward,
                                       surface_->mesh, surface_->records);
    surface_->seconds_evolution = now() - start;
    return s;
  }

  plc_surface* release() { return surface_.release(); }

 private:
  // Everything up to the evolution.
  Status build() {
    const double start = now();
    plc_parameters& p = surface_->parameters;
    surface_->range = voxel_range(volume_, context_.schedule, context_.simd);
    if (surface_->range.not_finite > 0) {
      return {ErrorCode::kInvalidData, "image: " + std::to_string(surface_->range.not_finite) +
                                           " voxels are NaN or infinite"};
    }
    const bool above = p.inside_below == 0;
    double background = 0;
    if (Status s = derive_parameters(volume_, surface_->range, context_.schedule, p, background);
        !s.ok()) {
      return s;
    }
    if (Status s =
            build_pyramid(volume_, pyramid_spec(p), context_.schedule, context_.simd, pyramid_);
        !s.ok()) {
      return s;
    }
    spec_ = recovery_spec(p, volume_.spacing);
    choose_isos(above, background);
    surface_->seconds_pyramid = now() - start;
    return {};
  }

  void choose_isos(bool above, double background) {
    plc_parameters& p = surface_->parameters;
    if (p.level_iso_count == 0) {
      spec_.isos = covering_isos(pyramid_, normalised(p, p.iso), above,
                                 level_iso_bound(p, background), context_.schedule, context_.simd);
    } else {
      for (int h = 0; h <= p.levels; ++h) spec_.isos.push_back(normalised(p, p.level_iso[h]));
    }
    p.level_iso_count = p.levels + 1;
    for (size_t h = 0; h < spec_.isos.size(); ++h) {
      p.level_iso[h] = denormalised(p, spec_.isos[h]);
    }
    for (size_t h = pyramid_.levels.size(); h-- > 0;) {
      surface_->level_dims.push_back(pyramid_.levels[h].dims);
      surface_->level_units.push_back(pyramid_.levels[h].unit);
      surface_->level_isos.push_back(p.level_iso[h]);
    }
  }

  plc_context& context_;
  std::unique_ptr<plc_surface> surface_;
  VolumeView volume_;
  Pyramid pyramid_;
  RecoverySpec spec_;
};

}  // namespace

}  // namespace plc

extern "C" plc_status plc_extract(plc_context* context, const plc_image* image,
                                  const plc_parameters* parameters, plc_progress_fn progress,
                                  void* user, plc_surface** surface) {
  using plc::ErrorCode;
  using plc::Status;
  if (context == nullptr) return PLC_INVALID_ARGUMENT;
  return plc::guarded(context, [&]() -> Status {
    if (surface == nullptr || image == nullptr || parameters == nullptr) {
      return {ErrorCode::kInvalidArgument, "image, parameters, surface: must not be NULL"};
    }
    *surface = nullptr;
    if (image->struct_size != sizeof *image || parameters->struct_size != sizeof *parameters) {
      return {ErrorCode::kInvalidArgument, "struct_size is not that of this version"};
    }
    if (Status s = plc::check_image(*image); !s.ok()) return s;
    if (Status s = plc::check_parameters(*parameters); !s.ok()) return s;
    plc::Extraction extraction(*context, *image, *parameters);
    if (Status s = extraction.run(progress, user); !s.ok()) return s;
    *surface = extraction.release();
    return {};
  });
}

// The C API: volumes, and what every image of a host is asked.
#include <cmath>
#include <cstring>

#include "engine/api/api_pyramid.h"
#include "engine/api/handles.h"
#include "engine/base/blocks.h"
#include "pyramid/check_volume.h"

namespace plc {

namespace {

int64_t bytes_of(plc_voxel_type type) {
  switch (type) {
    case PLC_U8:
      return 1;
    case PLC_I16:
    case PLC_U16:
      return 2;
    case PLC_I32:
    case PLC_F32:
      return 4;
  }
  return 0;
}

std::string dims_text(const int64_t (&dims)[3]) {
  return std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " +
         std::to_string(dims[2]);
}

// The longest spacing and farthest origin, mm: of these, and of voxels, products are finite floats.
constexpr double kFarthest = 1e30;
constexpr double kUnitTolerance = 1e-2;  // of files that round directions

// Fewer bytes than 2^62: products of dims and distances between voxels fit.
constexpr __int128 kMaxBytes = __int128{1} << 62U;

Status check_dims(const std::string& name, const plc_image& image) {
  __int128 bytes = bytes_of(image.type);
  for (const int64_t n : image.dims) {
    if (n < 2) {
      return {ErrorCode::kInvalidData, name + " of " + dims_text(image.dims) +
                                           " voxels: at least 2 are needed on every axis"};
    }
    bytes *= n;
    if (bytes >= kMaxBytes) {
      return {ErrorCode::kInvalidData,
              name + " of " + dims_text(image.dims) + " voxels: more than any memory holds"};
    }
  }
  return {};
}

bool dense(const plc_image& image) {
  int64_t step = bytes_of(image.type);
  const bool given = image.strides[0] != 0 || image.strides[1] != 0 || image.strides[2] != 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (given && image.strides[axis] != step) return false;
    step *= image.dims[axis];
  }
  return true;
}

Status check_strides(const std::string& name, const plc_image& image) {
  const int64_t size = bytes_of(image.type);
  for (int axis = 0; axis < 3; ++axis) {
    const int64_t stride = image.strides[axis];
    if (stride % size != 0) {
      return bad_argument(name + ": stride " + std::to_string(stride) + " is no multiple of the " +
                          std::to_string(size) + " bytes of a voxel");
    }
    const __int128 reach = static_cast<__int128>(stride) * image.dims[axis];
    if (reach >= kMaxBytes || reach <= -kMaxBytes) {
      return bad_argument(name + ": stride " + std::to_string(stride) +
                          " leads beyond what an address can say");
    }
  }
  return {};
}

template <typename T>
void gather(const plc_image& image, const Executor& executor, T* to) {
  const auto* first = static_cast<const char*>(image.voxels);
  const auto nx = static_cast<size_t>(image.dims[0]);
  const auto ny = static_cast<size_t>(image.dims[1]);
  executor.run(static_cast<size_t>(image.dims[2]), [&](size_t z) {
    for (size_t y = 0; y < ny; ++y) {
      const char* row = first + static_cast<int64_t>(z) * image.strides[2] +
                        static_cast<int64_t>(y) * image.strides[1];
      T* out = to + (z * ny + y) * nx;
      for (size_t x = 0; x < nx; ++x) {
        std::memcpy(out + x, row + static_cast<int64_t>(x) * image.strides[0], sizeof(T));
      }
    }
  });
}

void copy_voxels(const plc_image& image, const Executor& executor, uint8_t* to) {
  if (dense(image)) {
    const auto bytes =
        static_cast<size_t>(bytes_of(image.type) * image.dims[0] * image.dims[1] * image.dims[2]);
    constexpr size_t kBlock = size_t{1} << 20U;
    run_blocks(executor, bytes, kBlock, [&](size_t, size_t begin, size_t end) {
      std::memcpy(to + begin, static_cast<const uint8_t*>(image.voxels) + begin, end - begin);
    });
    return;
  }
  switch (bytes_of(image.type)) {
    case 1:
      return gather(image, executor, to);
    case 2:
      return gather(image, executor, reinterpret_cast<uint16_t*>(to));
    default:
      return gather(image, executor, reinterpret_cast<uint32_t*>(to));
  }
}

}  // namespace

Status check_frame(const plc_image& image) {
  for (int i = 0; i < 3; ++i) {
    if (!(image.spacing[i] >= 1 / kFarthest && image.spacing[i] <= kFarthest)) {
      return {ErrorCode::kInvalidData, "image: spacing " + number_text(image.spacing[i]) +
                                           ", expected a length from 1e-30 to 1e+30 mm"};
    }
    if (!(std::abs(image.origin[i]) <= kFarthest)) {
      return {ErrorCode::kInvalidData,
              "image: origin " + number_text(image.origin[i]) + ", expected -1e+30 to 1e+30 mm"};
    }
  }
  const double* d = image.direction;
  const double det = d[0] * (d[4] * d[8] - d[5] * d[7]) - d[1] * (d[3] * d[8] - d[5] * d[6]) +
                     d[2] * (d[3] * d[7] - d[4] * d[6]);
  if (!(std::abs(det) > 1e-6) || !std::isfinite(det)) {
    return {ErrorCode::kInvalidData, "image: the direction cosines are singular or not finite"};
  }
  for (int i = 0; i < 3; ++i) {
    const double norm = std::sqrt(d[i] * d[i] + d[3 + i] * d[3 + i] + d[6 + i] * d[6 + i]);
    if (!(std::abs(norm - 1) <= kUnitTolerance)) {
      return {ErrorCode::kInvalidData,
              "image: direction cosines of length " + number_text(norm) + ", expected 1"};
    }
  }
  return {};
}

Frame frame_of(const plc_image& image) {
  Frame frame;
  std::copy(image.spacing, image.spacing + 3, frame.spacing.begin());
  std::copy(image.origin, image.origin + 3, frame.origin.begin());
  std::copy(image.direction, image.direction + 9, frame.direction.begin());
  return frame;
}

Status take_voxels(const char* name, const plc_image& image, bool copy, const Executor& executor,
                   VolumeView& view, Buffer<uint8_t>& own) {
  if (image.voxels == nullptr) return bad_argument(std::string(name) + ": no voxels");
  if (image.type < PLC_U8 || image.type > PLC_F32) {
    return bad_argument(std::string(name) + ": type is not a plc_voxel_type");
  }
  if (Status s = check_dims(name, image); !s.ok()) return s;
  if (Status s = check_strides(name, image); !s.ok()) return s;
  const int64_t size = bytes_of(image.type);
  if (reinterpret_cast<uintptr_t>(image.voxels) % static_cast<uintptr_t>(size) != 0) {
    return bad_argument(std::string(name) + ": voxels are not aligned to the " +
                        std::to_string(size) + " bytes of their type");
  }
  view.type = static_cast<VoxelType>(image.type);
  view.voxels = image.voxels;
  std::copy(image.dims, image.dims + 3, view.dims.begin());
  std::copy(image.spacing, image.spacing + 3, view.spacing.begin());
  if (!copy && dense(image)) return {};
  own.resize_uninitialized(
      static_cast<size_t>(size * image.dims[0] * image.dims[1] * image.dims[2]));
  copy_voxels(image, executor, own.data());
  view.voxels = own.data();
  return {};
}

std::shared_ptr<VolumeData> new_volume(const std::shared_ptr<Host>& host) {
  auto data = std::make_shared<VolumeData>();
  data->host = host;
  return data;
}

}  // namespace plc

using plc::Status;

extern "C" {

plc_status plc_volume_create(plc_context* context, const plc_image* image, plc_ownership ownership,
                             plc_volume** volume) {
  if (volume != nullptr) *volume = nullptr;
  return plc::guarded(context, [&]() -> Status {
    if (volume == nullptr) return plc::bad_argument("volume: must not be NULL");
    if (ownership != PLC_COPY && ownership != PLC_BORROW) {
      return plc::bad_argument("ownership: not a plc_ownership");
    }
    plc_image used;
    if (Status s = plc::take_struct(image, plc_image_defaults, "image", used); !s.ok()) return s;
    if (Status s = plc::check_frame(used); !s.ok()) return s;
    const auto data = plc::new_volume(context->host);
    data->frame = plc::frame_of(used);
    if (Status s = plc::take_voxels("image", used, ownership == PLC_COPY, context->host->schedule,
                                    data->view, data->own);
        !s.ok()) {
      return s;
    }
    *volume = new plc_volume{data};
    return {};
  });
}

void plc_volume_destroy(plc_volume* volume) {
  delete volume;
}

plc_status plc_volume_range(plc_context* context, const plc_volume* volume, double* low,
                            double* high) {
  return plc::guarded(context, [&]() -> Status {
    if (volume == nullptr || low == nullptr || high == nullptr) {
      return plc::bad_argument("volume, low, high: must not be NULL");
    }
    const plc::VolumeData& data = *volume->data;
    const plc::VoxelRange range =
        data.range ? *data.range : plc::voxel_range(data.view, context->host->schedule);
    if (Status s = plc::check_range(range); !s.ok()) return s;
    *low = range.low;
    *high = range.high;
    return {};
  });
}

plc_status plc_volume_image(plc_context* context, const plc_volume* volume, plc_image* image) {
  return plc::guarded(context, [&]() -> Status {
    if (volume == nullptr) return plc::bad_argument("volume: must not be NULL");
    if (Status s = plc::check_output(image, "image"); !s.ok()) return s;
    const plc::VolumeData& data = *volume->data;
    plc_image out;
    plc_image_defaults(&out);
    out.type = static_cast<plc_voxel_type>(data.view.type);
    out.voxels = data.view.voxels;
    std::copy(data.view.dims.begin(), data.view.dims.end(), out.dims);
    std::copy(data.frame.spacing.begin(), data.frame.spacing.end(), out.spacing);
    std::copy(data.frame.origin.begin(), data.frame.origin.end(), out.origin);
    std::copy(data.frame.direction.begin(), data.frame.direction.end(), out.direction);
    plc::give_struct(out, image);
    return {};
  });
}

}  // extern "C"

// The C API for the tests: contexts, images and surfaces that clean up after themselves.
#pragma once
#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/sample_handles.h"
#include "tests/samples/sample_volumes.h"

namespace samples {

inline Context make_context(int threads = 1, plc_simd simd = PLC_SIMD_AUTO) {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = threads;
  options.simd = simd;
  plc_context* context = nullptr;
  REQUIRE(plc_context_create(&options, &context, nullptr, 0) == PLC_OK);
  return Context(context);
}

inline plc_image image_of(const Volume& volume) {
  plc_image image;
  plc_image_defaults(&image);
  image.type = PLC_F32;
  image.voxels = volume.values.data();
  for (size_t a = 0; a < 3; ++a) {
    image.dims[a] = volume.dims[a];
    image.spacing[a] = volume.spacing[a];
  }
  return image;
}

inline plc_parameters parameters(double iso, int levels) {
  plc_parameters p;
  plc_parameters_defaults(&p);
  p.iso = iso;
  p.levels = levels;
  p.curvature = 0.1;
  return p;
}

inline plc_extras no_extras() {
  plc_extras extras;
  plc_extras_defaults(&extras);
  return extras;
}

inline Surface extract(plc_context* context, const plc_image& image, const plc_parameters& p,
                       const plc_extras* extras = nullptr) {
  plc_surface* surface = nullptr;
  const plc_status status = plc_extract(context, &image, &p, extras, &surface);
  INFO(plc_context_message(context));
  REQUIRE(status == PLC_OK);
  return Surface(surface);
}

inline std::vector<float> positions(const plc_surface* surface, plc_space space) {
  const int64_t n = plc_surface_vertex_count(surface);
  std::vector<float> xyz(static_cast<size_t>(n) * 3);
  REQUIRE(plc_surface_positions(make_context().get(), surface, space, xyz.data(), n) == PLC_OK);
  return xyz;
}

inline std::vector<double> positions_f64(const plc_surface* surface, plc_space space) {
  const int64_t n = plc_surface_vertex_count(surface);
  std::vector<double> xyz(static_cast<size_t>(n) * 3);
  REQUIRE(plc_surface_positions_f64(make_context().get(), surface, space, xyz.data(), n) == PLC_OK);
  return xyz;
}

inline std::vector<uint32_t> faces(const plc_surface* surface, plc_space space) {
  const int64_t n = plc_surface_face_count(surface);
  std::vector<uint32_t> abc(static_cast<size_t>(n) * 3);
  REQUIRE(plc_surface_faces(make_context().get(), surface, space, abc.data(), n) == PLC_OK);
  return abc;
}

inline std::vector<float> normals(const plc_surface* surface, plc_space space) {
  const int64_t n = plc_surface_vertex_count(surface);
  std::vector<float> xyz(static_cast<size_t>(n) * 3);
  REQUIRE(plc_surface_normals(make_context().get(), surface, space, xyz.data(), n) == PLC_OK);
  return xyz;
}

inline plc_level_report level_of(const plc_surface* surface, int index) {
  plc_level_report report{};
  report.struct_size = sizeof report;
  REQUIRE(plc_surface_level(make_context().get(), surface, index, &report) == PLC_OK);
  return report;
}

inline plc_parameters parameters_of(const plc_surface* surface) {
  plc_parameters used;
  plc_parameters_defaults(&used);
  REQUIRE(plc_surface_parameters(make_context().get(), surface, &used) == PLC_OK);
  return used;
}

// Smallest and largest voxel.
inline std::array<double, 2> range_of(const plc_surface* surface) {
  double low = 0, high = 0;
  REQUIRE(plc_surface_input_range(make_context().get(), surface, &low, &high) == PLC_OK);
  return {low, high};
}

inline plc_measures measured(plc_context* context, const plc_surface* surface, plc_space space) {
  plc_measures measures{};
  measures.struct_size = sizeof measures;
  REQUIRE(plc_surface_measure(context, surface, space, &measures) == PLC_OK);
  return measures;
}

}  // namespace samples

// The bits of every kernel, written down: a machine or a compiler that rounds differently shows
// here first, by the kernel's name.
#include <catch2/catch.hpp>

#include "pyramid/pyramid.h"
#include "tests/kernels/golden_image.h"
#include "tests/kernels/golden_surface.h"
#include "tests/samples/sample_levels.h"

namespace {

using namespace golden;
using plc::VoxelType;

// Of all that is done to an image before the evolution.
uint64_t pyramid(SimdTarget simd) {
  const std::vector<float> voxels = random_floats(size_t{41} * 37 * 29, -100, 900, 31);
  plc::PyramidSpec spec;
  spec.levels = 2;
  spec.window_high = 700;
  spec.pad_voxels = 2;
  plc::Pyramid pyramid;
  REQUIRE(plc::build_pyramid({VoxelType::kF32, voxels.data(), {41, 37, 29}, {1, 0.9, 1.7}}, spec,
                             plc::SerialExecutor(simd), pyramid)
              .ok());
  Fnv hash;
  for (const plc::PyramidLevel& level : pyramid.levels) hash.add_all(samples::values_of(level));
  return hash.value();
}

struct Golden {
  const char* name;
  uint64_t (*hash)(SimdTarget);
  uint64_t recorded;
};

// Recorded once. A kernel that is changed on purpose gets the new value that its failure shows, and
// so do the whole runs of test_determinism.cpp that go through it.
const Golden kGolden[] = {
    {"laplacian", laplacian, 0x371ddda2e8dd6609U},
    {"curvature_force", curvature_force, 0x9130f5c5afdff602U},
    {"spring_force", spring_force, 0xfb3123b313a7ee9aU},
    {"spring_force, stretched", spring_force_stretched, 0x909231925dde14afU},
    {"normals", normals, 0x6d42107961ff4939U},
    {"normals_and_laplacian", normals_and_laplacian, 0xa0cd5bc9db53e3e5U},
    {"metric_normals", metric_normals, 0x42b6f4ddef06515dU},
    {"edge_violations", edge_violations, 0xd46f47d7796a0712U},
    {"turned_faces", turned_faces, 0xeb2f7ceac1410805U},
    {"edge_length_sum", edge_length_sum, 0x443ae003bf3090ceU},
    {"edge_length_sum, stretched", edge_length_sum_stretched, 0x69ff4502764abe00U},
    {"rk4_stage 0", rk4_stage<0>, 0x31b3fe8a78eea7a1U},
    {"rk4_stage 1", rk4_stage<1>, 0x795f29e01a145bc8U},
    {"rk4_stage 2", rk4_stage<2>, 0x5e49c936bd49315eU},
    {"rk4_stage 3", rk4_stage<3>, 0xb669eba834b77483U},
    {"guided_stage 0", guided_stage<0>, 0x65b01d3557205802U},
    {"guided_stage 1", guided_stage<1>, 0x3774df395b27386aU},
    {"guided_stage 2", guided_stage<2>, 0x9268ab2e959dbf1aU},
    {"guided_stage 3", guided_stage<3>, 0xc3b2bc8930105a1cU},
    {"max_squared", max_squared, 0xb09a87e950034ed2U},
    {"move", move, 0xbb58aecf44fd97c5U},
    {"guided_move", guided_move, 0x167960bdbd0e7ee1U},
    {"face_pairs", face_pairs, 0x667f4cd2d86e1fc9U},
    {"entries_within", entries_within, 0x88ed04c79033517aU},
    {"near_or_turned", near_or_turned, 0xb8912c2ebe22fab2U},
    {"sample_trilinear, unit", sample_trilinear<plc::UnitVoxel>, 0x853530250a972cf3U},
    {"sample_trilinear, u8", sample_trilinear<uint8_t>, 0xed69396132730a2dU},
    {"sample_trilinear, i16", sample_trilinear<int16_t>, 0xccd642e421a52bf0U},
    {"sample_trilinear, u16", sample_trilinear<uint16_t>, 0xd09581c7fbf024e8U},
    {"sample_trilinear, f32", sample_trilinear<float>, 0xde3600a643e9003cU},
    {"iso_force, unit", iso_force<plc::UnitVoxel>, 0x4c5cd499b152d73dU},
    {"iso_force, u8", iso_force<uint8_t>, 0xb309c63a85b227b6U},
    {"iso_force, i16", iso_force<int16_t>, 0x42fb132a41571a4cU},
    {"iso_force, u16", iso_force<uint16_t>, 0x2f52b37c4b91936eU},
    {"iso_force, f32", iso_force<float>, 0xf2efa3868c74f985U},
    {"image_rows, unit", image_rows<plc::UnitVoxel>, 0x29aa11d6c7b3256eU},
    {"image_rows, u8", image_rows<uint8_t>, 0xad1f9321e3dd11abU},
    {"image_rows, i16", image_rows<int16_t>, 0x412cbf0a9609e7e9U},
    {"image_rows, u16", image_rows<uint16_t>, 0x3a1bb7429653b1a6U},
    {"image_rows, f32", image_rows<float>, 0x2263ab2ca52b340bU},
    {"gradient_force", gradient_force, 0xe42a48ca0f47487fU},
    {"sobel", sobel, 0xf36ac39f9e68a634U},
    {"bound_vectors", bound_vectors, 0xcd17d7e24b8f3a5eU},
    {"vector_norms", vector_norms, 0x862547d87ddc0874U},
    {"reduce_x", reduce_x, 0x7abb6f8ec29b52b0U},
    {"reduce_y", reduce_y, 0x17517f7f6b7661b6U},
    {"reduce_z", reduce_z, 0x43f87cacc5b44ac0U},
    {"weighted_rows", weighted_rows, 0xc334a750bbdf44d5U},
    {"blend_rows", blend_rows, 0xff3240f3b752e2ffU},
    {"normalize_voxels, u8", normalize_voxels<VoxelType::kU8, uint8_t>, 0xa7cf7bd15090698dU},
    {"normalize_voxels, i16", normalize_voxels<VoxelType::kI16, int16_t>, 0x4f2088084040c106U},
    {"normalize_voxels, u16", normalize_voxels<VoxelType::kU16, uint16_t>, 0xa1216ba414d6636eU},
    {"normalize_voxels, i32", normalize_voxels<VoxelType::kI32, int32_t>, 0x3f6e671268dedeccU},
    {"normalize_voxels, f32", normalize_voxels<VoxelType::kF32, float>, 0xe9657758fbda743fU},
    {"voxel_extent, u8", voxel_extent<VoxelType::kU8, uint8_t>, 0x20a5d8d0597ab522U},
    {"voxel_extent, i16", voxel_extent<VoxelType::kI16, int16_t>, 0x5de2edb490208987U},
    {"voxel_extent, u16", voxel_extent<VoxelType::kU16, uint16_t>, 0xa2c1b00ca2bb42b3U},
    {"voxel_extent, i32", voxel_extent<VoxelType::kI32, int32_t>, 0x18acbb3a515333b1U},
    {"voxel_extent, f32", voxel_extent<VoxelType::kF32, float>, 0x61b1eff622dce602U},
    {"pyramid", pyramid, 0x8ed4e9b4a18b3810U},
};

}  // namespace

TEST_CASE("every kernel has the recorded bits on every SIMD target", "[kernels]") {
  for (const Golden& golden : kGolden) {
    for (const SimdTarget simd : plc::available_simd_targets()) {
      CAPTURE(golden.name, plc::simd_target_name(simd));
      CHECK(golden.hash(simd) == golden.recorded);
    }
  }
}

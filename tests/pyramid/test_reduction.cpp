#include "pyramid/reduction.h"

#include <catch2/catch.hpp>

#include "kernels/scalar.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/limited_memory.h"
#include "tests/samples/typed_images.h"

namespace {

using namespace fixtures;
using plc::SimdTarget;
namespace scalar = plc::kernels::scalar;
using Dims = std::array<int64_t, 3>;

size_t volume(const Dims& dims) {
  return static_cast<size_t>(dims[0] * dims[1] * dims[2]);
}

plc::ImageView view_of(const std::vector<float>& values, const Dims& dims) {
  plc::ImageView view;
  view.data = values.data();
  for (size_t a = 0; a < 3; ++a) view.dims[a] = static_cast<int32_t>(dims[a]);
  return view;
}

// Appendix A as it stands: whole images G and H between the passes.
std::vector<float> appendix_a(const std::vector<float>& in, const Dims& from,
                              const std::array<plc::AxisTaps, 3>& taps, const Dims& to) {
  const auto m = static_cast<size_t>(from[0]), n = static_cast<size_t>(from[1]);
  const auto p = static_cast<size_t>(from[2]);
  const auto m_to = static_cast<size_t>(to[0]), n_to = static_cast<size_t>(to[1]);
  std::vector<float> g(m_to * n * p), h(m_to * n_to * p), out(volume(to));
  scalar::reduce_x(taps[0].view(), {in.data(), m, m}, n * p, {g.data(), m_to, m_to}, nullptr);
  for (size_t z = 0; z < p; ++z) {
    scalar::reduce_y(
        taps[1].view(), 0, n_to,
        {g.data() + (z * n + static_cast<size_t>(taps[1].first[0])) * m_to, m_to, m_to},
        {h.data() + z * n_to * m_to, m_to, m_to});
  }
  for (size_t k = 0; k < static_cast<size_t>(to[2]); ++k) {
    std::vector<const float*> planes;
    for (int32_t t = 0; t < taps[2].taps; ++t) {
      planes.push_back(h.data() + static_cast<size_t>(taps[2].first[k] + t) * n_to * m_to);
    }
    scalar::reduce_z(taps[2].weights.data() + k * static_cast<size_t>(taps[2].taps), taps[2].taps,
                     planes.data(), n_to * m_to, out.data() + k * n_to * m_to);
  }
  return out;
}

void require_tiles_do_not_show(const Dims& from, const Dims& to,
                               const std::array<double, 3>& spread) {
  const std::vector<float> in = random_floats(volume(from), 0.0F, 1.0F, 1);
  std::array<plc::AxisTaps, 3> taps;
  for (size_t a = 0; a < 3; ++a) taps[a] = plc::make_axis_taps(from[a], to[a], spread[a]);
  const std::vector<float> expected = appendix_a(in, from, taps, to);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const plc::SerialExecutor serial(simd);
    const ThreadExecutor threads(3, simd);
    for (const plc::Executor* executor : {static_cast<const plc::Executor*>(&serial),
                                          static_cast<const plc::Executor*>(&threads)}) {
      CAPTURE(plc::simd_target_name(simd), executor == &serial);
      std::vector<float> got(volume(to), kUntouched);
      REQUIRE(plc::reduce_image(view_of(in, from), taps, to, *executor, got.data()));
      REQUIRE(first_difference(got, expected) == -1);
    }
  }
}

}  // namespace

TEST_CASE("tiles along Z give the bits of whole passes", "[pyramid]") {
  require_tiles_do_not_show({19, 23, 97}, {10, 13, 56}, {1.0, 0.8, 0.99});
  require_tiles_do_not_show({9, 9, 64}, {7, 7, 51}, {1.0, 1.0, 1.0});
}

TEST_CASE("tiles along Y give the bits of whole passes", "[pyramid]") {
  require_tiles_do_not_show({611, 211, 21}, {488, 168, 16}, {1.0, 1.0, 0.7});
}

TEST_CASE("a coarse axis whose taps skip planes keeps its window right", "[pyramid]") {
  require_tiles_do_not_show({11, 12, 80}, {6, 6, 40}, {1.0, 1.0, 0.05});
  require_tiles_do_not_show({8, 8, 8}, {4, 4, 4}, {0.05, 0.05, 0.05});
}

TEST_CASE("two voxels reduce to one", "[pyramid]") {
  require_tiles_do_not_show({2, 2, 2}, {1, 1, 1}, {1.0, 1.0, 1.0});
}

TEMPLATE_TEST_CASE("a typed image is reduced as the same image in floats, bit for bit", "[pyramid]",
                   uint8_t, int16_t, uint16_t, float) {
  for (const int32_t pad : {0, 6}) {
    const TypedImage<TestType> image(71, 45, 38, pad, 5);
    const Dims from{image.view.dims[0], image.view.dims[1], image.view.dims[2]};
    const Dims to{from[0] / 2, from[1] * 10 / 17, from[2] * 10 / 17};
    std::array<plc::AxisTaps, 3> taps;
    for (size_t a = 0; a < 3; ++a) taps[a] = plc::make_axis_taps(from[a], to[a], 0.9);
    const std::vector<float> values = image.values();
    std::vector<float> expected(volume(to));
    REQUIRE(plc::reduce_image(image.unit_view(values), taps, to,
                              ThreadExecutor(2, SimdTarget::kScalar), expected.data()));
    for (const SimdTarget simd : plc::available_simd_targets()) {
      CAPTURE(plc::simd_target_name(simd), pad);
      std::vector<float> got(volume(to), kUntouched);
      REQUIRE(plc::reduce_image(image.view, taps, to, ThreadExecutor(2, simd), got.data()));
      REQUIRE(first_difference(got, expected) == -1);
    }
  }
}

TEST_CASE("a white image stays within one", "[pyramid]") {
  const Dims from{40, 40, 40}, to{23, 23, 23};
  std::array<plc::AxisTaps, 3> taps;
  for (plc::AxisTaps& axis : taps) axis = plc::make_axis_taps(40, 23, 1.0);
  const std::vector<float> in(volume(from), 1.0F);
  std::vector<float> out(volume(to));
  const plc::SerialExecutor serial;
  REQUIRE(plc::reduce_image(view_of(in, from), taps, to, serial, out.data()));
  for (const float value : out) {
    REQUIRE(value <= 1.0F);
    REQUIRE(value > 0.999999F);
  }
}

#if FIXTURES_CAN_LIMIT_MEMORY
TEST_CASE("a tile without memory for its rows is reported", "[pyramid]") {
  const Dims from{int64_t{1} << 22, 2, 2}, to{int64_t{1} << 21, 1, 1};
  std::array<plc::AxisTaps, 3> taps;
  for (size_t a = 0; a < 3; ++a) taps[a] = plc::make_axis_taps(from[a], to[a], 1.0);
  const std::vector<float> in(volume(from));
  std::vector<float> out(volume(to));
  const plc::SerialExecutor serial;
  const MemoryLimit limit(size_t{64} << 20);  // transposed rows take 256 MB
  REQUIRE_FALSE(plc::reduce_image(view_of(in, from), taps, to, serial, out.data()));
}
#endif

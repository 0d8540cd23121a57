#include "engine/measure/mesh_input.h"

#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/mesh_arrays.h"
#include "engine/measure/mesh_topology.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_shapes.h"

namespace {

using Catch::Matchers::Contains;
using plc::ErrorCode;

plc::Status checked(const std::vector<double>& xyz, const plc::Vector<uint32_t>& abc) {
  return plc::check_mesh_input(plc::arrays_of(xyz, abc), samples::ReverseExecutor());
}

}  // namespace

TEST_CASE("any finite mesh whose indices are vertices is accepted, an empty one too",
          "[mesh_input]") {
  CHECK(checked({}, {}).ok());
  CHECK(checked({0, -0.0, 1e70, -1e-70, 5, 6}, {0, 1, 0}).ok());
}

TEST_CASE("the first value out of range is named, whatever the order of tasks", "[mesh_input]") {
  std::vector<double> xyz(3 * 20000, 1.0);
  xyz[58000] = 1e71;
  xyz[30001] = std::numeric_limits<double>::infinity();
  xyz[30004] = std::numeric_limits<double>::quiet_NaN();
  CHECK(checked(xyz, {}).code() == ErrorCode::kInvalidData);
  CHECK_THAT(checked(xyz, {}).message(), Contains("vertex 10000: y is inf, expected a finite"));
  xyz[30001] = 1e-71;
  CHECK_THAT(checked(xyz, {}).message(), Contains("vertex 10000: y") && Contains("magnitude"));
}

TEST_CASE("the first corner that is no vertex is named", "[mesh_input]") {
  const plc::Status status = checked({0, 0, 0, 1, 1, 1}, {0, 1, 1, 0, 0, 2, 9, 9, 9});
  CHECK(status.code() == ErrorCode::kInvalidData);
  CHECK_THAT(status.message(), Contains("face 1: corner 2 is vertex 2, expected an index below 2"));
}

TEST_CASE("counts that cannot be and arrays that are missing are refused", "[mesh_input]") {
  const double xyz[3] = {0, 0, 0};
  const uint32_t abc[3] = {0, 0, 0};
  const plc::SerialExecutor serial;
  const auto code = [&](const double* x, int64_t vertices, const uint32_t* a, int64_t faces) {
    return plc::check_mesh_input({x, static_cast<size_t>(vertices), a, static_cast<size_t>(faces)},
                                 serial)
        .code();
  };
  CHECK(code(xyz, 1, abc, 1) == ErrorCode::kOk);
  CHECK(code(xyz, -1, abc, 1) == ErrorCode::kInvalidArgument);
  CHECK(code(xyz, (int64_t{1} << 32) + 1, abc, 1) == ErrorCode::kInvalidArgument);
  CHECK(code(xyz, 1, abc, -1) == ErrorCode::kInvalidArgument);
  CHECK(code(xyz, 1, abc, plc::kMaxFaces + 1) == ErrorCode::kInvalidArgument);
  CHECK(code(nullptr, 1, abc, 0) == ErrorCode::kInvalidArgument);
  CHECK(code(xyz, 1, nullptr, 1) == ErrorCode::kInvalidArgument);
}

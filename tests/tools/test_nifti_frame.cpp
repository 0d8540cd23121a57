#include "tools/volume/nifti_frame.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/samples/sample_files.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/volume/volume_io.h"

namespace {

using fixtures::failure_of;
using plc::tools::LoadedVolume;
using plc::tools::NiftiFrame;
using plc::tools::read_volume;

// Where the fields stand.
constexpr size_t kPixdim = 76, kUnits = 123, kQformCode = 252, kSformCode = 254, kQuaternion = 256,
                 kOffset = 268, kSform = 280;

// 5 x 4 x 3 voxels of 0.5, 0.75 and 2 mm with neither form.
std::string bare() {
  std::string file = samples::nifti({5, 4, 3}, 2, 8, std::string(60, 'a'));
  samples::put_at<int16_t>(file, kSformCode, 0);
  return file;
}

void put_floats(std::string& file, size_t at, const std::vector<float>& values) {
  for (const float value : values) {
    samples::put_at(file, at, value);
    at += sizeof value;
  }
}

void put_sform(std::string& file, const std::vector<float>& rows, int16_t code = 1) {
  samples::put_at(file, kSformCode, code);
  put_floats(file, kSform, rows);
}

// The rotation is by the quaternion's b, c, d.
void put_qform(std::string& file, const std::vector<float>& bcd, const std::vector<float>& offset,
               float qfac = 1, int16_t code = 1) {
  samples::put_at(file, kQformCode, code);
  samples::put_at(file, kPixdim, qfac);
  put_floats(file, kQuaternion, bcd);
  put_floats(file, kOffset, offset);
}

// All numbers of the header in the other order of bytes.
std::string big_endian(std::string file) {
  const auto turn = [&](size_t from, size_t count, size_t size) {
    for (size_t i = 0; i < count; ++i) {
      const auto begin = file.begin() + static_cast<std::ptrdiff_t>(from + i * size);
      std::reverse(begin, begin + static_cast<std::ptrdiff_t>(size));
    }
  };
  turn(0, 1, 4);
  turn(40, 8, 2);
  turn(70, 2, 2);
  turn(kPixdim, 11, 4);
  turn(kQformCode, 2, 2);
  turn(kQuaternion, 18, 4);
  return file;
}

// Where a voxel lies, RAS.
std::array<double, 3> ras(const plc_image& image, const std::array<double, 3>& voxel) {
  std::array<double, 3> p{};
  for (size_t row = 0; row < 3; ++row) {
    p[row] = image.origin[row];
    for (size_t axis = 0; axis < 3; ++axis) {
      p[row] += image.direction[3 * row + axis] * image.spacing[axis] * voxel[axis];
    }
    if (row < 2) p[row] = -p[row];
  }
  return p;
}

// rows: the affine to RAS that nibabel gives.
void check_affine(const plc_image& image, const std::vector<double>& rows, double scale = 1) {
  const std::array<double, 3> corners[] = {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2}, {4, 3, 2}};
  for (const auto& voxel : corners) {
    const auto found = ras(image, voxel);
    for (size_t row = 0; row < 3; ++row) {
      const double* const m = rows.data() + 4 * row;
      const double expected = m[0] * voxel[0] + m[1] * voxel[1] + m[2] * voxel[2] + m[3];
      CHECK(found[row] == Approx(scale * expected).epsilon(1e-6).margin(1e-5 * scale));
    }
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    const double* const d = image.direction + axis;
    CHECK(std::hypot(d[0], d[3], d[6]) == Approx(1).epsilon(1e-12));
  }
}

const std::vector<float> kStraight = {-0.5F, 0, 0, 10, 0, 0.75F, 0, 20, 0, 0, 2, 30};
const std::vector<double> kStraightRas(kStraight.begin(), kStraight.end());
// A quarter turn about z: the first axis to the front, the second one to the left.
const std::vector<float> kQuarter = {0, 0, 0.70710678F};
const std::vector<double> kTurnedRas = {0, -0.75, 0, 1, 0.5, 0, 0, 2, 0, 0, 2, 3};

class Files {
 public:
  LoadedVolume read(const std::string& file, NiftiFrame frame = NiftiFrame::kAuto) const {
    return read_volume(folder_.put("a.nii", file), frame);
  }
  LoadedVolume read_packed(const std::string& file) const {
    return read_volume(folder_.put("a.nii.gz", samples::deflated(file, true)));
  }
  std::string failure(const std::string& file, NiftiFrame frame = NiftiFrame::kAuto) const {
    return failure_of([&] { read(file, frame); });
  }

 private:
  fixtures::Folder folder_;
};

}  // namespace

TEST_CASE("an sform of any code goes before a qform", "[nifti_frame]") {
  const Files files;
  for (const int16_t code : std::vector<int16_t>{1, 2, 3, 4, 5}) {
    for (const int16_t other : std::vector<int16_t>{0, 1, 2, 4}) {
      CAPTURE(code, other);
      std::string file = bare();
      put_sform(file, kStraight, code);
      put_qform(file, kQuarter, {1, 2, 3}, 1, other);
      check_affine(files.read(file).image, kStraightRas);
      check_affine(files.read_packed(file).image, kStraightRas);
      check_affine(files.read(big_endian(file)).image, kStraightRas);
      check_affine(files.read(file, NiftiFrame::kSform).image, kStraightRas);
    }
  }
}

TEST_CASE("a qform is taken where the sform has no code, or where it is asked for",
          "[nifti_frame]") {
  const Files files;
  std::string file = bare();
  put_qform(file, kQuarter, {1, 2, 3});
  check_affine(files.read(file).image, kTurnedRas);
  check_affine(files.read(big_endian(file)).image, kTurnedRas);
  CHECK(files.read(file).warnings.empty());
  put_sform(file, kStraight);
  check_affine(files.read(file, NiftiFrame::kQform).image, kTurnedRas);
  // qfac: the third axis the other way round.
  put_qform(file, kQuarter, {1, 2, 3}, -1);
  std::vector<double> mirrored = kTurnedRas;
  mirrored[10] = -2;
  check_affine(files.read(file, NiftiFrame::kQform).image, mirrored);
  // Half a turn about an axis between x and y, a being 0, with b and c rounded up.
  put_qform(file, {0.7071069F, 0.7071069F, 0}, {1, 2, 3});
  check_affine(files.read(file, NiftiFrame::kQform).image,
               {0, 0.75, 0, 1, 0.5, 0, 0, 2, 0, 0, -2, 3});
}

TEST_CASE("with neither form the centre is the origin and the first axis runs to the left",
          "[nifti_frame]") {
  const Files files;
  const LoadedVolume volume = files.read(bare());
  check_affine(volume.image, {-0.5, 0, 0, 1, 0, 0.75, 0, -1.125, 0, 0, 2, -2});
  REQUIRE(volume.warnings.size() == 1);
  CHECK_THAT(volume.warnings[0], Catch::Contains("a.nii: says nothing of its place"));
}

TEST_CASE("a form that is asked for and has no code is refused", "[nifti_frame]") {
  const Files files;
  CHECK_THAT(files.failure(bare(), NiftiFrame::kSform), Catch::Contains("has no sform"));
  CHECK_THAT(files.failure(bare(), NiftiFrame::kQform), Catch::Contains("has no qform"));
  std::string file = bare();
  put_sform(file, kStraight);
  CHECK_THAT(files.failure(file, NiftiFrame::kQform), Catch::Contains("has no qform"));
}

TEST_CASE("forms that differ by more than half a voxel are told with both places",
          "[nifti_frame]") {
  const Files files;
  std::string file = bare();
  put_sform(file, {0.5F, 0, 0, 10, 0, 0.75F, 0, 20, 0, 0, 2, 30});
  put_qform(file, {0, 0, 0}, {10.2F, 20, 30});
  CHECK(files.read(file).warnings.empty());  // by 0.2 mm, of 0.5
  put_qform(file, {0, 0, 0}, {10.3F, 20, 30});
  const LoadedVolume moved = files.read(file);
  REQUIRE(moved.warnings.size() == 1);
  CHECK_THAT(moved.warnings[0], Catch::Contains("voxel (0, 0, 0) lies at (10, 20, 30) mm RAS by "
                                                "the sform, which is taken, and at (10.3, 20, 30) "
                                                "by the qform") &&
                                    !Catch::Contains("mirror") && !Catch::Contains("\n"));
  // Another side of the head; the first voxel is the same.
  put_sform(file, {-0.5F, 0, 0, 10, 0, 0.75F, 0, 20, 0, 0, 2, 30});
  put_qform(file, {0, 0, 0}, {10, 20, 30});
  const LoadedVolume mirrored = files.read(file);
  REQUIRE(mirrored.warnings.size() == 1);
  CHECK_THAT(mirrored.warnings[0], Catch::Contains("mirror image") &&
                                       Catch::Contains("voxel (4, 0, 0) lies at (8, 20, 30)") &&
                                       Catch::Contains("(12, 20, 30) by the qform"));
  // The user has chosen.
  CHECK(files.read(file, NiftiFrame::kSform).warnings.empty());
  CHECK(files.read(file, NiftiFrame::kQform).warnings.empty());
}

TEST_CASE("an sform that shears is kept as it is", "[nifti_frame]") {
  const Files files;
  const std::vector<float> sheared = {0.5F, 0.2F, 0.3F, 10, 0, 0.75F, -0.4F, 20, 0.05F, 0, 2, 30};
  std::string file = bare();
  put_sform(file, sheared);
  check_affine(files.read(file).image, {sheared.begin(), sheared.end()});
}

TEST_CASE("places in metres and microns become mm", "[nifti_frame]") {
  const Files files;
  for (const auto& [unit, scale] : {std::pair<char, double>{0, 1}, {1, 1000}, {2, 1}, {3, 1e-3}}) {
    CAPTURE(static_cast<int>(unit));
    std::string file = bare();
    file[kUnits] = static_cast<char>(unit + 16);  // and milliseconds
    check_affine(files.read(file).image, {-0.5, 0, 0, 1, 0, 0.75, 0, -1.125, 0, 0, 2, -2}, scale);
    put_qform(file, kQuarter, {1, 2, 3});
    check_affine(files.read(file).image, kTurnedRas, scale);
    put_sform(file, kStraight);
    check_affine(files.read(file).image, kStraightRas, scale);
  }
}

TEST_CASE("forms that are no frame are refused", "[nifti_frame]") {
  const Files files;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::vector<std::vector<float>> wrong = {
      std::vector<float>(12, 0),
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0},      // an axis of no length
      {1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0},      // two axes the same
      {1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1e-3F, 0},  // nearly in a plane
      {1, 0, 0, 0, 0, kNan, 0, 0, 0, 0, 1, 0},
      {1, 0, 0, kInfinity, 0, 1, 0, 0, 0, 0, 1, 0},
      {kInfinity, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
  };
  for (const auto& rows : wrong) {
    std::string file = bare();
    put_sform(file, rows);
    const std::string message = files.failure(file);
    CHECK_THAT(message,
               Catch::Contains("a.nii: its sform is not usable") && !Catch::Contains("\n"));
  }
  std::string file = bare();
  put_qform(file, {0, kNan, 0}, {0, 0, 0});
  CHECK_THAT(files.failure(file), Catch::Contains("its qform is not usable"));
  put_qform(file, {0, 0, 0}, {0, kNan, 0});
  CHECK_THAT(files.failure(file), Catch::Contains("its qform is not usable"));
  // What is not taken need not be usable.
  put_sform(file, kStraight);
  check_affine(files.read(file).image, kStraightRas);
  file = bare();
  put_floats(file, kPixdim + 4, {kNan});
  CHECK_THAT(files.failure(file), Catch::Contains("its voxel spacing is not usable"));
}

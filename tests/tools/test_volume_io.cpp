#include "tools/volume/volume_io.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "tests/samples/limited_memory.h"
#include "tests/samples/sample_files.h"
#include "tests/tools/tool_fixtures.h"

namespace {

using fixtures::failure_of;
using plc::tools::LoadedVolume;
using plc::tools::read_volume;
using plc::tools::write_volume;

constexpr int64_t kDims[3] = {5, 4, 3};
constexpr size_t kVoxels = 60;

// Values over the whole range of the type, a NaN and an infinity among the floats.
template <typename T>
std::vector<T> ramp(size_t count = kVoxels) {
  std::vector<T> values(count);
  for (size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(count - 1);
    const double low = static_cast<double>(std::numeric_limits<T>::lowest());
    const double high = static_cast<double>(std::numeric_limits<T>::max());
    values[i] = i + 1 == count ? std::numeric_limits<T>::max()
                               : static_cast<T>(low + t * (high / 2 - low / 2));
  }
  if constexpr (!std::numeric_limits<T>::is_integer) {
    values[6] = std::numeric_limits<T>::denorm_min();
  }
  return values;
}

template <typename T>
std::vector<T> wild_ramp() {
  std::vector<T> values = ramp<T>();
  if constexpr (!std::numeric_limits<T>::is_integer) {
    values[7] = std::numeric_limits<T>::quiet_NaN();
    values[8] = std::numeric_limits<T>::infinity();
  }
  return values;
}

template <typename T>
std::vector<T> voxels(const LoadedVolume& volume) {
  REQUIRE(volume.image.voxels == volume.bytes.data());
  std::vector<T> values(volume.bytes.size() / sizeof(T));
  std::memcpy(values.data(), volume.bytes.data(), volume.bytes.size());
  return values;
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <typename T>
plc_image image_of(plc_voxel_type type, const std::vector<T>& values) {
  plc_image image{};
  image.struct_size = sizeof image;
  image.type = type;
  image.voxels = values.data();
  std::copy(kDims, kDims + 3, image.dims);
  const double spacing[3] = {0.1, 0.75, 2.5};
  const double origin[3] = {-12.3456789012345, 1e-3, 400};
  // A turn about z by an angle of no round cosine, and y reversed.
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  const double direction[9] = {c, s, 0, s, -c, 0, 0, 0, 1};
  std::copy(spacing, spacing + 3, image.spacing);
  std::copy(origin, origin + 3, image.origin);
  std::copy(direction, direction + 9, image.direction);
  return image;
}

template <typename T>
void check_round_trip(plc_voxel_type type) {
  const fixtures::Folder folder;
  const std::vector<T> values = wild_ramp<T>();
  const plc_image image = image_of(type, values);
  for (const char* const name : {"a.nrrd", "b.mha", "c.mhd"}) {
    CAPTURE(name, type);
    write_volume(folder / name, image);
    const LoadedVolume back = read_volume(folder / name);
    CHECK(back.image.type == type);
    CHECK(std::equal(kDims, kDims + 3, back.image.dims));
    CHECK(same_bits(voxels<T>(back), values));
    for (int i = 0; i < 3; ++i) {
      CHECK(back.image.spacing[i] == Approx(image.spacing[i]).epsilon(1e-14));
      CHECK(back.image.origin[i] == image.origin[i]);
    }
    for (int i = 0; i < 9; ++i) {
      CHECK(back.image.direction[i] == Approx(image.direction[i]).margin(1e-14));
    }
  }
  CHECK(folder.file_count() == 4);  // c.raw, too, and nothing temporary
}

template <typename From, typename To>
void check_nifti(int16_t datatype, plc_voxel_type type) {
  const fixtures::Folder folder;
  const std::vector<From> values = ramp<From>();
  const std::string file = samples::nifti(
      {5, 4, 3}, datatype, static_cast<int16_t>(8 * sizeof(From)), samples::raw(values));
  folder.put("a.nii", file);
  folder.put("a.nii.gz", samples::deflated(file, true));
  std::vector<To> expected;
  expected.reserve(values.size());
  for (const From value : values) expected.push_back(static_cast<To>(value));
  for (const char* const name : {"a.nii", "a.nii.gz"}) {
    CAPTURE(name, datatype);
    const LoadedVolume volume = read_volume(folder / name);
    CHECK(volume.image.type == type);
    CHECK(same_bits(voxels<To>(volume), expected));
  }
}

std::string nrrd(const std::string& fields, const std::string& data) {
  return "NRRD0004\nendian: little\n" + fields + "\n\n" + data;
}

std::string meta(const std::string& fields, const std::string& data,
                 const std::string& file = "LOCAL") {
  return "ObjectType = Image\n" + fields + "\nElementDataFile = " + file + "\n" + data;
}

const std::string kMetaShort =
    "NDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nElementSpacing = 1 1 1\n"
    "DimSize = 5 4 3\nElementType = MET_SHORT\n";

// The slice at z: its voxels are z * 100 + i.
samples::DicomSlice slice_at(int z, const std::string& series = "1.2.3.4") {
  samples::DicomSlice slice;
  slice.series = series;
  slice.number = 100 - z;  // the other way round
  slice.position = "-5\\-7\\" + std::to_string(2 * z);
  slice.voxels.resize(12);
  std::iota(slice.voxels.begin(), slice.voxels.end(), static_cast<int16_t>(100 * z));
  return slice;
}

}  // namespace

TEST_CASE("What is written as NRRD or MetaImage is read back bit for bit", "[volume_io]") {
  check_round_trip<uint8_t>(PLC_U8);
  check_round_trip<int16_t>(PLC_I16);
  check_round_trip<uint16_t>(PLC_U16);
  check_round_trip<int32_t>(PLC_I32);
  check_round_trip<float>(PLC_F32);
}

TEST_CASE("NIfTI whose values are scaled from what is stored has the values", "[volume_io]") {
  const fixtures::Folder folder;
  std::vector<int16_t> stored = ramp<int16_t>();
  std::string file = samples::nifti({5, 4, 3}, 4, 16, samples::raw(stored));
  samples::put_at(file, 112, 0.5F);  // slope
  samples::put_at(file, 116, 3.0F);  // intercept
  folder.put("a.nii", file);
  std::vector<float> expected;
  for (const int16_t value : stored) expected.push_back(0.5F * static_cast<float>(value) + 3);
  const LoadedVolume volume = read_volume(folder / "a.nii");
  CHECK(volume.image.type == PLC_F32);
  CHECK(same_bits(voxels<float>(volume), expected));
}

#if FIXTURES_CAN_LIMIT_MEMORY
TEST_CASE("plain files are read into the volume's own memory, once", "[volume_io]") {
  const fixtures::Folder folder;
  const std::string bytes(size_t{400} * 400 * 400, 'v');
  folder.put("a.nii", samples::nifti({400, 400, 400}, 2, 8, bytes));
  folder.put("a.nrrd", nrrd("type: uint8\ndimension: 3\nsizes: 400 400 400\nencoding: raw", bytes));
  for (const char* const name : {"a.nii", "a.nrrd"}) {
    CAPTURE(name);
    const fixtures::MemoryLimit limit(size_t{100} << 20);  // the voxels are 61 MB
    CHECK(read_volume(folder / name).bytes.size() == bytes.size());
  }
}
#endif

TEST_CASE("NIfTI keeps the engine's types and converts the others", "[volume_io]") {
  check_nifti<uint8_t, uint8_t>(2, PLC_U8);
  check_nifti<int16_t, int16_t>(4, PLC_I16);
  check_nifti<uint16_t, uint16_t>(512, PLC_U16);
  check_nifti<int32_t, int32_t>(8, PLC_I32);
  check_nifti<float, float>(16, PLC_F32);
  check_nifti<int8_t, int16_t>(256, PLC_I16);
  check_nifti<uint32_t, float>(768, PLC_F32);
  check_nifti<int64_t, float>(1024, PLC_F32);
  check_nifti<uint64_t, float>(1280, PLC_F32);
}

TEST_CASE("NIfTI of version 2, and of the other order of bytes, is read like any other",
          "[volume_io]") {
  const fixtures::Folder folder;
  const std::vector<int16_t> values = ramp<int16_t>();
  std::string swapped = samples::raw(values);
  for (size_t i = 0; i < swapped.size(); i += 2) std::swap(swapped[i], swapped[i + 1]);
  for (const bool big : {false, true}) {
    for (const bool scaled : {false, true}) {
      const std::string file =
          samples::nifti2({5, 4, 3}, 4, scaled ? 0.5 : 0, scaled ? 3 : 0, big) +
          (big ? swapped : samples::raw(values));
      folder.put("a.nii", file);
      folder.put("a.nii.gz", samples::deflated(file, true));
      for (const char* const name : {"a.nii", "a.nii.gz"}) {
        CAPTURE(big, scaled, name);
        const LoadedVolume volume = read_volume(folder / name);
        REQUIRE(volume.image.type == (scaled ? PLC_F32 : PLC_I16));
        for (size_t i = 0; i < values.size(); ++i) {
          if (scaled) {
            CHECK(voxels<float>(volume)[i] == 0.5F * static_cast<float>(values[i]) + 3);
          } else {
            CHECK(voxels<int16_t>(volume)[i] == values[i]);
          }
        }
        CHECK(volume.image.spacing[2] == 2.5);
        CHECK(volume.image.origin[1] == -20);
      }
    }
  }
}

TEST_CASE("NIfTI headers that are none, or name voxels elsewhere, are refused", "[volume_io]") {
  const fixtures::Folder folder;
  const std::string good = samples::nifti({5, 4, 3}, 2, 8, std::string(kVoxels, 'a'));
  const auto message = [&](size_t at, const std::string& bytes) {
    std::string file = good;
    file.replace(at, bytes.size(), bytes);
    return failure_of([&] { read_volume(folder.put("a.nii", file)); });
  };
  CHECK_THAT(message(344, std::string("ni1\0", 4)), Catch::Contains("in another file"));
  CHECK_THAT(message(344, std::string(4, '\0')), Catch::Contains("not a readable NIfTI"));
  CHECK_THAT(message(0, std::string(4, '\0')), Catch::Contains("not a readable NIfTI"));
  CHECK_THAT(message(40, std::string(2, '\0')), Catch::Contains("header is damaged"));
  CHECK_THAT(message(40, "\x08"), Catch::Contains("header is damaged"));
  CHECK_THAT(message(70, "\x20"), Catch::Contains("complex numbers"));
  CHECK_THAT(message(70, "\x03"), Catch::Contains("NIfTI type 3"));
  const auto offset = [&](float value) { return message(108, samples::raw<float>({value})); };
  CHECK_THAT(offset(1e20F), Catch::Contains("header is damaged"));
  CHECK_THAT(offset(std::nanf("")), Catch::Contains("header is damaged"));
  CHECK_THAT(offset(1e9F), Catch::Contains("truncated"));
}

TEST_CASE("Wide integers whose values are small become i32", "[volume_io]") {
  const fixtures::Folder folder;
  std::vector<int64_t> values(kVoxels, -3);
  values[5] = std::numeric_limits<int32_t>::max();
  const std::string path =
      folder.put("a.nii", samples::nifti({5, 4, 3}, 1024, 64, samples::raw(values)));
  CHECK(read_volume(path).image.type == PLC_I32);
  CHECK(voxels<int32_t>(read_volume(path))[5] == std::numeric_limits<int32_t>::max());
  values[6] = int64_t{1} << 31;
  folder.put("a.nii", samples::nifti({5, 4, 3}, 1024, 64, samples::raw(values)));
  CHECK(read_volume(path).image.type == PLC_F32);
}

TEST_CASE("Doubles become floats, NaN stays NaN", "[volume_io]") {
  const fixtures::Folder folder;
  std::vector<double> values(kVoxels, 0.1);
  values[3] = std::nan("");
  const std::string header = "type: double\ndimension: 3\nsizes: 5 4 3\nencoding: raw";
  const LoadedVolume volume = read_volume(folder.put("a.nrrd", nrrd(header, samples::raw(values))));
  CHECK(volume.image.type == PLC_F32);
  CHECK(voxels<float>(volume)[2] == 0.1F);
  CHECK(std::isnan(voxels<float>(volume)[3]));
}

TEST_CASE("NaN and infinity in NIfTI are refused, its library would make them 0", "[volume_io]") {
  const fixtures::Folder folder;
  std::vector<float> singles(kVoxels, 1);
  singles[59] = std::nanf("");
  std::vector<double> doubles(kVoxels, 1);
  doubles[0] = -std::numeric_limits<double>::infinity();
  for (const std::string& file : {samples::nifti({5, 4, 3}, 16, 32, samples::raw(singles)),
                                  samples::nifti({5, 4, 3}, 64, 64, samples::raw(doubles))}) {
    folder.put("a.nii", file);
    folder.put("a.nii.gz", samples::deflated(file, true));
    for (const char* const name : {"a.nii", "a.nii.gz"}) {
      CHECK_THAT(failure_of([&] { read_volume(folder / name); }),
                 Catch::Contains("NaN or infinite"));
    }
  }
}

TEST_CASE("NIfTI's right-front-head becomes left-back-head", "[volume_io]") {
  const fixtures::Folder folder;
  const std::string file = samples::nifti({5, 4, 3}, 2, 8, std::string(kVoxels, 'a'));
  const plc_image image = read_volume(folder.put("a.nii", file)).image;
  const double spacing[3] = {0.5, 0.75, 2};
  const double origin[3] = {-10, -20, 30};
  const double direction[9] = {-1, 0, 0, 0, -1, 0, 0, 0, 1};
  CHECK(std::equal(spacing, spacing + 3, image.spacing));
  CHECK(std::equal(origin, origin + 3, image.origin));
  CHECK(std::equal(direction, direction + 9, image.direction));
}

TEST_CASE("A fourth axis of one voxel is no axis", "[volume_io]") {
  const fixtures::Folder folder;
  const std::string data(kVoxels, 'a');
  CHECK(read_volume(folder.put("a.nii", samples::nifti({5, 4, 3, 1}, 2, 8, data))).image.dims[2] ==
        3);
}

TEST_CASE("Compressed MetaImage and NRRD are read", "[volume_io]") {
  const fixtures::Folder folder;
  const std::vector<int16_t> values = ramp<int16_t>();
  const std::string packed = samples::deflated(samples::raw(values), false);
  const std::string fields =
      kMetaShort + "CompressedData = True\nCompressedDataSize = " + std::to_string(packed.size());
  CHECK(voxels<int16_t>(read_volume(folder.put("a.mha", meta(fields, packed)))) == values);
  const std::string gzip = samples::deflated(samples::raw(values), true);
  const std::string header = "type: short\ndimension: 3\nsizes: 5 4 3\nencoding: gzip";
  CHECK(voxels<int16_t>(read_volume(folder.put("a.nrrd", nrrd(header, gzip)))) == values);
}

TEST_CASE("A TIFF file of several pages is a volume", "[volume_io]") {
  const fixtures::Folder folder;
  const std::vector<uint16_t> page = ramp<uint16_t>(20);
  std::vector<uint16_t> all;
  for (int i = 0; i < 3; ++i) all.insert(all.end(), page.begin(), page.end());
  const std::string file = samples::tiff(5, 4, 16, 1, {3, samples::raw(page)});
  const LoadedVolume volume = read_volume(folder.put("a.tif", file));
  CHECK(volume.image.type == PLC_U16);
  CHECK(std::equal(kDims, kDims + 3, volume.image.dims));
  CHECK(voxels<uint16_t>(volume) == all);
  const std::string floats = samples::tiff(5, 4, 32, 3, {2, samples::raw(ramp<float>(20))});
  CHECK(read_volume(folder.put("b.tiff", floats)).image.type == PLC_F32);
}

TEST_CASE("A folder of TIFF files is a stack in the order of their numbers", "[volume_io]") {
  const fixtures::Folder folder;
  for (int i = 1; i <= 11; ++i) {
    const std::string page(20, static_cast<char>(i));
    folder.put("s" + std::to_string(i) + ".tif", samples::tiff(5, 4, 8, 1, {page}));
  }
  const LoadedVolume volume = read_volume(folder.path());
  REQUIRE(volume.image.dims[2] == 11);
  for (size_t i = 0; i < 11; ++i) CHECK(voxels<uint8_t>(volume)[20 * i] == i + 1);
}

TEST_CASE("DICOM slices are sorted by position", "[volume_io]") {
  const fixtures::Folder folder;
  for (const int z : {2, 0, 3, 1}) {
    folder.put("f" + std::to_string(5 * z % 4), samples::dicom(slice_at(z)));
  }
  const LoadedVolume volume = read_volume(folder.path());
  CHECK(volume.image.type == PLC_I16);
  const int64_t dims[3] = {4, 3, 4};
  const double spacing[3] = {0.5, 0.75, 2};
  const double origin[3] = {-5, -7, 0};
  CHECK(std::equal(dims, dims + 3, volume.image.dims));
  CHECK(std::equal(spacing, spacing + 3, volume.image.spacing));
  CHECK(std::equal(origin, origin + 3, volume.image.origin));
  for (size_t z = 0; z < 4; ++z)
    CHECK(voxels<int16_t>(volume)[12 * z + 5] == static_cast<int>(100 * z + 5));
}

TEST_CASE("Slices of a tilted gantry make a leaning axis", "[volume_io]") {
  const fixtures::Folder folder;
  for (int z = 0; z < 3; ++z) {
    samples::DicomSlice slice = slice_at(z);
    slice.position = "0\\" + std::to_string(3 * z) + "\\" + std::to_string(4 * z);
    folder.put(std::to_string(z), samples::dicom(slice));
  }
  const plc_image image = read_volume(folder.path()).image;
  CHECK(image.spacing[2] == Approx(5));
  CHECK(image.direction[5] == Approx(0.6));
  CHECK(image.direction[8] == Approx(0.8));
}

TEST_CASE("Of several DICOM series the largest is read", "[volume_io]") {
  const fixtures::Folder folder;
  for (int z = 0; z < 3; ++z) folder.put("a" + std::to_string(z), samples::dicom(slice_at(z)));
  for (int z = 0; z < 5; ++z) {
    folder.put("b" + std::to_string(z), samples::dicom(slice_at(z, "1.2.3.5")));
  }
  CHECK(read_volume(folder.path()).image.dims[2] == 5);
}

TEST_CASE("DICOM folders with holes are refused", "[volume_io]") {
  const fixtures::Folder folder;
  for (const int z : {0, 1, 2, 4, 5}) {
    folder.put(std::to_string(z), samples::dicom(slice_at(z)));
  }
  CHECK_THAT(failure_of([&] { read_volume(folder.path()); }), Catch::Contains("evenly spaced"));
}

TEST_CASE("A truncated DICOM file is refused by its name", "[volume_io]") {
  const fixtures::Folder folder;
  for (int z = 0; z < 3; ++z) {
    std::string file = samples::dicom(slice_at(z));
    if (z == 1) file.resize(file.size() - 3);
    folder.put("slice" + std::to_string(z), file);
  }
  CHECK_THAT(failure_of([&] { read_volume(folder.path()); }),
             Catch::Contains("slice1: is truncated"));
}

TEST_CASE("An InVesalius project is read in patient space", "[volume_io]") {
  const fixtures::Folder folder;
  const std::vector<int16_t> values = ramp<int16_t>();
  const std::string shape = "<integer>3</integer><integer>4</integer><integer>5</integer>";
  const std::string project = samples::tar({{"tmp/matrix.dat", samples::raw(values)},
                                            {"tmp/main.plist", samples::plist("int16", shape)}});
  folder.put("a.inv3", project);
  folder.put("b.inv3", samples::deflated(project, true));
  for (const char* const name : {"a.inv3", "b.inv3"}) {
    const LoadedVolume volume = read_volume(folder / name);
    CHECK(volume.image.type == PLC_I16);
    CHECK(voxels<int16_t>(volume) == values);
    CHECK(std::equal(kDims, kDims + 3, volume.image.dims));
    const double spacing[3] = {0.5, 0.75, 1.5};
    const double direction[9] = {1, 0, 0, 0, -1, 0, 0, 0, 1};
    CHECK(std::equal(spacing, spacing + 3, volume.image.spacing));
    CHECK(std::equal(direction, direction + 9, volume.image.direction));
  }
}

TEST_CASE("Bad InVesalius projects give one line", "[volume_io]") {
  const fixtures::Folder folder;
  const auto message = [&](const std::string& file) {
    return failure_of([&] { read_volume(folder.put("a.inv3", file)); });
  };
  const std::string shape = "<integer>3</integer><integer>4</integer><integer>5</integer>";
  const std::string list = samples::plist("int16", shape);
  const std::string data(2 * kVoxels, 'a');
  const std::string good = samples::tar({{"main.plist", list}, {"matrix.dat", data}});
  CHECK(message(good).empty());
  CHECK_THAT(message("no tar"), Catch::Contains("InVesalius"));
  CHECK_THAT(message(good.substr(0, 700)), Catch::Contains("truncated"));
  CHECK_THAT(message(good.substr(0, good.size() - 1024 - 450)), Catch::Contains("truncated"));
  CHECK_THAT(message(samples::tar({{"matrix.dat", data}})), Catch::Contains("main.plist"));
  CHECK_THAT(message(samples::tar({{"main.plist", list}})), Catch::Contains("matrix.dat"));
  CHECK_THAT(message(samples::tar({{"main.plist", list}, {"matrix.dat", data + "a"}})),
             Catch::Contains("121 bytes"));
  CHECK_THAT(message(samples::tar({{"main.plist", list.substr(0, 200)}, {"matrix.dat", data}})),
             Catch::Contains("XML"));
  CHECK_THAT(message(samples::tar({{"main.plist", samples::plist("complex64", shape)}})),
             Catch::Contains("complex64"));
  CHECK_THAT(message(samples::tar({{"main.plist", samples::plist("int16", "")}})),
             Catch::Contains("matrix/shape"));
}

TEST_CASE("Files that are no volumes give one line that says why", "[volume_io]") {
  const fixtures::Folder folder;
  const auto message = [&](const std::string& name, const std::string& file) {
    const std::string path = folder.put(name, file);
    std::string text = failure_of([&] { read_volume(path); });
    CHECK_THAT(text, Catch::StartsWith(path));
    return text;
  };
  const std::string bytes(2 * kVoxels, 'a');
  CHECK_THAT(failure_of([&] { read_volume(folder / "none.nii"); }),
             Catch::Contains("no such file"));
  CHECK_THAT(failure_of([&] { read_volume(folder.path()); }), Catch::Contains("no DICOM or TIFF"));
  CHECK_THAT(message("a.xyz", bytes), Catch::Contains("unknown format"));
  CHECK_THAT(message("a.nii", ""), Catch::Contains("empty"));
  for (const char* const name : {"a.nii", "a.nii.gz", "a.nrrd", "a.mha", "a.tif", "a.dcm"}) {
    CHECK_THAT(message(name, bytes), Catch::Contains("not a readable"));
  }
  CHECK_THAT(message("2d.nii", samples::nifti({10, 6}, 4, 16, bytes)), Catch::Contains("2-D"));
  CHECK_THAT(message("flat.nii", samples::nifti({10, 6, 1}, 4, 16, bytes)),
             Catch::Contains("not a volume"));
  CHECK_THAT(message("4d.nii", samples::nifti({3, 4, 5, 2}, 2, 8, bytes)), Catch::Contains("4-D"));
  CHECK_THAT(message("rgb.nii", samples::nifti({2, 4, 5}, 128, 24, bytes)),
             Catch::Contains("3 values per voxel"));
  CHECK_THAT(message("vector.nrrd", nrrd("type: short\ndimension: 4\nsizes: 3 5 4 1\n"
                                         "kinds: vector domain domain domain\nencoding: raw",
                                         bytes)),
             Catch::Contains("3 values per voxel"));
  CHECK_THAT(
      message("zero.nrrd", nrrd("type: short\ndimension: 3\nsizes: 5 0 3\nencoding: raw", "")),
      Catch::Contains("size is zero"));
  CHECK_THAT(message("zero.mha", meta("NDims = 3\nDimSize = 5 0 3\nElementType = MET_SHORT", "")),
             Catch::Contains("no voxels"));
  CHECK_THAT(message("page.tif", samples::tiff(5, 4, 8, 1, {std::string(20, 'a')})),
             Catch::Contains("2-D"));
  CHECK_THAT(message("int.tif", samples::tiff(5, 3, 32, 1, {2, std::string(60, 'a')})),
             Catch::Contains("32-bit"));
}

TEST_CASE("Truncated volumes are refused", "[volume_io]") {
  const fixtures::Folder folder;
  const auto message = [&](const std::string& name, const std::string& file) {
    const std::string path = folder.put(name, file);
    return failure_of([&] { read_volume(path); });
  };
  const std::vector<int16_t> values = ramp<int16_t>();
  const std::string bytes = samples::raw(values);
  const auto cut = [](const std::string& file, size_t by) {
    return file.substr(0, file.size() - by);
  };
  const std::string nifti = samples::nifti({5, 4, 3}, 4, 16, bytes);
  CHECK_THAT(message("a.nii", cut(nifti, 1)), Catch::Contains("truncated"));
  CHECK_THAT(message("a.nii", cut(nifti, 200)), Catch::Contains("a.nii"));
  CHECK_THAT(message("a.nii.gz", cut(samples::deflated(nifti, true), 9)),
             Catch::Contains("truncated"));
  CHECK_THAT(message("a.nii.gz", samples::deflated(cut(nifti, 1), true)),
             Catch::Contains("truncated"));
  const std::string header = "type: short\ndimension: 3\nsizes: 5 4 3\nencoding: ";
  CHECK_THAT(message("a.nrrd", nrrd(header + "raw", cut(bytes, 1))), Catch::Contains("119"));
  CHECK_THAT(message("a.nrrd", nrrd(header + "gzip", samples::deflated(cut(bytes, 1), true))),
             Catch::Contains("119"));
  CHECK_THAT(message("a.mha", meta(kMetaShort, cut(bytes, 1))), Catch::Contains("truncated"));
  const std::string packed = samples::deflated(cut(bytes, 1), false);
  CHECK_THAT(message("a.mha", meta(kMetaShort + "CompressedData = True\nCompressedDataSize = " +
                                       std::to_string(packed.size()),
                                   packed)),
             Catch::Contains("truncated"));
  folder.put("short.raw", cut(bytes, 1));
  CHECK_THAT(message("a.mhd", meta(kMetaShort, "", "short.raw")),
             Catch::Contains("short.raw: is truncated"));
  CHECK_THAT(message("a.mhd", meta(kMetaShort, "", "none.raw")), Catch::Contains("none.raw"));
  const std::string tiff = samples::tiff(5, 4, 8, 1, {3, std::string(20, 'a')});
  for (const size_t by : {size_t{1}, size_t{130}, size_t{160}, tiff.size() - 9}) {
    CHECK_THAT(message("a.tif", cut(tiff, by)), Catch::Contains("a.tif"));
  }
}

TEST_CASE("A volume that cannot be written leaves nothing behind", "[volume_io]") {
  const fixtures::Folder folder;
  const std::vector<uint8_t> values = ramp<uint8_t>();
  const plc_image image = image_of(PLC_U8, values);
  CHECK_THAT(failure_of([&] { write_volume(folder / "none/a.nrrd", image); }),
             Catch::Contains("cannot be written"));
  CHECK_THAT(failure_of([&] { write_volume(folder / "a.nii", image); }), Catch::Contains(".nrrd"));
  CHECK_THAT(failure_of([&] { write_volume(folder.path(), image); }), Catch::Contains(".nrrd"));
  CHECK(folder.file_count() == 0);
  std::filesystem::create_directory(folder / "b.nrrd");
  CHECK_THAT(failure_of([&] { write_volume(folder / "b.nrrd", image); }),
             Catch::Contains("directory"));
}

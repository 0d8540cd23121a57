// Images by bricks have the voxels of those that are read whole.
#include "tools/volume/brick_source.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <numeric>

#include "tests/samples/sample_files.h"
#include "tests/samples/sample_zarr.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/phantom/phantoms.h"
#include "tools/volume/ome_zarr.h"
#include "tools/volume/volume_io.h"
#include "tools/volume/volume_io_memory.h"
#include "tools/volume/volume_statistics.h"

namespace {

using fixtures::failure_of;
using plc::tools::BrickSource;
using plc::tools::LoadedVolume;
using plc::tools::open_bricks;
using plc::tools::read_volume;
using plc::tools::VoxelBox;
using plc::tools::Voxels;

VoxelBox all_of(const plc_image& image) {
  VoxelBox box{};
  for (size_t a = 0; a < 3; ++a) box.high[a] = image.dims[a] - 1;
  return box;
}

std::vector<std::byte> read(const BrickSource& source, const VoxelBox& box) {
  size_t bytes = plc::tools::voxel_size(source.image().type);
  for (size_t a = 0; a < 3; ++a) bytes *= static_cast<size_t>(box.high[a] - box.low[a] + 1);
  std::vector<std::byte> voxels(bytes);
  source.read(box, voxels.data());
  return voxels;
}

bool same(const plc::tools::SharedBytes& a, const std::vector<std::byte>& b) {
  return a.size() == b.size() && std::equal(b.begin(), b.end(), a.begin());
}

// Of the whole volume, of a box of it, and of every brick.
void check_same(const BrickSource& source, const LoadedVolume& volume) {
  const plc_image &image = source.image(), &whole = volume.image;
  CHECK(image.voxels == nullptr);
  CHECK(image.type == whole.type);
  CHECK(std::equal(image.dims, image.dims + 3, whole.dims));
  CHECK(std::equal(image.spacing, image.spacing + 3, whole.spacing));
  CHECK(std::equal(image.origin, image.origin + 3, whole.origin));
  CHECK(std::equal(image.direction, image.direction + 9, whole.direction));
  CHECK(source.warnings == volume.warnings);
  CHECK(same(volume.bytes, read(source, all_of(image))));
  VoxelBox box = all_of(image);
  for (size_t a = 0; a < 3; ++a) {
    box.low[a] = 1;
    box.high[a] = std::max<int64_t>(box.high[a] / 2, 2);
  }
  CHECK(same(plc::tools::cut_out("image", volume, box).bytes, read(source, box)));
  size_t pieces = 0;
  std::vector<std::byte> sum;
  Voxels(source).visit([&](const auto* first, const auto* last) {
    ++pieces;
    const auto* bytes = reinterpret_cast<const std::byte*>(first);
    sum.insert(sum.end(), bytes, reinterpret_cast<const std::byte*>(last));
  });
  size_t bricks = 1;
  for (size_t a = 0; a < 3; ++a) {
    bricks *= static_cast<size_t>((image.dims[a] + source.brick()[a] - 1) / source.brick()[a]);
  }
  CHECK(pieces == bricks);
  CHECK(sum.size() == volume.bytes.size());
  CHECK(plc::tools::otsu_of(Voxels(source)) == plc::tools::otsu_of(volume.image));
  const std::vector<double> percents{5, 50, 99};
  CHECK(plc::tools::percentiles_of(Voxels(source), percents) ==
        plc::tools::percentiles_of(volume.image, percents));
}

void check_file(const std::string& path) {
  CAPTURE(path);
  const std::unique_ptr<BrickSource> source = open_bricks(path);
  REQUIRE(source != nullptr);
  check_same(*source, read_volume(path));
}

LoadedVolume phantom(plc_voxel_type type) {
  plc::tools::PhantomOptions options;
  options.size[0] = 70;
  options.size[1] = 65;
  options.size[2] = 40;
  options.spacing[1] = 0.75;
  options.noise = 0.05;
  options.type = type;
  return plc::tools::chain_phantom(options);
}

template <typename T>
std::vector<T> ramp() {
  std::vector<T> values(60);
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<T>(i * 3);
  return values;
}

std::string nrrd(const std::string& fields, const std::string& data) {
  return "NRRD0004\ndimension: 3\nsizes: 5 4 3\ntype: short\n" + fields + "\n\n" + data;
}

std::string meta(const std::string& fields, const std::string& data, const std::string& file) {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nElementSpacing = 1 1 1\n"
         "DimSize = 5 4 3\nElementType = MET_SHORT\n" +
         fields + "ElementDataFile = " + file + "\n" + data;
}

std::string turned(std::string data, size_t size) {
  for (size_t i = 0; i < data.size(); i += size) {
    std::reverse(data.begin() + static_cast<std::ptrdiff_t>(i),
                 data.begin() + static_cast<std::ptrdiff_t>(i + size));
  }
  return data;
}

}  // namespace

TEST_CASE("OME-Zarr, NRRD and MetaImage by bricks are those that are read whole", "[bricks]") {
  const fixtures::Folder folder;
  for (const plc_voxel_type type : {PLC_U8, PLC_I16, PLC_U16, PLC_F32}) {
    plc_image image = phantom(type).image;
    const LoadedVolume volume = phantom(type);
    image.voxels = volume.bytes.data();
    image.origin[2] = -12.25;
    for (const char* const name : {"a.ome.zarr", "a.nrrd", "a.mha", "a.mhd"}) {
      plc::tools::write_volume(folder / name, image);
      check_file(folder / name);
    }
  }
}

TEST_CASE("NIfTI by bricks is what it is read as", "[bricks]") {
  const fixtures::Folder folder;
  const auto put = [&](int16_t datatype, int16_t bits, const std::string& data) {
    return folder.put("a.nii", samples::nifti({5, 4, 3}, datatype, bits, data));
  };
  check_file(put(2, 8, samples::raw(ramp<uint8_t>())));
  check_file(put(4, 16, samples::raw(ramp<int16_t>())));
  check_file(put(16, 32, samples::raw(ramp<float>())));
  check_file(put(64, 64, samples::raw(ramp<double>())));
  check_file(put(256, 8, samples::raw(ramp<int8_t>())));
  check_file(put(512, 16, samples::raw(ramp<uint16_t>())));
  // Scaled, in both orders of bytes.
  for (const bool big : {false, true}) {
    const std::string shorts = samples::raw(ramp<int16_t>()),
                      doubles = samples::raw(ramp<double>());
    check_file(folder.put(
        "b.nii", samples::nifti2({5, 4, 3}, 4, 0.1, 2, big) + (big ? turned(shorts, 2) : shorts)));
    check_file(folder.put("b.nii", samples::nifti2({5, 4, 3}, 64, 0.1, 2, big) +
                                       (big ? turned(doubles, 8) : doubles)));
  }
  // Packed, or of values that do not tell their type before all have been seen.
  CHECK(open_bricks(put(8, 32, samples::raw(ramp<int32_t>()))) == nullptr);
  const std::string file = samples::nifti({5, 4, 3}, 4, 16, samples::raw(ramp<int16_t>()));
  CHECK(open_bricks(folder.put("a.nii.gz", samples::deflated(file, true))) == nullptr);
  CHECK(open_bricks(folder.put("c.nii", samples::deflated(file, true))) == nullptr);
}

TEST_CASE("where the voxels of NRRD and MetaImage are, and in which order of bytes", "[bricks]") {
  const fixtures::Folder folder;
  const std::string data = samples::raw(ramp<int16_t>());
  const std::string big = turned(data, 2);
  check_file(folder.put("a.nrrd", nrrd("encoding: raw\nendian: little", data)));
  check_file(folder.put("b.nrrd", nrrd("encoding: raw\nendian: big", big)));
  folder.put("c.raw", data);
  check_file(folder.put("c.nhdr", nrrd("encoding: raw\nendian: little\ndata file: c.raw", "")));
  check_file(folder.put("a.mha", meta("", data, "LOCAL")));
  check_file(folder.put("b.mha", meta("BinaryDataByteOrderMSB = True\n", big, "LOCAL")));
  check_file(folder.put("c.mhd", meta("", "", "c.raw")));
  // Those that are no one piece of the file.
  folder.put("d.raw", "head" + data);
  CHECK(open_bricks(folder.put(
            "d.nhdr", nrrd("encoding: raw\nendian: little\nbyte skip: 4\ndata file: d.raw", ""))) ==
        nullptr);
  CHECK(open_bricks(folder.put("d.mhd", meta("HeaderSize = 4\n", "", "d.raw"))) == nullptr);
  CHECK(open_bricks(folder.put("e.nrrd", nrrd("encoding: gzip\nendian: little",
                                              samples::deflated(data, true)))) == nullptr);
  CHECK(open_bricks(folder.path()) == nullptr);
}

TEST_CASE("sharded Zarr, chunks that are not there, and boxes by bricks", "[bricks]") {
  const std::array<int64_t, 3> dims{70, 50, 37};
  const auto store = std::make_shared<samples::ZarrMemory>(
      samples::sharded_zarr(dims, [](int64_t x, int64_t y, int64_t z) {
        return static_cast<uint16_t>(x + 100 * y + 1000 * z);
      }));
  std::unique_ptr<BrickSource> source = plc::tools::open_zarr_bricks(store, "");
  REQUIRE(source != nullptr);
  CHECK(source->brick() == BrickSource::Side{32, 33, 32});  // whole chunks of 4, 3 and 2
  const LoadedVolume volume =
      plc::tools::read_ome_zarr(*store, plc::tools::open_ome_zarr(*store), 1);
  check_same(*source, volume);
  const VoxelBox box{{5, 6, 7}, {68, 40, 36}};
  source = plc::tools::cut_out("image", std::move(source), box);
  check_same(*source, plc::tools::cut_out("image", volume, box));
  CHECK_THAT(failure_of([&] {
               plc::tools::cut_out("image", std::move(source), VoxelBox{{0, 0, 0}, {70, 9, 9}});
             }),
             Catch::Matchers::Contains("the box 0,70,0,9,0,9"));
}

TEST_CASE("files that end early, change or are damaged give one line", "[bricks]") {
  const fixtures::Folder folder;
  const std::string data = samples::raw(ramp<int16_t>());
  const std::string whole = nrrd("encoding: raw\nendian: little", data);
  const std::string path = folder.put("a.nrrd", whole.substr(0, whole.size() - 2));
  CHECK_THAT(failure_of([&] { open_bricks(path); }), Catch::Matchers::Contains("is truncated"));
  folder.put("a.nrrd", whole);
  const std::unique_ptr<BrickSource> source = open_bricks(path);
  REQUIRE(source != nullptr);
  std::filesystem::resize_file(path, whole.size() - 2);
  CHECK_THAT(failure_of([&] { read(*source, all_of(source->image())); }),
             Catch::Matchers::Contains("is truncated"));
  CHECK_THAT(failure_of([&] { open_bricks(folder.put("b.nii", "no header at all")); }),
             Catch::Matchers::Contains("b.nii"));
  folder.put("c.raw", data);
  CHECK_THAT(failure_of([&] { open_bricks(folder.put("c.mhd", meta("", "", "gone.raw"))); }),
             Catch::Matchers::Contains("gone.raw"));
  const LoadedVolume volume = phantom(PLC_U8);
  plc_image image = volume.image;
  image.voxels = volume.bytes.data();
  plc::tools::write_volume(folder / "d.ome.zarr", image);
  const std::unique_ptr<BrickSource> zarr = open_bricks(folder / "d.ome.zarr");
  REQUIRE(zarr != nullptr);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "d.ome.zarr")) {
    if (entry.is_regular_file() && !entry.path().filename().string().starts_with(".")) {
      std::filesystem::resize_file(entry.path(), 20);
    }
  }
  CHECK_THAT(failure_of([&] { read(*zarr, all_of(zarr->image())); }),
             Catch::Matchers::Contains("d.ome.zarr"));
}

#include <catch2/catch.hpp>
#include <cstring>
#include <numeric>

#include "tests/samples/sample_zarr.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/phantom/phantoms.h"
#include "tools/volume/ome_zarr.h"
#include "tools/volume/ome_zarr_write.h"
#include "tools/volume/volume_io.h"

namespace {

using fixtures::failure_of;
using plc::tools::LoadedVolume;
using plc::tools::open_ome_zarr;
using plc::tools::read_ome_zarr;
using samples::ZarrMemory;

LoadedVolume loaded(const ZarrMemory& store, int threads = 1) {
  return read_ome_zarr(store, open_ome_zarr(store), threads);
}

template <typename T>
std::vector<T> voxels(const LoadedVolume& volume) {
  std::vector<T> values(volume.bytes.size() / sizeof(T));
  std::memcpy(values.data(), volume.bytes.data(), volume.bytes.size());
  return values;
}

// A Zarr 2 array of 3 x 2 x 4 voxels (x, y, z) in one chunk: its metadata but for what is given,
// and the chunk.
ZarrMemory one_chunk(const std::string& type, const std::string& rest, const std::string& chunk) {
  ZarrMemory store;
  store.values[".zarray"] = R"({"zarr_format": 2, "shape": [4, 2, 3], "chunks": [4, 2, 3], )"
                            R"("filters": null, "fill_value": 0, "dtype": ")" +
                            type + "\", " + rest + "}";
  store.values["0.0.0"] = chunk;
  return store;
}

std::vector<uint16_t> ramp() {
  std::vector<uint16_t> values(24);
  std::iota(values.begin(), values.end(), uint16_t{250});
  return values;
}

const std::string kPlain = R"("order": "C", "compressor": null)";

std::string compressor(const std::string& id) {
  return R"("order": "C", "compressor": {"id": ")" + id + "\"}";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

uint16_t voxel(int64_t x, int64_t y, int64_t z) {
  return static_cast<uint16_t>(1 + x + 20 * y + 400 * z);
}
constexpr std::array<int64_t, 3> kDims{13, 7, 5};

}  // namespace

TEST_CASE("Packings of Zarr 2 are undone", "[zarr]") {
  const std::string raw = samples::raw(ramp());
  CHECK(voxels<uint16_t>(loaded(one_chunk("<u2", kPlain, raw))) == ramp());
  CHECK(voxels<uint16_t>(
            loaded(one_chunk("<u2", compressor("gzip"), samples::deflated(raw, true)))) == ramp());
  CHECK(voxels<uint16_t>(
            loaded(one_chunk("<u2", compressor("zlib"), samples::deflated(raw, false)))) == ramp());
  if (plc::tools::has_library(plc::tools::ZarrCodec::kZstd)) {
    CHECK(voxels<uint16_t>(
              loaded(one_chunk("<u2", compressor("zstd"), samples::zstd_frame(raw)))) == ramp());
  }
  if (plc::tools::has_library(plc::tools::ZarrCodec::kBlosc)) {
    const auto packed = plc::tools::zarr_compress("", std::as_bytes(std::span(raw)), 2);
    const std::string text(reinterpret_cast<const char*>(packed.data()), packed.size());
    CHECK(voxels<uint16_t>(loaded(one_chunk("<u2", compressor("blosc"), text))) == ramp());
  }
}

TEST_CASE("Byte order, order of axes and keys are those of the metadata", "[zarr]") {
  std::string swapped = samples::raw(ramp());
  for (size_t i = 0; i < swapped.size(); i += 2) std::swap(swapped[i], swapped[i + 1]);
  CHECK(voxels<uint16_t>(loaded(one_chunk(">u2", kPlain, swapped))) == ramp());
  std::vector<uint16_t> turned;  // z fastest
  for (size_t x = 0; x < 3; ++x) {
    for (size_t y = 0; y < 2; ++y) {
      for (size_t z = 0; z < 4; ++z) turned.push_back(ramp()[x + 3 * (y + 2 * z)]);
    }
  }
  const std::string order = R"("order": "F", "compressor": null, "dimension_separator": "/")";
  ZarrMemory store = one_chunk("<u2", order, "");
  store.values["0/0/0"] = samples::raw(turned);
  CHECK(voxels<uint16_t>(loaded(store)) == ramp());
}

TEST_CASE("Types that the engine has not are converted", "[zarr]") {
  const std::vector<int8_t> small{-128, 127, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12,
                                  13,   14,  0, 1, 2, 3, 4, 5, 6, 7,  8,  9};
  const LoadedVolume bytes = loaded(one_chunk("|i1", kPlain, samples::raw(small)));
  CHECK(bytes.image.type == PLC_I16);
  CHECK(voxels<int16_t>(bytes) == std::vector<int16_t>(small.begin(), small.end()));
  const std::vector<double> wide(24, 0.5);
  const LoadedVolume reals = loaded(one_chunk("<f8", kPlain, samples::raw(wide)));
  CHECK(reals.image.type == PLC_F32);
  CHECK(voxels<float>(reals) == std::vector<float>(24, 0.5F));
  const std::vector<uint8_t> flags(24, 1);
  CHECK(loaded(one_chunk("|b1", kPlain, samples::raw(flags))).image.type == PLC_U8);
}

TEST_CASE("Sharded OME-Zarr 0.5 is read, and chunks that are not there are filled", "[zarr]") {
  const ZarrMemory store = samples::sharded_zarr(kDims, voxel);
  std::vector<uint16_t> expected;
  for (int64_t z = 0; z < kDims[2]; ++z) {
    for (int64_t y = 0; y < kDims[1]; ++y) {
      for (int64_t x = 0; x < kDims[0]; ++x) {
        expected.push_back(x < 4 && y < 3 && z < 2 ? uint16_t{7} : voxel(x, y, z));
      }
    }
  }
  for (const int threads : {1, 3}) {
    const LoadedVolume volume = loaded(store, threads);
    CHECK(volume.image.type == PLC_U16);
    CHECK(std::equal(kDims.begin(), kDims.end(), volume.image.dims));
    CHECK(voxels<uint16_t>(volume) == expected);
    const double spacing[3] = {1, 1.5, 2};  // of micrometres
    const double origin[3] = {10, 20, 30};
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(volume.image.spacing[axis] == Approx(spacing[axis]));
      CHECK(volume.image.origin[axis] == Approx(origin[axis]));
    }
  }
}

TEST_CASE("Axes that are not in the order z, y, x turn the volume, not the object", "[zarr]") {
  ZarrMemory store = samples::sharded_zarr(kDims, voxel);
  std::string& json = store.values["zarr.json"];
  json = replaced(replaced(replaced(json, "\"z\"", "\"q\""), "\"x\"", "\"z\""), "\"q\"", "\"x\"");
  const plc_image image = loaded(store).image;
  const double direction[9] = {0, 0, 1, 0, 1, 0, 1, 0, 0};
  CHECK(std::equal(direction, direction + 9, image.direction));
  CHECK(image.origin[2] == Approx(10));
  CHECK(image.spacing[2] == Approx(2));
}

TEST_CASE("Axes of channels and times are of length 1, or refused", "[zarr]") {
  ZarrMemory store;
  const auto metadata = [](int channels) {
    const std::string n = std::to_string(channels);
    return R"({"zarr_format": 2, "shape": [1, )" + n +
           R"(, 4, 2, 3], "chunks": [1, 1, 4, 2, 3], "dtype": "<u2", "order": "C",
           "compressor": null, "fill_value": 0, "dimension_separator": "/"})";
  };
  store.values[".zattrs"] = R"({"multiscales": [{"axes": [{"name": "t", "type": "time"},
      {"name": "c", "type": "channel"}, {"name": "z", "type": "space"},
      {"name": "y", "type": "space"}, {"name": "x", "type": "space"}],
      "datasets": [{"path": "a/b", "coordinateTransformations": [
        {"type": "scale", "scale": [1, 1, 3, 2, 0.5]}]}],
      "coordinateTransformations": [{"type": "scale", "scale": [0.1, 1, 2, 2, 2]}]}]})";
  store.values["a/b/.zarray"] = metadata(1);
  store.values["a/b/0/0/0/0/0"] = samples::raw(ramp());
  const LoadedVolume volume = loaded(store);
  CHECK(voxels<uint16_t>(volume) == ramp());
  CHECK(volume.image.spacing[2] == 6);
  CHECK(volume.image.spacing[0] == 1);
  store.values["a/b/.zarray"] = metadata(2);
  CHECK(failure_of([&] { loaded(store); }) ==
        "memory: has 2 images along its axis \"c\"; one is needed");
}

TEST_CASE("What is wrong with a Zarr hierarchy is told in one line", "[zarr]") {
  const ZarrMemory good = samples::sharded_zarr(kDims, voxel);
  const auto refusal = [&](const std::string& key, const std::function<void(std::string&)>& harm) {
    ZarrMemory store = good;
    harm(store.values[key]);
    return failure_of([&] { loaded(store); });
  };
  const auto with = [&](const std::string& what, const std::string& by) {
    return refusal("0/zarr.json", [&](std::string& text) { text = replaced(text, what, by); });
  };
  const std::string shard = "0/c/1/1/1";
  CHECK(refusal("zarr.json", [](std::string& text) { text.resize(100); }) ==
        "memory/zarr.json: is damaged (it is no JSON object)");
  CHECK(refusal("zarr.json", [](std::string& t) { t = replaced(t, "\"0\"", "\"../0\""); }) ==
        "memory: its OME-Zarr image has a path that is not usable");
  CHECK(refusal("zarr.json", [](std::string& t) { t = replaced(t, "[2000,", "["); }) ==
        "memory: its OME-Zarr image has coordinateTransformations that are not usable");
  CHECK(refusal("zarr.json", [](std::string& t) { t = replaced(t, "2000", "0"); }) ==
        "memory: its voxel spacing or origin is not usable");
  CHECK(with("uint16", "complex64") ==
        "memory/0/zarr.json: values of type complex64 are not supported");
  CHECK(with("[5,", "[-5,") == "memory/0/zarr.json: its shape is not usable");
  CHECK(with("[2, 3, 4]", "[2, 3, 5]") ==
        "memory/0/zarr.json: the shape of its shards is no multiple of that of the chunks in them");
  CHECK(with("[4, 6, 8]", "[4000, 6000, 8000]") ==
        "memory/0/zarr.json: its shards hold too many chunks");
  CHECK(with("gzip", "lzma") == "memory/0/zarr.json: the codec \"lzma\" is not supported there");
  CHECK(with("\"fill_value\": 7", "\"fill_value\": 70000") ==
        "memory/0/zarr.json: its fill_value is none of its type");
  CHECK(refusal(shard, [](std::string& bytes) { bytes.back() ^= 1; }) ==
        "memory/0/c/1/1/1: is truncated or damaged (its checksum is another one)");
  CHECK(refusal(shard, [](std::string& bytes) { bytes.resize(9); }) ==
        "memory/0/c/1/1/1: is truncated");
  CHECK(refusal("0/c/0/0/0", [](std::string& bytes) {
          bytes[20] ^= 64;
        }).starts_with("memory/0/c/0/0/0: is truncated or damaged"));
  CHECK(failure_of([&] { loaded(one_chunk("<u2", kPlain, samples::raw(ramp()) + "x")); }) ==
        "memory/0.0.0: has 49 bytes of a chunk's 48");
  CHECK(failure_of([&] { loaded(ZarrMemory()); }) ==
        "memory: holds no OME-Zarr image (a group with \"multiscales\") and no array");
}

TEST_CASE("Metadata that ask for much memory without voxels are refused", "[zarr]") {
  const auto told = [](const std::string& shape, const std::string& chunks) {
    ZarrMemory store = one_chunk("<u2", kPlain, samples::raw(ramp()));
    std::string& json = store.values[".zarray"];
    json = replaced(json, "\"shape\": [4, 2, 3]", "\"shape\": " + shape);
    json = replaced(json, "\"chunks\": [4, 2, 3]", "\"chunks\": " + chunks);
    store.values.erase("0.0.0");
    return failure_of([&] { loaded(store); });
  };
  CHECK(told("[4, 2, 3]", "[4000, 2000, 3000]") == "memory: its chunks are too large");
  CHECK(told("[2000000, 2000000, 2000000]", "[1, 1, 1]").starts_with("memory: "));
  CHECK(told("[1000, 1000, 1000]", "[100, 100, 100]") ==
        "memory: has no chunks where they were looked for");
}

TEST_CASE("A volume that is written as OME-Zarr is read as it was", "[zarr]") {
  const fixtures::Folder folder;
  plc::tools::PhantomOptions options;
  options.size[0] = 70;
  options.size[1] = 65;
  options.size[2] = 130;
  options.spacing[1] = 0.75;
  for (const plc_voxel_type type : {PLC_U8, PLC_I16, PLC_U16, PLC_I32, PLC_F32}) {
    CAPTURE(type);
    options.type = type;
    const LoadedVolume volume = plc::tools::chain_phantom(options);
    plc_image image = volume.image;
    image.origin[2] = -12.25;
    plc::tools::write_volume(folder / "a.ome.zarr", image);  // over the one before
    const LoadedVolume back = plc::tools::read_volume(folder / "a.ome.zarr");
    CHECK(back.image.type == type);
    CHECK(back.image.spacing[1] == 0.75);
    CHECK(back.image.origin[2] == -12.25);
    REQUIRE(back.bytes.size() == volume.bytes.size());
    CHECK(std::equal(back.bytes.begin(), back.bytes.end(), volume.bytes.begin()));
    const LoadedVolume one = plc::tools::read_volume(folder / "a.ome.zarr/0");
    CHECK(one.image.origin[2] == -12.25);
  }
  CHECK(folder.file_count() == 1);
}

TEST_CASE("A phantom that is handed over in planes is the whole one", "[zarr][phantoms]") {
  plc::tools::PhantomOptions options;
  for (auto& size : options.size) size = 20;
  options.noise = 0.1;
  for (const std::string& name : plc::tools::phantom_names()) {
    CAPTURE(name);
    options.take_planes = nullptr;
    const LoadedVolume whole = plc::tools::make_phantom(name, options);
    std::vector<std::byte> parts;
    options.take_planes = [&](const plc_image& image, std::span<const std::byte> planes) {
      CHECK(image.dims[2] == 20);
      parts.insert(parts.end(), planes.begin(), planes.end());
    };
    CHECK(plc::tools::make_phantom(name, options).bytes.empty());
    CHECK(std::equal(parts.begin(), parts.end(), whole.bytes.begin(), whole.bytes.end()));
  }
}

TEST_CASE("Nothing but a Zarr hierarchy is replaced by one, and nothing is left half-written",
          "[zarr]") {
  const fixtures::Folder folder;
  folder.put("a.zarr", "not ours");
  const LoadedVolume volume = plc::tools::chain_phantom({});
  CHECK(failure_of([&] { plc::tools::write_volume(folder / "a.zarr", volume.image); }) ==
        (folder / "a.zarr") + ": is there, and is no Zarr hierarchy that could be replaced");
  CHECK(fixtures::contents(folder / "a.zarr") == "not ours");
  { plc::tools::OmeZarrWriter never(folder / "b.zarr", volume.image); }
  CHECK(folder.file_count() == 1);
  plc_image turned = volume.image;
  turned.direction[0] = -1;
  CHECK(failure_of([&] { plc::tools::write_volume(folder / "b.zarr", turned); }) ==
        (folder / "b.zarr") + ": OME-Zarr has no place for the direction of the volume's axes");
}

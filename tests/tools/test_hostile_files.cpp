// Files made to do harm are refused in one line, before memory is taken: headers that lie, small
// files that stand for large ones, sizes about 2^31, 2^32 and 2^63.
#include <sys/mman.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "tests/samples/limited_memory.h"
#include "tests/samples/sample_files.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/command/attach_file.h"
#include "tools/mesh/mesh_io.h"
#include "tools/mesh/mesh_io_formats.h"
#include "tools/volume/volume_io.h"
#include "tools/volume/volume_io_formats.h"
#include "tools/volume/volume_io_memory.h"
#include "tools/volume/volume_io_size.h"

namespace {

using fixtures::failure_of;
using plc::tools::ItkFormat;
using plc::tools::ItkHeader;

constexpr size_t kLittle = size_t{96} << 20;  // for what is refused

// Where a limit is possible, reading must do with little memory.
class Tight {
#if FIXTURES_CAN_LIMIT_MEMORY
  fixtures::MemoryLimit limit_{kLittle};
#endif
};

class Files {
 public:
  std::string volume(const std::string& name, const std::string& file) const {
    const std::string path = folder_.put(name, file);
    return failure_of([&] {
      const Tight tight;
      plc::tools::read_volume(path);
    });
  }
  std::string mesh(const std::string& name, const std::string& file) const {
    const std::string path = folder_.put(name, file);
    return failure_of([&] {
      const Tight tight;
      plc::tools::read_mesh(path);
    });
  }
  const fixtures::Folder& folder() const { return folder_; }

 private:
  fixtures::Folder folder_;
};

std::string project(const std::string& plist, const std::string& data = "abcd") {
  return samples::tar({{"main.plist", plist}, {"matrix.dat", data}});
}

std::string integers(const std::vector<std::string>& values) {
  std::string out;
  for (const std::string& value : values) out += "<integer>" + value + "</integer>";
  return out;
}

// Says that its file number `index` has `size` bytes, in octal digits.
std::string with_size(std::string tar, size_t at, const std::string& size) {
  constexpr size_t kBlock = 512;
  tar.replace(at + 124, 11, size);
  tar.replace(at + 148, 8, "        ");
  unsigned sum = 0;
  for (size_t i = 0; i < kBlock; ++i) sum += static_cast<unsigned char>(tar[at + i]);
  char checksum[8];
  std::snprintf(checksum, sizeof checksum, "%06o", sum);
  return tar.replace(at + 148, 7, checksum, 7);
}

std::string repeated(const std::string& text, size_t times) {
  std::string out;
  out.reserve(text.size() * times);
  for (size_t i = 0; i < times; ++i) out += text;
  return out;
}

std::string nrrd(const std::string& sizes, const std::string& encoding, const std::string& data) {
  return "NRRD0004\ntype: float\ndimension: 3\nsizes: " + sizes +
         "\nendian: little\nencoding: " + encoding + "\n\n" + data;
}

std::string meta(const std::string& sizes, const std::string& fields, const std::string& file,
                 const std::string& data = "") {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nElementSpacing = 1 1 1\nDimSize = " +
         sizes + "\nElementType = MET_SHORT\n" + fields + "ElementDataFile = " + file + "\n" + data;
}

std::string piece(const std::string& arrays) {
  return "<Piece NumberOfPoints=\"1\"><Points>" + arrays + "</Points></Piece>";
}

std::string vtp(const std::string& pieces, const std::string& rest = "",
                const std::string& before = "") {
  return "<?xml version=\"1.0\"?>\n" + before +
         "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData>" + pieces +
         "</PolyData>" + rest + "</VTKFile>\n";
}

// Ten times the one before: the billion laughs.
std::string laughs() {
  std::string out = "<!DOCTYPE lolz [<!ENTITY l0 \"0 0 0 \">";
  for (int i = 1; i < 10; ++i) {
    const std::string before = "&l" + std::to_string(i - 1) + ";";
    out += "<!ENTITY l" + std::to_string(i) + " \"" + repeated(before, 10) + "\">";
  }
  return out + "]>\n";
}

}  // namespace

TEST_CASE("Voxel counts are computed in 64 bits, and refused where those do not do", "[hostile]") {
  const auto count = [](int64_t x, int64_t y, int64_t z) {
    const int64_t dims[3] = {x, y, z};
    return plc::tools::checked_voxel_count("a", dims);
  };
  constexpr int64_t k31 = int64_t{1} << 31;
  CHECK(count(k31 - 1, 2, 2) == 4 * (k31 - 1));
  CHECK(count(k31, 2, 2) == int64_t{1} << 33);
  CHECK(count(k31 + 1, 2, 2) == 4 * (k31 + 1));
  CHECK(count(int64_t{1} << 20, int64_t{1} << 20, int64_t{1} << 19) == int64_t{1} << 59);
  CHECK_THAT(failure_of([&] { count(int64_t{1} << 20, int64_t{1} << 20, int64_t{1} << 20); }),
             Catch::Contains("too large"));
  CHECK_THAT(failure_of([&] { count(k31, k31, k31); }), Catch::Contains("too large"));
  CHECK_THAT(failure_of([&] { count(std::numeric_limits<int64_t>::max(), 2, 2); }),
             Catch::Contains("too large"));
  CHECK_THAT(failure_of([&] { count(-k31, k31, 2); }), Catch::Contains("no voxels"));
  CHECK(plc::tools::times(uint64_t{1} << 32, uint64_t{1} << 31) == uint64_t{1} << 63);
  CHECK(plc::tools::times(uint64_t{1} << 32, uint64_t{1} << 32) ==
        std::numeric_limits<uint64_t>::max());
  CHECK(plc::tools::product_of({k31, k31, k31}, 8) == std::numeric_limits<uint64_t>::max());
  CHECK(plc::tools::product_of({k31, 0, k31}, 8) == 0);
}

TEST_CASE("What the machine has not the memory for is refused, though the file holds it",
          "[hostile]") {
  const Files files;
  // 4 GiB of voxels and more, most of them a hole of the file.
  const std::string sizes = "100000 100000 1000";
  const std::string path = files.folder().put("a.nrrd", nrrd(sizes, "raw", ""));
  std::error_code error;
  std::filesystem::resize_file(path, uint64_t{40100} * 1000 * 1000 * 1000, error);
  if (error) return;  // not on every file system
  CHECK_THAT(failure_of([&] { plc::tools::read_volume(path); }), Catch::Contains("of memory"));
}

TEST_CASE("Volumes whose headers ask for more than the file can hold take no memory", "[hostile]") {
  const Files files;
  const auto refuses = [&](const std::string& name, const std::string& file) {
    CAPTURE(name);
    CHECK_THAT(files.volume(name, file), Catch::Contains("truncated"));
  };
  const std::string gzip = samples::deflated("abcd", true);
  for (const char* const sizes : {"1000 1000 300", "2147483647 2 2", "1048576 1048576 524288"}) {
    CAPTURE(sizes);
    for (const char* const encoding : {"raw", "ascii", "hex"}) {
      refuses("a.nrrd", nrrd(sizes, encoding, "1234"));
    }
    refuses("b.nrrd", nrrd(sizes, "gzip", gzip));
  }
  refuses("a.mha", meta("1000 1000 300", "", "LOCAL", "1234"));
  refuses("b.mha", meta("1000 1000 300", "CompressedData = True\nCompressedDataSize = 4\n", "LOCAL",
                        "1234"));
  std::string text = meta("1000 1000 300", "", "LOCAL", "1 2 3 4");
  text.replace(text.find("BinaryData = True"), 17, "BinaryData = False");
  refuses("c.mha", text);
  const std::string nifti = samples::nifti({1000, 1000, 300}, 4, 16, "1234");
  refuses("a.nii", nifti);
  refuses("a.nii.gz", samples::deflated(nifti, true));
  // Directories of 20,000 x 20,000 with strips of four bytes.
  refuses("a.tif", samples::tiff(20000, 20000, 16, 1, {"1234", "1234", "1234"}));
}

TEST_CASE("DICOM files are measured where they are plain, and where they are packed", "[hostile]") {
  const Files files;
  samples::DicomSlice slice;
  slice.columns = slice.rows = 65535;
  slice.voxels.assign(12, 1);
  const std::string plain = samples::dicom(slice);
  std::string packed = plain;  // RLE
  const std::string syntax = "1.2.840.10008.1.2.1";
  packed.replace(packed.find(syntax), syntax.size(), "1.2.840.10008.1.2.5");
  const ItkHeader header{plc::tools::ItkComponent::kI16, {65535, 65535, 1}};
  for (const std::string& file : {plain, packed}) {
    const std::string path = files.folder().put("a.dcm", file);
    CHECK_THAT(failure_of([&] { plc::tools::check_file_size(path, ItkFormat::kDicom, header); }),
               Catch::Contains("truncated"));
  }
}

TEST_CASE("NRRD sizes that ITK would take for smaller ones are refused", "[hostile]") {
  const Files files;
  // 2^32 + 5 is 5 to it, while the library under it reads all there is into memory for that.
  CHECK_THAT(files.volume("a.nrrd", nrrd("4294967301 4 3", "raw", std::string(100000, '\0'))),
             Catch::Contains("too large"));
  CHECK_THAT(files.volume("a.nrrd", nrrd("2147483648 2 2", "raw", "abc")),
             Catch::Contains("too large"));
  CHECK_THAT(files.volume("a.nrrd", nrrd("5 4 9223372036854775808", "raw", "abc")),
             Catch::Contains("a.nrrd: "));
}

TEST_CASE("NIfTI is measured by its type, not by what it says of bits", "[hostile]") {
  const Files files;
  // Of 24 bits the floats would not be whole in the buffer that looks for NaN.
  const std::string bytes(4 * 60, '\0');
  for (const int bits : {0, 7, 8, 24}) {
    const std::string file = samples::nifti({5, 4, 3}, 16, static_cast<int16_t>(bits), bytes);
    CHECK_THAT(files.volume("a.nii", file.substr(0, file.size() - 1)),
               Catch::Contains("truncated"));
  }
}

TEST_CASE("MetaImage hands no printf format to its library", "[hostile]") {
  const Files files;
  for (const char* const name : {"%s.raw", "%n", "a%03d%s.raw", "a%%d", "a%", "a%9999d", "%0$d"}) {
    CAPTURE(name);
    CHECK_THAT(files.volume("a.mhd", meta("5 4 3", "", name)), Catch::Contains("named by"));
  }
  CHECK(plc::tools::numbered_name("slice%03d.raw", 7) == "slice007.raw");
  CHECK(plc::tools::numbered_name("slice%d.raw", 1234) == "slice1234.raw");
  CHECK(plc::tools::numbered_name("%4d", 12) == "  12");
}

TEST_CASE("A MetaImage of slices in files is read, and refused where they are not there",
          "[hostile]") {
  const Files files;
  for (const char* const name : {"s1.raw", "s2.raw", "s3.raw"}) {
    files.folder().put(name, std::string(40, 'a'));
  }
  CHECK(files.volume("a.mhd", meta("5 4 3", "", "s%d.raw 1 3 1")) == "");
  CHECK(files.volume("a.mhd", meta("5 4 3", "", "s%d.raw")) == "");
  CHECK(files.volume("b.mhd", meta("5 4 3", "", "LIST", "s1.raw\ns2.raw\ns3.raw\n")) == "");
  CHECK_THAT(files.volume("b.mhd", meta("5 4 3", "", "LIST", "s1.raw\ns2.raw\n")),
             Catch::Contains("truncated"));
  CHECK_THAT(files.volume("b.mhd", meta("5 4 4", "", "s%d.raw 1 4 1")), Catch::Contains("s4.raw"));
  CHECK_THAT(files.volume("b.mhd", meta("5 4 1000000", "", "s%d.raw")), Catch::Contains("s4.raw"));
  CHECK_THAT(files.volume("c.mhd", meta("5 4 3", "", "/dev/zero")),
             Catch::Contains("cannot be read"));
  const std::string lies = "CompressedData = True\nCompressedDataSize = 9000000000000\n";
  CHECK_THAT(files.volume("d.mha", meta("5 4 3", lies, "LOCAL", samples::deflated("a", false))),
             Catch::Contains("9000000000000"));
}

TEST_CASE("An NRRD of slices in files is read, and refused where they are not there", "[hostile]") {
  const Files files;
  for (const char* const name : {"s1.raw", "s2.raw", "s3.raw"}) {
    files.folder().put(name, std::string(80, '\0'));
  }
  const auto header = [](const std::string& encoding, const std::string& data) {
    return "NRRD0004\ntype: float\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: " +
           encoding + "\ndata file: " + data + "\n";
  };
  CHECK(files.volume("a.nhdr", header("raw", "s%d.raw 1 3 1")) == "");
  CHECK(files.volume("a.nhdr", header("raw", "LIST\ns1.raw\ns2.raw\ns3.raw")) == "");
  CHECK_THAT(files.volume("a.nhdr", header("raw", "LIST\ns1.raw\ns2.raw")),
             Catch::Contains("got 2"));
  CHECK_THAT(files.volume("a.nhdr", header("raw", "s%d.raw 2 4 1")), Catch::Contains("s4.raw"));
  CHECK_THAT(files.volume("a.nhdr", header("raw", "s1.raw")), Catch::Contains("truncated"));
  CHECK_THAT(files.volume("a.nhdr", header("raw", "s%n.raw 1 3 1")),
             Catch::Contains("couldn't open"));
  CHECK_THAT(files.volume("a.nhdr", header("bzip2", "s1.raw")), Catch::Contains("bzip2"));
}

TEST_CASE("TIFF directories of no entries are refused before a library walks them", "[hostile]") {
  const Files files;
  std::string tiff = samples::tiff(4, 3, 8, 1, {std::string(12, 'a'), std::string(12, 'b')});
  const auto empty = static_cast<uint32_t>(tiff.size());
  samples::put_at(tiff, tiff.size() - 4, empty);
  samples::put<uint16_t>(tiff, 0);
  samples::put<uint32_t>(tiff, empty);
  CHECK_THAT(files.volume("a.tif", tiff), Catch::Contains("empty"));
}

TEST_CASE("A MetaImage of many axes is refused before they are read", "[hostile]") {
  const Files files;
  for (const char* const axes : {"11", "100000", "1e5", "4294967296"}) {
    std::string file = meta("2 2 2", "", "LOCAL", std::string(16, 'a'));
    file.replace(file.find("NDims = 3"), 9, std::string("NDims = ") + axes);
    CHECK_THAT(files.volume("a.mha", file), Catch::Contains(std::string(axes) + "-D"));
  }
}

TEST_CASE("TIFF directories that lead in circles end soon", "[hostile]") {
  const Files files;
  // 5,000 entries, the next directory is the same.
  std::string tiff("II*\0\10\0\0\0", 8);
  samples::put<uint16_t>(tiff, 5000);
  for (int i = 0; i < 5000; ++i) tiff += std::string("\377\377\4\0\1\0\0\0\0\0\0\0", 12);
  samples::put<uint32_t>(tiff, 8);
  const ItkHeader header{plc::tools::ItkComponent::kU8, {2, 2, 2}};
  const std::string path = files.folder().put("a.tif", tiff);
  CHECK_THAT(failure_of([&] { plc::tools::check_file_size(path, ItkFormat::kTiff, header); }),
             Catch::Contains("in a circle"));
}

TEST_CASE("InVesalius projects are refused before memory is taken", "[hostile]") {
  const Files files;
  const auto message = [&](const std::string& file) { return files.volume("a.inv3", file); };
  const std::string huge = samples::plist("int16", integers({"1024", "1024", "1024"}));
  // A header says 2 GiB where nothing is.
  const std::string tar = project(huge);
  const size_t entry = tar.rfind("matrix.dat") / 512 * 512;
  CHECK_THAT(message(with_size(tar, entry, "20000000000")), Catch::Contains("too small to hold"));
  CHECK_THAT(message(samples::deflated(with_size(tar, entry, "20000000000"), true)),
             Catch::Contains("too small to hold"));
  CHECK_THAT(message(with_size(tar, 0, "20000000000")),
             Catch::Contains("main.plist in it is too large"));
  const std::string good = samples::plist("uint8", integers({"2", "2", "2"}));
  const std::string small = project(good, "12345678");
  CHECK(message(small) == "");
  CHECK(message(samples::deflated(small, true)) == "");
  CHECK_THAT(message(samples::deflated(samples::deflated(small, true), true)),
             Catch::Contains("packed more than once"));
  for (const char* const item :
       {"4611686018427387904", "2147483648", "-1", "9223372036854775808"}) {
    CHECK_FALSE(message(project(samples::plist("uint8", integers({item, item, "4"})))).empty());
  }
}

TEST_CASE("Property lists that grow as they are read are refused, and their text is one line",
          "[hostile]") {
  const Files files;
  const auto message = [&](const std::string& plist) {
    return files.volume("a.inv3", project(plist));
  };
  CHECK_THAT(message(repeated("<array>", 100)), Catch::Contains("nested too deeply"));
  CHECK_THAT(message(laughs() + "<plist><dict><key>a</key><string>&l9;</string></dict></plist>"),
             Catch::Contains("entities of its own"));
  // Every item stands under a key of 100 kB: together they would be 5 GB.
  const std::string key(100000, 'k');
  CHECK_THAT(message("<plist><dict><key>" + key + "</key><array>" + repeated("<i>1</i>", 50000) +
                     "</array></dict></plist>"),
             Catch::Contains("does not have matrix"));
  CHECK_THAT(message(samples::plist("a\nb" + std::string(1000, 'c'), "")),
             Catch::Contains("a?bccc"));
}

TEST_CASE("A piece inside of an array of a VTP file does not end in freed memory", "[hostile]") {
  const Files files;
  const std::string array = "<DataArray type=\"Float32\" format=\"ascii\">0 0 0";
  CHECK_THAT(
      files.mesh("a.vtp", vtp("<Piece><Points>" + array + repeated("<Piece>", 40) + "1 1 1")),
      Catch::Contains("XML"));
}

TEST_CASE("VTP files that stand for more than they are take no memory", "[hostile]") {
  const Files files;
  const auto message = [&](const std::string& file) { return files.mesh("a.vtp", file); };
  const std::string array = "<DataArray type=\"Float32\" format=\"ascii\">";
  CHECK_THAT(message(vtp(piece(array + "&l9;</DataArray>"), "", laughs())),
             Catch::Contains("entities of its own"));
  CHECK_THAT(message(vtp(repeated("<a>", 1000))), Catch::Contains("nested too deeply"));
  CHECK_THAT(message(vtp(repeated("<Piece/>", 70000))), Catch::Contains("too many pieces"));
  // 20,000 pieces that read the same 240 kB.
  const std::string data(240000, '\0');
  const std::string same = piece("<DataArray type=\"Float32\" format=\"appended\" offset=\"0\"/>");
  CHECK_THAT(message(vtp(repeated(same, 20000), "<AppendedData encoding=\"raw\">_" +
                                                    samples::raw<uint32_t>({240000}) + data +
                                                    "</AppendedData>")),
             Catch::Contains("bytes of other arrays"));
}

TEST_CASE("Blocks of a VTP file are counted without wrapping", "[hostile]") {
  // 2^26 blocks of 2^38 bytes are 0 in 64 bits. The file is as long as it must be for that; what of
  // it is not written takes no memory.
  constexpr uint64_t kBlocks = uint64_t{1} << 26;
  constexpr uint64_t kBlockSize = uint64_t{1} << 38;
  constexpr uint64_t kPacked = kBlockSize / 1100 + (uint64_t{1} << 16);
  const std::string array = "<DataArray type=\"Float32\" format=\"appended\" offset=\"0\"/>";
  const std::string head =
      "<VTKFile type=\"PolyData\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">"
      "<PolyData>" +
      piece(array) + "</PolyData><AppendedData encoding=\"raw\">_" +
      samples::raw<uint64_t>({kBlocks, kBlockSize, 0, kPacked});
  const size_t size = head.size() + 8 * kBlocks + kPacked;
  void* const at = mmap(nullptr, size, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  REQUIRE(at != MAP_FAILED);
  std::memcpy(at, head.data(), head.size());
  const std::string_view file(static_cast<const char*>(at), size);
  CHECK_THAT(failure_of([&] {
               const Tight tight;
               plc::tools::read_vtp("a.vtp", file);
             }),
             Catch::Contains("contradict each other"));
  munmap(at, size);
}

TEST_CASE("What a message repeats of a file is short and one line", "[hostile]") {
  const Files files;
  const std::string odd = "a\x7f\x1b" + std::string(1000, 'b');
  for (const std::string& file : {"OFF\n" + odd, "ply\nformat ascii 1.0\n" + odd + "\n",
                                  "ply\nformat " + odd + "\n", "v " + odd + "\n"}) {
    for (const char* const name : {"a.off", "a.ply", "a.obj", "a.stl"}) {
      const std::string message = files.mesh(name, file);
      CHECK(message.find('\x7f') == std::string::npos);
      CHECK(message.find('\x1b') == std::string::npos);
      CHECK(message.size() < 300);
    }
  }
}

TEST_CASE("Words of a file of places are numbers to their end, and come back short", "[hostile]") {
  const Files files;
  const auto message = [&](const std::string& file) {
    const std::string path = files.folder().put("places", file);
    return failure_of([&] { plc::tools::read_attach_file(path); });
  };
  CHECK_THAT(message(std::string("pin 1\0x 2 3 4\n", 14)), Catch::Contains("not a finite number"));
  CHECK_THAT(message(std::string(5000, 'x')), Catch::Contains("xxx..."));
  CHECK_THAT(message("pin 1 2 3 \x1b[2J\n"), Catch::Contains("?[2J"));
}

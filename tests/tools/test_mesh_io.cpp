#include "tools/mesh/mesh_io.h"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <limits>
#include <map>

#include "tests/samples/sample_files.h"
#include "tests/samples/sample_meshes.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/file/base64.h"

namespace {

using fixtures::failure_of;
using plc::tools::encode_base64;
using plc::tools::read_mesh;
using plc::tools::TriangleMesh;
using plc::tools::write_mesh;

// Those that are read, too.
const char* const kSuffixes[] = {".stl", ".ply", ".obj", ".off", ".vtp", ".vtk", ".gii"};

// A torus whose coordinates are floats of many digits, with normals.
TriangleMesh torus() {
  const samples::Soup soup = samples::torus(13, 7, 2, 0.7);
  TriangleMesh mesh;
  for (const double x : soup.xyz) mesh.xyz.push_back(static_cast<float>(100 / 3.0 + x));
  mesh.abc.assign(soup.abc.begin(), soup.abc.end());
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    mesh.normals.push_back(i % 3 == 0 ? 0.6F : i % 3 == 1 ? 0.8F : 1e-9F);
  }
  return mesh;
}

std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

// One square, in each format that has polygons.
void check_square(const TriangleMesh& mesh) {
  CHECK(mesh.xyz == std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5});
  CHECK(mesh.abc == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
}

template <typename T>
std::string swapped(std::vector<T> values) {
  std::string out;
  for (const T value : values) {
    std::string bytes = samples::raw(std::vector<T>{value});
    out.append(bytes.rbegin(), bytes.rend());
  }
  return out;
}

// A PolyData file whose arrays are given as the attributes and the text of their elements.
struct Arrays {
  std::string points, connectivity, offsets;
};
std::string vtp(const std::string& attributes, const Arrays& arrays, const std::string& cells,
                const std::string& rest = "") {
  const auto element = [](const std::string& head, const std::string& body) {
    return "<DataArray " + head + " " + body + "</DataArray>";
  };
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" " +
         attributes + "><PolyData><Piece NumberOfPoints=\"4\"><Points>" +
         element("type=\"Float32\" NumberOfComponents=\"3\"", arrays.points) + "</Points><" +
         cells + ">" + element("type=\"Int32\" Name=\"connectivity\"", arrays.connectivity) +
         element("type=\"Int32\" Name=\"offsets\"", arrays.offsets) + "</" + cells +
         "></Piece></PolyData>" + rest + "</VTKFile>\n";
}

const std::vector<float> kPoints = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5};
const std::vector<int32_t> kCorners = {0, 1, 2, 3};
const std::vector<int32_t> kOffsets = {4};

// With a length before it, of 32 bits.
std::string sized(const std::string& data) {
  return samples::raw<uint32_t>({static_cast<uint32_t>(data.size())}) + data;
}

// In one block of zlib's.
std::string packed(const std::string& data, bool as_base64) {
  const std::string block = samples::deflated(data, false);
  const auto size = static_cast<uint32_t>(data.size());
  const std::string header =
      samples::raw<uint32_t>({1, size, 0, static_cast<uint32_t>(block.size())});
  return as_base64 ? encode_base64(header) + encode_base64(block) : header + block;
}

std::string inline_array(const std::string& format, const std::string& text) {
  return "format=\"" + format + "\">" + text;
}

}  // namespace

TEST_CASE("Meshes come back as they were written", "[mesh_io]") {
  const fixtures::Folder folder;
  const TriangleMesh mesh = torus();
  for (const std::string suffix : kSuffixes) {
    CAPTURE(suffix);
    const std::string path = folder / ("a" + suffix);
    write_mesh(path, mesh);
    const TriangleMesh back = read_mesh(path);
    if (suffix == ".stl") {  // numbered in the order of the triangles
      REQUIRE(back.abc.size() == mesh.abc.size());
      CHECK(back.xyz.size() == mesh.xyz.size());
      bool same = true;
      for (size_t i = 0; i < mesh.abc.size(); ++i) {
        for (size_t k = 0; k < 3; ++k) {
          same &= back.xyz[3 * back.abc[i] + k] == mesh.xyz[3 * mesh.abc[i] + k];
        }
      }
      CHECK(same);
      continue;
    }
    // Nine digits of a float are that float's, not all digits of its double.
    CHECK(std::vector<float>(back.xyz.begin(), back.xyz.end()) ==
          std::vector<float>(mesh.xyz.begin(), mesh.xyz.end()));
    if (suffix != ".obj" && suffix != ".off") CHECK(back.xyz == mesh.xyz);
    CHECK(back.abc == mesh.abc);
    const bool has_normals = suffix != ".off" && suffix != ".gii";
    CHECK(back.normals == (has_normals ? mesh.normals : std::vector<float>()));
  }
  CHECK(folder.file_count() == std::size(kSuffixes));
}

TEST_CASE("Meshes without normals are written without", "[mesh_io]") {
  const fixtures::Folder folder;
  TriangleMesh mesh = torus();
  mesh.normals.clear();
  for (const std::string suffix : kSuffixes) {
    write_mesh(folder / ("a" + suffix), mesh);
    CHECK(read_mesh(folder / ("a" + suffix)).normals.empty());
  }
}

TEST_CASE("Values at vertices come back from the formats that hold them", "[mesh_io]") {
  const fixtures::Folder folder;
  for (const bool with_normals : {true, false}) {
    TriangleMesh mesh = torus();
    if (!with_normals) mesh.normals.clear();
    plc::tools::Scalars ones{"Ones", {}}, ids{"Ids", {}};
    for (size_t v = 0; v < mesh.xyz.size() / 3; ++v) {
      ones.values.push_back(v % 5 == 0 ? std::numeric_limits<float>::quiet_NaN() : 1.0F);
      ids.values.push_back(static_cast<float>(v));
    }
    mesh.scalars = {ones, ids};
    for (const std::string suffix : {".ply", ".vtp", ".vtk", ".gii"}) {
      CAPTURE(suffix, with_normals);
      const std::string path = folder / ("a" + suffix);
      write_mesh(path, mesh);
      const TriangleMesh back = read_mesh(path);
      CHECK(back.xyz == mesh.xyz);
      CHECK(back.abc == mesh.abc);
      if (suffix != ".gii") CHECK(back.normals == mesh.normals);
      REQUIRE(back.scalars.size() == 2);
      CHECK(back.scalars[0].name == "Ones");
      CHECK(back.scalars[1].name == "Ids");
      CHECK(back.scalars[1].values == ids.values);
      CHECK(samples::raw(back.scalars[0].values) == samples::raw(ones.values));
    }
    // The values themselves, where the headers say they are.
    const size_t stride = (with_normals ? 8 : 5) * sizeof(float);
    const std::string ply = fixtures::contents(folder / "a.ply");
    CHECK_THAT(ply, Catch::Contains("property float Ones\nproperty float Ids\nelement face"));
    const size_t vertices = ply.find("end_header\n") + 11;
    const std::string vtp = fixtures::contents(folder / "a.vtp");
    const size_t tag = vtp.find("Name=\"Ids\" format=\"appended\" offset=\"");
    REQUIRE(tag != std::string::npos);
    const size_t array = vtp.find("\n_") + 2 + std::stoul(vtp.substr(tag + 37)) + sizeof(uint64_t);
    for (size_t v = 0; v < ids.values.size(); ++v) {
      const size_t end = vertices + (v + 1) * stride;
      CHECK(ply.substr(end - 4, 4) == samples::raw<float>({ids.values[v]}));
      CHECK(ply.substr(end - 8, 4) == samples::raw<float>({ones.values[v]}));
      CHECK(vtp.substr(array + 4 * v, 4) == samples::raw<float>({ids.values[v]}));
    }
  }
}

TEST_CASE("Formats that hold no values at vertices refuse them, before and when writing",
          "[mesh_io]") {
  const fixtures::Folder folder;
  TriangleMesh mesh = torus();
  mesh.scalars = {{"Ones", std::vector<float>(mesh.xyz.size() / 3, 1.0F)}};
  for (const std::string suffix : {".stl", ".obj", ".off", ".3mf"}) {
    const std::string path = folder / ("a" + suffix);
    CHECK_THAT(failure_of([&] { write_mesh(path, mesh); }), Catch::Contains("no values"));
    CHECK_THAT(failure_of([&] { plc::tools::check_mesh_path(path, true); }),
               Catch::Contains("no values"));
  }
  CHECK(folder.file_count() == 0);
}

TEST_CASE("An empty mesh is a mesh", "[mesh_io]") {
  const fixtures::Folder folder;
  for (const std::string suffix : kSuffixes) {
    CAPTURE(suffix);
    write_mesh(folder / ("a" + suffix), {});
    CHECK(read_mesh(folder / ("a" + suffix)).abc.empty());
  }
}

TEST_CASE("A binary STL does not begin like an ASCII one and has outward normals", "[mesh_io]") {
  const fixtures::Folder folder;
  write_mesh(folder / "a.stl", {{0, 0, 0, 2, 0, 0, 0, 3, 0}, {0, 1, 2}, {}});
  const std::string file = fixtures::contents(folder / "a.stl");
  REQUIRE(file.size() == 134);
  CHECK(file.substr(0, 5) != "solid");
  CHECK(file.substr(84, 12) == samples::raw<float>({0, 0, 1}));
}

TEST_CASE("ASCII STL is read and welded", "[mesh_io]") {
  const fixtures::Folder folder;
  const std::string facet =
      "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex +1.0e0 0 0\n  vertex 1 1 -0\n"
      " endloop\nendfacet\n";
  const std::string other = with_replaced(facet, "+1.0e0 0 0", "1 1 0");
  const std::string text =
      "solid a b c\n" + facet + with_replaced(other, "1 1 -0", "0 1 0.5") + "endsolid a b c\n";
  check_square(read_mesh(folder.put("a.stl", text)));
  CHECK_THAT(failure_of([&] { read_mesh(folder.put("a.stl", text.substr(0, 150))); }),
             Catch::Contains("line"));
  CHECK_THAT(failure_of([&] { read_mesh(folder.put("a.stl", "solid a\n" + facet)); }),
             Catch::Contains("ends too early"));
}

TEST_CASE("A binary STL that begins with solid is binary", "[mesh_io]") {
  const fixtures::Folder folder;
  std::string file = "solid by another program";
  file.resize(80, ' ');
  file += samples::raw<uint32_t>({1}) + samples::raw<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) +
          std::string(2, '\0');
  CHECK(read_mesh(folder.put("a.stl", file)).xyz.size() == 9);
}

TEST_CASE("PLY is read in its three encodings, with properties nobody asked for", "[mesh_io]") {
  const fixtures::Folder folder;
  const auto header = [](const std::string& format) {
    return "ply\nformat " + format +
           " 1.0\ncomment x\nelement vertex 4\nproperty uchar red\nproperty double x\n"
           "property float y\nproperty float z\nelement other 2\nproperty list uchar short l\n"
           "element face 1\nproperty int id\nproperty list uchar int vertex_index\nend_header\n";
  };
  const std::string ascii =
      header("ascii") + "9 0 0 0\n9 1 0 0\n9 1 1 0\n9 0 1 0.5\n2 7 7\n0\n5 4 0 1 2 3\n";
  check_square(read_mesh(folder.put("a.ply", ascii)));
  check_square(
      read_mesh(folder.put("a.ply", with_replaced(ascii, "end_header\n", "end_header\r\n"))));
  std::string little = header("binary_little_endian");
  std::string big = header("binary_big_endian");
  for (size_t i = 0; i < 4; ++i) {
    const std::vector<float> yz(kPoints.begin() + 3 * static_cast<int>(i) + 1,
                                kPoints.begin() + 3 * static_cast<int>(i) + 3);
    const auto x = static_cast<double>(kPoints[3 * i]);
    little += '\x9' + samples::raw<double>({x}) + samples::raw(yz);
    big += '\x9' + swapped<double>({x}) + swapped(yz);
  }
  little += '\2' + samples::raw<int16_t>({7, 7}) + '\0' + samples::raw<int32_t>({5}) + '\4' +
            samples::raw(kCorners);
  big += '\2' + swapped<int16_t>({7, 7}) + '\0' + swapped<int32_t>({5}) + '\4' + swapped(kCorners);
  check_square(read_mesh(folder.put("a.ply", little)));
  check_square(read_mesh(folder.put("a.ply", big)));
}

TEST_CASE("OBJ is read with every kind of corner", "[mesh_io]") {
  const fixtures::Folder folder;
  const std::string points = "# c\nmtllib x\nv 0 0 0\nv 1 0 0 # c\nv 1 1 0 1.0\nv 0 1 0.5\n";
  for (const char* const face : {"f 1 2 3 4\n", "f 1/5 2/6 3/7 4/8\n", "f 1//1 2//1 3//1 4//1",
                                 "f -4 -3 -2 -1\n", "f 1/1/1 2/1/1 3/1/1 4/1/1\r\n"}) {
    CAPTURE(face);
    check_square(read_mesh(folder.put("a.obj", points + "vn 0 0 1\n" + face)));
  }
  for (const char* const face : {"f 1 2\n", "f 1 2 5\n", "f 0 1 2\n", "f 1 2 -5\n", "f 1 2 x\n"}) {
    CAPTURE(face);
    CHECK_FALSE(failure_of([&] { read_mesh(folder.put("a.obj", points + face)); }).empty());
  }
}

TEST_CASE("OFF is read with comments and colours", "[mesh_io]") {
  const fixtures::Folder folder;
  const std::string text =
      "COFF # c\n4 1 0\n# c\n0 0 0 255 0 0\n1 0 0 255 0 0\n\n1 1 0 9 9 9\n0 1 0.5 1 1 1\n"
      "4 0 1 2 3 0.5 0.5 0.5\n";
  check_square(read_mesh(folder.put("a.off", text)));
  check_square(read_mesh(folder.put("a.off", with_replaced(text, "COFF # c\n", "OFF "))));
}

TEST_CASE("VTP is read in every encoding", "[mesh_io]") {
  const fixtures::Folder folder;
  const std::string p = samples::raw(kPoints);
  const std::string c = samples::raw(kCorners);
  const std::string o = samples::raw(kOffsets);
  const auto check = [&](const std::string& file) {
    check_square(read_mesh(folder.put("a.vtp", file)));
  };
  check(vtp("",
            {inline_array("ascii", "0 0 0 1 0 0\n1 1 0 0 1 0.5"), inline_array("ascii", "0 1 2 3"),
             inline_array("ascii", "4")},
            "Polys"));
  const auto binary = [](const std::string& text) { return inline_array("binary", "\n " + text); };
  check(vtp("",
            {binary(encode_base64(sized(p))), binary(encode_base64(sized(c))),
             binary(encode_base64(sized(o)))},
            "Polys"));
  const std::string zlib = "compressor=\"vtkZLibDataCompressor\"";
  check(vtp(zlib, {binary(packed(p, true)), binary(packed(c, true)), binary(packed(o, true))},
            "Polys"));
  const auto appended = [](size_t at) {
    return "format=\"appended\" offset=\"" + std::to_string(at) + "\">";
  };
  const auto appended_file = [&](const std::string& attributes, const std::string& encoding,
                                 const std::string& a, const std::string& b, const std::string& d) {
    return vtp(attributes, {appended(0), appended(a.size()), appended(a.size() + b.size())},
               "Polys",
               "<AppendedData encoding=\"" + encoding + "\">\n _" + a + b + d + "</AppendedData>");
  };
  check(appended_file("", "raw", sized(p), sized(c), sized(o)));
  check(appended_file("", "base64", encode_base64(sized(p)), encode_base64(sized(c)),
                      encode_base64(sized(o))));
  check(appended_file(zlib, "raw", packed(p, false), packed(c, false), packed(o, false)));
  check(appended_file(zlib, "base64", packed(p, true), packed(c, true), packed(o, true)));
}

TEST_CASE("Strips of a VTP file become triangles of one orientation", "[mesh_io]") {
  const fixtures::Folder folder;
  const std::string file = vtp("",
                               {inline_array("ascii", "0 0 0 1 0 0 0 1 0 1 1 0 0 2 0"),
                                inline_array("ascii", "0 1 2 3 4"), inline_array("ascii", "5")},
                               "Strips");
  CHECK(read_mesh(folder.put("a.vtp", file)).abc ==
        std::vector<uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4});
}

TEST_CASE("A file cut anywhere is refused or whole, and never more", "[mesh_io]") {
  const fixtures::Folder folder;
  const TriangleMesh mesh = torus();
  for (const std::string suffix : kSuffixes) {
    write_mesh(folder / ("whole" + suffix), mesh);
    const std::string file = fixtures::contents(folder / ("whole" + suffix));
    size_t refused = 0;
    size_t tried = 0;
    for (size_t size = 0; size < file.size(); size += 1 + file.size() / 97, ++tried) {
      const std::string path = folder.put("cut" + suffix, file.substr(0, size));
      const std::string message = failure_of([&] {
        const TriangleMesh part = read_mesh(path);
        CHECK(part.abc.size() <= mesh.abc.size());
      });
      if (message.empty()) continue;
      ++refused;
      CHECK_THAT(message, Catch::StartsWith(path));
    }
    CAPTURE(suffix);
    // OBJ does not say how much there is to come: cut after a line it is whole. VTK does not say
    // that normals follow the faces.
    CHECK((refused == tried || suffix == ".obj" || suffix == ".vtk"));
  }
}

TEST_CASE("Files with bytes changed are read or refused, in one line", "[mesh_io]") {
  const fixtures::Folder folder;
  for (const std::string suffix : kSuffixes) {
    write_mesh(folder / ("whole" + suffix), torus());
    const std::string file = fixtures::contents(folder / ("whole" + suffix));
    uint64_t random = 1;
    for (int round = 0; round < 200; ++round) {
      std::string damaged = file;
      for (int i = 0; i < 3; ++i) {
        random = random * 6364136223846793005U + 1442695040888963407U;
        // Headers first: what they say is what can do harm.
        const size_t reach = round % 2 == 0 ? std::min<size_t>(file.size(), 600) : file.size();
        damaged[(random >> 33) % reach] = static_cast<char>(random >> 25);
      }
      const std::string path = folder.put("damaged" + suffix, damaged);
      failure_of([&] { read_mesh(path); });
    }
  }
}

TEST_CASE("Counts that lie do not reserve memory", "[mesh_io]") {
  const fixtures::Folder folder;
  const auto message = [&](const std::string& name, const std::string& file) {
    return failure_of([&] { read_mesh(folder.put(name, file)); });
  };
  std::string stl(84, ' ');
  samples::put_at<uint32_t>(stl, 80, 4000000000U);
  CHECK_THAT(message("a.stl", stl), Catch::Contains("truncated"));
  CHECK_THAT(message("a.off", "OFF\n4000000000 1 0\n0 0 0\n"), Catch::Contains("cannot hold"));
  CHECK_THAT(message("a.off", "OFF\n-1 1 0\n0 0 0\n"), Catch::Contains("cannot hold"));
  CHECK_THAT(message("a.off", "OFF\n1 1 0\n0 0 0\n4000000000 0 0 0\n"), Catch::Contains("corners"));
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 9000000000000000000\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n";
  CHECK_THAT(message("a.ply", ply), Catch::Contains("truncated"));
  CHECK_THAT(message("b.ply", with_replaced(ply, "binary_little_endian", "ascii")),
             Catch::Contains("truncated"));
  const std::string list =
      "ply\nformat binary_little_endian 1.0\nelement face 1\n"
      "property list uint int vertex_indices\nend_header\n\xff\xff\xff\xff";
  CHECK_THAT(message("c.ply", list), Catch::Contains("truncated"));
  const auto binary = [](const std::string& text) { return inline_array("binary", text); };
  const std::string wild = encode_base64(samples::raw<uint32_t>({0xfffffff0U, 0, 0}));
  CHECK_THAT(message("a.vtp", vtp("", {binary(wild), binary(wild), binary(wild)}, "Polys")),
             Catch::Contains("truncated"));
  const std::string bomb =
      encode_base64(samples::raw<uint32_t>({3, 0x7fffffffU, 0, 4, 4, 4, 1, 2, 3}));
  CHECK_FALSE(message("b.vtp", vtp("compressor=\"vtkZLibDataCompressor\"",
                                   {binary(bomb), binary(bomb), binary(bomb)}, "Polys"))
                  .empty());
}

TEST_CASE("Faces that refer to no vertex are refused", "[mesh_io]") {
  const fixtures::Folder folder;
  CHECK_THAT(failure_of([&] {
               read_mesh(folder.put("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"));
             }),
             Catch::Contains("face 0 refers to vertex 3 of 3"));
  CHECK_THAT(failure_of([&] {
               read_mesh(folder.put("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"));
             }),
             Catch::Contains("vertex -1"));
}

TEST_CASE("Values that are no numbers are kept for the check to find", "[mesh_io]") {
  const fixtures::Folder folder;
  const TriangleMesh mesh =
      read_mesh(folder.put("a.off", "OFF\n3 1 0\nnan inf 1e999\n1 0 0\n0 1 0\n3 0 1 2\n"));
  CHECK(std::isnan(mesh.xyz[0]));
  CHECK(std::isinf(mesh.xyz[1]));
}

TEST_CASE("Coordinates in doubles are read back as they were from every format", "[mesh_io]") {
  const fixtures::Folder folder;
  TriangleMesh mesh = torus();
  for (double& x : mesh.xyz) x = 1e7 / 3 + x * 1e-7;
  mesh.doubles = true;
  for (const std::string suffix : kSuffixes) {
    CAPTURE(suffix);
    const std::string path = folder / "mesh" + suffix;
    if (suffix == ".gii") {  // which has floats alone
      CHECK_THAT(failure_of([&] { write_mesh(path, mesh); }), Catch::Contains("has no doubles"));
      continue;
    }
    write_mesh(path, mesh);
    const TriangleMesh read = read_mesh(path);
    REQUIRE(read.abc.size() == mesh.abc.size());
    REQUIRE(read.xyz.size() == mesh.xyz.size());  // an .stl welds what is the same, and orders it
    for (size_t i = 0; i < mesh.abc.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) {
        REQUIRE(read.xyz[3 * read.abc[i] + k] == mesh.xyz[3 * mesh.abc[i] + k]);
      }
    }
    if (suffix != ".stl" && suffix != ".off") CHECK(read.normals == mesh.normals);
  }
  CHECK_THAT(fixtures::contents(folder / "mesh.stl"), Catch::StartsWith("solid Pellicle"));
  mesh.scalars.push_back({"Speed", std::vector<float>(mesh.xyz.size() / 3, 0.5F)});
  for (const char* name : {"values.ply", "values.vtp"}) {
    write_mesh(folder / name, mesh);
    CHECK(read_mesh(folder / name).xyz == mesh.xyz);
    CHECK(read_mesh(folder / name).abc == mesh.abc);
  }
}

TEST_CASE("Paths that cannot be written are found before the run", "[mesh_io]") {
  const fixtures::Folder folder;
  using plc::tools::check_mesh_path;
  CHECK(failure_of([&] { check_mesh_path(folder / "a.STL"); }).empty());
  CHECK(folder.file_count() == 0);
  CHECK_THAT(failure_of([&] { check_mesh_path(folder / "a.xyz"); }),
             Catch::Contains("unknown format"));
  CHECK_THAT(failure_of([&] { check_mesh_path(folder / "a"); }), Catch::Contains("unknown format"));
  CHECK_THAT(failure_of([&] { check_mesh_path(folder / "none/a.stl"); }),
             Catch::Contains("cannot be written"));
  std::filesystem::create_directory(folder / "b.stl");
  CHECK_THAT(failure_of([&] { check_mesh_path(folder / "b.stl"); }), Catch::Contains("directory"));
}

TEST_CASE("A write that fails keeps the old file and leaves no other", "[mesh_io]") {
  const fixtures::Folder folder;
  folder.put("a.ply", "old");
  // A file may not grow beyond the limit: what a full disk does.
  rlimit old_limit{};
  getrlimit(RLIMIT_FSIZE, &old_limit);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{1000, old_limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  const std::string message = failure_of([&] { write_mesh(folder / "a.ply", torus()); });
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  CHECK_THAT(message, Catch::Contains("a.ply: cannot be written"));
  CHECK(fixtures::contents(folder / "a.ply") == "old");
  CHECK(folder.file_count() == 1);
}

TEST_CASE("A link is written through, a device directly", "[mesh_io]") {
  const fixtures::Folder folder;
  folder.put("real.off", "old");
  std::filesystem::create_symlink("real.off", folder / "link.off");
  write_mesh(folder / "link.off", torus());
  CHECK(std::filesystem::is_symlink(folder / "link.off"));
  CHECK(read_mesh(folder / "real.off").abc == torus().abc);
  if (!std::filesystem::exists("/dev/full")) return;
  std::filesystem::create_symlink("/dev/full", folder / "full.stl");
  CHECK_THAT(failure_of([&] { write_mesh(folder / "full.stl", torus()); }),
             Catch::Contains("No space left"));
  CHECK(folder.file_count() == 3);
}

TEST_CASE("values of other types are read, colours and what is no number are left out",
          "[mesh_io]") {
  const fixtures::Folder folder;
  const TriangleMesh ply = read_mesh(
      folder.put("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty uchar red\nproperty float x\n"
                 "property float y\nproperty float z\nproperty int label\nelement face 1\n"
                 "property list uchar int vertex_indices\nend_header\n"
                 "9 0 0 0 5\n9 1 0 0 5\n9 0 1 0 70\n3 0 1 2\n"));
  REQUIRE(ply.scalars.size() == 1);
  CHECK(ply.scalars[0].name == "label");
  CHECK(ply.scalars[0].values == std::vector<float>{5, 5, 70});
  const std::string piece =
      "<Piece><Points><DataArray type='Float32' NumberOfComponents='3' format='ascii'>"
      "0 0 0 1 0 0 0 1 0</DataArray></Points><Polys>"
      "<DataArray type='Int32' Name='connectivity' format='ascii'>0 1 2</DataArray>"
      "<DataArray type='Int32' Name='offsets' format='ascii'>3</DataArray></Polys>";
  const std::string values =
      "<PointData><DataArray type='String' Name='words' format='ascii'>a b c</DataArray>"
      "<DataArray type='Float32' Name='vectors' NumberOfComponents='2' format='ascii'>"
      "1 2 3 4 5 6</DataArray>"
      "<DataArray type='UInt8' Name='Label_of_parts' format='ascii'>1 1 2</DataArray></PointData>";
  const TriangleMesh vtp =
      read_mesh(folder.put("a.vtp", "<VTKFile type='PolyData'><PolyData>" + piece + values +
                                        "</Piece></PolyData></VTKFile>"));
  REQUIRE(vtp.scalars.size() == 1);
  CHECK(vtp.scalars[0].name == "Label_of_parts");
  CHECK(vtp.scalars[0].values == std::vector<float>{1, 1, 2});
  // Of several pieces those that every piece has, as VTK has it.
  const TriangleMesh pieces =
      read_mesh(folder.put("b.vtp", "<VTKFile type='PolyData'><PolyData>" + piece + "</Piece>" +
                                        piece + values + "</Piece></PolyData></VTKFile>"));
  CHECK(pieces.xyz.size() == 18);
  CHECK(pieces.scalars.empty());
}

// What the formats say beside the mesh, and those that are written only.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/samples/sample_files.h"
#include "tests/samples/sample_meshes.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/file/base64.h"
#include "tools/file/text.h"
#include "tools/mesh/mesh_io.h"
#include "tools/mesh/vertex_colours.h"

namespace {

using fixtures::failure_of;
using plc::tools::read_mesh;
using plc::tools::TriangleMesh;
using plc::tools::write_mesh;

TriangleMesh cube(const std::string& space) {
  const samples::Soup soup = samples::moved(samples::cube(), 1, 2, 3);
  TriangleMesh mesh;
  mesh.xyz = soup.xyz;
  mesh.abc.assign(soup.abc.begin(), soup.abc.end());
  mesh.space = space;
  return mesh;
}

struct Glb {
  nlohmann::json json;
  std::string block;
};

Glb parts_of(const std::string& file) {
  using plc::tools::load_value;
  REQUIRE(file.substr(0, 4) == "glTF");
  CHECK(load_value<uint32_t>(file.data() + 4, false) == 2);
  CHECK(load_value<uint32_t>(file.data() + 8, false) == file.size());
  const auto length = load_value<uint32_t>(file.data() + 12, false);
  CHECK(length % 4 == 0);
  CHECK(file.substr(16, 4) == "JSON");
  Glb glb{nlohmann::json::parse(file.substr(20, length)), {}};
  if (file.size() == 20 + length) return glb;
  CHECK(load_value<uint32_t>(file.data() + 20 + length, false) == file.size() - length - 28);
  CHECK(file.substr(24 + length, 4) == std::string("BIN\0", 4));
  glb.block = file.substr(28 + length);
  return glb;
}

// The bytes of one attribute.
std::string attribute(const Glb& glb, const std::string& name) {
  const auto& primitive = glb.json["meshes"][0]["primitives"][0];
  const auto& index = name == "indices" ? primitive["indices"] : primitive["attributes"][name];
  const auto& view =
      glb.json["bufferViews"]
              [glb.json["accessors"][index.get<size_t>()]["bufferView"].get<size_t>()];
  return glb.block.substr(view["byteOffset"], view["byteLength"]);
}

const std::string kCorners = "0 0 0 1 0 0 1 1 0 0 1 0.5";

}  // namespace

TEST_CASE("A file names the space of its coordinates, and it comes back", "[mesh_formats]") {
  const fixtures::Folder folder;
  for (const std::string space : {"LPS", "RAS", "voxel"}) {
    for (const std::string suffix : {".ply", ".obj", ".stl", ".vtp", ".vtk"}) {
      CAPTURE(space, suffix);
      const std::string path = folder / ("a" + suffix);
      TriangleMesh mesh = cube(space);
      write_mesh(path, mesh);
      CHECK(read_mesh(path).space == space);
      if (suffix != ".vtp") CHECK_THAT(fixtures::contents(path), Catch::Contains("SPACE=" + space));
      mesh.doubles = true;
      write_mesh(path, mesh);
      CHECK(read_mesh(path).space == space);
    }
  }
  write_mesh(folder / "a.ply", cube(""));
  CHECK(read_mesh(folder / "a.ply").space.empty());
  CHECK(fixtures::contents(folder / "a.ply").find("SPACE") == std::string::npos);
}

TEST_CASE("GIFTI files are in RAS, and are read to LPS", "[mesh_formats]") {
  const fixtures::Folder folder;
  const TriangleMesh lps = cube("LPS");
  write_mesh(folder / "lps.gii", lps);
  CHECK(read_mesh(folder / "lps.gii").space == "LPS");
  CHECK(read_mesh(folder / "lps.gii").xyz == lps.xyz);
  TriangleMesh ras = cube("RAS");
  for (size_t i = 0; i < ras.xyz.size(); ++i) ras.xyz[i] *= i % 3 == 2 ? 1 : -1;
  write_mesh(folder / "ras.gii", ras);
  CHECK(fixtures::contents(folder / "ras.gii") == fixtures::contents(folder / "lps.gii"));
  write_mesh(folder / "voxel.gii", cube("voxel"));
  CHECK(read_mesh(folder / "voxel.gii").space == "voxel");
  CHECK(read_mesh(folder / "voxel.gii").xyz == lps.xyz);
}

TEST_CASE("GIFTI is read in every encoding and order", "[mesh_formats]") {
  const fixtures::Folder folder;
  const auto file = [&](const std::string& encoding, const std::string& order,
                        const std::string& points, const std::string& faces) {
    const auto array = [&](const std::string& intent, const std::string& type, int rows,
                           const std::string& text) {
      return "<DataArray Intent=\"NIFTI_INTENT_" + intent + "\" DataType=\"NIFTI_TYPE_" + type +
             "\" ArrayIndexingOrder=\"" + order + "\" Dimensionality=\"2\" Dim0=\"" +
             std::to_string(rows) + "\" Dim1=\"3\" Encoding=\"" + encoding +
             "\" Endian=\"LittleEndian\"><Data>" + text + "</Data></DataArray>";
    };
    return folder.put("a.gii", "<?xml version=\"1.0\"?><GIFTI Version=\"1.0\">" +
                                   array("POINTSET", "FLOAT32", 4, points) +
                                   array("TRIANGLE", "INT32", 2, faces) + "</GIFTI>");
  };
  const auto check = [](const TriangleMesh& mesh) {
    CHECK(mesh.xyz == std::vector<double>{0, 0, 0, -1, 0, 0, -1, -1, 0, 0, -1, 0.5});
    CHECK(mesh.abc == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  };
  using plc::tools::encode_base64;
  const std::string rows = "RowMajorOrder";
  const std::string p = samples::raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5F});
  const std::string f = samples::raw<int32_t>({0, 1, 2, 0, 2, 3});
  check(read_mesh(file("ASCII", rows, kCorners, "0 1 2 0 2 3")));
  check(read_mesh(file("ASCII", "ColumnMajorOrder", "0 1 1 0 0 0 1 1 0 0 0 0.5", "0 0 1 2 2 3")));
  check(read_mesh(file("Base64Binary", rows, encode_base64(p), encode_base64(f))));
  check(read_mesh(file("GZipBase64Binary", rows, encode_base64(samples::deflated(p, false)),
                       encode_base64(samples::deflated(f, false)))));
  const auto refused = [&](const std::string& path, const std::string& why) {
    CHECK_THAT(failure_of([&] { read_mesh(path); }), Catch::Contains(why));
  };
  refused(file("ExternalFileBinary", rows, "", ""), "encoding that is not read");
  refused(file("ASCII", rows, kCorners, "0 1 2 0 2"), "is truncated");
  refused(file("ASCII", rows, kCorners, "0 1 2 0 2 4"), "refers to vertex 4 of 4");
  refused(file("ASCII", rows, kCorners, "0 1 2 0 2 -1"), "refers to no vertex");
  refused(file("Base64Binary", rows, encode_base64(p.substr(4)), ""), "is truncated");
  refused(file("GZipBase64Binary", rows, encode_base64(p), ""), "cannot be decompressed");
  refused(folder.put("b.gii", "<?xml version=\"1.0\"?><GIFTI/>"), "holds no surface");
  refused(folder.put("b.gii", "<?xml version=\"1.0\"?><VTKFile/>"), "is not a GIFTI file");
}

TEST_CASE("VTK's legacy files are read as text, and with the cells of version 5",
          "[mesh_formats]") {
  const fixtures::Folder folder;
  const auto check = [](const TriangleMesh& mesh) {
    CHECK(mesh.xyz == std::vector<double>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5});
    CHECK(mesh.abc == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  };
  const auto head = [](const std::string& version, const std::string& encoding) {
    return "# vtk DataFile Version " + version + "\nwritten by SPACE=RAS\n" + encoding +
           "\nDATASET POLYDATA\nPOINTS 4 float\n";
  };
  const std::string values =
      "POINT_DATA 4\nSCALARS Speed float\nLOOKUP_TABLE default\n1 2 3 4\nFIELD FieldData 1\n"
      "Heat 1 4 double\n5 6 7 8\nMETADATA\nINFORMATION 0\n\nCELL_DATA 1\nSCALARS a int\n";
  const TriangleMesh mesh = read_mesh(folder.put(
      "a.vtk", head("3.0", "ASCII") + kCorners + "\nPOLYGONS 1 5\n4 0 1 2 3\n" + values));
  check(mesh);
  CHECK(mesh.space == "RAS");
  REQUIRE(mesh.scalars.size() == 2);
  CHECK(mesh.scalars[0].values == std::vector<float>{1, 2, 3, 4});
  CHECK(mesh.scalars[1].name == "Heat");
  CHECK(mesh.scalars[1].values == std::vector<float>{5, 6, 7, 8});
  check(read_mesh(folder.put("a.vtk", head("5.1", "ASCII") + kCorners +
                                          "\nMETADATA\nINFORMATION 0\n\nPOLYGONS 2 4\nOFFSETS "
                                          "vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n"
                                          "0 1 2 3\n")));
  const TriangleMesh strip = read_mesh(
      folder.put("a.vtk", head("3.0", "ASCII") + kCorners + "\nTRIANGLE_STRIPS 1 5\n4 0 1 2 3\n"));
  CHECK(strip.abc == std::vector<uint32_t>{0, 1, 2, 1, 3, 2});
  const auto refused = [&](const std::string& text, const std::string& why) {
    CHECK_THAT(failure_of([&] { read_mesh(folder.put("b.vtk", text)); }), Catch::Contains(why));
  };
  refused("# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\n", "POLYDATA");
  refused("VTK\n\nASCII\n", "not a file of VTK");
  refused(head("3.0", "ASCII") + kCorners + "\nPOLYGONS 2 5\n4 0 1 2 3\n", "do not fit");
  refused(head("3.0", "ASCII") + kCorners + "\nPOLYGONS 1 5\n5 0 1 2 3\n", "do not fit");
  refused(head("3.0", "ASCII") + kCorners + "\nPOLYGONS 1 4\n3 0 1 4\n", "not there");
  refused(head("3.0", "BINARY") + "abc", "truncated");
  refused(
      "# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 9000000000000000000 float\n",
      "truncated");
}

TEST_CASE("A GLB holds the mesh, its place in metres, its values and their colours",
          "[mesh_formats]") {
  const fixtures::Folder folder;
  TriangleMesh mesh = cube("LPS");
  const size_t vertices = mesh.xyz.size() / 3;
  std::vector<float> heights, labels;
  for (size_t v = 0; v < vertices; ++v) {
    heights.push_back(static_cast<float>(v));
    labels.push_back(static_cast<float>(1 + v % 2));
  }
  heights.back() = std::numeric_limits<float>::quiet_NaN();
  mesh.scalars = {{"Height", heights}};
  write_mesh(folder / "a.glb", mesh);
  const Glb glb = parts_of(fixtures::contents(folder / "a.glb"));
  CHECK(glb.json["buffers"][0]["byteLength"] == glb.block.size());
  CHECK(attribute(glb, "POSITION") ==
        samples::raw(std::vector<float>(mesh.xyz.begin(), mesh.xyz.end())));
  CHECK(attribute(glb, "indices") == samples::raw(mesh.abc));
  heights.back() = 0;
  CHECK(attribute(glb, "_HEIGHT") == samples::raw(heights));
  const std::string colours = attribute(glb, "COLOR_0");
  REQUIRE(colours.size() == 4 * vertices);
  CHECK(colours.substr(0, 4) != colours.substr(4, 4));
  CHECK(glb.json["accessors"][0]["min"] == nlohmann::json({1, 2, 3}));
  CHECK(glb.json["accessors"][0]["max"] == nlohmann::json({2, 3, 4}));
  // To the left is x, to the head y, to the front z: (1, 2, 3) mm is (1, 3, -2) / 1000.
  const std::vector<double> m = glb.json["nodes"][0]["matrix"];
  REQUIRE(m.size() == 16);
  CHECK(1 * m[0] + 2 * m[4] + 3 * m[8] == Approx(0.001));
  CHECK(1 * m[1] + 2 * m[5] + 3 * m[9] == Approx(0.003));
  CHECK(1 * m[2] + 2 * m[6] + 3 * m[10] == Approx(-0.002));

  mesh.scalars = {{plc::tools::Scalars::kLabels, labels}};
  write_mesh(folder / "b.glb", mesh);
  const std::string two = attribute(parts_of(fixtures::contents(folder / "b.glb")), "COLOR_0");
  CHECK(two.substr(0, 4) == two.substr(8, 4));
  CHECK(two.substr(0, 4) != two.substr(4, 4));

  mesh.scalars = {{"Height", heights}, {"height", labels}};
  write_mesh(folder / "c.glb", mesh);
  const Glb both = parts_of(fixtures::contents(folder / "c.glb"));
  CHECK(attribute(both, "_HEIGHT") == samples::raw(heights));
  CHECK(attribute(both, "_HEIGHT_2") == samples::raw(labels));

  write_mesh(folder / "empty.glb", {});
  CHECK(parts_of(fixtures::contents(folder / "empty.glb")).block.empty());
}

TEST_CASE("Formats that are written only say so, and those without doubles refuse them",
          "[mesh_formats]") {
  const fixtures::Folder folder;
  TriangleMesh mesh = cube("LPS");
  for (const std::string suffix : {".glb", ".3mf"}) {
    write_mesh(folder / ("a" + suffix), mesh);
    CHECK_THAT(failure_of([&] { read_mesh(folder / ("a" + suffix)); }),
               Catch::Contains("is written only"));
  }
  CHECK(fixtures::contents(folder / "a.3mf").substr(0, 4) == "PK\3\4");
  mesh.doubles = true;
  for (const std::string suffix : {".glb", ".gii"}) {
    CHECK_THAT(failure_of([&] { write_mesh(folder / ("b" + suffix), mesh); }),
               Catch::Contains("has no doubles"));
  }
  CHECK(folder.file_count() == 2);
}

TEST_CASE("The same mesh makes the same bytes in every format", "[mesh_formats]") {
  const fixtures::Folder folder;
  for (const std::string suffix : {".glb", ".3mf", ".gii", ".vtk"}) {
    write_mesh(folder / ("a" + suffix), cube("LPS"));
    write_mesh(folder / ("b" + suffix), cube("LPS"));
    CHECK(fixtures::contents(folder / ("a" + suffix)) ==
          fixtures::contents(folder / ("b" + suffix)));
  }
}

TEST_CASE("Labels have colours of their own, and no value is grey", "[mesh_formats]") {
  using plc::tools::label_colour;
  using plc::tools::value_colour;
  for (int32_t a = 0; a < 30; ++a) {
    for (int32_t b = 0; b < a; ++b) CHECK(label_colour(a) != label_colour(b));
    for (const double part : label_colour(a)) CHECK((part >= 0 && part <= 1));
  }
  CHECK(value_colour(std::numeric_limits<double>::quiet_NaN()) == label_colour(0));
  CHECK(value_colour(-1) == value_colour(0));
  CHECK(value_colour(0)[2] > value_colour(0)[1]);
  CHECK(value_colour(2)[0] > value_colour(2)[2]);
}

TEST_CASE("Labels are integers by that name, whatever a file says", "[mesh_formats]") {
  using plc::tools::Scalars;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(Scalars{"Label", {1, -3, nan}}.are_labels());
  CHECK(Scalars{"tissue_labels", {1, 2}}.are_labels());
  CHECK_FALSE(Scalars{"Label", {1, 1.5F}}.are_labels());
  CHECK_FALSE(Scalars{"Label", {1, 1e20F}}.are_labels());
  CHECK_FALSE(Scalars{"Height", {1, 2}}.are_labels());
  const fixtures::Folder folder;
  TriangleMesh mesh = cube("LPS");
  std::vector<float> wild(mesh.xyz.size() / 3, 1e20F);
  wild[0] = nan;
  mesh.scalars = {{"Label", wild}};
  write_mesh(folder / "a.gii", mesh);
  CHECK(read_mesh(folder / "a.gii").scalars[0].values[1] == 1e20F);
  wild.assign(wild.size(), 4);
  wild[0] = nan;
  mesh.scalars = {{"Label", wild}};
  write_mesh(folder / "b.gii", mesh);
  CHECK(read_mesh(folder / "b.gii").scalars[0].values[0] == 0);
}

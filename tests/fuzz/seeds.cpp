// fuzz_seeds FOLDER: what libFuzzer starts from, FOLDER/TARGET/NAME: small valid files for the
// readers, random bytes for the targets of the C API.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/samples/sample_files.h"
#include "tests/samples/sample_meshes.h"
#include "tests/samples/sample_volumes.h"
#include "tests/samples/sample_zarr.h"
#include "tools/mesh/mesh_io.h"

namespace {

using plc::tools::TriangleMesh;

class Seeds {
 public:
  explicit Seeds(const std::string& folder) : folder_(folder) {}

  void put(const std::string& target, const std::string& name, const std::string& bytes) const {
    std::ofstream(path(target, name), std::ios::binary) << bytes;
  }
  std::string path(const std::string& target, const std::string& name) const {
    std::filesystem::create_directories(folder_ / target);
    return (folder_ / target / name).string();
  }

 private:
  std::filesystem::path folder_;
};

void put_meshes(const Seeds& seeds) {
  const samples::Soup soup = samples::cube();
  TriangleMesh mesh;
  mesh.xyz = soup.xyz;
  mesh.abc.assign(soup.abc.begin(), soup.abc.end());
  for (const std::string name : {"plain", "normals", "scalars"}) {
    if (name == "normals") mesh.normals.assign(mesh.xyz.size(), 0.5F);
    if (name == "scalars") mesh.scalars = {{"Speed", std::vector<float>(mesh.xyz.size() / 3, 2)}};
    for (const std::string format : {"gii", "obj", "off", "ply", "stl", "vtk", "vtp"}) {
      const std::string file = name + "." + format;
      if (name == "scalars" && !plc::tools::holds_scalars(file)) continue;
      plc::tools::write_mesh(seeds.path(format == "gii" ? "mesh_gifti" : "mesh_" + format, file),
                             mesh);
    }
  }
  seeds.put(
      "mesh_gifti", "ascii.gii",
      "<?xml version=\"1.0\"?><GIFTI><MetaData><MD><Name>SPACE</Name><Value>voxel</Value></MD>"
      "</MetaData><DataArray Intent=\"NIFTI_INTENT_POINTSET\" DataType=\"NIFTI_TYPE_FLOAT32\" "
      "ArrayIndexingOrder=\"ColumnMajorOrder\" Dim0=\"3\" Dim1=\"3\" Encoding=\"ASCII\"><Data>"
      "0 1 0 0 0 1 0 0 0</Data></DataArray><DataArray Intent=\"NIFTI_INTENT_TRIANGLE\" "
      "DataType=\"NIFTI_TYPE_INT32\" Dim0=\"1\" Dim1=\"3\" Encoding=\"Base64Binary\"><Data>"
      "AAAAAAEAAAACAAAA</Data></DataArray></GIFTI>\n");
  const std::string vtk =
      "ASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0.5\nMETADATA\nA 0\n\n";
  const std::string values =
      "POINT_DATA 4\nSCALARS Speed float 1\nLOOKUP_TABLE default\n1 2 3 4\nFIELD FieldData 1\n"
      "Heat 1 4 double\n5 6 7 8\nNORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1\nCELL_DATA 1\n";
  seeds.put("mesh_vtk", "old.vtk",
            "# vtk DataFile Version 3.0\nSPACE=RAS\n" + vtk +
                "POLYGONS 1 5\n4 0 1 2 3\nTRIANGLE_STRIPS 1 5\n4 0 1 2 3\n" + values);
  seeds.put("mesh_vtk", "new.vtk",
            "# vtk DataFile Version 5.1\n\n" + vtk +
                "POLYGONS 2 4\nOFFSETS vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n0 1 2 3\n");
  const std::string points = "v 0 0 0\nv 1 0 0 # c\nv 1 1 0 1.0\nv 0 1 0.5\nvn 0 0 1\n";
  seeds.put("mesh_obj", "corners.obj",
            points + "f 1/5 2/6 3/7 4/8\nf 1//1 2//1 3//1\nf -4 -3 -2 -1\nf 1/1/1 2/1/1 3/1/1\n");
  seeds.put("mesh_off", "colours.off",
            "COFF # c\n4 1 0\n0 0 0 255 0 0\n1 0 0 255 0 0\n\n1 1 0 9 9 9\n0 1 0.5 1 1 1\n"
            "4 0 1 2 3 0.5 0.5 0.5\n");
  seeds.put("mesh_ply", "ascii.ply",
            "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty uchar red\n"
            "property double x\nproperty float y\nproperty float z\nelement other 2\n"
            "property list uchar short l\nelement face 1\nproperty int id\n"
            "property list uchar int vertex_index\nend_header\n"
            "9 0 0 0\n9 1 0 0\n9 1 1 0\n9 0 1 0.5\n2 7 7\n0\n5 4 0 1 2 3\n");
  seeds.put("mesh_ply", "big.ply",
            "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty char x\n"
            "property short y\nproperty ushort z\nelement face 1\n"
            "property list uint uchar vertex_indices\nend_header\n" +
                std::string("\0\0\0\0\1\1\0\0\0\0\0\0\0\1\0\0\0\0\3\0\1\2", 22));
  seeds.put("mesh_stl", "ascii.stl",
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
            "endloop\nendfacet\nendsolid a\n");
}

// One array as the file says, the other two as ASCII.
std::string vtp(const std::string& attributes, const std::string& points,
                const std::string& appended) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" " +
         attributes +
         "><PolyData><Piece NumberOfPoints=\"3\"><Points><DataArray type=\"Float32\" " +
         "NumberOfComponents=\"3\" " + points +
         "</DataArray></Points><Polys><DataArray type=\"Int32\" Name=\"connectivity\" "
         "format=\"ascii\">0 1 2</DataArray><DataArray type=\"Int32\" Name=\"offsets\" "
         "format=\"ascii\">3</DataArray></Polys></Piece></PolyData>" +
         appended + "</VTKFile>\n";
}

void put_packed_meshes(const Seeds& seeds) {
  const std::string data = samples::raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto size = static_cast<uint32_t>(data.size());
  const std::string block = samples::deflated(data, false);
  const std::string sizes =
      samples::raw<uint32_t>({1, size, 0, static_cast<uint32_t>(block.size())});
  const std::string zlib = "compressor=\"vtkZLibDataCompressor\"";
  const auto appended = [](const std::string& encoding, const std::string& bytes) {
    return "<AppendedData encoding=\"" + encoding + "\">_" + bytes + "</AppendedData>";
  };
  const std::string at_0 = "format=\"appended\" offset=\"0\">";
  seeds.put("mesh_vtp", "ascii.vtp", vtp("", "format=\"ascii\">0 0 0 1 0 0 0 1 0", ""));
  seeds.put(
      "mesh_vtp", "base64.vtp",
      vtp("", "format=\"binary\">JAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAA==", ""));
  seeds.put("mesh_vtp", "raw.vtp",
            vtp("", at_0, appended("raw", samples::raw<uint32_t>({size}) + data)));
  seeds.put("mesh_vtp", "zlib.vtp", vtp(zlib, at_0, appended("raw", sizes + block)));
}

void put_inv3(const Seeds& seeds) {
  const std::string shape = "<integer>3</integer><integer>4</integer><integer>5</integer>";
  const std::string voxels(2 * 60, 'a');
  const std::string project =
      samples::tar({{"a/matrix.dat", voxels}, {"a/main.plist", samples::plist("int16", shape)}});
  seeds.put("inv3", "plain.inv3", project);
  seeds.put("inv3", "gzip.inv3", samples::deflated(project, true));
}

// As the volume targets take them apart from the end: no odd geometry, the dimensions with the
// byte that makes them small, three axes, the component.
std::string with_header(const std::string& file, uint8_t component) {
  std::string out = file + '\1';
  for (const char dim : {'\3', '\4', '\5'}) {
    out += dim;
    out += '\2';
  }
  out += '\1';
  return out + static_cast<char>(component);
}

void put_volumes(const Seeds& seeds) {
  constexpr uint8_t kI16 = 3;
  const std::string voxels(2 * 60, 'a');
  const std::string floats = samples::raw(std::vector<float>(60, 0.5F));
  const std::string nifti = samples::nifti({5, 4, 3}, 4, 16, voxels);
  // The byte behind the file chooses the frame.
  seeds.put("volume_nifti", "plain", nifti + '\1');
  seeds.put("volume_nifti", "gzip", samples::deflated(nifti, true) + '\2');
  seeds.put("volume_nifti", "float",
            samples::nifti({5, 4, 3}, 16, 32, floats) + std::string(1, '\0'));
  const std::string packed = samples::deflated(voxels, false);
  const std::string fields =
      "ObjectType = Image\nNDims = 3\nDimSize = 5 4 3\nBinaryData = True\n"
      "ElementType = MET_SHORT\n";
  seeds.put("volume_meta", "plain",
            with_header(fields + "ElementDataFile = LOCAL\n" + voxels, kI16));
  seeds.put("volume_meta", "packed",
            with_header(fields + "CompressedData = True\nCompressedDataSize = " +
                            std::to_string(packed.size()) + "\nElementDataFile = LOCAL\n" + packed,
                        kI16));
  seeds.put("volume_meta", "list", with_header(fields + "ElementDataFile = LIST\na\nb\n", kI16));
  seeds.put("volume_meta", "pattern",
            with_header(fields + "ElementDataFile = a%03d.raw 1 3 1\n", kI16));
  const std::string nrrd = "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 4 3\nencoding: ";
  seeds.put("volume_nrrd", "raw", with_header(nrrd + "raw\n\n" + voxels, kI16));
  seeds.put("volume_nrrd", "gzip",
            with_header(nrrd + "gzip\n\n" + samples::deflated(voxels, true), kI16));
  seeds.put("volume_nrrd", "detached", with_header(nrrd + "raw\ndata file: a.raw\n", kI16));
  seeds.put(
      "volume_tiff", "pages",
      with_header(samples::tiff(5, 4, 16, 2, std::vector<std::string>(3, std::string(40, 'a'))),
                  kI16));
}

std::string parts_of(const samples::ZarrMemory& store) {
  std::string text;
  for (const auto& [key, value] : store.values) text += key + "\n----\n" + value + "\n----\n";
  return text;
}

void put_zarr(const Seeds& seeds) {
  const samples::ZarrMemory sharded = samples::sharded_zarr(
      {9, 5, 3}, [](int64_t x, int64_t y, int64_t z) { return static_cast<uint16_t>(x + y + z); });
  seeds.put("volume_zarr", "sharded", parts_of(sharded));
  const std::string voxels(48, 'a');
  const auto packed = plc::tools::zarr_compress("", std::as_bytes(std::span(voxels)), 2);
  samples::ZarrMemory old;
  old.values[".zattrs"] =
      R"({"multiscales": [{"axes": ["z", "y", "x"], "datasets": [{"path": "0",)"
      R"("coordinateTransformations": [{"type": "scale", "scale": [1, 2, 3]}]}]}]})";
  for (const std::string id : {"blosc", "zstd", "zlib"}) {
    old.values["0/.zarray"] =
        R"({"zarr_format": 2, "shape": [4, 2, 3], "chunks": [4, 2, 3], "dtype": ">i2",
        "fill_value": -1, "order": "F", "filters": [], "compressor": {"id": ")" +
        id + "\"}}";
    old.values["0/0.0.0"] =
        id == "blosc"  ? std::string(reinterpret_cast<const char*>(packed.data()), packed.size())
        : id == "zstd" ? samples::zstd_frame(voxels)
                       : samples::deflated(voxels, false);
    seeds.put("volume_zarr", id, parts_of(old));
  }
}

void put_texts(const Seeds& seeds) {
  seeds.put("attach", "places",
            "# places\nattach 1 2.5 -3 4\nattach 1 2 3 4 50\npin 0 0 0 1e3 # still\n");
  const auto words = [](const std::string& text) {
    std::string out = text;
    for (char& c : out) c = c == ' ' ? '\0' : c;
    return out;
  };
  seeds.put("options", "ct", words("in.nii -o out.ply --iso 226 --levels 2 --space ras"));
  seeds.put("options", "starts",
            words("in.nii -o out.ply --init seeds=1,2,3,4;5,6,7,8 --force both"));
  seeds.put("options", "values",
            words("in.nii -o out.ply --iso 1,2,3 --level-iso 1,2,3,4 --window 0,1 --rest-length "
                  "1.5 --init bubbles=3,3,3 --bound scale --threads 2"));
  seeds.put("options", "structures",
            words("in.nii -o out.ply --structure") + '\0' + "skin=--iso -200 --curvature 0.1" +
                '\0' + words("--structure bone=--iso=226 --quiet"));
}

// What the targets of the C API make calls of: no bytes are wrong.
void put_random(const Seeds& seeds) {
  constexpr size_t kBytes = 300;
  samples::Random random(1);
  for (const std::string target : {"api", "mesh", "state", "evolution"}) {
    for (int i = 0; i < 24; ++i) {
      std::string bytes(kBytes, '\0');
      for (char& byte : bytes) byte = static_cast<char>(random.bits() >> 56);
      seeds.put(target, std::to_string(i), bytes);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n");
    return 2;
  }
  const Seeds seeds(argv[1]);
  put_meshes(seeds);
  put_packed_meshes(seeds);
  put_inv3(seeds);
  put_volumes(seeds);
  put_zarr(seeds);
  put_texts(seeds);
  put_random(seeds);
  return 0;
}

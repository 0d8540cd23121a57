// Readers that are ours from the first byte on: meshes, InVesalius projects, places to attach to.
#include <algorithm>
#include <string>
#include <string_view>

#include "tests/fuzz/input.h"
#include "tests/fuzz/refusal.h"
#include "tools/command/attach_file.h"
#include "tools/mesh/mesh_io_formats.h"
#include "tools/volume/inv3.h"
#include "tools/volume/volume_io_memory.h"

namespace fuzz {

namespace {

using plc::tools::LoadedVolume;
using plc::tools::TriangleMesh;

const std::string kPath = "a.mesh";

void check_mesh(const TriangleMesh& mesh) {
  require(mesh.xyz.size() % 3 == 0, "a vertex without all its coordinates");
  require(mesh.abc.size() % 3 == 0, "a face without all its corners");
  const size_t vertices = mesh.xyz.size() / 3;
  require(std::all_of(mesh.abc.begin(), mesh.abc.end(), [&](uint32_t v) { return v < vertices; }),
          "a face of a vertex that is not there");
  require(mesh.normals.empty() || mesh.normals.size() == mesh.xyz.size(),
          "normals of some vertices only");
  require(std::all_of(mesh.scalars.begin(), mesh.scalars.end(),
                      [&](const auto& scalars) { return scalars.values.size() == vertices; }),
          "values at some vertices only");
}

using Reader = TriangleMesh (*)(const std::string& path, std::string_view data);

void read_mesh(Reader reader, Bytes file) {
  read_or_refuse(kPath, [&] {
    check_mesh(reader(kPath, {reinterpret_cast<const char*>(file.data()), file.size()}));
  });
}

}  // namespace

void mesh_obj(Bytes file) {
  read_mesh(plc::tools::read_obj, file);
}
void mesh_off(Bytes file) {
  read_mesh(plc::tools::read_off, file);
}
void mesh_ply(Bytes file) {
  read_mesh(plc::tools::read_ply, file);
}
void mesh_stl(Bytes file) {
  read_mesh(plc::tools::read_stl, file);
}
void mesh_vtp(Bytes file) {
  read_mesh(plc::tools::read_vtp, file);
}

void inv3(Bytes file) {
  static const ScratchFile scratch;
  scratch.put(file);
  read_or_refuse(scratch.path(), [&] {
    const LoadedVolume volume = plc::tools::read_inv3(scratch.path());
    const int64_t count = plc::tools::checked_voxel_count(scratch.path(), volume.image.dims);
    require(volume.bytes.size() ==
                static_cast<size_t>(count) * plc::tools::voxel_size(volume.image.type),
            "voxels that are not as many as the image has");
  });
}

void attach(Bytes file) {
  static const ScratchFile scratch;
  scratch.put(file);
  read_or_refuse(scratch.path(), [&] {
    const plc::tools::AttachFile places = plc::tools::read_attach_file(scratch.path());
    require(!places.attachments.empty() || !places.pins.empty(), "a file of no places");
    for (const plc_attachment& a : places.attachments) {
      require(a.radius > 0 && a.strength > 0, "an attachment without radius or strength");
    }
    for (const plc_pin& p : places.pins) require(p.radius > 0, "a pin without radius");
  });
}

}  // namespace fuzz

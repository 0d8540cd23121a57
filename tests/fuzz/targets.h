// The fuzz targets: functions that take any bytes. What they find is a crash, the report of a
// sanitizer, or Broken. Each has a program of its own under libFuzzer (tools/fuzz), and
// test_fuzz_corpus runs all of them over what was once wrong.
#pragma once
#include <cstdint>
#include <span>
#include <stdexcept>

namespace fuzz {

using Bytes = std::span<const uint8_t>;

// Something that must not be.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The C API: any calls with any arguments; any mesh; saved states, altered; an evolution step by
// step, which is interrupted, saved and restored.
void api(Bytes bytes);
void mesh(Bytes bytes);
void state(Bytes bytes);
void evolution(Bytes bytes);

// Readers of the tools: the bytes are a file.
void mesh_gifti(Bytes file);
void mesh_obj(Bytes file);
void mesh_off(Bytes file);
void mesh_ply(Bytes file);
void mesh_stl(Bytes file);
void mesh_vtk(Bytes file);
void mesh_vtp(Bytes file);
void inv3(Bytes file);
void attach(Bytes file);

// A file of a volume, and behind it the header that a format's library may have made of it: what
// stands between that header and the memory for its voxels.
void volume_nifti(Bytes input);
void volume_meta(Bytes input);
void volume_nrrd(Bytes input);
void volume_tiff(Bytes input);

// A Zarr hierarchy, value by value: see sample_zarr.h's ZarrMemory.
void volume_zarr(Bytes values);

// Words of a command line of `pellicle extract`, separated by zeros.
void options(Bytes words);

struct Target {
  const char* name;
  void (*run)(Bytes);
};

inline constexpr Target kTargets[] = {
    {"api", api},
    {"mesh", mesh},
    {"state", state},
    {"evolution", evolution},
#ifdef PELLICLE_FUZZ_READERS
    {"mesh_gifti", mesh_gifti},
    {"mesh_obj", mesh_obj},
    {"mesh_off", mesh_off},
    {"mesh_ply", mesh_ply},
    {"mesh_stl", mesh_stl},
    {"mesh_vtk", mesh_vtk},
    {"mesh_vtp", mesh_vtp},
    {"inv3", inv3},
    {"attach", attach},
    {"volume_nifti", volume_nifti},
    {"volume_meta", volume_meta},
    {"volume_nrrd", volume_nrrd},
    {"volume_tiff", volume_tiff},
    {"volume_zarr", volume_zarr},
    {"options", options},
#endif
};

}  // namespace fuzz

// OME-Zarr: images of several resolutions, version 0.4 (on Zarr 2) and 0.5 (on Zarr 3), and plain
// Zarr arrays of three axes.
#pragma once
#include <string>
#include <vector>

#include "tools/volume/volume_io.h"
#include "tools/volume/volume_io_itk.h"
#include "tools/volume/zarr_array.h"

namespace plc::tools {

// Whether a folder is a Zarr hierarchy, whatever it is called.
bool is_zarr_folder(const std::string& path);

// A folder's image and which of its resolutions is meant; "": the finest, or the folder is a plain
// array.
struct OmeZarrPlace {
  std::string root, dataset;
};
OmeZarrPlace find_ome_zarr(const std::string& path);

// The array of the first, finest resolution, and where its voxels lie: the last axis is x where
// axes have no names. Lengths become mm where the axes have units. `space`: the axes of the array
// that are those of the volume, x first; the others are of length 1.
struct OmeZarrImage {
  ZarrArray array;
  ItkHeader header;
  std::array<size_t, 3> space{};
};
// dataset: another resolution than the finest, by its path; Failure where the image has none such.
// Throws Failure: damaged, more than one channel or time, or not supported.
OmeZarrImage open_ome_zarr(const ZarrStore& store, const std::string& dataset = "");

// All voxels, on as many threads as the machine has. A path may lead to one resolution in the
// image: "head.ome.zarr/2". Throws Failure.
LoadedVolume read_ome_zarr(const std::string& path);
LoadedVolume read_ome_zarr(const ZarrStore& store, const OmeZarrImage& image, int threads);

}  // namespace plc::tools

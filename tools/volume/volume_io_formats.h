// What read_volume() dispatches to. All throw Failure.
#pragma once
#include <string>
#include <vector>

#include "tools/volume/volume_io.h"
#include "tools/volume/volume_io_itk.h"

namespace plc::tools {

// A file of one of ITK's formats that holds the whole volume.
LoadedVolume read_itk_volume(const std::string& path, ItkFormat format);

// A folder: the largest DICOM series of it, or else its TIFF files as slices in the order of their
// names (numbers by value).
LoadedVolume read_folder(const std::string& path);

// Values are scaled as the header says; NaN and infinity are refused.
LoadedVolume read_nifti(const std::string& path, NiftiFrame frame);

// Voxels of any type as one the engine takes: i8 as i16; u32, i64, u64 as i32 where all fit, else
// as f32; f64 as f32; the others as they are. Geometry from the header (its first three axes).
LoadedVolume volume_from(const std::string& path, const ItkHeader& header, SharedBytes voxels);

// An image of the header's geometry, without voxels.
plc_image image_from(const ItkHeader& header, plc_voxel_type type);

// Memory for the header's voxels as they are in the file; Failure where what they and their
// conversion need is not there.
SharedBytes allocate_voxels(const std::string& path, const ItkHeader& header);

// The header as one of three axes: axes of size 1 at the end are dropped. Failure where it is not
// 3-D, or where its spacing or direction is no geometry.
ItkHeader checked_header(const std::string& path, ItkHeader header);

// Failure where ITK would not come to an end with the header.
void check_first(const std::string& path, ItkFormat format);

// Failure unless the file holds what its header says, or can hold it where it is packed: before
// memory is taken for it, and because ITK does not look in all formats.
void check_file_size(const std::string& path, ItkFormat format, const ItkHeader& header);

}  // namespace plc::tools

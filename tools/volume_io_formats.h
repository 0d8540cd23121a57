// What read_volume() dispatches to. All throw Failure.
#pragma once
#include <string>
#include <vector>

#include "tools/volume_io.h"
#include "tools/volume_io_itk.h"

namespace plc::tools {

// A file of one of ITK's formats that holds the whole volume.
LoadedVolume read_itk_volume(const std::string& path, ItkFormat format);

// A folder: the largest DICOM series of it, or else its TIFF files as slices in the order of their
// names (numbers by value).
LoadedVolume read_folder(const std::string& path);

// The voxels of an uncompressed NIfTI-1 file whose values are what is stored, little endian; false,
// and nothing is read, for any other. Failure where the file ends early.
bool read_plain_nifti(const std::string& path, const ItkHeader& header, std::byte* voxels);

// Voxels of any type as one the engine takes: i8 as i16; u32, i64, u64 as i32 where all fit, else
// as f32; f64 as f32; the others as they are. Geometry from the header (its first three axes).
LoadedVolume volume_from(const std::string& path, const ItkHeader& header,
                         std::vector<std::byte> voxels);

// Memory for the header's voxels as they are in the file; Failure where what they and their
// conversion need is not there.
std::vector<std::byte> allocate_voxels(const std::string& path, const ItkHeader& header);

// The header as one of three axes: axes of size 1 at the end are dropped. Failure where it is not
// 3-D, or where its spacing or direction is no geometry.
ItkHeader checked_header(const std::string& path, ItkHeader header);

// Failure unless the file holds what its header says, or can hold it where it is packed: before
// memory is taken for it, and because ITK does not look in all formats.
void check_file_size(const std::string& path, ItkFormat format, const ItkHeader& header);

}  // namespace plc::tools

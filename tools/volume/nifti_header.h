// The header of a NIfTI file, version 1 or 2, in either order of bytes, packed by gzip or not. Read
// by ourselves: ITK knows no version 2 and refuses files whose sform shears.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace plc::tools {

struct NiftiHeader {
  bool big_endian = false;
  std::vector<int64_t> dims;  // as many as the file has, each >= 1
  int datatype = 0;           // DT_UINT8 ...
  uint64_t offset = 0;        // of the voxels, bytes
  // A value is slope * voxel + intercept; 1 and 0 where the header asks for no scaling.
  double slope = 1;
  double intercept = 0;

  // Where the voxels lie, in the header's units.
  int units = 0;  // xyzt_units
  int qform_code = 0;
  int sform_code = 0;
  std::array<double, 4> pixdim{};  // qfac, then the sides of a voxel
  std::array<double, 6> qform{};   // b, c, d of the quaternion, then the place of the first voxel
  std::array<double, 12> sform{};  // rows of the affine to RAS
};

// Throws Failure where it is none.
NiftiHeader read_nifti_header(const std::string& path);

}  // namespace plc::tools

// Where the voxels of a NIfTI file lie, as nibabel, SPM, FSL and MRIcroGL have it.
#pragma once
#include <string>
#include <vector>

#include "tools/volume/nifti_header.h"
#include "tools/volume/volume_io_itk.h"

namespace plc::tools {

// What --nifti-frame names.
enum class NiftiFrame {
  kAuto,   // the sform where it has a code, else the qform where that has one, else neither
  kSform,  // Failure where it has no code
  kQform
};

// Sets spacing, origin and direction of `header`, in LPS and mm; the columns of the direction need
// not be perpendicular. With neither form voxels are as long as the file says, their first axis
// runs to the left, and the centre of the image is the origin. Lengths in metres or microns, where
// the file says so, become mm. Returns lines about what a user should know. Throws Failure where
// the form that is used is no frame.
std::vector<std::string> place_nifti(const std::string& path, const NiftiHeader& nifti,
                                     NiftiFrame wanted, ItkHeader& header);

}  // namespace plc::tools

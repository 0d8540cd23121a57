// Names and colours of labels: the lookup tables that lie beside label images.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace plc::tools {

struct LabelEntry {
  std::string name;                           // UTF-8 without control characters
  std::optional<std::array<uint8_t, 3>> rgb;  // sRGB, where the table has colours
};

using LabelEntries = std::map<int32_t, LabelEntry>;

// By what stands in the file, whatever its name:
//   FreeSurfer, 3D Slicer   7 Left-Putamen 236 13 176 0     the names may have spaces in them
//   ITK-SNAP                7 236 13 176 1 1 1 "Left Putamen"
//   AAL and others          7 Left-Putamen 2001             the code is left out, or not there
//   AAL of SPM              PUT_L Left-Putamen 2001         the code is the label
//   MRIcron's .lut          256 bytes of red, of green and of blue: colours without names
// Lines that begin with # or // are comments. Of a label that is there twice the first line counts.
// Throws Failure, one line that names the file and the line, where it is none of them.
LabelEntries read_label_names(const std::string& path);

// The tables that belong to an image by their names: of atlas.nii.gz those that begin with `atlas`
// or `atlas.nii` and end with .label, .ctbl, .txt or .lut, and FreeSurferColorLUT.txt in its
// folder. Those that have names come before those of colours alone.
std::vector<std::string> label_tables_beside(const std::string& image);

// The names and colours of the tables that lie beside the image: what one has not, the next one may
// have. A table that cannot be read is passed over, and a line of why is added to `warnings`.
LabelEntries label_names_beside(const std::string& image, std::vector<std::string>& warnings);

}  // namespace plc::tools

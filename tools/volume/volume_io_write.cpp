// write_volume(): NRRD and MetaImage, uncompressed, little endian, and OME-Zarr, packed.
#include <bit>
#include <charconv>
#include <filesystem>

#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"
#include "tools/file/path_suffix.h"
#include "tools/volume/ome_zarr_write.h"
#include "tools/volume/volume_io.h"
#include "tools/volume/volume_io_memory.h"

namespace plc::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "voxels are written as they are");

std::string text_of(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

// `items` values `stride` apart.
std::string joined(const double* values, int items, int stride, const char* separator) {
  std::string text;
  for (int i = 0; i < items; ++i) {
    if (i > 0) text += separator;
    text += text_of(values[i * stride]);
  }
  return text;
}

std::string sizes(const plc_image& image) {
  return std::to_string(image.dims[0]) + ' ' + std::to_string(image.dims[1]) + ' ' +
         std::to_string(image.dims[2]);
}

std::string nrrd_header(const plc_image& image) {
  static const char* const types[] = {"uint8", "int16", "uint16", "int32", "float"};
  std::string text = "NRRD0004\n# Written by Pellicle\ntype: ";
  text += types[image.type];
  text += "\ndimension: 3\nspace: left-posterior-superior\nsizes: " + sizes(image);
  text += "\nspace directions:";
  for (int axis = 0; axis < 3; ++axis) {
    double step[3];
    for (int row = 0; row < 3; ++row) {
      step[row] = image.direction[3 * row + axis] * image.spacing[axis];
    }
    text.append(" (").append(joined(step, 3, 1, ",")).append(")");
  }
  text += "\nkinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: (" +
          joined(image.origin, 3, 1, ",") + ")\n\n";
  return text;
}

std::string meta_header(const plc_image& image, const std::string& data_file) {
  static const char* const types[] = {"MET_UCHAR", "MET_SHORT", "MET_USHORT", "MET_INT",
                                      "MET_FLOAT"};
  std::string text = "ObjectType = Image\nNDims = 3\nBinaryData = True\n";
  text += "BinaryDataByteOrderMSB = False\nCompressedData = False\nTransformMatrix =";
  for (int axis = 0; axis < 3; ++axis) {
    text.append(" ").append(joined(image.direction + axis, 3, 3, " "));
  }
  text += "\nOffset = " + joined(image.origin, 3, 1, " ");
  text += "\nElementSpacing = " + joined(image.spacing, 3, 1, " ");
  text += "\nDimSize = " + sizes(image) + "\nElementType = " + types[image.type];
  text += "\nElementDataFile = " + data_file + '\n';
  return text;
}

}  // namespace

void write_volume(const std::string& path, const plc_image& image) {
  const std::string suffix = path_suffix(path);
  const size_t bytes =
      static_cast<size_t>(checked_voxel_count(path, image.dims)) * voxel_size(image.type);
  AtomicFiles files;
  if (suffix == ".nrrd" || suffix == ".mha") {
    AtomicFile& file = files.add(path);
    file.write(suffix == ".nrrd" ? nrrd_header(image) : meta_header(image, "LOCAL"));
    file.write(image.voxels, bytes);
  } else if (suffix == ".mhd") {
    const std::filesystem::path raw = std::filesystem::path(path).replace_extension(".raw");
    files.add(raw.string()).write(image.voxels, bytes);
    files.add(path).write(meta_header(image, raw.filename().string()));
  } else if (suffix == ".zarr") {
    OmeZarrWriter writer(path, image);
    writer.add({static_cast<const std::byte*>(image.voxels), bytes});
    writer.commit();
  } else {
    throw Failure{path + ": volumes are written as .nrrd, .mha, .mhd or .ome.zarr"};
  }
  files.commit();
}

}  // namespace plc::tools

#include "tools/volume/volume_io_itk.h"

// Debian's ITK was built by GCC and its headers turn every other compiler away, Clang and
// clang-tidy among them. What their detection defines and the headers below use:
#ifdef __clang__
#define ITK_COMPILER_DETECTION_H
#define ITK_NOEXCEPT noexcept
#define VXL_COMPILER_DETECTION_H
#define VXL_DEPRECATED_MSG(text)
#endif

#include <fcntl.h>
#include <gdcmImageHelper.h>
#include <gdcmReader.h>
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkTIFFImageIO.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "tools/file/failure.h"
#include "tools/volume/volume_io_size.h"

namespace plc::tools {
namespace {

// The libraries under ITK print by printf, by std::cerr and by handlers of their own, each with
// another switch, some with none; what matters comes back as an exception. So stdout and stderr
// themselves are put aside while they work.
class Silence {
 public:
  Silence() {
    flush();
    for (int i = 0; i < 2; ++i) {
      saved_[i] = fcntl(i + 1, F_DUPFD_CLOEXEC, 3);
      const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
      if (saved_[i] >= 0 && null >= 0) dup2(null, i + 1);
      if (null >= 0) close(null);
    }
  }
  ~Silence() {
    flush();
    for (int i = 0; i < 2; ++i) {
      if (saved_[i] < 0) continue;
      dup2(saved_[i], i + 1);
      close(saved_[i]);
    }
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  static void flush() {
    std::cout.flush();
    std::cerr.flush();
    std::fflush(nullptr);
  }
  int saved_[2] = {-1, -1};
};

// The first sentence of what ITK says, without the place in its sources.
std::string one_line(const itk::ExceptionObject& exception) {
  std::string text = exception.GetDescription();
  const std::string prefix = "ITK ERROR: ";
  if (text.rfind(prefix, 0) == 0) text.erase(0, prefix.size());
  const size_t address = text.find("): ");  // "NrrdImageIO(0x55d0c8): Read: ..."
  if (address != std::string::npos && text.find("(0x") < address) text.erase(0, address + 3);
  const std::string nrrd = "[nrrd] ";  // a stack of messages, the cause last
  const size_t cause = text.rfind(nrrd);
  if (cause != std::string::npos) {
    const size_t colon = text.find(": ", cause);
    text.erase(0, colon != std::string::npos ? colon + 2 : cause + nrrd.size());
  }
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  text.erase(
      std::unique(text.begin(), text.end(), [](char a, char b) { return a == ' ' && b == ' '; }),
      text.end());
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  constexpr size_t kMaxLine = 300;
  if (text.size() > kMaxLine) text = text.substr(0, kMaxLine) + " ...";
  return text;
}

// Runs what uses ITK: silent, and with its errors as Failures.
template <typename Work>
auto guarded(const std::string& path, const char* what, const Work& work) {
  try {
    const Silence silence;
    return work();
  } catch (const itk::ExceptionObject& exception) {
    throw Failure{path + ": " + what + " (" + one_line(exception) + ")"};
  } catch (const std::bad_alloc&) {
    throw Failure{path + ": " + what + " (not enough memory)"};
  } catch (const std::exception& exception) {
    throw Failure{path + ": " + what + " (" + exception.what() + ")"};
  }
}

itk::ImageIOBase::Pointer make_reader(ItkFormat format) {
  switch (format) {
    case ItkFormat::kNrrd:
      return itk::NrrdImageIO::New().GetPointer();
    case ItkFormat::kMeta:
      return itk::MetaImageIO::New().GetPointer();
    case ItkFormat::kTiff:
      return itk::TIFFImageIO::New().GetPointer();
    case ItkFormat::kDicom:
      return itk::GDCMImageIO::New().GetPointer();
  }
  return nullptr;
}

const char* format_name(ItkFormat format) {
  switch (format) {
    case ItkFormat::kNrrd:
      return "NRRD";
    case ItkFormat::kMeta:
      return "MetaImage";
    case ItkFormat::kTiff:
      return "TIFF";
    case ItkFormat::kDicom:
      return "DICOM";
  }
  return "";
}

ItkComponent component_of(const std::string& path, const itk::ImageIOBase& reader) {
  static_assert(sizeof(long) == 8 && sizeof(int) == 4 && sizeof(short) == 2);
  switch (reader.GetComponentType()) {
    case itk::IOComponentEnum::UCHAR:
      return ItkComponent::kU8;
    case itk::IOComponentEnum::CHAR:
      return ItkComponent::kI8;
    case itk::IOComponentEnum::USHORT:
      return ItkComponent::kU16;
    case itk::IOComponentEnum::SHORT:
      return ItkComponent::kI16;
    case itk::IOComponentEnum::UINT:
      return ItkComponent::kU32;
    case itk::IOComponentEnum::INT:
      return ItkComponent::kI32;
    case itk::IOComponentEnum::ULONG:
    case itk::IOComponentEnum::ULONGLONG:
      return ItkComponent::kU64;
    case itk::IOComponentEnum::LONG:
    case itk::IOComponentEnum::LONGLONG:
      return ItkComponent::kI64;
    case itk::IOComponentEnum::FLOAT:
      return ItkComponent::kF32;
    case itk::IOComponentEnum::DOUBLE:
      return ItkComponent::kF64;
    default:
      throw Failure{path + ": has voxels of a type that is not supported (" +
                    itk::ImageIOBase::GetComponentTypeAsString(reader.GetComponentType()) + ")"};
  }
}

ItkHeader header_of(const itk::ImageIOBase& reader) {
  ItkHeader header;
  const unsigned axes = reader.GetNumberOfDimensions();
  for (unsigned i = 0; i < axes; ++i) {
    header.dims.push_back(static_cast<int64_t>(reader.GetDimensions(i)));
  }
  for (unsigned i = 0; i < std::min(axes, 3U); ++i) {
    header.spacing[i] = reader.GetSpacing(i);
    header.origin[i] = reader.GetOrigin(i);
    const std::vector<double> column = reader.GetDirection(i);
    for (unsigned row = 0; row < std::min(axes, 3U); ++row) {
      header.direction[3 * row + i] = column[row];
    }
  }
  return header;
}

}  // namespace

size_t component_size(ItkComponent component) {
  switch (component) {
    case ItkComponent::kU8:
    case ItkComponent::kI8:
      return 1;
    case ItkComponent::kU16:
    case ItkComponent::kI16:
      return 2;
    case ItkComponent::kU32:
    case ItkComponent::kI32:
    case ItkComponent::kF32:
      return 4;
    case ItkComponent::kU64:
    case ItkComponent::kI64:
    case ItkComponent::kF64:
      return 8;
  }
  return 0;
}

ItkHeader read_itk_header(const std::string& path, ItkFormat format) {
  const std::string what = std::string("is not a readable ") + format_name(format) + " file";
  return guarded(path, what.c_str(), [&] {
    const itk::ImageIOBase::Pointer reader = make_reader(format);
    if (!reader->CanReadFile(path.c_str())) throw Failure{path + ": " + what};
    reader->SetFileName(path);
    reader->ReadImageInformation();
    if (reader->GetNumberOfComponents() != 1) {
      throw Failure{path + ": has " + std::to_string(reader->GetNumberOfComponents()) +
                    " values per voxel; one is needed"};
    }
    ItkHeader header = header_of(*reader);
    header.component = component_of(path, *reader);
    if (format == ItkFormat::kTiff &&
        (header.component == ItkComponent::kU32 || header.component == ItkComponent::kI32)) {
      // ITK 5.2 takes them for i32 and reads zeros.
      throw Failure{path + ": is a TIFF file of 32-bit integers, which is not supported"};
    }
    return header;
  });
}

void read_itk_voxels(const std::string& path, ItkFormat format, const ItkHeader& header,
                     std::byte* voxels) {
  guarded(path, "its voxels cannot be read", [&] {
    const itk::ImageIOBase::Pointer reader = make_reader(format);
    reader->SetFileName(path);
    reader->ReadImageInformation();
    const auto axes = static_cast<unsigned>(header.dims.size());
    if (header_of(*reader).dims != header.dims || component_of(path, *reader) != header.component) {
      throw Failure{path + ": changed while it was read"};
    }
    itk::ImageIORegion region(axes);
    for (unsigned i = 0; i < axes; ++i) {
      region.SetIndex(i, 0);
      region.SetSize(i, static_cast<itk::SizeValueType>(header.dims[i]));
    }
    reader->SetIORegion(region);
    reader->Read(voxels);
  });
}

void check_dicom_size(const std::string& path) {
  guarded(path, "its DICOM header cannot be read", [&] {
    const gdcm::Tag pixel_data(0x7fe0, 0x0010);  // not read: the reader stops at its first byte
    gdcm::Reader reader;
    reader.SetFileName(path.c_str());
    if (!reader.ReadUpToTag(pixel_data, {pixel_data}))
      throw Failure{path + ": its DICOM header cannot be read"};
    const gdcm::TransferSyntax syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
    const std::vector<unsigned> dims = gdcm::ImageHelper::GetDimensionsValue(reader.GetFile());
    const gdcm::PixelFormat format = gdcm::ImageHelper::GetPixelFormatValue(reader.GetFile());
    uint64_t needed = format.GetPixelSize();
    for (const unsigned dim : dims) needed = times(needed, dim);
    const uint64_t size = size_of(path);
    if (syntax.IsEncapsulated() || syntax == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian) {
      // The decoder notices what is missing; here what no packing comes to, blank slices included.
      constexpr uint64_t kMaxRatio = 10000;
      return require_ratio(path, size, needed, kMaxRatio);
    }
    const uint64_t begin = reader.GetStreamCurrentPosition();
    if (size - std::min(size, begin) < needed) {
      throw Failure{path + ": is truncated (" + std::to_string(size) + " bytes, pixels from " +
                    std::to_string(begin) + " need " + std::to_string(needed) + ")"};
    }
  });
}

DicomSeries find_dicom_series(const std::string& folder) {
  return guarded(folder, "its DICOM files cannot be read", [&] {
    const auto names = itk::GDCMSeriesFileNames::New();
    names->SetUseSeriesDetails(true);
    names->SetDirectory(folder);
    DicomSeries largest;
    for (const std::string& uid : names->GetSeriesUIDs()) {
      ++largest.series_count;
      const std::vector<std::string>& files = names->GetFileNames(uid);
      if (files.size() > largest.files.size()) largest.files = files;
    }
    return largest;
  });
}

}  // namespace plc::tools

#include "tools/volume/nifti_header.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "tools/file/failure.h"
#include "tools/file/text.h"

namespace plc::tools {
namespace {

// Where the fields stand. What is a float or a 16-bit integer in version 1 is a double or a longer
// integer in version 2, but for the datatype.
struct Layout {
  size_t size, magic, dim, datatype, pixdim, offset, slope, intercept, units, qform_code,
      sform_code, qform, sform;
};
constexpr Layout kVersion1 = {348, 344, 40, 70, 76, 108, 112, 116, 123, 252, 254, 256, 280};
constexpr Layout kVersion2 = {540, 4, 16, 12, 104, 168, 176, 184, 500, 344, 348, 352, 400};
using Bytes = std::array<char, kVersion2.size>;

class Fields {
 public:
  Fields(const Bytes& bytes, bool big, bool wide)
      : bytes_(bytes.data()), big_(big), layout_(wide ? kVersion2 : kVersion1), wide_(wide) {}

  const Layout& at() const { return layout_; }

  double real(size_t at) const {
    return wide_ ? value<double>(at) : static_cast<double>(value<float>(at));
  }
  template <size_t Count>
  void reals(size_t at, std::array<double, Count>& to) const {
    for (double& x : to) {
      x = real(at);
      at += wide_ ? sizeof(double) : sizeof(float);
    }
  }
  int code(size_t at) const { return wide_ ? value<int32_t>(at) : value<int16_t>(at); }
  int64_t dim(size_t index) const {
    return wide_ ? value<int64_t>(layout_.dim + 8 * index)
                 : value<int16_t>(layout_.dim + 2 * index);
  }
  int datatype() const { return value<int16_t>(layout_.datatype); }
  int units() const {
    return wide_ ? value<int32_t>(layout_.units) : static_cast<uint8_t>(bytes_[layout_.units]);
  }
  double offset() const {
    return wide_ ? static_cast<double>(value<int64_t>(layout_.offset)) : real(layout_.offset);
  }

 private:
  template <typename T>
  T value(size_t at) const {
    return load_value<T>(bytes_ + at, big_);
  }
  const char* bytes_;
  bool big_;
  const Layout& layout_;
  bool wide_;
};

NiftiHeader header_of(const std::string& path, const Fields& fields, bool big) {
  constexpr int64_t kMostAxes = 7;
  const Layout& at = fields.at();
  NiftiHeader header;
  header.big_endian = big;
  const int64_t axes = fields.dim(0);
  const double offset = fields.offset();
  if (axes < 1 || axes > kMostAxes || !(offset < 1e15)) {
    throw Failure{path + ": is not a readable NIfTI file (its header is damaged)"};
  }
  for (int64_t i = 1; i <= axes; ++i) {
    header.dims.push_back(std::max<int64_t>(1, fields.dim(static_cast<size_t>(i))));
  }
  header.datatype = fields.datatype();
  header.offset = static_cast<uint64_t>(std::max(offset, static_cast<double>(at.size)));
  const double slope = fields.real(at.slope);
  const double intercept = fields.real(at.intercept);
  if (std::isfinite(slope) && slope != 0) {
    header.slope = slope;
    header.intercept = std::isfinite(intercept) ? intercept : 0;
  }
  header.units = fields.units();
  header.qform_code = fields.code(at.qform_code);
  header.sform_code = fields.code(at.sform_code);
  fields.reals(at.pixdim, header.pixdim);
  fields.reals(at.qform, header.qform);
  fields.reals(at.sform, header.sform);
  return header;
}

}  // namespace

NiftiHeader read_nifti_header(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (file == nullptr) throw Failure{path + ": cannot be read"};
  Bytes bytes{};
  const int got = gzread(file.get(), bytes.data(), bytes.size());
  for (const bool big : {false, true}) {
    const auto size = load_value<int32_t>(bytes.data(), big);
    const bool wide = size == static_cast<int32_t>(kVersion2.size);
    if (!wide && size != static_cast<int32_t>(kVersion1.size)) continue;
    if (got < size) throw Failure{path + ": is truncated (its header is not whole)"};
    const Fields fields(bytes, big, wide);
    const char* magic = bytes.data() + fields.at().magic;
    if (std::memcmp(magic, wide ? "ni2" : "ni1", 3) == 0) {
      throw Failure{path +
                    ": has its voxels in another file, which is not supported: .nii files "
                    "hold both"};
    }
    if (std::memcmp(magic, wide ? "n+2" : "n+1", 3) == 0) return header_of(path, fields, big);
  }
  throw Failure{path + ": is not a readable NIfTI file"};
}

}  // namespace plc::tools

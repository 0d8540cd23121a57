// Small files of the formats that are read but not written, made byte by byte.
#pragma once
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace samples {

template <typename T>
void put(std::string& out, T value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  out.append(bytes.data(), bytes.size());
}

template <typename T>
void put_at(std::string& out, size_t at, T value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  out.replace(at, bytes.size(), bytes.data(), bytes.size());
}

template <typename T>
std::string raw(const std::vector<T>& values) {
  std::string out;
  for (const T value : values) put(out, value);
  return out;
}

// zlib's stream; window_bits + 16 makes it gzip's.
inline std::string deflated(const std::string& data, bool gzip) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, gzip ? 15 + 16 : 15, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, data.size()), '\0');
  std::string in = data;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

// Axes x, y, z of 0.5, 0.75 and 2 mm to the right, front and head; voxel (0,0,0) at (10, 20, 30)
// RAS.
inline std::string nifti(const std::vector<int16_t>& dims, int16_t datatype, int16_t bits,
                         const std::string& voxels) {
  constexpr float kOffset = 352;
  const float pixdim[8] = {1, 0.5F, 0.75F, 2, 1, 1, 1, 1};
  const float sform[12] = {0.5F, 0, 0, 10, 0, 0.75F, 0, 20, 0, 0, 2, 30};
  std::string out(static_cast<size_t>(kOffset), '\0');
  put_at<int32_t>(out, 0, 348);
  put_at(out, 40, static_cast<int16_t>(dims.size()));
  for (size_t i = 0; i < 7; ++i) {
    put_at<int16_t>(out, 42 + 2 * i, i < dims.size() ? dims[i] : int16_t{1});
  }
  put_at(out, 70, datatype);
  put_at(out, 72, bits);
  for (size_t i = 0; i < 8; ++i) put_at(out, 76 + 4 * i, pixdim[i]);
  put_at(out, 108, kOffset);
  put_at<int16_t>(out, 254, 1);  // sform_code
  for (size_t i = 0; i < 12; ++i) put_at(out, 280 + 4 * i, sform[i]);
  out.replace(344, 4, std::string("n+1\0", 4));
  return out + voxels;
}

// The header of a NIfTI-2 file whose voxels of 1, 1.5 and 2.5 mm run to the right, front and head
// from (10, 20, 30); in big endian where `big`.
inline std::string nifti2(const std::vector<int64_t>& dims, int16_t datatype, double slope,
                          double intercept, bool big) {
  std::string out(544, '\0');
  const auto put = [&](size_t at, auto value) {
    put_at(out, at, value);
    const auto begin = out.begin() + static_cast<std::ptrdiff_t>(at);
    if (big) std::reverse(begin, begin + static_cast<std::ptrdiff_t>(sizeof value));
  };
  put(0, int32_t{540});
  out.replace(4, 8, std::string("n+2\0\r\n\032\n", 8));
  put(12, datatype);
  put(16, static_cast<int64_t>(dims.size()));
  for (size_t i = 0; i < dims.size(); ++i) put(24 + 8 * i, dims[i]);
  put(168, int64_t{544});
  put(176, slope);
  put(184, intercept);
  put(348, int32_t{2});
  const double sform[12] = {1, 0, 0, 10, 0, 1.5, 0, 20, 0, 0, 2.5, 30};
  for (size_t i = 0; i < 12; ++i) put(400 + 8 * i, sform[i]);
  return out;
}

// One strip per page; format 1 unsigned, 2 signed, 3 float.
inline std::string tiff(uint32_t width, uint32_t height, uint32_t bits, uint32_t format,
                        const std::vector<std::string>& pages) {
  std::string out("II*\0\0\0\0\0", 8);
  size_t link = 4;
  for (const std::string& page : pages) {
    const auto offset = static_cast<uint32_t>(out.size());
    out += page;
    if (out.size() % 2 != 0) out += '\0';
    put_at(out, link, static_cast<uint32_t>(out.size()));
    const std::array<std::array<uint32_t, 3>, 10> tags = {{{256, 4, width},
                                                           {257, 4, height},
                                                           {258, 3, bits},
                                                           {259, 3, 1},
                                                           {262, 3, 1},
                                                           {273, 4, offset},
                                                           {277, 3, 1},
                                                           {278, 4, height},
                                                           {279, 4, uint32_t(page.size())},
                                                           {339, 3, format}}};
    put(out, static_cast<uint16_t>(tags.size()));
    for (const auto& tag : tags) {
      put(out, static_cast<uint16_t>(tag[0]));
      put(out, static_cast<uint16_t>(tag[1]));
      put<uint32_t>(out, 1);
      put(out, tag[2]);
    }
    link = out.size();
    put<uint32_t>(out, 0);
  }
  return out;
}

struct DicomSlice {
  std::string series = "1.2.3.4";
  int number = 1;
  std::string position = "0\\0\\0";  // mm, LPS
  uint16_t columns = 4, rows = 3;
  std::vector<int16_t> voxels;
};

// An MR image, explicit VR little endian.
inline std::string dicom(const DicomSlice& slice) {
  const auto element = [](std::string& out, uint16_t group, uint16_t item, const std::string& vr,
                          std::string value) {
    if (value.size() % 2 != 0) value += vr == "UI" ? '\0' : ' ';
    put(out, group);
    put(out, item);
    out += vr;
    if (vr == "OB" || vr == "OW") {
      put<uint16_t>(out, 0);
      put(out, static_cast<uint32_t>(value.size()));
    } else {
      put(out, static_cast<uint16_t>(value.size()));
    }
    out += value;
  };
  const auto u16 = [](uint16_t value) { return raw<uint16_t>({value}); };
  const std::string mr = "1.2.840.10008.5.1.4.1.1.4";
  const std::string instance = slice.series + "." + std::to_string(slice.number);
  std::string meta;
  element(meta, 2, 1, "OB", std::string("\0\1", 2));
  element(meta, 2, 2, "UI", mr);
  element(meta, 2, 3, "UI", instance);
  element(meta, 2, 0x10, "UI", "1.2.840.10008.1.2.1");
  element(meta, 2, 0x12, "UI", "1.2.3");
  std::string out = std::string(128, '\0') + "DICM";
  element(out, 2, 0, "UL", raw<uint32_t>({static_cast<uint32_t>(meta.size())}));
  out += meta;
  element(out, 8, 0x16, "UI", mr);
  element(out, 8, 0x18, "UI", instance);
  element(out, 8, 0x60, "CS", "MR");
  element(out, 0x20, 0x0d, "UI", "1.2.3");
  element(out, 0x20, 0x0e, "UI", slice.series);
  element(out, 0x20, 0x13, "IS", std::to_string(slice.number));
  element(out, 0x20, 0x32, "DS", slice.position);
  element(out, 0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0");
  element(out, 0x28, 2, "US", u16(1));
  element(out, 0x28, 4, "CS", "MONOCHROME2");
  element(out, 0x28, 0x10, "US", u16(slice.rows));
  element(out, 0x28, 0x11, "US", u16(slice.columns));
  element(out, 0x28, 0x30, "DS", "0.75\\0.5");  // between rows, between columns
  element(out, 0x28, 0x100, "US", u16(16));
  element(out, 0x28, 0x101, "US", u16(16));
  element(out, 0x28, 0x102, "US", u16(15));
  element(out, 0x28, 0x103, "US", u16(1));
  element(out, 0x7fe0, 0x10, "OW", raw(slice.voxels));
  return out;
}

// A tar of one file after the other.
inline std::string tar(const std::vector<std::pair<std::string, std::string>>& files) {
  constexpr size_t kBlock = 512;
  std::string out;
  for (const auto& [name, data] : files) {
    std::string header(kBlock, '\0');
    header.replace(0, name.size(), name);
    header.replace(100, 7, "0000644");
    char size[13];
    std::snprintf(size, sizeof size, "%011zo", data.size());
    header.replace(124, 11, size, 11);
    header.replace(136, 11, "00000000000");
    header[156] = '0';
    header.replace(257, 8, std::string("ustar\00000", 8));
    header.replace(148, 8, "        ");
    unsigned sum = 0;
    for (const char c : header) sum += static_cast<unsigned char>(c);
    char checksum[8];
    std::snprintf(checksum, sizeof checksum, "%06o", sum);
    header.replace(148, 7, checksum, 7);
    out += header + data;
    out.resize((out.size() + kBlock - 1) / kBlock * kBlock, '\0');
  }
  out.append(2 * kBlock, '\0');
  return out;
}

inline std::string plist(const std::string& type, const std::string& shape) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<plist version=\"1.0\"><dict><key>matrix</key><dict>"
      "<key>dtype</key><string>" +
      type + "</string><key>filename</key><string>matrix.dat</string><key>shape</key><array>" +
      shape + "</array></dict><key>spacing</key><array>";
  for (const char* const step : {"0.5", "0.75", "1.5"}) {
    text.append("<real>").append(step).append("</real>");
  }
  return text + "</array></dict></plist>\n";
}

}  // namespace samples

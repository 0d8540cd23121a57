#include "tools/view/packed.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <new>

#include "tools/file/base64.h"
#include "tools/file/failure.h"

namespace plc::tools {

namespace {

constexpr int kLevel = 6;  // of zlib: 9 takes four times as long for a hundredth less

// By pieces: zlib counts what it is given at once in 32 bits.
std::string deflated(const std::string& data) {
  z_stream stream{};
  if (deflateInit(&stream, kLevel) != Z_OK) throw std::bad_alloc();
  std::string out;
  std::string part(size_t{1} << 18, '\0');
  size_t given = 0;
  int status = Z_OK;
  while (status == Z_OK) {
    if (stream.avail_in == 0) {
      const size_t piece = std::min(data.size() - given, size_t{1} << 24);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data() + given));
      stream.avail_in = static_cast<uInt>(piece);
      given += piece;
    }
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = static_cast<uInt>(part.size());
    status = deflate(&stream, given == data.size() ? Z_FINISH : Z_NO_FLUSH);
    out.append(part, 0, part.size() - stream.avail_out);
  }
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw Failure{"zlib has failed"};
  return out;
}

}  // namespace

std::string packed_words(std::span<const uint32_t> words) {
  std::string bytes;
  bytes.reserve(words.size() * sizeof(uint32_t));
  for (unsigned shift = 0; shift < 32; shift += 8) {
    for (const uint32_t word : words) bytes += static_cast<char>(word >> shift & 0xffU);
  }
  return encode_base64(deflated(bytes));
}

std::string packed_floats(std::span<const float> values) {
  std::vector<uint32_t> words(values.size());
  std::transform(values.begin(), values.end(), words.begin(),
                 [](float value) { return std::bit_cast<uint32_t>(value); });
  return packed_words(words);
}

std::string packed_indices(std::span<const uint32_t> indices) {
  std::vector<uint32_t> words(indices.size());
  uint32_t last = 0;
  for (size_t i = 0; i < indices.size(); ++i) {
    const uint32_t difference = indices[i] - last;
    const bool negative = difference > std::numeric_limits<uint32_t>::max() / 2;
    words[i] = negative ? ~(difference << 1) : difference << 1;
    last = indices[i];
  }
  return packed_words(words);
}

std::string packed_greys(std::span<const uint8_t> greys) {
  std::string bytes(greys.size(), '\0');
  uint8_t last = 0;
  for (size_t i = 0; i < greys.size(); ++i) {
    bytes[i] = static_cast<char>(static_cast<uint8_t>(greys[i] - last));
    last = greys[i];
  }
  return encode_base64(deflated(bytes));
}

}  // namespace plc::tools

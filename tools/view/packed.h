// Arrays as text within the page: their bytes sorted, compressed and in base64.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace plc::tools {

// Of numbers that resemble each other the high bytes are alike, and deflate finds that where they
// stand together: first the lowest byte of all words, then the next one of all, and so on.
std::string packed_words(std::span<const uint32_t> words);

// Each floating-point number as it is, NaN included.
std::string packed_floats(std::span<const float> values);

// Each as the difference to the one before, modulo 2^32, with its sign as the lowest bit.
std::string packed_indices(std::span<const uint32_t> indices);

// Each as the difference to the one before, modulo 256.
std::string packed_greys(std::span<const uint8_t> greys);

}  // namespace plc::tools

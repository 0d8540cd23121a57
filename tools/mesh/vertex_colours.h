// Colours of vertices by their values or labels.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "tools/mesh/mesh_io.h"

namespace plc::tools {

using Rgb = std::array<double, 3>;  // linear, as glTF has them, 0 .. 1

// Of a label: labels that follow each other are far apart in hue. 0 and less: grey.
Rgb label_colour(int32_t label);

// The same as bytes of sRGB, as tables of labels have them; and such bytes as a colour.
std::array<uint8_t, 3> label_bytes(int32_t label);
Rgb colour_of_bytes(const std::array<uint8_t, 3>& srgb);

// From dark blue over green to yellow (viridis) for 0 .. 1, which is held to; grey for NaN.
Rgb value_colour(double place);

// The values that the ends of the colours stand for: the 2nd and the 98th percentile, as the few
// largest curvatures would leave one colour to all others. Both NaN where there is no value.
struct ColourRange {
  double low, high;
};
ColourRange colour_range(const Scalars& scalars);

// One per vertex, of the mesh's first values: with the colours of its table, where it has one.
std::vector<Rgb> vertex_colours(const TriangleMesh& mesh);
// The same as bytes of sRGB, three for each vertex.
std::vector<uint8_t> vertex_bytes(const TriangleMesh& mesh);

}  // namespace plc::tools

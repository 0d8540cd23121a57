#include "engine/start/patch.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <utility>

#include "engine/base/schedule.h"
#include "engine/start/voxel_sides.h"
#include "tests/samples/sample_meshes.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using samples::Soup;

const plc::SerialExecutor kSerial;

// A grid of n x m squares, two faces each, in the plane z = 0; without the squares of `hole`.
template <typename Hole>
plc::Vector<uint32_t> sheet(uint32_t n, uint32_t m, const Hole& hole) {
  plc::Vector<uint32_t> abc;
  const auto id = [n](uint32_t x, uint32_t y) { return y * (n + 1) + x; };
  for (uint32_t y = 0; y < m; ++y) {
    for (uint32_t x = 0; x < n; ++x) {
      if (hole(x, y)) continue;
      abc.insert(abc.end(), {id(x, y), id(x + 1, y), id(x + 1, y + 1)});
      abc.insert(abc.end(), {id(x, y), id(x + 1, y + 1), id(x, y + 1)});
    }
  }
  return abc;
}

// Each edge is run once in each direction, and no vertex has too many.
void check_closed(const plc::Vector<uint32_t>& abc, size_t vertices) {
  std::map<std::pair<uint32_t, uint32_t>, int> runs;
  std::vector<size_t> faces(vertices, 0);
  for (size_t f = 0; f < abc.size(); f += 3) {
    for (size_t k = 0; k < 3; ++k) {
      ++runs[{abc[f + k], abc[f + (k + 1) % 3]}];
      REQUIRE(abc[f + k] < vertices);
      ++faces[abc[f + k]];
    }
  }
  for (const auto& [edge, count] : runs) {
    REQUIRE(count == 1);
    REQUIRE(runs.count({edge.second, edge.first}) == 1);
  }
  CHECK(*std::max_element(faces.begin(), faces.end()) <= plc::kMostClosing);
}

}  // namespace

TEST_CASE("every border is closed, whatever its length", "[patch]") {
  const auto none = [](uint32_t, uint32_t) { return false; };
  for (const uint32_t side : {1U, 2U, 127U, 128U, 129U, 400U}) {
    plc::Vector<uint32_t> abc = sheet(side, side, none);
    const size_t vertices = size_t{side + 1} * (side + 1);
    const size_t absent = plc::close_borders(vertices, abc, kSerial);
    check_closed(abc, vertices + absent);
    CHECK((absent == 1) == (4 * side <= plc::kMostClosing));
  }
  // Two holes and the border around.
  plc::Vector<uint32_t> holed =
      sheet(20, 20, [](uint32_t x, uint32_t y) { return (x == 3 || x == 9) && y >= 4 && y < 8; });
  CHECK(plc::close_borders(21 * 21, holed, kSerial) == 3);
  check_closed(holed, 21 * 21 + 3);
  // What is closed stays as it is.
  plc::Vector<uint32_t> closed;
  for (const uint32_t v : samples::sphere(2).abc) closed.push_back(v);
  CHECK(plc::close_borders(66, closed, kSerial) == 0);
}

TEST_CASE("an open patch tells which voxels of its room are inside", "[patch]") {
  // A torus about z, through which rows go up to four times; cut off below x = -3.
  Soup soup = samples::torus(48, 24, 12, 5);
  plc::Mesh whole;
  samples::fill_mesh(whole, soup, 1);
  plc::Vector<double> xyz;
  plc::Vector<float> rounded;
  for (const double x : soup.xyz) {
    rounded.push_back(static_cast<float>(x));
    xyz.push_back(static_cast<double>(rounded.back()));
  }
  plc::Vector<uint32_t> abc;
  for (size_t f = 0; f < soup.abc.size(); f += 3) {
    bool below = false;
    for (size_t k = 0; k < 3; ++k) below = below || xyz[3 * size_t{soup.abc[f + k]}] < -3;
    if (!below) abc.insert(abc.end(), &soup.abc[f], &soup.abc[f] + 3);
  }
  const plc::Vector<uint8_t> held(xyz.size() / 3, 1);
  plc::Mesh patch;
  REQUIRE(
      plc::fill_patch(plc::arrays_of(xyz, abc), held.data(), rounded.data(), kSerial, patch).ok());
  plc::ImageView image;
  for (size_t a = 0; a < 3; ++a) {
    image.dims[a] = 44;
    image.offset[a] = 22;
  }
  const plc::VoxelSides of_whole(whole, image);
  // Rooms that begin outside, within the tube, and in its hole; the last one sees one crossing.
  const std::vector<plc::VoxelRoom> rooms = {{{22, 0, 0}, {43, 43, 43}},
                                             {{22, 32, 20}, {40, 41, 25}},
                                             {{23, 20, 20}, {40, 25, 25}},
                                             {{33, 22, 22}, {43, 24, 24}}};
  for (const plc::VoxelRoom& room : rooms) {
    const plc::VoxelSides of_patch(patch, image, room);
    REQUIRE(of_patch.known());
    size_t inside = 0;
    for (int32_t z = room.low[2]; z <= room.high[2]; ++z) {
      for (int32_t y = room.low[1]; y <= room.high[1]; ++y) {
        std::array<uint8_t, 44> expected{}, found{};
        of_whole.row(y, z, expected.data());
        of_patch.row(y, z, found.data());
        for (int32_t x = room.low[0]; x <= room.high[0]; ++x) {
          const auto i = static_cast<size_t>(x);
          inside += expected[i];
          REQUIRE(found[i - static_cast<size_t>(room.low[0])] == expected[i]);
        }
      }
    }
    CHECK(inside > 0);
  }
  // Where no face is, nothing tells.
  CHECK_FALSE(plc::VoxelSides(patch, image, {{22, 0, 40}, {43, 10, 43}}).known());
}

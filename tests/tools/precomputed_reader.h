// The meshes that are written for neuroglancer, read as it does it.
#pragma once
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/tool_fixtures.h"
#include "tools/blocks/chunk_grid.h"
#include "tools/file/text.h"

namespace samples {

using plc::tools::Int3;
using plc::tools::Place;
using plc::tools::Triangle;

inline constexpr int64_t kLargest = 65535;  // of 16 bits

struct Fragment {
  Int3 chunk{};
  uint32_t size = 0;
  std::vector<std::array<Int3, 3>> faces;  // 0 .. 65535
};

struct Lod {
  double scale = 0;
  std::vector<Fragment> fragments;

  size_t face_count() const {
    size_t count = 0;
    for (const Fragment& f : fragments) count += f.faces.size();
    return count;
  }
};

struct Meshes {
  Place chunk{}, origin{};
  std::vector<Lod> lods;

  // Where a corner is, in steps of a chunk's grid from the origin: the same for all chunks.
  static Int3 steps(const Fragment& fragment, const Int3& corner) {
    Int3 at{};
    for (size_t a = 0; a < 3; ++a) at[a] = fragment.chunk[a] * kLargest + corner[a];
    return at;
  }
  Place place(size_t lod, const Fragment& fragment, const Int3& corner) const {
    Place at{};
    for (size_t a = 0; a < 3; ++a) {
      at[a] = origin[a] + static_cast<double>(steps(fragment, corner)[a]) / kLargest *
                              std::ldexp(chunk[a], static_cast<int>(lod));
    }
    return at;
  }
  std::vector<Triangle> triangles(size_t lod) const {
    std::vector<Triangle> all;
    for (const Fragment& fragment : lods[lod].fragments) {
      for (const auto& face : fragment.faces) {
        all.push_back({place(lod, fragment, face[0]), place(lod, fragment, face[1]),
                       place(lod, fragment, face[2])});
      }
    }
    return all;
  }
};

// What neuroglancer's decoder asks for (its src/mesh/draco/neuroglancer_draco.cc).
inline void decode(const std::string& bytes, Fragment& fragment) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  REQUIRE(decoded.ok());
  const draco::Mesh& mesh = *decoded.value();
  const draco::PointAttribute* positions =
      mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  REQUIRE(positions != nullptr);
  REQUIRE(positions->num_components() == 3);
  REQUIRE(positions->data_type() == draco::DT_INT32);
  REQUIRE(mesh.GetAttributeElementType(static_cast<int>(positions->unique_id())) ==
          draco::MESH_CORNER_ATTRIBUTE);
  REQUIRE(positions->size() == mesh.num_points());
  for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
    std::array<Int3, 3> face{};
    for (size_t k = 0; k < 3; ++k) {
      std::array<int32_t, 3> xyz{};
      positions->GetMappedValue(mesh.face(draco::FaceIndex(f))[k], xyz.data());
      for (size_t a = 0; a < 3; ++a) face[k][a] = xyz[a];
    }
    fragment.faces.push_back(face);
  }
}

inline Meshes read_meshes(const std::string& folder, const std::string& segment) {
  const std::string index = fixtures::contents(folder + "/" + segment + ".index");
  const std::string data = fixtures::contents(folder + "/" + segment);
  size_t next = 0;
  const auto number = [&] {
    next += 4;
    REQUIRE(next <= index.size());
    return plc::tools::load_value<uint32_t>(index.data() + next - 4, false);
  };
  const auto real = [&] {
    next += 4;
    REQUIRE(next <= index.size());
    return static_cast<double>(plc::tools::load_value<float>(index.data() + next - 4, false));
  };
  Meshes meshes;
  for (double& x : meshes.chunk) x = real();
  for (double& x : meshes.origin) x = real();
  meshes.lods.resize(number());
  for (Lod& lod : meshes.lods) lod.scale = real();
  for (size_t i = 0; i < 3 * meshes.lods.size(); ++i) CHECK(real() == 0);
  for (Lod& lod : meshes.lods) lod.fragments.resize(number());
  size_t offset = 0;
  for (Lod& lod : meshes.lods) {
    for (size_t a = 0; a < 3; ++a) {
      for (Fragment& f : lod.fragments) f.chunk[a] = number();
    }
    for (Fragment& f : lod.fragments) {
      f.size = number();
      REQUIRE(offset + f.size <= data.size());
      if (f.size > 0) decode(data.substr(offset, f.size), f);
      offset += f.size;
    }
  }
  CHECK(next == index.size());
  CHECK(offset == data.size());
  return meshes;
}

// Edges that more faces go along in one direction than in the other one, corners of the same place
// taken for one.
inline size_t open_edges(const Lod& lod) {
  std::map<std::pair<Int3, Int3>, int> net;
  for (const Fragment& fragment : lod.fragments) {
    for (const auto& face : fragment.faces) {
      for (size_t k = 0; k < 3; ++k) {
        const Int3 from = Meshes::steps(fragment, face[k]);
        const Int3 to = Meshes::steps(fragment, face[(k + 1) % 3]);
        net[std::minmax(from, to)] += from < to ? 1 : -1;
      }
    }
  }
  return static_cast<size_t>(
      std::count_if(net.begin(), net.end(), [](const auto& e) { return e.second != 0; }));
}

inline uint64_t z_code(const Int3& at) {
  uint64_t code = 0;
  for (unsigned bit = 0; bit < 20; ++bit) {
    for (size_t a = 0; a < 3; ++a) {
      code |= (static_cast<uint64_t>(at[a]) >> bit & 1U) << (3 * bit + a);
    }
  }
  return code;
}

// neuroglancer draws eighths of a chunk: every face must be in one.
inline bool in_an_eighth(const std::array<Int3, 3>& face) {
  for (size_t a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax({face[0][a], face[1][a], face[2][a]});
    if (low < 32768 && high > 32768) return false;
  }
  return true;
}

inline void check_tree(const Meshes& meshes) {
  for (size_t l = 0; l < meshes.lods.size(); ++l) {
    const Lod& lod = meshes.lods[l];
    CHECK((l == 0 || lod.scale > meshes.lods[l - 1].scale));
    std::set<Int3> above;
    if (l + 1 < meshes.lods.size()) {
      for (const Fragment& f : meshes.lods[l + 1].fragments) above.insert(f.chunk);
    }
    for (size_t i = 0; i < lod.fragments.size(); ++i) {
      const Fragment& f = lod.fragments[i];
      CHECK((i == 0 || z_code(lod.fragments[i - 1].chunk) < z_code(f.chunk)));
      CHECK((above.empty() || above.contains({f.chunk[0] / 2, f.chunk[1] / 2, f.chunk[2] / 2})));
      CHECK((f.size == 0) == f.faces.empty());
      bool within = true, whole = true;
      for (const auto& face : f.faces) {
        for (const Int3& corner : face) {
          for (const int64_t x : corner) within = within && x >= 0 && x <= kLargest;
        }
        whole = whole && (l == 0 || in_an_eighth(face));
      }
      CHECK(within);
      CHECK(whole);
    }
  }
}

// Faces that no chunk of the level below stands for.
inline size_t uncovered(const Lod& lod, const Lod& below) {
  std::set<Int3> known;
  for (const Fragment& f : below.fragments) known.insert(f.chunk);
  size_t count = 0;
  for (const Fragment& f : lod.fragments) {
    for (const auto& face : f.faces) {
      bool found = false;
      for (int64_t eighth = 0; eighth < 8; ++eighth) {
        Int3 child{};
        bool within = true;
        for (size_t a = 0; a < 3; ++a) {
          const auto [low, high] = std::minmax({face[0][a], face[1][a], face[2][a]});
          const int64_t upper = eighth >> a & 1;
          within = within && (upper != 0 ? low >= 32768 : high <= 32768);
          child[a] = 2 * f.chunk[a] + upper;
        }
        found = found || (within && known.contains(child));
      }
      count += found ? 0 : 1;
    }
  }
  return count;
}

}  // namespace samples

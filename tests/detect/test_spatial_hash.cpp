#include "engine/detect/spatial_hash.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Mesh;
using plc::SpatialHash;
using plc::Vec3;

Vec3 somewhere(samples::Random& random, double low, double high) {
  return {static_cast<float>(random.uniform(low, high)),
          static_cast<float>(random.uniform(low, high)),
          static_cast<float>(random.uniform(low, high))};
}

// Living vertices anywhere; their rings play no part.
void scatter(Mesh& mesh, samples::Random& random, uint32_t count, double extent) {
  plc::Neighbors ring;
  for (const uint32_t v : {0U, 1U, 2U}) ring.push_back(v);
  for (uint32_t v = 0; v < count; ++v) {
    mesh.set_ring(mesh.create(somewhere(random, -extent, extent), {}), ring);
  }
}

std::set<uint32_t> visited(const Mesh& mesh, const SpatialHash& hash, Vec3 low, Vec3 high) {
  std::set<uint32_t> found;
  hash.visit_box(mesh, low, high, [&](uint32_t v, Vec3 p) {
    CHECK(plc::squared_distance(p, mesh.at(v)) == 0);
    found.insert(v);
  });
  return found;
}

std::set<uint32_t> within(const Mesh& mesh, Vec3 low, Vec3 high) {
  std::set<uint32_t> found;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const Vec3 p = mesh.at(v);
    if (mesh.alive(v) && p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y &&
        p.z >= low.z && p.z <= high.z) {
      found.insert(v);
    }
  }
  return found;
}

void check_queries(const Mesh& mesh, const SpatialHash& hash, samples::Random& random,
                   double extent, double most) {
  for (int i = 0; i < 60; ++i) {
    const Vec3 low = somewhere(random, -1.2 * extent, 1.2 * extent);
    const Vec3 high = low + somewhere(random, 0, most);
    CHECK(visited(mesh, hash, low, high) == within(mesh, low, high));
  }
}

}  // namespace

TEST_CASE("a query finds the vertices of its box and no others", "[spatial_hash]") {
  samples::Random random(14);
  for (const uint32_t count : {0U, 1U, 10U, 300U, 5000U}) {
    for (const double extent : {3.0, 30.0}) {
      for (const float cell : {0.3F, 1.4433757F, 7.0F}) {
        Mesh mesh;
        scatter(mesh, random, count, extent);
        SpatialHash hash;
        hash.build(mesh, cell, samples::kSerial);
        check_queries(mesh, hash, random, extent, 4);
      }
    }
  }
}

TEST_CASE("a box that is longer than the table is searched whole", "[spatial_hash]") {
  samples::Random random(15);
  Mesh mesh;
  scatter(mesh, random, 100, 50);
  SpatialHash hash;
  hash.build(mesh, 0.05F, samples::kSerial);
  // 4000 cells along x, 512 buckets.
  const Vec3 low{-100, -1, -1}, high{100, 1, 1};
  CHECK(visited(mesh, hash, low, high) == within(mesh, low, high));
}

TEST_CASE("vertices on the walls of a box and of cells belong to it", "[spatial_hash]") {
  Mesh mesh;
  plc::Neighbors ring;
  for (const uint32_t v : {0U, 1U, 2U}) ring.push_back(v);
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        const uint32_t v =
            mesh.create({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}, {});
        mesh.set_ring(v, ring);
      }
    }
  }
  SpatialHash hash;
  hash.build(mesh, 1, samples::kSerial);
  CHECK(visited(mesh, hash, {-1, -1, -1}, {1, 1, 1}).size() == 27);
  CHECK(visited(mesh, hash, {0, 0, 0}, {0, 0, 0}).size() == 1);
  CHECK(visited(mesh, hash, {-2, -2, -2}, {2, 2, 2}).size() == 125);
}

TEST_CASE("moved, new and deleted vertices are seen as they are now", "[spatial_hash]") {
  samples::Random random(16);
  Mesh mesh;
  scatter(mesh, random, 500, 10);
  SpatialHash hash;
  hash.build(mesh, 1, samples::kSerial);
  plc::Neighbors ring;
  for (const uint32_t v : {0U, 1U, 2U}) ring.push_back(v);
  for (int step = 0; step < 400; ++step) {
    const auto v = static_cast<uint32_t>(random.integer(3, 499));
    switch (random.integer(0, 2)) {
      case 0:
        if (!mesh.alive(v)) break;
        mesh.place(v, somewhere(random, -10, 10));
        hash.insert(v, mesh.at(v));
        break;
      case 1:
        if (mesh.alive(v)) mesh.destroy(v);
        break;
      default: {
        const uint32_t w = mesh.create(somewhere(random, -10, 10), {});
        mesh.set_ring(w, ring);
        hash.insert(w, mesh.at(w));
      }
    }
  }
  check_queries(mesh, hash, random, 10, 5);
  hash.build(mesh, 1, samples::kSerial);
  check_queries(mesh, hash, random, 10, 5);
}

TEST_CASE("vertices that have moved within the slack are found where they are", "[spatial_hash]") {
  samples::Random random(19);
  Mesh mesh;
  scatter(mesh, random, 4000, 10);
  SpatialHash hash;
  constexpr float kSlack = 0.25F;
  hash.build(mesh, 1, samples::kSerial, kSlack);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    mesh.place(v, mesh.at(v) + somewhere(random, -0.249, 0.249));
  }
  check_queries(mesh, hash, random, 10, 3);
  CHECK(hash.inserted() == 0);
  for (uint32_t v = 0; v < mesh.slots(); v += 3) {
    mesh.place(v, somewhere(random, -10, 10));
    hash.insert(v, mesh.at(v));
  }
  const size_t inserted = hash.inserted();
  CHECK(inserted > 1300);
  CHECK(inserted <= 1334);
  check_queries(mesh, hash, random, 10, 3);
  // Those that are entered again near where they are have their entries.
  for (uint32_t v = 0; v < mesh.slots(); v += 3) hash.insert(v, mesh.at(v));
  CHECK(hash.inserted() == inserted);
  check_queries(mesh, hash, random, 10, 3);
}

TEST_CASE("what is made in the place of a deleted vertex is found", "[spatial_hash]") {
  Mesh mesh;
  samples::Random random(23);
  scatter(mesh, random, 500, 5);
  SpatialHash hash;
  hash.build(mesh, 1, samples::kSerial);
  mesh.destroy(100);
  const Vec3 place = somewhere(random, 2, 4);
  REQUIRE(mesh.create(place, {}) == 100);
  plc::Neighbors ring;
  for (const uint32_t w : {1U, 2U, 3U}) ring.push_back(w);
  mesh.set_ring(100, ring);
  hash.insert(100, place);
  CHECK(visited(mesh, hash, place, place) == std::set<uint32_t>{100});
}

TEST_CASE("what is collected of a box is what is visited of it", "[spatial_hash]") {
  samples::Random random(20);
  Mesh mesh;
  scatter(mesh, random, 3000, 8);
  SpatialHash hash;
  hash.build(mesh, 1.5F, samples::kSerial, 0.1F);
  for (uint32_t v = 0; v < mesh.slots(); v += 4) {
    mesh.place(v, somewhere(random, -8, 8));
    hash.insert(v, mesh.at(v));
  }
  for (uint32_t v = 3; v < mesh.slots(); v += 5) mesh.destroy(v);
  SpatialHash::Collected collected;
  for (int i = 0; i < 60; ++i) {
    const Vec3 low = somewhere(random, -9, 9);
    const Vec3 high = low + somewhere(random, 0, 5);
    hash.collect(mesh, low, high, collected);
    std::set<uint32_t> living;
    for (const uint32_t v : collected.ids) {
      if (mesh.alive(v)) living.insert(v);
    }
    CHECK(living == visited(mesh, hash, low, high));
  }
}

TEST_CASE("queries see vertices in one order whatever built the table", "[spatial_hash]") {
  samples::Random random(17);
  Mesh mesh;
  scatter(mesh, random, 6000, 12);
  for (uint32_t v = 3; v < 6000; v += 7) mesh.destroy(v);
  SpatialHash one, other;
  one.build(mesh, 1, samples::kSerial);
  other.build(mesh, 1, fixtures::ThreadExecutor(3));
  for (int i = 0; i < 50; ++i) {
    const Vec3 low = somewhere(random, -12, 12);
    const Vec3 high = low + Vec3{3, 3, 3};
    plc::Vector<uint32_t> first, second;
    one.visit_box(mesh, low, high, [&](uint32_t v, Vec3) { first.push_back(v); });
    other.visit_box(mesh, low, high, [&](uint32_t v, Vec3) { second.push_back(v); });
    CHECK(first == second);
  }
}

TEST_CASE("a table is used again for a larger and for a smaller mesh", "[spatial_hash]") {
  samples::Random random(18);
  SpatialHash hash;
  for (const uint32_t count : {50U, 3000U, 20U}) {
    Mesh mesh;
    scatter(mesh, random, count, 8);
    hash.build(mesh, 1, samples::kSerial);
    check_queries(mesh, hash, random, 8, 3);
  }
}

TEST_CASE("what is entered again within its cell is found where it is now", "[spatial_hash]") {
  samples::Random random(21);
  Mesh mesh;
  scatter(mesh, random, 2000, 8);
  SpatialHash hash;
  const float cell = 4;
  hash.build(mesh, cell, samples::kSerial, 0.05F);
  for (int step = 0; step < 4; ++step) {
    plc::Vector<uint32_t> moved;
    for (uint32_t v = static_cast<uint32_t>(step); v < mesh.slots(); v += 3) {
      // To anywhere in the same cell.
      const auto in_cell = [&](float x) {
        return std::floor(x / cell) * cell + static_cast<float>(random.uniform(0, 0.999)) * cell;
      };
      const Vec3 p = mesh.at(v);
      mesh.place(v, {in_cell(p.x), in_cell(p.y), in_cell(p.z)});
      moved.push_back(v);
    }
    if (step % 2 == 0) {
      for (const uint32_t v : moved) hash.insert(v, mesh.at(v));
    } else {
      hash.insert(mesh, moved, fixtures::ThreadExecutor(3));
    }
    CHECK(hash.inserted() == 0);
    check_queries(mesh, hash, random, 8, 2);
  }
}

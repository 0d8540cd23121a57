#include "engine/mesh/vertex_bytes.h"

#include <catch2/catch.hpp>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/mesh/mesh.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Mesh;
using plc::VertexBytes;
using Reset = plc::VertexBytes::Reset;

// One byte for each kind, none of which is the first one's value.
struct Owners {
  explicit Owners(Mesh& mesh)
      : touched(mesh, 7, Reset::kTouched),
        woken(mesh, 8, Reset::kWoken),
        created(mesh, 9, Reset::kCreated) {
    for (VertexBytes* bytes : {&touched, &woken, &created}) bytes->fill(1);
  }
  std::vector<int> of(uint32_t v) const { return {touched[v], woken[v], created[v]}; }

  VertexBytes touched, woken, created;
};

}  // namespace

TEST_CASE("a byte goes back to the first where a vertex is touched, woken or created",
          "[vertex_bytes]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  const Owners bytes(mesh);
  mesh.touch(2);
  mesh.wake(3);
  mesh.place(4, mesh.at(4));
  mesh.destroy(5);
  CHECK(bytes.of(1) == std::vector<int>{1, 1, 1});
  CHECK(bytes.of(2) == std::vector<int>{7, 1, 1});
  CHECK(bytes.of(3) == std::vector<int>{7, 8, 1});
  CHECK(bytes.of(4) == std::vector<int>{7, 1, 1});
  CHECK(bytes.of(5) == std::vector<int>{1, 1, 1});
  CHECK(mesh.create({}, {}) == 5);
  CHECK(bytes.of(5) == std::vector<int>{7, 8, 9});
  CHECK(mesh.create({}, {}) == 18);
  CHECK(bytes.of(18) == std::vector<int>{7, 8, 9});
}

TEST_CASE("vertices that were there before their bytes have the first", "[vertex_bytes]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  mesh.reserve(100);
  const VertexBytes bytes(mesh, 7, Reset::kCreated);
  CHECK(bytes[0] == 7);
  CHECK(bytes[17] == 7);
  CHECK(bytes[18] == 0);
  CHECK(bytes.all().size() == 112);
}

TEST_CASE("there are bytes for all vertices that are created at once, and for the padding",
          "[vertex_bytes]") {
  Mesh mesh;
  const VertexBytes bytes(mesh, 7, Reset::kTouched);
  mesh.create_many(
      1000, [](uint32_t) { return 6U; }, fixtures::ThreadExecutor(3));
  REQUIRE(bytes.all().size() == mesh.padded());
  CHECK(std::accumulate(bytes.all().begin(), bytes.all().end(), 0) == 7000);
}

TEST_CASE("bytes follow their vertices to new ids, on any executor", "[vertex_bytes]") {
  for (const bool threads : {false, true}) {
    Mesh mesh;
    samples::fill_mesh(mesh, samples::sphere(3), 1);
    Owners bytes(mesh);
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      bytes.touched[v] = static_cast<uint8_t>(v);
      bytes.created[v] = static_cast<uint8_t>(3 * v);
    }
    mesh.create({}, {});  // never alive: it has no place in the new order
    plc::Vector<uint32_t> order(mesh.vertex_count());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = mesh.vertex_count() - 1 - i;
    if (threads) {
      mesh.renumber(order, fixtures::ThreadExecutor(3));
    } else {
      mesh.renumber(order);
    }
    for (uint32_t i = 0; i < order.size(); ++i) {
      CHECK(bytes.touched[i] == static_cast<uint8_t>(order[i]));
      CHECK(bytes.created[i] == static_cast<uint8_t>(3 * order[i]));
    }
    CHECK(bytes.created.all().size() == mesh.padded());
    for (uint32_t i = mesh.slots(); i < mesh.padded(); ++i) CHECK(bytes.created[i] == 0);
  }
}

TEST_CASE("an empty mesh has no bytes, another surface in it new ones", "[vertex_bytes]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  const Owners bytes(mesh);
  mesh.clear();
  CHECK(bytes.created.all().empty());
  Mesh other;
  samples::fill_mesh(other, samples::sphere(2), 1);
  mesh.take(std::move(other));
  REQUIRE(bytes.created.all().size() == mesh.padded());
  CHECK(bytes.of(65) == std::vector<int>{7, 8, 9});
  CHECK(bytes.created[66] == 0);
}

TEST_CASE("copies of a mesh and what moves out of it leave the bytes where they are",
          "[vertex_bytes]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  const Owners bytes(mesh);
  Mesh copy = mesh.copy();
  copy.wake(3);
  CHECK(bytes.of(3) == std::vector<int>{1, 1, 1});
  CHECK(copy.bytes() < mesh.bytes());
  Mesh moved = std::move(copy);
  moved.wake(3);
  CHECK(bytes.of(3) == std::vector<int>{1, 1, 1});
  mesh.wake(3);
  CHECK(bytes.of(3) == std::vector<int>{7, 8, 1});
}

TEST_CASE("a mesh and the owners of its bytes may go in any order", "[vertex_bytes]") {
  auto mesh = std::make_unique<Mesh>();
  samples::fill_mesh(*mesh, samples::sphere(1), 1);
  auto first = std::make_unique<VertexBytes>(*mesh, 7, Reset::kWoken);
  const VertexBytes second(*mesh, 8, Reset::kWoken);
  first.reset();
  mesh->wake(3);
  mesh.reset();
  CHECK(second[3] == 8);
}

TEST_CASE("bytes are saved with their padding and restored after the mesh", "[vertex_bytes]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(1), 1);
  VertexBytes bytes(mesh, 7, Reset::kCreated);
  bytes[3] = 5;
  bytes[20] = 6;  // of the padding
  plc::StateWriter size;
  bytes.save(size);
  std::vector<uint8_t> state(size.size());
  plc::StateWriter writer(state.data());
  bytes.save(writer);
  bytes.fill(0);
  plc::StateReader reader(state.data(), state.size());
  bytes.restore(reader);
  CHECK(reader.ok());
  CHECK(bytes[2] == 7);
  CHECK(bytes[3] == 5);
  CHECK(bytes[20] == 6);
  Mesh larger;
  samples::fill_mesh(larger, samples::sphere(2), 1);
  VertexBytes other(larger, 7, Reset::kCreated);
  plc::StateReader again(state.data(), state.size());
  other.restore(again);
  CHECK_FALSE(again.ok());
}

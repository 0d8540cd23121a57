// Functions of the C API that take any mesh, on small meshes of any kind: closed ones with corners
// pulled about, and faces and coordinates at random.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/fuzz/host.h"
#include "tests/fuzz/random_arguments.h"
#include "tests/samples/sample_meshes.h"

namespace fuzz {

namespace {

// Vertices and faces in memory that ends with them.
struct Mesh {
  explicit Mesh(const samples::Soup& soup)
      : vertices(static_cast<int64_t>(soup.xyz.size() / 3)),
        faces(static_cast<int64_t>(soup.abc.size() / 3)),
        xyz(3 * vertices),
        abc(3 * faces) {
    std::copy(soup.xyz.begin(), soup.xyz.end(), xyz.data());
    std::copy(soup.abc.begin(), soup.abc.end(), abc.data());
  }
  int64_t vertices, faces;
  Room<double> xyz;
  Room<uint32_t> abc;
};

samples::Soup random_soup(Input& input) {
  samples::Soup soup;
  switch (input.below(4)) {
    case 0:
      soup = samples::cube();
      break;
    case 1:
      soup = samples::torus(5, 4, 2, 0.5);
      break;
    case 2:
      soup = samples::cube();
      soup.append(samples::moved(samples::cube(), 0.25 * input.below(8), 0, 0, 0.5));
      break;
    default:
      soup.xyz.resize(3 * size_t{input.below(12)});
      for (double& c : soup.xyz) c = static_cast<double>(input.below(4));
      soup.abc.resize(3 * size_t{input.below(24)});
      for (uint32_t& v : soup.abc) {
        v = input.below(static_cast<uint32_t>(soup.vertex_count()) +
                        (input.below(64) == 0 ? 2 : 1));
      }
  }
  for (uint32_t changes = input.below(6); changes > 0 && !soup.xyz.empty(); --changes) {
    const auto limit = static_cast<uint32_t>(soup.xyz.size());
    double& c = soup.xyz[input.below(limit)];
    c = input.below(3) == 0 ? random_double(input) : 0.25 * input.below(16) - 1;
  }
  for (uint32_t changes = input.below(4); changes > 0 && !soup.abc.empty(); --changes) {
    const auto limit = static_cast<uint32_t>(soup.abc.size());
    uint32_t& v = soup.abc[input.below(limit)];
    v = input.below(static_cast<uint32_t>(soup.vertex_count()) + 1);
  }
  return soup;
}

class Measurer {
 public:
  Measurer(Input& input, const samples::Soup& soup)
      : input_(input), mesh_(soup), context_(make_context(int64_t{256} << 20)) {}

  void run() {
    const bool readable = check();
    measure(readable);
    paths(readable);
    simplify();
    round();
    surface();
  }

 private:
  bool ok(plc_status status) {
    check_status(context_.get(), status);
    return status == PLC_OK;
  }

  // Whether the mesh can be read at all; the other functions must see it the same way.
  bool check() {
    check_.struct_size = sizeof check_;
    const plc_status status = plc_check_mesh(context_.get(), mesh_.xyz.data(), mesh_.vertices,
                                             mesh_.abc.data(), mesh_.faces, &check_);
    if (!ok(status)) return false;
    require(check_.measures.vertices == mesh_.vertices && check_.measures.faces == mesh_.faces,
            "a mesh that was counted wrongly");
    const bool all = check_.closed != 0 && check_.manifold != 0 && check_.oriented != 0 &&
                     check_.outward == 1 && check_.degenerate_faces == 0 &&
                     check_.self_intersections == 0;
    require(check_.valid == 0 || all, "a valid mesh that something is wrong with");
    require((check_.self_intersections > 0) == (check_.first_intersection[0] >= 0),
            "a first intersection of none, or none of some");
    return true;
  }

  void measure(bool readable) {
    plc_component_measures whole{};
    whole.struct_size = sizeof whole;
    const int64_t capacity = input_.below(4);
    Room<plc_component_measures> components(capacity);
    int64_t count = -7;
    const plc_status status = plc_mesh_component_measures(
        context_.get(), mesh_.xyz.data(), mesh_.vertices, mesh_.abc.data(), mesh_.faces, &whole,
        components.data(), capacity, &count);
    require(ok(status) == readable, "measures where the mesh is not read, or none where it is");
    if (!readable) {
      require(count == -7 && components.is_untouched(), "outputs changed by a call that failed");
      return;
    }
    require(count == check_.measures.components, "components counted in two ways");
    Room<double> mean(mesh_.vertices), gaussian(mesh_.vertices), area(mesh_.vertices);
    require(
        ok(plc_mesh_curvature(context_.get(), mesh_.xyz.data(), mesh_.vertices, mesh_.abc.data(),
                              mesh_.faces, mean.data(), gaussian.data(), area.data())),
        "no curvature of a mesh that is read");
    for (int64_t v = 0; v < mesh_.vertices; ++v) {
      require(!(area.data()[v] < 0), "an area below 0");
    }
  }

  void paths(bool readable) {
    const double point[3] = {0.25, random_double(input_), 0.5};
    int64_t vertex = -7;
    const bool near = ok(plc_mesh_nearest_vertex(context_.get(), mesh_.xyz.data(), mesh_.vertices,
                                                 mesh_.abc.data(), mesh_.faces, point, &vertex));
    require(near || vertex == -7, "a vertex of a call that failed");
    require(!near || (vertex >= -1 && vertex < mesh_.vertices), "a nearest vertex that is none");
    const int64_t source = static_cast<int64_t>(input_.below(14)) - 1;
    Room<double> distance(mesh_.vertices);
    if (!ok(plc_mesh_geodesic(context_.get(), mesh_.xyz.data(), mesh_.vertices, mesh_.abc.data(),
                              mesh_.faces, source, distance.data()))) {
      require(distance.is_untouched(), "distances of a call that failed");
      require(!readable || source < 0 || source >= mesh_.vertices,
              "no paths in a mesh that is read");
    } else {
      require(distance.data()[source] == 0, "a way from a vertex to itself");
      for (int64_t v = 0; v < mesh_.vertices; ++v) require(distance.data()[v] >= 0, "no distance");
    }
    Mesh other(samples::cube());
    Room<double> apart(mesh_.vertices);
    plc_distances summary{};
    summary.struct_size = sizeof summary;
    require(ok(plc_mesh_distance(context_.get(), mesh_.xyz.data(), mesh_.vertices, mesh_.abc.data(),
                                 mesh_.faces, other.xyz.data(), other.vertices, other.abc.data(),
                                 other.faces, apart.data(), &summary)) == readable,
            "distances where the mesh is not read, or none where it is");
  }

  void round() {
    Room<float> rounded(3 * mesh_.vertices);
    if (!ok(plc_mesh_round(context_.get(), mesh_.xyz.data(), mesh_.vertices, mesh_.abc.data(),
                           mesh_.faces, rounded.data(), nullptr))) {
      return;
    }
    const std::vector<double> xyz(rounded.data(), rounded.data() + 3 * mesh_.vertices);
    plc_check check{};
    check.struct_size = sizeof check;
    require(ok(plc_check_mesh(context_.get(), xyz.data(), mesh_.vertices, mesh_.abc.data(),
                              mesh_.faces, &check)) &&
                check.valid == 1,
            "a mesh rounded to floats that is not valid");
  }

  void simplify() {
    plc_simplify_options options;
    plc_simplify_options_defaults(&options);
    options.tolerance = input_.below(4) == 0 ? random_double(input_) : 0.1 * input_.below(10);
    options.one_sided = input_.below(2) == 0 ? 1 : 0;
    Room<double> xyz(3 * mesh_.vertices);
    Room<uint32_t> abc(3 * mesh_.faces);
    plc_simplified told{};
    told.struct_size = sizeof told;
    if (!ok(plc_mesh_simplify(context_.get(), mesh_.xyz.data(), mesh_.vertices, mesh_.abc.data(),
                              mesh_.faces, &options, xyz.data(), abc.data(), &told))) {
      return;
    }
    require(check_.valid == 1, "a simplified mesh of one that is not valid");
    require(told.from_at_most <= options.tolerance &&
                (options.one_sided != 0 || told.to_at_most <= options.tolerance),
            "a simplified mesh too far away");
    plc_check check{};
    check.struct_size = sizeof check;
    require(ok(plc_check_mesh(context_.get(), xyz.data(), told.vertices, abc.data(), told.faces,
                              &check)) &&
                check.valid == 1 && check.measures.components == check_.measures.components &&
                check.measures.genus == check_.measures.genus,
            "a simplified mesh that is not valid, or of another shape");
  }

  void surface() {
    plc_surface* made = nullptr;
    const auto space = static_cast<plc_space>(input_.below(3));
    const plc_status status =
        plc_surface_create(context_.get(), space, nullptr, mesh_.xyz.data(), mesh_.vertices,
                           mesh_.abc.data(), mesh_.faces, &made);
    require(ok(status) == (made != nullptr), "a surface without PLC_OK, or none with it");
    if (made == nullptr) return;
    const SurfaceHandle surface(made);
    if (plc_surface_face_count(made) > 0) {
      require_valid(context_.get(), made, "a surface made of a mesh");
    }
    const int64_t vertices = plc_surface_vertex_count(made);
    Room<float> positions(3 * vertices), values(vertices);
    require(ok(plc_surface_positions(context_.get(), made, space, positions.data(), vertices)),
            "no positions");
    for (int scalar = PLC_SCALAR_MEAN_CURVATURE; scalar <= PLC_SCALAR_MOVEMENT; ++scalar) {
      require(ok(plc_surface_scalars(context_.get(), made, space, static_cast<plc_scalar>(scalar),
                                     values.data(), vertices)),
              "no scalars");
    }
  }

  Input& input_;
  Mesh mesh_;
  Context context_;
  plc_check check_{};
};

}  // namespace

void mesh(Bytes bytes) {
  Input input(bytes);
  const samples::Soup soup = random_soup(input);
  Measurer(input, soup).run();
}

}  // namespace fuzz

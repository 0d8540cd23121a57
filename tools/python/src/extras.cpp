#include "tools/python/src/extras.h"

#include <pybind11/stl.h>

#include "tools/python/src/parameters.h"

namespace plc::python {

namespace {

// The rows are the structs.
static_assert(sizeof(plc_seed) == 4 * sizeof(double));
static_assert(sizeof(plc_attachment) == 5 * sizeof(double));
static_assert(sizeof(plc_pin) == 4 * sizeof(double));

template <class Struct>
void view_rows(const std::optional<Extras::Rows>& rows, const char* name, const Struct*& data,
               int64_t& count) {
  if (!rows) return;
  constexpr py::ssize_t kColumns = sizeof(Struct) / sizeof(double);
  if (rows->ndim() != 2 || rows->shape(1) != kColumns) {
    throw py::value_error(std::string(name) + ": must be rows of " + std::to_string(kColumns));
  }
  data = reinterpret_cast<const Struct*>(rows->data());
  count = rows->shape(0);
}

Extras make(const std::string& space, std::optional<Extras::Rows> seeds,
            std::optional<Extras::Rows> attachments, std::optional<Extras::Rows> pins,
            std::optional<py::array> mask, std::optional<MeshArrays> mesh,
            std::optional<MeshArrays> obstacles, double obstacle_gap, py::object progress,
            py::object level, py::object force) {
  return {space_of(space),
          std::move(seeds),
          std::move(attachments),
          std::move(pins),
          std::move(mask),
          std::move(mesh),
          std::move(obstacles),
          obstacle_gap,
          {std::move(progress), std::move(level), std::move(force)}};
}

}  // namespace

ExtrasView::ExtrasView(const Extras& extras, Callbacks& callbacks) : view_{}, mask_{} {
  plc_extras_defaults(&view_);
  view_.space = extras.space;
  view_rows(extras.seeds, "seeds", view_.seeds, view_.seed_count);
  view_rows(extras.attachments, "attachments", view_.attachments, view_.attachment_count);
  view_rows(extras.pins, "pins", view_.pins, view_.pin_count);
  if (extras.mask) {
    // Where it lies is not asked: it has the voxels of the image.
    mask_ = image_of(*extras.mask, {{1, 1, 1}, {0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}});
    view_.mask = &mask_;
  }
  if (extras.mesh) {
    const MeshView mesh(*extras.mesh);
    view_.mesh_xyz = mesh.xyz;
    view_.mesh_vertex_count = mesh.vertex_count;
    view_.mesh_abc = mesh.abc;
    view_.mesh_face_count = mesh.face_count;
  }
  if (extras.obstacles) {
    const MeshView obstacles(*extras.obstacles);
    view_.obstacle_xyz = obstacles.xyz;
    view_.obstacle_vertex_count = obstacles.vertex_count;
    view_.obstacle_abc = obstacles.abc;
    view_.obstacle_face_count = obstacles.face_count;
    view_.obstacle_gap = extras.obstacle_gap;
  }
  callbacks.install(view_, extras.functions);
}

void bind_extras(py::module_& module) {
  using namespace py::literals;
  py::class_<Extras>(module, "Extras")
      .def(py::init(&make), py::kw_only(), "space"_a, "seeds"_a, "attachments"_a, "pins"_a,
           "mask"_a, "mesh"_a, "obstacles"_a, "obstacle_gap"_a, "progress"_a, "level"_a, "force"_a);
}

}  // namespace plc::python

// Pellicle for C++17: pellicle.h, which tells what everything means, with handles that free
// themselves, failures as exceptions and arrays as vectors. There is nothing in it to link with.
//
//   pellicle::Context context;
//   auto image = pellicle::defaults<plc_image>();            // then voxels, dims, spacing, ...
//   auto parameters = pellicle::defaults<plc_parameters>();  // then iso, ...
//   const pellicle::Surface surface = pellicle::extract(context, image, parameters);
//   const std::vector<float> xyz = surface.positions(PLC_SPACE_LPS);
//   const std::vector<uint32_t> abc = surface.faces(PLC_SPACE_LPS);
//
// Each class owns one handle; it can be moved, not copied. One that was moved from can be assigned
// to or destroyed, nothing else. What is made with a context shares it: calls are made in it, so
// that the context and all that was made with it may be used by one thread at a time, and an object
// may outlive the Context. For a surface that several threads look at, call the functions of C with
// get() and a context for each.
//
// Callbacks, in plc_extras and plc_context_options, are those of C, and no exception may leave
// them.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "pellicle.h"

namespace pellicle {

// What a call has failed with: what() is the engine's line of text.
class Error : public std::runtime_error {
 public:
  Error(plc_status status, const std::string& message)
      : std::runtime_error(message.empty() ? plc_status_string(status) : message),
        status_(status) {}
  plc_status status() const noexcept { return status_; }

 private:
  plc_status status_;
};

namespace detail {

inline void fill(plc_context_options& s) {
  plc_context_options_defaults(&s);
}
inline void fill(plc_image& s) {
  plc_image_defaults(&s);
}
inline void fill(plc_parameters& s) {
  plc_parameters_defaults(&s);
}
inline void fill(plc_extras& s) {
  plc_extras_defaults(&s);
}
inline void fill(plc_pyramid_level& s) {
  plc_pyramid_level_defaults(&s);
}
inline void fill(plc_run_state& s) {
  plc_run_state_defaults(&s);
}
inline void fill(plc_measures& s) {
  plc_measures_defaults(&s);
}
inline void fill(plc_level_report& s) {
  plc_level_report_defaults(&s);
}
inline void fill(plc_seconds& s) {
  plc_seconds_defaults(&s);
}
inline void fill(plc_check& s) {
  plc_check_defaults(&s);
}
inline void fill(plc_component_measures& s) {
  plc_component_measures_defaults(&s);
}
inline void fill(plc_distances& s) {
  plc_distances_defaults(&s);
}
inline void fill(plc_simplify_options& s) {
  plc_simplify_options_defaults(&s);
}
inline void fill(plc_simplified& s) {
  plc_simplified_defaults(&s);
}
inline void fill(plc_bricks& s) {
  plc_bricks_defaults(&s);
}
inline void fill(plc_brick_counts& s) {
  plc_brick_counts_defaults(&s);
}

template <auto destroy>
struct Destroy {
  template <typename T>
  void operator()(T* handle) const noexcept {
    destroy(handle);
  }
};
template <typename T, auto destroy>
using Handle = std::unique_ptr<T, Destroy<destroy>>;

using Shared = std::shared_ptr<plc_context>;

inline void demand(const Shared& context, plc_status status) {
  if (status != PLC_OK) throw Error(status, plc_context_message(context.get()));
}

inline std::size_t size(int64_t count) {
  return static_cast<std::size_t>(count);
}

}  // namespace detail

// A struct of the C API as its _defaults function fills it.
template <typename Struct>
Struct defaults() {
  Struct filled;
  detail::fill(filled);
  return filled;
}

class Context {
 public:
  explicit Context(const plc_context_options& options = defaults<plc_context_options>()) {
    plc_context* made = nullptr;
    std::array<char, 256> error{};
    const plc_status status = plc_context_create(&options, &made, error.data(), error.size());
    if (status != PLC_OK) throw Error(status, error.data());
    shared_ = detail::Shared(made, plc_context_destroy);
  }

  plc_context* get() const noexcept { return shared_.get(); }
  const detail::Shared& shared() const noexcept { return shared_; }
  // Throws where a call of a function of C with get() has failed.
  void demand(plc_status status) const { detail::demand(shared_, status); }

  int threads() const { return plc_context_threads(get()); }
  std::string simd() const { return plc_context_simd(get()); }
  struct Memory {
    int64_t now = 0, peak = 0;  // bytes
  };
  Memory memory() const {
    Memory m;
    demand(plc_context_memory(get(), &m.now, &m.peak));
    return m;
  }

 private:
  detail::Shared shared_;
};

struct Range {
  double low = 0, high = 0;
};

class Volume {
 public:
  // The voxels are copied; with PLC_BORROW they must outlive all that is made of the volume.
  Volume(const Context& context, const plc_image& image, plc_ownership ownership = PLC_COPY)
      : context_(context.shared()) {
    plc_volume* made = nullptr;
    detail::demand(context_, plc_volume_create(context_.get(), &image, ownership, &made));
    handle_.reset(made);
  }

  // Of bricks; bricks.fetch and bricks.user must outlive all that is made of the volume.
  Volume(const Context& context, const plc_bricks& bricks) : context_(context.shared()) {
    plc_volume* made = nullptr;
    detail::demand(context_, plc_volume_create_bricks(context_.get(), &bricks, &made));
    handle_.reset(made);
  }

  plc_volume* get() const noexcept { return handle_.get(); }
  // Of a volume of bricks.
  plc_brick_counts brick_counts() const {
    auto counts = defaults<plc_brick_counts>();
    detail::demand(context_, plc_volume_brick_counts(context_.get(), get(), &counts));
    return counts;
  }
  Range range() const {
    Range r;
    detail::demand(context_, plc_volume_range(context_.get(), get(), &r.low, &r.high));
    return r;
  }
  // Its voxels live as long as the volume.
  plc_image image() const {
    auto image = defaults<plc_image>();
    detail::demand(context_, plc_volume_image(context_.get(), get(), &image));
    return image;
  }

 private:
  detail::Shared context_;
  detail::Handle<plc_volume, plc_volume_destroy> handle_;
};

class Pyramid {
 public:
  Pyramid(const Context& context, const Volume& volume, const plc_parameters& parameters)
      : context_(context.shared()) {
    plc_pyramid* made = nullptr;
    detail::demand(context_, plc_pyramid_create(context_.get(), volume.get(), &parameters, &made));
    handle_.reset(made);
  }

  plc_pyramid* get() const noexcept { return handle_.get(); }
  int levels() const { return plc_pyramid_levels(get()); }
  plc_pyramid_level level(int h) const {
    auto level = defaults<plc_pyramid_level>();
    detail::demand(context_, plc_pyramid_level_info(context_.get(), get(), h, &level));
    return level;
  }
  std::vector<float> values(int h) const {
    const plc_pyramid_level of = level(h);
    const int64_t count = of.dims[0] * of.dims[1] * of.dims[2];
    std::vector<float> values(detail::size(count));
    detail::demand(context_, plc_pyramid_values(context_.get(), get(), h, values.data(), count));
    return values;
  }
  plc_parameters parameters() const {
    auto parameters = defaults<plc_parameters>();
    detail::demand(context_, plc_pyramid_parameters(context_.get(), get(), &parameters));
    return parameters;
  }

 private:
  detail::Shared context_;
  detail::Handle<plc_pyramid, plc_pyramid_destroy> handle_;
};

class Surface {
 public:
  // Takes over a handle that a function of C has made in the context.
  Surface(const Context& context, plc_surface* made) : Surface(context.shared(), made) {}
  Surface(detail::Shared context, plc_surface* made)
      : context_(std::move(context)), handle_(made) {}
  // A mesh from elsewhere; image may be NULL.
  Surface(const Context& context, plc_space space, const plc_image* image,
          const std::vector<double>& xyz, const std::vector<uint32_t>& abc)
      : context_(context.shared()) {
    plc_surface* made = nullptr;
    detail::demand(context_, plc_surface_create(context_.get(), space, image, xyz.data(),
                                                static_cast<int64_t>(xyz.size() / 3), abc.data(),
                                                static_cast<int64_t>(abc.size() / 3), &made));
    handle_.reset(made);
  }

  plc_surface* get() const noexcept { return handle_.get(); }
  int64_t vertex_count() const { return plc_surface_vertex_count(get()); }
  int64_t face_count() const { return plc_surface_face_count(get()); }
  std::vector<float> positions(plc_space space) const {
    return values<float>(3, vertex_count(), [&](float* xyz, int64_t n) {
      return plc_surface_positions(context_.get(), get(), space, xyz, n);
    });
  }
  std::vector<double> positions_f64(plc_space space) const {
    return values<double>(3, vertex_count(), [&](double* xyz, int64_t n) {
      return plc_surface_positions_f64(context_.get(), get(), space, xyz, n);
    });
  }
  std::vector<uint32_t> faces(plc_space space) const {
    return values<uint32_t>(3, face_count(), [&](uint32_t* abc, int64_t n) {
      return plc_surface_faces(context_.get(), get(), space, abc, n);
    });
  }
  std::vector<float> normals(plc_space space) const {
    return values<float>(3, vertex_count(), [&](float* xyz, int64_t n) {
      return plc_surface_normals(context_.get(), get(), space, xyz, n);
    });
  }
  std::vector<float> scalars(plc_space space, plc_scalar scalar) const {
    return values<float>(1, vertex_count(), [&](float* to, int64_t n) {
      return plc_surface_scalars(context_.get(), get(), space, scalar, to, n);
    });
  }
  struct FrozenSite {
    std::array<double, 3> place{};
    int64_t vertices = 0;
  };
  std::vector<FrozenSite> frozen_sites(plc_space space) const {
    int64_t count = 0;
    const auto ask = [&](double* xyz, int64_t* vertices, int64_t capacity) {
      detail::demand(context_, plc_surface_frozen_sites(context_.get(), get(), space, xyz, vertices,
                                                        capacity, &count));
    };
    ask(nullptr, nullptr, 0);
    if (count == 0) return {};
    std::vector<double> xyz(detail::size(3 * count));
    std::vector<int64_t> vertices(detail::size(count));
    ask(xyz.data(), vertices.data(), count);
    std::vector<FrozenSite> sites(vertices.size());
    for (std::size_t i = 0; i < sites.size(); ++i) {
      sites[i] = {{xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}, vertices[i]};
    }
    return sites;
  }
  // plc_surface_patch: of each vertex the one of the patch given that it is, or a PLC_PATCH_ value.
  std::vector<int64_t> patch() const {
    std::vector<int64_t> source(detail::size(plc_surface_vertex_count(get())));
    detail::demand(context_, plc_surface_patch(context_.get(), get(), source.data(),
                                               static_cast<int64_t>(source.size())));
    return source;
  }
  uint64_t hash() const { return plc_surface_hash(get()); }
  plc_measures measure(plc_space space) const {
    auto measures = defaults<plc_measures>();
    detail::demand(context_, plc_surface_measure(context_.get(), get(), space, &measures));
    return measures;
  }
  plc_check check() const {
    auto check = defaults<plc_check>();
    detail::demand(context_, plc_surface_check(context_.get(), get(), &check));
    return check;
  }
  bool converged() const { return plc_surface_converged(get()) != 0; }
  // From coarse to fine.
  std::vector<plc_level_report> levels() const {
    std::vector<plc_level_report> levels(detail::size(plc_surface_level_count(get())),
                                         defaults<plc_level_report>());
    for (std::size_t i = 0; i < levels.size(); ++i) {
      detail::demand(context_,
                     plc_surface_level(context_.get(), get(), static_cast<int>(i), &levels[i]));
    }
    return levels;
  }
  plc_seconds seconds() const {
    auto seconds = defaults<plc_seconds>();
    detail::demand(context_, plc_surface_seconds(context_.get(), get(), &seconds));
    return seconds;
  }
  plc_parameters parameters() const {
    auto parameters = defaults<plc_parameters>();
    detail::demand(context_, plc_surface_parameters(context_.get(), get(), &parameters));
    return parameters;
  }
  Range input_range() const {
    Range r;
    detail::demand(context_, plc_surface_input_range(context_.get(), get(), &r.low, &r.high));
    return r;
  }

 private:
  template <typename T, typename Write>
  std::vector<T> values(int64_t each, int64_t count, const Write& write) const {
    std::vector<T> values(detail::size(each * count));
    detail::demand(context_, write(values.data(), count));
    return values;
  }

  detail::Shared context_;
  detail::Handle<plc_surface, plc_surface_destroy> handle_;
};

// extras may be NULL, here and below.
inline Surface extract(const Context& context, const plc_image& image,
                       const plc_parameters& parameters, const plc_extras* extras = nullptr) {
  plc_surface* made = nullptr;
  context.demand(plc_extract(context.get(), &image, &parameters, extras, &made));
  return {context, made};
}

inline Surface extract(const Context& context, const Volume& volume,
                       const plc_parameters& parameters, const plc_extras* extras = nullptr) {
  plc_surface* made = nullptr;
  context.demand(plc_extract_volume(context.get(), volume.get(), &parameters, extras, &made));
  return {context, made};
}

class Run {
 public:
  Run(const Context& context, const Pyramid& pyramid, const plc_parameters& parameters,
      const plc_extras* extras = nullptr)
      : context_(context.shared()) {
    plc_run* made = nullptr;
    detail::demand(context_,
                   plc_run_create(context_.get(), pyramid.get(), &parameters, extras, &made));
    handle_.reset(made);
  }
  // A run that goes on from what save() has given.
  Run(const Context& context, const Pyramid& pyramid, const plc_parameters& parameters,
      const std::vector<unsigned char>& saved, const plc_extras* extras = nullptr)
      : context_(context.shared()) {
    plc_run* made = nullptr;
    detail::demand(context_, plc_run_restore(context_.get(), pyramid.get(), &parameters, extras,
                                             saved.data(), saved.size(), &made));
    handle_.reset(made);
  }

  plc_run* get() const noexcept { return handle_.get(); }
  // A run that a callback has cancelled throws Error with PLC_CANCELLED, and can go on.
  plc_run_state advance(plc_amount amount) {
    auto state = defaults<plc_run_state>();
    detail::demand(context_, plc_run_advance(context_.get(), get(), amount, &state));
    return state;
  }
  plc_run_state state() const {
    auto state = defaults<plc_run_state>();
    detail::demand(context_, plc_run_get_state(context_.get(), get(), &state));
    return state;
  }
  Surface surface() const {
    plc_surface* made = nullptr;
    detail::demand(context_, plc_run_surface(context_.get(), get(), &made));
    return {context_, made};
  }
  std::vector<unsigned char> save() const {
    std::size_t size = 0;
    detail::demand(context_, plc_run_save(context_.get(), get(), nullptr, 0, &size));
    std::vector<unsigned char> state(size);
    detail::demand(context_, plc_run_save(context_.get(), get(), state.data(), size, &size));
    return state;
  }

 private:
  detail::Shared context_;
  detail::Handle<plc_run, plc_run_destroy> handle_;
};

// A triangle mesh, ours or not, to be checked and measured.
struct Mesh {
  std::vector<double> xyz;
  std::vector<uint32_t> abc;
  int64_t vertices() const { return static_cast<int64_t>(xyz.size() / 3); }
  int64_t faces() const { return static_cast<int64_t>(abc.size() / 3); }
};

inline plc_check check(const Context& context, const Mesh& mesh) {
  auto check = defaults<plc_check>();
  context.demand(plc_check_mesh(context.get(), mesh.xyz.data(), mesh.vertices(), mesh.abc.data(),
                                mesh.faces(), &check));
  return check;
}

struct ComponentMeasures {
  plc_component_measures whole = defaults<plc_component_measures>();
  std::vector<plc_component_measures> components;  // the largest area first
};
inline ComponentMeasures component_measures(const Context& context, const Mesh& mesh) {
  ComponentMeasures m;
  int64_t count = 0;
  const auto ask = [&](int64_t capacity) {
    context.demand(plc_mesh_component_measures(
        context.get(), mesh.xyz.data(), mesh.vertices(), mesh.abc.data(), mesh.faces(), &m.whole,
        capacity == 0 ? nullptr : m.components.data(), capacity, &count));
  };
  ask(0);
  m.components.resize(detail::size(count), defaults<plc_component_measures>());
  if (count > 0) ask(count);
  return m;
}

// Of each vertex.
struct Curvature {
  std::vector<double> mean, gaussian, area;
};
inline Curvature curvature(const Context& context, const Mesh& mesh) {
  const std::size_t n = detail::size(mesh.vertices());
  Curvature c{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  context.demand(plc_mesh_curvature(context.get(), mesh.xyz.data(), mesh.vertices(),
                                    mesh.abc.data(), mesh.faces(), c.mean.data(), c.gaussian.data(),
                                    c.area.data()));
  return c;
}

inline int64_t nearest_vertex(const Context& context, const Mesh& mesh,
                              const std::array<double, 3>& point) {
  int64_t vertex = -1;
  context.demand(plc_mesh_nearest_vertex(context.get(), mesh.xyz.data(), mesh.vertices(),
                                         mesh.abc.data(), mesh.faces(), point.data(), &vertex));
  return vertex;
}

// From the vertex source to each.
inline std::vector<double> geodesic(const Context& context, const Mesh& mesh, int64_t source) {
  std::vector<double> distance(detail::size(mesh.vertices()));
  context.demand(plc_mesh_geodesic(context.get(), mesh.xyz.data(), mesh.vertices(), mesh.abc.data(),
                                   mesh.faces(), source, distance.data()));
  return distance;
}

struct Distances {
  plc_distances summary = defaults<plc_distances>();
  std::vector<double> of_vertex;  // of the first mesh
};
inline Distances distances(const Context& context, const Mesh& from, const Mesh& to) {
  Distances d;
  d.of_vertex.resize(detail::size(from.vertices()));
  context.demand(plc_mesh_distance(context.get(), from.xyz.data(), from.vertices(), from.abc.data(),
                                   from.faces(), to.xyz.data(), to.vertices(), to.abc.data(),
                                   to.faces(), d.of_vertex.data(), &d.summary));
  return d;
}

struct Simplified {
  plc_simplified summary = defaults<plc_simplified>();
  Mesh mesh;
};
inline Simplified simplify(const Context& context, const Mesh& mesh,
                           const plc_simplify_options& options) {
  Simplified s;
  s.mesh.xyz.resize(mesh.xyz.size());
  s.mesh.abc.resize(mesh.abc.size());
  context.demand(plc_mesh_simplify(context.get(), mesh.xyz.data(), mesh.vertices(), mesh.abc.data(),
                                   mesh.faces(), &options, s.mesh.xyz.data(), s.mesh.abc.data(),
                                   &s.summary));
  s.mesh.xyz.resize(3 * detail::size(s.summary.vertices));
  s.mesh.abc.resize(3 * detail::size(s.summary.faces));
  return s;
}

// See plc_mesh_round.
inline std::vector<float> round(const Context& context, const Mesh& mesh) {
  std::vector<float> rounded(mesh.xyz.size());
  context.demand(plc_mesh_round(context.get(), mesh.xyz.data(), mesh.vertices(), mesh.abc.data(),
                                mesh.faces(), rounded.data(), nullptr));
  return rounded;
}

}  // namespace pellicle

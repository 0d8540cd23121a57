// What a run tells its callbacks, and what is held against its meshes and its status.
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "engine/api/handles.h"
#include "tests/campaign/campaign_watch.h"

namespace campaign {

samples::Soup soup_of(plc_context* context, const plc_surface* surface, plc_space space) {
  samples::Soup soup;
  const int64_t vertices = plc_surface_vertex_count(surface);
  const int64_t faces = plc_surface_face_count(surface);
  soup.abc.resize(static_cast<size_t>(faces) * 3);
  soup.xyz.resize(static_cast<size_t>(vertices) * 3);
  plc_surface_positions_f64(context, surface, space, soup.xyz.data(), vertices);
  plc_surface_faces(context, surface, space, soup.abc.data(), faces);
  return soup;
}

samples::Soup exact_soup(const plc_surface* surface) {
  samples::Soup soup;
  for (uint32_t v = 0; v < surface->mesh.slots(); ++v) {
    const plc::Vec3 p = surface->mesh.at(v);
    soup.xyz.insert(soup.xyz.end(), {p.x, p.y, p.z});
  }
  const auto faces = surface->mesh.faces();
  soup.abc.assign(faces.begin(), faces.end());
  return soup;
}

int Watch::progress(const plc_progress& p) {
  record_.iterations.push_back({p.level, p.iteration, p.vertices, p.energy, p.speed});
  if (!(p.energy >= 0 && p.energy < 1e30 && p.speed >= 0 && p.speed < 1e30) || p.vertices < 0 ||
      !(p.fraction >= 0 && p.fraction <= 1)) {
    fail(Finding::kInvariant, "level " + std::to_string(p.level) + " iteration " +
                                  std::to_string(p.iteration) + ": energy " +
                                  std::to_string(p.energy) + ", speed " + std::to_string(p.speed) +
                                  ", fraction " + std::to_string(p.fraction));
  }
  work_ += p.vertices;
  // What is cancelled before the first iteration makes no run.
  if (way_.steps && p.iteration > 0 && way_.pause_at == iterations() && !record_.paused) {
    record_.paused = true;
    return 1;
  }
  return cancels() ? 1 : 0;
}

bool Watch::cancels() const {
  return (case_.cancel_at != 0 && iterations() >= case_.cancel_at) || work_ > 2 * case_.work;
}

plc_verdict Watch::level(const plc_level_report& report, const plc_surface* surface) {
  char line[200];
  std::snprintf(line, sizeof line,
                "level %d: %lld iterations, %lld vertices, energy %.9g, converged %d, hash %016llx",
                report.level, static_cast<long long>(report.iterations),
                static_cast<long long>(report.vertices), report.energy, report.converged,
                static_cast<unsigned long long>(plc_surface_hash(surface)));
  record_.levels.emplace_back(line);
  check_report(report);
  if (exact_) check(exact_soup(surface), "end of level " + std::to_string(report.level), false);
  if (report.level == case_.more_level && !more_given_ && work_ <= case_.work) {
    more_given_ = true;
    return PLC_VERDICT_MORE;
  }
  const bool stops = report.level == case_.stop_level || work_ > case_.work;
  return stops ? PLC_VERDICT_STOP : PLC_VERDICT_ACCEPT;
}

int Watch::force(const plc_force_points& points, float* forces) const {
  const auto strength = static_cast<float>(case_.force_strength);
  for (int64_t i = 0; i < 3 * points.count; ++i) {
    if (case_.force == UserForce::kPressure) {
      forces[i] = strength * points.normals[i];
    } else if (case_.force == UserForce::kNotFinite) {
      forces[i] = std::numeric_limits<float>::infinity();
    } else {
      const float way =
          static_cast<float>(case_.force_centre[static_cast<size_t>(i % 3)]) - points.xyz[i];
      forces[i] = strength * way / (1 + std::abs(way));
    }
  }
  return 0;
}

Finding judge(plc_context* checker, const samples::Soup& soup, std::string& what) {
  plc_check found{};
  found.struct_size = sizeof found;
  const plc_status status =
      plc_check_mesh(checker, soup.xyz.data(), static_cast<int64_t>(soup.vertex_count()),
                     soup.abc.data(), static_cast<int64_t>(soup.face_count()), &found);
  if (status != PLC_OK) {
    what = plc_context_message(checker);
    return Finding::kInvalid;
  }
  if (found.valid != 0 && found.isolated_vertices == 0) return Finding::kNone;
  char line[320];
  std::snprintf(line, sizeof line,
                "closed %d, manifold %d, oriented %d, outward %d, wrongly oriented components "
                "%lld, degenerate faces %lld, isolated vertices %lld, self-intersections %lld, "
                "first %lld and %lld of %zu",
                found.closed, found.manifold, found.oriented, found.outward,
                static_cast<long long>(found.wrongly_oriented_components),
                static_cast<long long>(found.degenerate_faces),
                static_cast<long long>(found.isolated_vertices),
                static_cast<long long>(found.self_intersections),
                static_cast<long long>(found.first_intersection[0]),
                static_cast<long long>(found.first_intersection[1]), soup.face_count());
  what = line;
  return found.self_intersections != 0 ? Finding::kSelfIntersection : Finding::kInvalid;
}

void Watch::check(const samples::Soup& soup, const std::string& where, bool rounded) {
  std::string wrong;
  const Finding found = judge(checker_.get(), soup, wrong);
  if (found != Finding::kNone) fail(rounded ? Finding::kRounded : found, where + ": " + wrong);
}

void Watch::check_report(const plc_level_report& r) {
  // I_0 goes on up to twice after late bubbles, and each level once more when the caller says so.
  const int64_t most =
      int64_t{case_.parameters.max_iterations} * 4 * (r.level == case_.more_level ? 2 : 1);
  const bool finite = std::isfinite(r.energy) && std::isfinite(r.speed) && r.energy >= 0 &&
                      r.speed >= 0 && r.delta > 0 && r.unit > 0 && std::isfinite(r.late_volume);
  if (case_.rests && r.converged == 0) {
    fail(Finding::kRestless, "level " + std::to_string(r.level) + ": " +
                                 std::to_string(r.iterations) + " iterations, energy " +
                                 std::to_string(r.energy));
  }
  if (finite && r.iterations >= 1 && r.iterations <= most && r.vertices >= 4) return;
  fail(Finding::kInvariant, "report of level " + std::to_string(r.level) + ": " +
                                std::to_string(r.iterations) + " iterations, " +
                                std::to_string(r.vertices) + " vertices, energy " +
                                std::to_string(r.energy) + ", speed " + std::to_string(r.speed));
}

void Watch::check_result(const plc_surface* surface) {
  check(exact_soup(surface), "result", false);
  plc_measures m{};
  m.struct_size = sizeof m;
  if (plc_surface_measure(checker_.get(), surface, case_.space, &m) != PLC_OK) {
    return fail(Finding::kStatus, std::string("measures: ") + plc_context_message(checker_.get()));
  }
  const bool sums = m.genus >= 0 && m.euler == 2 * m.components - 2 * m.genus;
  if (!sums || !(m.volume > 0) || !(m.area > 0) || !std::isfinite(m.area)) {
    fail(Finding::kInvariant, "measures: " + std::to_string(m.components) + " components, euler " +
                                  std::to_string(m.euler) + ", genus " + std::to_string(m.genus) +
                                  ", area " + std::to_string(m.area) + ", volume " +
                                  std::to_string(m.volume));
  }
  check(soup_of(checker_.get(), surface, case_.space), "result in the space asked for", true);
}

void Watch::check_status() {
  const RunRecord& r = record_;
  const std::string said = "status " + std::to_string(r.status) + ": " + r.message;
  if (r.status == PLC_OK) {
    if (!case_.fault.empty()) fail(Finding::kStatus, "accepts what is wrong: " + case_.fault);
    if (cancels()) fail(Finding::kStatus, "goes on when it is cancelled");
    if (!r.message.empty()) fail(Finding::kStatus, "a message without a failure: " + said);
    return;
  }
  if (r.message.empty() || r.message.size() > 300 || r.message.find('\n') != std::string::npos) {
    fail(Finding::kStatus, "not one clear line: " + said);
  }
  if (r.status == PLC_OUT_OF_MEMORY && way_.memory_part > 0) return;
  if (r.status == PLC_CANCELLED && !cancels()) {
    fail(Finding::kStatus, "cancelled, but nobody asked for it");
  }
  for (const Refusal& allowed : case_.refusals) {
    if (allowed.status == r.status && r.message.find(allowed.phrase) != std::string::npos) return;
  }
  fail(Finding::kStatus, said + (case_.fault.empty() ? "" : "; expected of " + case_.fault));
}

}  // namespace campaign

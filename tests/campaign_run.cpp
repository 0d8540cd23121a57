#include "tests/campaign_run.h"

#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "engine/handles.h"

namespace campaign {

namespace {

struct Destroy {
  void operator()(plc_context* context) const { plc_context_destroy(context); }
  void operator()(plc_surface* surface) const { plc_surface_destroy(surface); }
};
using Context = std::unique_ptr<plc_context, Destroy>;
using Surface = std::unique_ptr<plc_surface, Destroy>;

// Of all threads of the process: what else the machine does is no part of it.
double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

samples::Soup soup_of(const plc_surface* surface, plc_space space) {
  samples::Soup soup;
  std::vector<float> xyz(static_cast<size_t>(plc_surface_vertex_count(surface)) * 3);
  soup.abc.resize(static_cast<size_t>(plc_surface_face_count(surface)) * 3);
  plc_surface_positions(surface, space, xyz.data());
  plc_surface_faces(surface, space, soup.abc.data());
  soup.xyz.assign(xyz.begin(), xyz.end());
  return soup;
}

// With the coordinates that the mesh evolves in, which no change of space has rounded.
samples::Soup exact_soup(const plc_surface* surface) {
  samples::Soup soup;
  for (uint32_t v = 0; v < surface->mesh.slots(); ++v) {
    const plc::Vec3 p = surface->mesh.at(v);
    soup.xyz.insert(soup.xyz.end(), {p.x, p.y, p.z});
  }
  soup.abc = surface->mesh.faces();
  return soup;
}

class Watch {
 public:
  Watch(const Case& c, bool exact) : case_(c), exact_(exact), checker_(one_thread()) {}

  RunRecord run(int threads, plc_simd simd, samples::Soup* mesh);
  Finding finding() const { return finding_; }
  const std::string& what() const { return what_; }

 private:
  static Context one_thread() { return context(1, PLC_SIMD_AUTO); }
  static Context context(int threads, plc_simd simd) {
    plc_context_options options;
    plc_context_options_defaults(&options);
    options.threads = threads;
    options.simd = simd;
    plc_context* made = nullptr;
    plc_context_create(&options, &made, nullptr, 0);
    return Context(made);
  }

  void fail(Finding finding, const std::string& what) {
    if (finding_ != Finding::kNone) return;
    finding_ = finding;
    what_ = what;
  }

  int progress(const plc_progress& p);
  plc_verdict level(const plc_level_report& report, const plc_surface* surface);
  int force(const plc_force_points& points, float* forces) const;
  void check(const samples::Soup& soup, const std::string& where, bool rounded);
  void check_report(const plc_level_report& report);
  void check_result(const plc_surface* surface);
  void check_status();
  bool cancels() const;

  const Case& case_;
  bool exact_;  // whether meshes are checked
  Context checker_;
  RunRecord record_;
  int64_t work_ = 0;
  bool more_given_ = false;
  Finding finding_ = Finding::kNone;
  std::string what_;
};

RunRecord Watch::run(int threads, plc_simd simd, samples::Soup* mesh) {
  const double start = processor_seconds();
  const Context context = Watch::context(threads, simd);
  if (context == nullptr || checker_ == nullptr) {
    fail(Finding::kStatus,
         "no context of " + std::to_string(threads) + " threads, target " + std::to_string(simd));
    return record_;
  }
  plc_extras extras = case_.extras();
  extras.progress = [](const plc_progress* p, void* self) {
    return static_cast<Watch*>(self)->progress(*p);
  };
  extras.level = [](const plc_level_report* report, const plc_surface* surface, void* self) {
    return static_cast<Watch*>(self)->level(*report, surface);
  };
  if (case_.force != UserForce::kNone) {
    extras.force = [](const plc_force_points* points, float* forces, void* self) {
      return static_cast<Watch*>(self)->force(*points, forces);
    };
  }
  extras.progress_user = extras.level_user = extras.force_user = this;
  plc_surface* made = reinterpret_cast<plc_surface*>(this);
  record_.status = plc_extract(context.get(), &case_.image, &case_.parameters, &extras, &made);
  const Surface surface(made);
  record_.message = plc_context_message(context.get());
  record_.seconds = processor_seconds() - start;
  check_status();
  if ((record_.status == PLC_OK) != (made != nullptr)) {
    fail(Finding::kStatus, "status " + std::to_string(record_.status) +
                               (made == nullptr ? " without" : " with") + " a surface");
  }
  if (made == nullptr || record_.status != PLC_OK) return record_;
  record_.hash = plc_surface_hash(made);
  record_.vertices = plc_surface_vertex_count(made);
  if (exact_) check_result(made);
  if (mesh != nullptr) *mesh = soup_of(made, case_.space);
  return record_;
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
  return cancels() ? 1 : 0;
}

bool Watch::cancels() const {
  const auto done = static_cast<int>(record_.iterations.size());
  return (case_.cancel_at != 0 && done >= case_.cancel_at) || work_ > 2 * case_.work;
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

void Watch::check(const samples::Soup& soup, const std::string& where, bool rounded) {
  plc_check found{};
  found.struct_size = sizeof found;
  const plc_status status =
      plc_check_mesh(checker_.get(), soup.xyz.data(), static_cast<int64_t>(soup.vertex_count()),
                     soup.abc.data(), static_cast<int64_t>(soup.face_count()), &found);
  if (status != PLC_OK) {
    return fail(rounded ? Finding::kRounded : Finding::kInvalid,
                where + ": " + plc_context_message(checker_.get()));
  }
  if (found.valid != 0 && found.isolated_vertices == 0) return;
  const bool meets = found.self_intersections != 0;
  const Finding kind = rounded ? Finding::kRounded
                       : meets ? Finding::kSelfIntersection
                               : Finding::kInvalid;
  fail(kind, where + ": closed " + std::to_string(found.closed) + ", manifold " +
                 std::to_string(found.manifold) + ", oriented " + std::to_string(found.oriented) +
                 ", outward " + std::to_string(found.outward) + ", wrongly oriented components " +
                 std::to_string(found.wrongly_oriented_components) + ", degenerate faces " +
                 std::to_string(found.degenerate_faces) + ", isolated vertices " +
                 std::to_string(found.isolated_vertices) + ", self-intersections " +
                 std::to_string(found.self_intersections) + ", first " +
                 std::to_string(found.first_intersection[0]) + " and " +
                 std::to_string(found.first_intersection[1]) + " of " +
                 std::to_string(soup.face_count()));
}

void Watch::check_report(const plc_level_report& r) {
  // I_0 goes on up to twice after late bubbles, and each level once more when the caller says so.
  const int64_t most =
      int64_t{case_.parameters.max_iterations} * 4 * (r.level == case_.more_level ? 2 : 1);
  const bool finite = std::isfinite(r.energy) && std::isfinite(r.speed) && r.energy >= 0 &&
                      r.speed >= 0 && r.delta > 0 && r.unit > 0 && std::isfinite(r.late_volume);
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
  check(soup_of(surface, case_.space), "result in the space asked for", true);
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
  if (r.status == PLC_CANCELLED && !cancels()) {
    fail(Finding::kStatus, "cancelled, but nobody asked for it");
  }
  for (const Refusal& allowed : case_.refusals) {
    if (allowed.status == r.status && r.message.find(allowed.phrase) != std::string::npos) return;
  }
  fail(Finding::kStatus, said + (case_.fault.empty() ? "" : "; expected of " + case_.fault));
}

std::string difference(const RunRecord& a, const RunRecord& b) {
  if (a.status != b.status || a.message != b.message) {
    return "status " + std::to_string(a.status) + " (" + a.message + ") and " +
           std::to_string(b.status) + " (" + b.message + ")";
  }
  for (size_t i = 0; i < std::min(a.iterations.size(), b.iterations.size()); ++i) {
    const Iteration& x = a.iterations[i];
    const Iteration& y = b.iterations[i];
    const auto same = [](double p, double q) {
      return std::bit_cast<uint64_t>(p) == std::bit_cast<uint64_t>(q);
    };
    if (x.level == y.level && x.iteration == y.iteration && x.vertices == y.vertices &&
        same(x.energy, y.energy) && same(x.speed, y.speed)) {
      continue;
    }
    char line[240];
    std::snprintf(line, sizeof line,
                  "first in level %d iteration %d: %lld and %lld vertices, energy %.17g and %.17g",
                  x.level, x.iteration, static_cast<long long>(x.vertices),
                  static_cast<long long>(y.vertices), x.energy, y.energy);
    return line;
  }
  if (a.iterations.size() != b.iterations.size()) return "numbers of iterations";
  for (size_t i = 0; i < std::min(a.levels.size(), b.levels.size()); ++i) {
    if (a.levels[i] != b.levels[i]) return a.levels[i] + " and " + b.levels[i];
  }
  if (a.levels.size() != b.levels.size()) return "numbers of levels";
  return a.hash != b.hash ? "the results, not the levels" : "";
}

constexpr const char* kFindingNames[kFindings] = {"none",       "invalid", "self-intersection",
                                                  "rounded",    "status",  "invariant",
                                                  "difference", "crash",   "hang"};

}  // namespace

const char* finding_name(Finding finding) {
  return kFindingNames[static_cast<size_t>(finding)];
}

Result run_case(const Case& c, samples::Soup* mesh) {
  const double start = processor_seconds();
  Result result;
  Watch first(c, true), second(c, false);
  result.runs[0] = first.run(1, PLC_SIMD_AUTO, mesh);
  result.runs[1] = second.run(c.threads, c.simd, nullptr);
  result.finding = first.finding();
  result.what = first.what();
  if (result.finding == Finding::kNone) {
    result.what = difference(result.runs[0], result.runs[1]);
    if (!result.what.empty()) result.finding = Finding::kDifference;
  }
  if (result.finding == Finding::kNone) {
    result.finding = second.finding();
    result.what = second.what();
  }
  result.seconds = processor_seconds() - start;
  return result;
}

}  // namespace campaign

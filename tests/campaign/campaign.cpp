// A campaign: N random evolutions, each in full twice in different ways, and what the engine
// promises held against each. tools/campaign builds and runs it.
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

#include "engine/base/schedule.h"
#include "tests/campaign/campaign_workers.h"

namespace {

using campaign::Finding;
using campaign::Note;

constexpr const char* kUsage =
    "usage: campaign [N] [--from SEED] [--jobs J] [--timeout SECONDS] [--findings FILE]\n"
    "       campaign --seed SEED [--write PREFIX]\n"
    "Runs the N (default 20000) cases from SEED (default 1) on, J (default 1) at a time. One that\n"
    "takes SECONDS (default 60) of the processor, or ten times as long, hangs. What is\n"
    "wrong goes to FILE (default campaign-findings.txt), a line per seed; exit code 1 if anything\n"
    "is. --seed runs one case, tells all about it, and writes its image to PREFIX.nrrd and its\n"
    "surface to PREFIX.off.\n";

struct Options {
  uint64_t count = 20000, from = 1, seed = 0;
  bool one = false;
  campaign::Workers workers;
  std::string findings = "campaign-findings.txt", prefix;
};

bool number(const char* text, uint64_t& value) {
  char* end = nullptr;
  const uint64_t read = std::strtoull(text, &end, 10);
  if (*text < '0' || *text > '9' || *end != '\0') return false;
  value = read;
  return true;
}

bool read_options(int argc, char** argv, Options& o) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (number(argv[i], o.count)) continue;
    if (++i == argc) return false;
    if (name == "--findings" || name == "--write") {
      (name == "--write" ? o.prefix : o.findings) = argv[i];
      continue;
    }
    uint64_t value = 0;
    if (!number(argv[i], value)) return false;
    if (name == "--from") {
      o.from = value;
    } else if (name == "--seed") {
      o.one = true;
      o.seed = value;
    } else if (name == "--jobs" && value >= 1 && value <= 1024) {
      o.workers.jobs = static_cast<int>(value);
    } else if (name == "--timeout" && value >= 1) {
      o.workers.timeout = static_cast<double>(value);
    } else {
      return false;
    }
  }
  return true;
}

int run_one(const Options& o) {
  using Control = oneapi::tbb::global_control;
  const Control threads(Control::max_allowed_parallelism, 8);
  const campaign::Case c = campaign::make_case(o.seed);
  std::fputs(campaign::description(c).c_str(), stdout);
  std::fflush(stdout);
  if (!o.prefix.empty() && c.fault.empty() && !campaign::write_nrrd(c, o.prefix + ".nrrd")) {
    std::fprintf(stderr, "%s.nrrd: cannot be written\n", o.prefix.c_str());
    return 2;
  }
  samples::Soup mesh;
  const campaign::Result result = campaign::run_case(c, &mesh);
  for (const campaign::RunRecord& run : result.runs) {
    std::printf("status %d %s\n", run.status, run.message.c_str());
    for (const std::string& line : run.levels) std::printf("  %s\n", line.c_str());
    int64_t most = 0;
    for (const campaign::Iteration& i : run.iterations) most = std::max(most, i.vertices);
    std::printf("  %zu iterations, %lld vertices, at most %lld, hash %016llx, %.3f s\n",
                run.iterations.size(), static_cast<long long>(run.vertices),
                static_cast<long long>(most), static_cast<unsigned long long>(run.hash),
                run.seconds);
  }
  std::printf("%s %s\n", campaign::finding_name(result.finding), result.what.c_str());
  if (!o.prefix.empty() && !mesh.abc.empty() && !campaign::write_off(mesh, o.prefix + ".off")) {
    std::fprintf(stderr, "%s.off: cannot be written\n", o.prefix.c_str());
    return 2;
  }
  return result.finding == Finding::kNone ? 0 : 1;
}

// Without its numbers, so that equal reasons are counted together.
std::string reason_of(const std::string& message) {
  std::string reason;
  for (const char letter : message) {
    const bool digit = std::strchr("0123456789", letter) != nullptr;
    if (!digit) reason += letter;
    if (digit && (reason.empty() || reason.back() != '#')) reason += '#';
  }
  return reason.size() > 90 ? reason.substr(0, 90) + "..." : reason;
}

struct Row {
  int64_t cases = 0, surfaces = 0, no_surface = 0, refused = 0, faults = 0, findings = 0;
};

class Summary {
 public:
  void add(const Note& note) {
    const char* init = note.init < 0 ? "?" : campaign::init_name(static_cast<plc_init>(note.init));
    for (Row* row : {&phantoms_[note.phantom], &inits_[init], &all_}) count(note, *row);
    ++findings_[static_cast<size_t>(note.finding)];
    steps_ += note.steps ? 1 : 0;
    saved_ += note.saved ? 1 : 0;
    paused_ += note.paused ? 1 : 0;
    own_memory_ += note.own_memory ? 1 : 0;
    backwards_ += note.backwards ? 1 : 0;
    strided_ += note.strided ? 1 : 0;
    out_of_memory_ += note.out_of_memory ? 1 : 0;
    const bool ok = note.status == PLC_OK;
    const bool ran = note.finding != Finding::kCrash && note.finding != Finding::kHang;
    if (!ok && ran) ++reasons_[reason_of(note.message)];
    if (ran) iterations_ += note.iterations;
    if (ok) vertices_ += note.vertices;
    most_vertices_ = std::max(most_vertices_, note.vertices);
    case_seconds_ += note.seconds;
    slowest_.emplace(note.seconds, note.seed);
    if (slowest_.size() > 8) slowest_.erase(slowest_.begin());
  }

  int64_t cases() const { return all_.cases; }
  int64_t findings() const { return all_.findings; }

  void print(double seconds) const {
    const char* const heads[] = {"phantom", "init"};
    const std::map<std::string, Row>* const tables[] = {&phantoms_, &inits_};
    for (size_t t = 0; t < 2; ++t) {
      std::printf("\n%-10s %7s %9s %11s %8s %15s %9s\n", heads[t], "cases", "surfaces",
                  "no surface", "refused", "wrong on purpose", "findings");
      for (const auto& [name, row] : *tables[t]) line(name, row);
    }
    line("all", all_);
    std::printf("\nrefused, or ended, because\n");
    for (const auto& [reason, times] : reasons_) {
      std::printf("%7lld  %s\n", static_cast<long long>(times), reason.c_str());
    }
    std::printf(
        "\nsecond runs: %lld in steps (%lld saved and restored, %lld paused), %lld with gaps "
        "in the image, %lld in the host's memory, %lld with its loops backwards, %lld that ran "
        "out of memory\n",
        static_cast<long long>(steps_), static_cast<long long>(saved_),
        static_cast<long long>(paused_), static_cast<long long>(strided_),
        static_cast<long long>(own_memory_), static_cast<long long>(backwards_),
        static_cast<long long>(out_of_memory_));
    std::printf("\nfindings\n");
    for (int f = 1; f < campaign::kFindings; ++f) {
      std::printf("%7lld  %s\n", static_cast<long long>(findings_[static_cast<size_t>(f)]),
                  campaign::finding_name(static_cast<Finding>(f)));
    }
    std::printf(
        "\n%lld cases, %lld iterations of the first runs, %lld vertices of their surfaces, "
        "%lld of the largest; %.0f s, %.1f ms of the processor a case; slowest",
        static_cast<long long>(all_.cases), static_cast<long long>(iterations_),
        static_cast<long long>(vertices_), static_cast<long long>(most_vertices_), seconds,
        1000 * case_seconds_ / static_cast<double>(std::max(all_.cases, int64_t{1})));
    for (auto it = slowest_.rbegin(); it != slowest_.rend(); ++it) {
      std::printf(" %llu (%.1f s)", static_cast<unsigned long long>(it->second), it->first);
    }
    std::printf("\n%s\n", all_.findings == 0 ? "nothing found" : "FINDINGS");
  }

 private:
  static void count(const Note& note, Row& row) {
    ++row.cases;
    row.findings += note.finding != Finding::kNone ? 1 : 0;
    if (note.fault[0] != '\0') {
      ++row.faults;
    } else if (note.finding == Finding::kCrash || note.finding == Finding::kHang) {
      return;
    } else if (note.status == PLC_OK) {
      ++row.surfaces;
    } else if (std::strncmp(note.message, "no surface", 10) == 0) {
      ++row.no_surface;
    } else {
      ++row.refused;
    }
  }

  static void line(const std::string& name, const Row& row) {
    std::printf("%-10s %7lld %9lld %11lld %8lld %15lld %9lld\n", name.c_str(),
                static_cast<long long>(row.cases), static_cast<long long>(row.surfaces),
                static_cast<long long>(row.no_surface), static_cast<long long>(row.refused),
                static_cast<long long>(row.faults), static_cast<long long>(row.findings));
  }

  std::map<std::string, Row> phantoms_, inits_;
  Row all_;
  std::map<std::string, int64_t> reasons_;
  int64_t findings_[campaign::kFindings] = {};
  int64_t iterations_ = 0, vertices_ = 0, most_vertices_ = 0;
  double case_seconds_ = 0;
  int64_t steps_ = 0, saved_ = 0, paused_ = 0, own_memory_ = 0, backwards_ = 0, strided_ = 0;
  int64_t out_of_memory_ = 0;
  std::multimap<double, uint64_t> slowest_;
};

int run_many(const Options& o) {
  std::FILE* file = std::fopen(o.findings.c_str(), "w");
  if (file == nullptr) {
    std::fprintf(stderr, "%s: cannot be written\n", o.findings.c_str());
    return 2;
  }
  const double start = plc::now();
  Summary summary;
  double told = start;
  const auto tell = [&](const Note& note) {
    summary.add(note);
    if (note.finding != Finding::kNone) {
      const auto seed = static_cast<unsigned long long>(note.seed);
      const char* name = campaign::finding_name(note.finding);
      std::fprintf(file, "%llu: %s: %s\n", seed, name, note.what);
      std::fflush(file);
      std::printf("seed %llu: %s: %s\n", seed, name, note.what);
    }
    constexpr double kPause = 60;
    if (plc::now() - told < kPause) return;
    told = plc::now();
    std::printf("%lld of %llu cases, %lld findings, %.0f s\n",
                static_cast<long long>(summary.cases()), static_cast<unsigned long long>(o.count),
                static_cast<long long>(summary.findings()), told - start);
    std::fflush(stdout);
  };
  const bool ran = campaign::run_seeds(o.workers, o.from, o.count, campaign::run_seed, tell);
  std::fclose(file);
  if (!ran) {
    std::fprintf(stderr, "no process can be started: %s\n", std::strerror(errno));
    return 2;
  }
  summary.print(plc::now() - start);
  return summary.findings() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read_options(argc, argv, options)) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  return options.one ? run_one(options) : run_many(options);
}

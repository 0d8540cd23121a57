#include "engine/schedule.h"

#include <oneapi/tbb/flow_graph.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <chrono>
#include <optional>

namespace plc {

struct Schedule::Arena {
  explicit Arena(int threads) : tbb(threads) {
    // More threads than cores: oneTBB would warn on stderr and leave it at the cores. The control
    // is process-wide and the smallest one counts, so there is none where it is not needed.
    if (threads > oneapi::tbb::info::default_concurrency()) {
      limit.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                    static_cast<size_t>(threads));
    }
  }
  std::optional<oneapi::tbb::global_control> limit;
  oneapi::tbb::task_arena tbb;
};

Schedule::Schedule(int threads)
    : arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr), threads_(threads) {}
Schedule::~Schedule() = default;

void Schedule::run(size_t tasks, const std::function<void(size_t)>& body) const {
  if (tasks <= 1 || arena_ == nullptr) {
    for (size_t i = 0; i < tasks; ++i) body(i);
    return;
  }
  arena_->tbb.execute(
      [&] { oneapi::tbb::parallel_for(size_t{0}, tasks, [&](size_t i) { body(i); }); });
}

void Schedule::run_passes(const std::vector<Pass>& passes, bool small) const {
  const auto timed = [](const Pass& pass) {
    const double start = now();
    pass.body();
    return now() - start;
  };
  if (small || arena_ == nullptr) {
    for (const Pass& pass : passes) *pass.seconds += timed(pass);
    return;
  }
  using Node = oneapi::tbb::flow::continue_node<oneapi::tbb::flow::continue_msg>;
  std::vector<double> seconds(passes.size(), 0);
  arena_->tbb.execute([&] {
    oneapi::tbb::flow::graph graph;
    std::vector<std::unique_ptr<Node>> nodes;
    std::vector<bool> has_predecessor(passes.size(), false);
    for (size_t i = 0; i < passes.size(); ++i) {
      nodes.push_back(std::make_unique<Node>(graph, [&, i](const oneapi::tbb::flow::continue_msg&) {
        seconds[i] = timed(passes[i]);
      }));
      for (size_t j = 0; j < i; ++j) {
        const bool conflict = (passes[j].writes & (passes[i].reads | passes[i].writes)) != 0 ||
                              (passes[j].reads & passes[i].writes) != 0;
        if (!conflict) continue;
        oneapi::tbb::flow::make_edge(*nodes[j], *nodes[i]);
        has_predecessor[i] = true;
      }
    }
    for (size_t i = 0; i < passes.size(); ++i) {
      if (!has_predecessor[i]) nodes[i]->try_put(oneapi::tbb::flow::continue_msg());
    }
    graph.wait_for_all();
  });
  for (size_t i = 0; i < passes.size(); ++i) *passes[i].seconds += seconds[i];
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace plc

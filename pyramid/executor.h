// How the engine hands parallel loops to the layers below it; nothing here knows of threads.
#pragma once
#include <cstddef>
#include <functional>

namespace plc {

// Runs body(0) .. body(tasks - 1), in any order and on any threads, and returns when all are done.
// Bodies must write to disjoint places: no result may depend on the order.
class Executor {
 public:
  virtual ~Executor() = default;
  virtual void run(size_t tasks, const std::function<void(size_t)>& body) const = 0;
};

// Everything on the calling thread, in index order.
class SerialExecutor final : public Executor {
 public:
  void run(size_t tasks, const std::function<void(size_t)>& body) const override {
    for (size_t i = 0; i < tasks; ++i) body(i);
  }
};

}  // namespace plc

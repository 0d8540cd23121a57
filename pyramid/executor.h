// How the engine hands parallel loops to the layers below it, and the SIMD target whose kernels run
// in them; nothing here knows of threads.
#pragma once
#include <cstddef>
#include <functional>

#include "kernels/simd.h"

namespace plc {

// Runs body(0) .. body(tasks - 1), in any order and on any threads, and returns when all are done.
// Bodies must write to disjoint places: no result may depend on the order.
class Executor {
 public:
  explicit Executor(SimdTarget simd = best_simd_target()) : simd_(simd) {}
  virtual ~Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;
  // Of the kernels that are called in its loops. Any gives the same bits.
  SimdTarget simd() const { return simd_; }
  virtual void run(size_t tasks, const std::function<void(size_t)>& body) const = 0;

 private:
  SimdTarget simd_;
};

// Everything on the calling thread, in index order.
class SerialExecutor final : public Executor {
 public:
  using Executor::Executor;
  void run(size_t tasks, const std::function<void(size_t)>& body) const override {
    for (size_t i = 0; i < tasks; ++i) body(i);
  }
};

}  // namespace plc

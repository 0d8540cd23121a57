// A host in C++: handles that free themselves, the host's own threads, a force and places of its
// own, and several extractions at the same time, which give the same bits.
#include <pellicle.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

// The host's threads. Loops of several contexts may run at the same time; the thread that asks for
// one works on it itself, so that it gets done even when all others are busy.
class ThreadPool {
 public:
  explicit ThreadPool(int threads) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { serve(); });
  }
  ~ThreadPool() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  // plc_parallel_for_fn, with the pool as `user`.
  static void parallel_for(size_t tasks, plc_task_fn task, void* data, void* user) {
    static_cast<ThreadPool*>(user)->run(tasks, task, data);
  }

 private:
  struct Loop {
    size_t tasks;
    plc_task_fn task;
    void* data;
    std::atomic<size_t> next{0};
    std::atomic<size_t> done{0};
  };

  void run(size_t tasks, plc_task_fn task, void* data) {
    const auto loop = std::make_shared<Loop>();
    loop->tasks = tasks;
    loop->task = task;
    loop->data = data;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      loops_.push_back(loop);
    }
    changed_.notify_all();
    work(*loop);
    std::unique_lock<std::mutex> lock(mutex_);
    loops_.erase(std::remove(loops_.begin(), loops_.end(), loop), loops_.end());
    changed_.wait(lock, [&] { return loop->done == loop->tasks; });
  }

  void work(Loop& loop) {
    for (size_t i = loop.next++; i < loop.tasks; i = loop.next++) {
      loop.task(i, loop.data);
      if (++loop.done == loop.tasks) {
        const std::lock_guard<std::mutex> lock(
            mutex_);  // not between a waiter's look and its sleep
        changed_.notify_all();
      }
    }
  }

  void serve() {
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      const auto open = std::find_if(loops_.begin(), loops_.end(),
                                     [](const auto& loop) { return loop->next < loop->tasks; });
      if (open != loops_.end()) {
        const std::shared_ptr<Loop> loop = *open;
        lock.unlock();
        work(*loop);
        lock.lock();
      } else if (ending_) {
        return;
      } else {
        changed_.wait(lock);
      }
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::shared_ptr<Loop>> loops_;
  bool ending_ = false;
  std::vector<std::thread> threads_;
};

// Two balls that touch: 1 in their middles, 0.5 on their surface.
struct Image {
  static constexpr int kSize = 36;
  static constexpr double kRadius = 7;
  std::vector<float> voxels;
  plc_image image = pellicle::defaults<plc_image>();

  Image() {
    const double middle = (kSize - 1) / 2.0;
    for (int z = 0; z < kSize; ++z) {
      for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
          const double left = std::hypot(x - middle + kRadius, y - middle, z - middle);
          const double right = std::hypot(x - middle - kRadius, y - middle, z - middle);
          voxels.push_back(
              static_cast<float>(std::max(0.0, 1 - 0.5 * std::min(left, right) / kRadius)));
        }
      }
    }
    image.type = PLC_F32;
    image.voxels = voxels.data();
    std::fill(image.dims, image.dims + 3, kSize);
  }
};

// A force of the host's own: everything above the middle plane is blown up a little.
int push_above(const plc_force_points* points, float* forces, void* user) {
  const float middle = *static_cast<const float*>(user);
  for (int64_t i = 0; i < points->count; ++i) {
    if (points->xyz[3 * i + 2] < middle) continue;
    for (int axis = 0; axis < 3; ++axis)
      forces[3 * i + axis] = 0.05F * points->normals[3 * i + axis];
  }
  return 0;
}

struct Result {
  uint64_t hash = 0;
  plc_check check{};
  bool converged = false;
  int64_t peak = 0;
  std::string simd;
  std::exception_ptr error;
};

Result extract(const Image& image, const plc_context_options& options) {
  const pellicle::Context context(options);
  auto parameters = pellicle::defaults<plc_parameters>();
  parameters.iso = 0.5;
  parameters.levels = 1;
  parameters.curvature = 0.1;

  // The surface goes through a place a voxel outside the left ball.
  const double middle = (Image::kSize - 1) / 2.0;
  float height = static_cast<float>(middle);
  const plc_attachment attachment{{middle - 2 * Image::kRadius - 1, middle, middle}, 4, 2};
  auto extras = pellicle::defaults<plc_extras>();
  extras.force = push_above;
  extras.force_user = &height;
  extras.attachments = &attachment;
  extras.attachment_count = 1;

  const pellicle::Surface surface = pellicle::extract(context, image.image, parameters, &extras);
  Result result;
  result.hash = surface.hash();
  result.simd = context.simd();
  result.check = surface.check();
  result.converged = surface.converged();
  result.peak = context.memory().peak;
  return result;
}

void run() {
  const Image image;
  ThreadPool pool(3);

  // Each with a context of its own: oneTBB, one thread, our threads, and our threads without SIMD.
  std::array<plc_context_options, 4> ways;
  ways.fill(pellicle::defaults<plc_context_options>());
  ways[1].threads = 1;
  ways[2].parallel_for = ways[3].parallel_for = ThreadPool::parallel_for;
  ways[2].parallel_for_user = ways[3].parallel_for_user = &pool;
  ways[3].simd = PLC_SIMD_SCALAR;
  std::array<Result, ways.size()> results;
  std::vector<std::thread> threads;
  for (size_t i = 0; i < ways.size(); ++i) {
    threads.emplace_back([&, i] {
      try {
        results[i] = extract(image, ways[i]);
      } catch (...) {
        results[i].error = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();

  for (const Result& result : results) {
    if (result.error) std::rethrow_exception(result.error);
    const plc_measures& m = result.check.measures;
    std::printf("%-7s %lld vertices, %lld faces, %.1f mm2, %.1f mm3, hash %016llx, %.1f MiB\n",
                result.simd.c_str(), static_cast<long long>(m.vertices),
                static_cast<long long>(m.faces), m.area, m.volume,
                static_cast<unsigned long long>(result.hash),
                static_cast<double>(result.peak) / (1024 * 1024));
    if (result.check.valid == 0) throw std::runtime_error("the surface is not valid");
    if (!result.converged) throw std::runtime_error("the surface has not come to rest");
    if (m.genus != 0) throw std::runtime_error("the surface has handles");
    if (result.hash != results[0].hash) throw std::runtime_error("the surfaces differ");
    if (result.peak <= 0) throw std::runtime_error("no memory was counted");
  }
}

}  // namespace

int main() {
  try {
    run();
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "host_cpp: %s\n", e.what());
    return 1;
  }
}

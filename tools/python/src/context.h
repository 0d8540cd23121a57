// Contexts: the lock that keeps one to a thread at a time, Python's exceptions on their way through
// the engine, and the owners of what is made with a context.
#pragma once
#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/pellicle.h"

namespace plc::python {

namespace py = pybind11;

// Throws the exception of pellicle/_errors.py that stands for the status.
[[noreturn]] void raise(plc_status status, const std::string& message);

// step() takes the GIL or runs Python code. While Python ends, threads that ask for the GIL are
// ended by unwinding, which C++ code above may not allow, and which lets go of Python objects
// without the GIL; once it has ended, they ask for a lock that is gone. Here they sleep until the
// process goes, as from Python 3.14 on.
template <class Step>
void sleeping_at_exit(Step&& step) noexcept {
  const auto sleep = [] {
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  };
  if (Py_IsInitialized() == 0) sleep();
  try {
    step();
  } catch (...) {
    sleep();  // within: nobody may catch the end of a thread and go on
  }
}

// function(arguments...), of Python. For callbacks: nothing between the interpreter and here is
// unwound.
template <class... Arguments>
py::object call_python(const py::object& function, const Arguments&... arguments) {
  const py::tuple objects = py::make_tuple(arguments...);
  PyObject* result = nullptr;
  sleeping_at_exit([&] { result = PyObject_CallObject(function.ptr(), objects.ptr()); });
  if (result == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(result);
}

class Context {
 public:
  // log: called with a plc_log_level and a line; None: nobody listens.
  Context(int threads, plc_simd simd, int64_t memory_limit, py::object log);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  int threads() const { return plc_context_threads(handle_); }
  std::string simd() const { return plc_context_simd(handle_); }
  std::pair<int64_t, int64_t> memory();

  // function(plc_context*) -> plc_status, without the GIL, when no other thread uses the context.
  // Throws what Python code has thrown meanwhile, else the exception of the status.
  // nested: also within a callback of this context.
  template <class Function>
  void call(Function&& function, bool nested = false) {
    plc_status status = PLC_OK;
    std::string message;
    std::unique_ptr<py::error_already_set> failure;
    {
      const Use use(*this, nested);
      status = function(handle_);
      if (status != PLC_OK) message = plc_context_message(handle_);
      if (!use.inner()) failure = std::move(failure_);
    }
    if (failure != nullptr) throw py::error_already_set(*failure);
    if (status != PLC_OK) raise(status, message);
  }

  // Destroys a handle: now, or when the thread that uses the context has left it. `lent` is let go
  // afterwards. With the GIL.
  void bury(void* handle, void (*destroy)(void*), std::shared_ptr<py::object> lent);

  // For callbacks: runs function() with the GIL. False where it threw: the exception is kept, and
  // thrown by the call into the engine that is under way.
  template <class Function>
  bool guarded(Function&& function) {
    std::optional<py::gil_scoped_acquire> gil;
    sleeping_at_exit([&] { gil.emplace(); });
    try {
      function();
      return true;
    } catch (py::error_already_set& error) {
      keep(error);
    } catch (const py::builtin_exception& error) {
      error.set_error();
      keep(py::error_already_set());
    } catch (const std::exception& error) {
      PyErr_SetString(PyExc_RuntimeError, error.what());
      keep(py::error_already_set());
    }
    return false;
  }
  bool failed() const { return failure_ != nullptr; }
  void log(plc_log_level level, const char* line);

 private:
  // The thread's turn with the context; the GIL is not held meanwhile.
  class Use {
   public:
    Use(Context& context, bool nested);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    bool inner() const { return inner_; }  // within a callback: the call outside has the turn

   private:
    void wait();
    Context& context_;
    bool inner_;
    PyThreadState* python_;  // of this thread, without the GIL
  };
  struct Grave {
    void* handle;
    void (*destroy)(void*);
    std::shared_ptr<py::object> lent;
  };

  void keep(const py::error_already_set& error);
  bool used_here() const { return user_.load() == std::this_thread::get_id(); }
  void settle();

  plc_context* handle_ = nullptr;
  py::object log_;
  std::timed_mutex mutex_;
  std::atomic<std::thread::id> user_{};             // who holds mutex_
  std::unique_ptr<py::error_already_set> failure_;  // of a callback; of the thread of mutex_
  std::vector<Grave> graves_;                       // with the GIL
};

// An engine's handle with what it needs: its context, and the array whose voxels it refers to.
template <class T, void (*kDestroy)(T*)>
class Handle {
 public:
  explicit Handle(std::shared_ptr<Context> context, std::shared_ptr<py::object> lent = nullptr)
      : context_(std::move(context)), lent_(std::move(lent)) {}
  ~Handle() {
    if (handle_ == nullptr) return;
    context_->bury(
        handle_, [](void* handle) { kDestroy(static_cast<T*>(handle)); }, std::move(lent_));
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  const std::shared_ptr<Context>& context() const { return context_; }
  const std::shared_ptr<py::object>& lent() const { return lent_; }
  T* get() const { return handle_; }
  T** out() { return &handle_; }

 private:
  std::shared_ptr<Context> context_;
  std::shared_ptr<py::object> lent_;
  T* handle_ = nullptr;
};

using Volume = Handle<plc_volume, plc_volume_destroy>;
using Pyramid = Handle<plc_pyramid, plc_pyramid_destroy>;
using Surface = Handle<plc_surface, plc_surface_destroy>;

}  // namespace plc::python

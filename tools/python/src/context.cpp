#include "tools/python/src/context.h"

#include <stdexcept>

namespace plc::python {

namespace {

// Python runs handlers of signals in its main thread only when that asks for it.
constexpr auto kLookForSignals = std::chrono::milliseconds(50);

const char* exception_of(plc_status status) {
  switch (status) {
    case PLC_INVALID_ARGUMENT:
      return "InvalidArgument";
    case PLC_INVALID_DATA:
      return "InvalidData";
    case PLC_OUT_OF_MEMORY:
      return "OutOfMemory";
    case PLC_CANCELLED:
      return "Cancelled";
    default:
      return "InternalError";
  }
}

void on_log(plc_log_level level, const char* line, void* user) {
  static_cast<Context*>(user)->log(level, line);
}

}  // namespace

void raise(plc_status status, const std::string& message) {
  const py::object type = py::module_::import("pellicle._errors").attr(exception_of(status));
  PyErr_SetString(type.ptr(), message.c_str());
  throw py::error_already_set();
}

Context::Context(int threads, plc_simd simd, int64_t memory_limit, py::object log)
    : log_(std::move(log)) {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = threads;
  options.simd = simd;
  options.memory_limit = memory_limit;
  if (!log_.is_none()) {
    options.log = on_log;
    options.log_user = this;
  }
  char error[256] = "";
  const plc_status status = plc_context_create(&options, &handle_, error, sizeof error);
  if (status != PLC_OK) raise(status, error);
}

// What was made with the context holds it: nothing uses it any more.
Context::~Context() {
  for (const Grave& grave : graves_) grave.destroy(grave.handle);
  plc_context_destroy(handle_);
}

std::pair<int64_t, int64_t> Context::memory() {
  std::pair<int64_t, int64_t> bytes;
  call([&](plc_context* context) {
    return plc_context_memory(context, &bytes.first, &bytes.second);
  });
  return bytes;
}

void Context::log(plc_log_level level, const char* line) {
  guarded([&] { call_python(log_, static_cast<int>(level), line); });
}

// The first failure is what went wrong; what fails in its wake is not told.
void Context::keep(const py::error_already_set& error) {
  if (failure_ == nullptr) failure_ = std::make_unique<py::error_already_set>(error);
}

void Context::bury(void* handle, void (*destroy)(void*), std::shared_ptr<py::object> lent) {
  graves_.push_back({handle, destroy, std::move(lent)});
  settle();
}

void Context::settle() {
  if (graves_.empty() || used_here() || !mutex_.try_lock()) return;
  std::vector<Grave> graves;
  graves.swap(graves_);
  for (const Grave& grave : graves) grave.destroy(grave.handle);
  mutex_.unlock();
  // The arrays go here, which may run any Python code.
}

Context::Use::Use(Context& context, bool nested)
    : context_(context), inner_(context.used_here()), python_(nullptr) {
  if (inner_ && !nested) {
    throw std::invalid_argument(
        "the context is in use by the call that made this callback: use another one");
  }
  python_ = PyEval_SaveThread();
  if (!inner_) wait();
}

void Context::Use::wait() {
  while (!context_.mutex_.try_lock_for(kLookForSignals)) {
    sleeping_at_exit([this] { PyEval_RestoreThread(python_); });
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    python_ = PyEval_SaveThread();
  }
  context_.user_ = std::this_thread::get_id();
}

Context::Use::~Use() {
  if (!inner_) {
    context_.user_ = std::thread::id();
    context_.mutex_.unlock();
  }
  sleeping_at_exit([this] { PyEval_RestoreThread(python_); });
  if (!inner_) context_.settle();
}

}  // namespace plc::python

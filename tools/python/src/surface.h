// Surfaces as Python has them: its own, or that of a level callback while that lasts.
#pragma once
#include "tools/python/src/context.h"

namespace plc::python {

class AnySurface {
 public:
  explicit AnySurface(std::shared_ptr<Context> context) : context_(std::move(context)) {}
  virtual ~AnySurface() = default;
  AnySurface(const AnySurface&) = delete;
  AnySurface& operator=(const AnySurface&) = delete;

  const std::shared_ptr<Context>& context() const { return context_; }
  // function(plc_context*, const plc_surface*) -> plc_status, as Context::call. Allowed in level
  // callbacks of the same context.
  template <class Function>
  void call(Function&& function) const {
    context_->call([&](plc_context* context) { return function(context, checked()); }, is_lent());
  }
  const plc_surface* checked() const;

 protected:
  virtual const plc_surface* get() const = 0;  // NULL: it is gone
  virtual bool is_lent() const = 0;

 private:
  std::shared_ptr<Context> context_;
};

class OwnSurface : public AnySurface {
 public:
  explicit OwnSurface(std::shared_ptr<Context> context)
      : AnySurface(context), handle_(std::move(context)) {}
  plc_surface** out() { return handle_.out(); }

 private:
  const plc_surface* get() const override { return handle_.get(); }
  bool is_lent() const override { return false; }
  Surface handle_;
};

class LentSurface : public AnySurface {
 public:
  LentSurface(std::shared_ptr<Context> context, const plc_surface* surface)
      : AnySurface(std::move(context)), surface_(surface) {}
  // The surface may be used until the scope ends.
  class Scope {
   public:
    explicit Scope(LentSurface& surface) : surface_(surface) {}
    ~Scope() { surface_.surface_ = nullptr; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    LentSurface& surface_;
  };

 private:
  const plc_surface* get() const override { return surface_; }
  bool is_lent() const override { return true; }
  std::atomic<const plc_surface*> surface_;
};

void bind_surface(py::module_& module);

}  // namespace plc::python

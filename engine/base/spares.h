// Objects that tasks work with, kept for later tasks with the memory that they have.
#pragma once
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace plc {

// An object is lent as the last task left it: results must not depend on what is in it. As many are
// made as tasks run at once. Thread-safe.
template <typename T>
class Spares {
 public:
  // An object on loan, given back when this is destroyed; the Spares must still be there then.
  class Lent {
   public:
    Lent(Spares& from, std::unique_ptr<T> object) : from_(from), object_(std::move(object)) {}
    ~Lent() { from_.take_back(std::move(object_)); }
    Lent(const Lent&) = delete;
    Lent& operator=(const Lent&) = delete;
    T& operator*() const { return *object_; }

   private:
    Spares& from_;
    std::unique_ptr<T> object_;
  };

  // Throws std::bad_alloc.
  Lent lend() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (idle_.empty()) {
      idle_.reserve(made_ + 1);  // taking back never allocates
      auto object = std::make_unique<T>();
      ++made_;
      return {*this, std::move(object)};
    }
    std::unique_ptr<T> object = std::move(idle_.back());
    idle_.pop_back();
    return {*this, std::move(object)};
  }

 private:
  void take_back(std::unique_ptr<T> object) {
    const std::lock_guard<std::mutex> lock(mutex_);
    idle_.push_back(std::move(object));
  }

  std::mutex mutex_;
  size_t made_ = 0;
  std::vector<std::unique_ptr<T>> idle_;
};

}  // namespace plc

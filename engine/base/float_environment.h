// The arithmetic that results are defined by, whatever the caller's thread is set to.
#pragma once
#include <cfenv>

namespace plc {

// While it lives: round to nearest, denormals as they are, no traps. Then what was before, with the
// flags of before.
class FloatEnvironment {
 public:
  FloatEnvironment() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatEnvironment() { std::fesetenv(&before_); }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
  std::fenv_t before_;
};

}  // namespace plc

// Errors are values: a code and one line that names the thing, what was found, what was expected.
#pragma once
#include <string>
#include <utility>

namespace plc {

enum class ErrorCode {
  kOk = 0,
  kInvalidArgument,  // a parameter is outside its range
  kInvalidData,      // the image or mesh cannot be used (NaN voxels, open mesh, ...)
  kOutOfMemory,
  kCancelled,
  kInternal,  // a bug of ours that was caught before it did harm
};

class [[nodiscard]] Status {
 public:
  Status() = default;
  Status(ErrorCode code, std::string message) : code_(code), message_(std::move(message)) {}
  bool ok() const { return code_ == ErrorCode::kOk; }
  ErrorCode code() const { return code_; }
  const std::string& message() const { return message_; }

 private:
  ErrorCode code_ = ErrorCode::kOk;
  std::string message_;
};

inline Status bad_argument(std::string message) {
  return {ErrorCode::kInvalidArgument, std::move(message)};
}

}  // namespace plc

#include "tools/file/shared_bytes.h"

#include <sys/ipc.h>
#include <sys/shm.h>

#include <cstdint>
#include <new>
#include <utility>

namespace plc::tools {

SharedBytes::SharedBytes(size_t size) : size_(size) {
  if (size == 0) return;
  constexpr int kOwnerOnly = 0600;
  id_ = shmget(IPC_PRIVATE, size, IPC_CREAT | kOwnerOnly);
  if (id_ < 0) throw std::bad_alloc();
  struct Gone {  // from now on it goes with the last process that has it, however that ends
    int id;
    ~Gone() { shmctl(id, IPC_RMID, nullptr); }
  } const gone{id_};
  attach();
}

SharedBytes SharedBytes::received(int id, pid_t maker) {
  SharedBytes bytes;
  shmid_ds status{};
  if (shmctl(id, IPC_STAT, &status) != 0 || status.shm_cpid != maker) throw std::bad_alloc();
  bytes.size_ = status.shm_segsz;
  bytes.id_ = id;
  bytes.attach();
  return bytes;
}

void SharedBytes::attach() {
  void* const at = shmat(id_, nullptr, 0);
  if (reinterpret_cast<intptr_t>(at) == -1) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(at);
}

SharedBytes::~SharedBytes() {
  if (data_ != nullptr) shmdt(data_);
}

SharedBytes::SharedBytes(SharedBytes&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      id_(std::exchange(other.id_, -1)) {}

SharedBytes& SharedBytes::operator=(SharedBytes&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(id_, other.id_);
  return *this;
}

}  // namespace plc::tools

#include "engine/base/team.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "engine/base/float_environment.h"

namespace plc {

namespace {

using Clock = std::chrono::steady_clock;

// Longer than what is serial between two loops: the transformations of a round.
constexpr auto kAwake = std::chrono::microseconds(1000);
// A thread that has come here while it waited for something else is kept from it no longer.
constexpr auto kTenure = std::chrono::milliseconds(5);
// A helper that was summoned and has not come may not come at all.
constexpr auto kPatience = std::chrono::milliseconds(10);
// Between looks at the clock; whoever else wants the core has it then.
constexpr uint32_t kPauses = 64;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

}  // namespace

bool Team::run(size_t tasks, uint32_t members, const std::function<void(size_t)>& body,
               const Summon& summon) {
  if (busy_.exchange(true, std::memory_order_acquire)) return false;
  body_ = &body;
  tasks_ = tasks;
  joined_ = static_cast<uint32_t>(std::min<size_t>(tasks, members));
  for (uint32_t share = 0; share < joined_; ++share) {
    places_[share].next.store(share == 0 ? 0 : share_end(share - 1), std::memory_order_relaxed);
  }
  open_.store(ticket(++loops_, joined_));
  for (uint32_t slot = 1; slot < joined_; ++slot) {
    if (!places_[slot].summoned.exchange(true)) summon(slot);
  }
  work(0);
  // A helper enters before it looks whether the loop is still open: who is seen to work is waited
  // for, who comes later sees that it is closed.
  open_.store(0);
  for (uint32_t waited = 1; working_.load() != 0; ++waited) {
    pause();
    if (waited % kPauses == 0) std::this_thread::yield();
  }
  busy_.store(false, std::memory_order_release);
  return true;
}

void Team::work(uint32_t slot) {
  for (uint32_t k = 0; k < joined_; ++k) {
    const uint32_t share = (slot + k) % joined_;
    const size_t end = share_end(share);
    std::atomic<size_t>& next = places_[share].next;
    while (next.load(std::memory_order_relaxed) < end) {
      const size_t task = next.fetch_add(1, std::memory_order_relaxed);
      if (task < end) (*body_)(task);
    }
  }
}

void Team::serve(uint32_t slot) {
  const FloatEnvironment environment;
  const uint32_t dismissals = dismissals_.load();
  const auto come = Clock::now();
  auto last = come;  // that there was a loop
  bool worked = false;
  uint64_t seen = 0;
  for (uint32_t waited = 1;; ++waited) {
    const uint64_t open = open_.load();
    if (open != seen && slot < wanted(open)) {
      working_.fetch_add(1);
      if (open_.load() == open) work(slot);
      working_.fetch_sub(1);
      seen = open;
      worked = true;
      continue;
    }
    pause();
    if (waited % kPauses != 0) continue;
    const auto now = Clock::now();
    if (worked) last = now;
    worked = false;
    if (now - last > kAwake || now - come > kTenure || dismissals_.load() != dismissals) break;
    std::this_thread::yield();
  }
  places_[slot].summoned.store(false);
}

void Team::wait_for_helpers() const {
  const auto until = Clock::now() + kPatience;
  for (const Place& place : places_) {
    while (place.summoned.load() && Clock::now() < until) std::this_thread::yield();
  }
}

}  // namespace plc

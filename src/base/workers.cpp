#include "base/workers.h"

#include <chrono>
#include <system_error>

namespace calot {
namespace {

/// Looks at something that another thread is about to change: at once, then leaving the processor to others in
/// between. Two threads that only look stand in each other's way where there is one core for both.
class Patience {
 public:
  void pause() {
    if (++looks_ > looks_at_once) {
      std::this_thread::yield();
      return;
    }
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }
  bool is_over() {
    if (looks_ <= looks_at_once) return false;
    if (looks_ == looks_at_once + 1) started_ = Clock::now();
    return Clock::now() - started_ > longest;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int looks_at_once = 1000;  // some 20 us
  /// Longer than between the loops of one step; waking a thread that sleeps takes some 50 us.
  static constexpr std::chrono::milliseconds longest{5};

  int looks_ = 0;
  Clock::time_point started_;
};

}  // namespace

int usual_threads() { return std::thread::hardware_concurrency() > 1 ? 2 : 1; }

Workers::Workers(int threads) {
  for (int k = 1; k < threads; ++k) {
    try {
      threads_.emplace_back([this] { work_on(); });
    } catch (const std::system_error&) {
      return;
    }
  }
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Workers::run(int chunks, Call call, const void* on) {
  if (threads_.empty() || chunks <= 1 || busy_.exchange(true)) {
    for (int k = 0; k < chunks; ++k) call(on, k);
    return;
  }
  call_ = call;
  on_ = on;
  left_ = chunks;
  ticket_ = ((ticket_ >> 32) + 1) << 32 | static_cast<std::uint32_t>(chunks);
  if (sleepers_ > 0) {
    { const std::lock_guard lock(mutex_); }  // who is about to sleep does so before it is woken
    wake_.notify_all();
  }
  while (take_chunk()) {
  }
  Patience patience;
  while (left_ > 0) patience.pause();
  busy_ = false;
}

bool Workers::take_chunk() {
  std::uint64_t ticket = ticket_;
  for (;;) {
    const auto chunk = static_cast<std::uint32_t>(ticket);
    if (chunk == 0) return false;
    // Of this loop only if its ticket still stands: until all its chunks are done no other loop begins.
    const Call call = call_;
    const void* on = on_;
    if (!ticket_.compare_exchange_weak(ticket, ticket - 1)) continue;
    call(on, static_cast<int>(chunk) - 1);
    --left_;
    return true;
  }
}

void Workers::work_on() {
  while (wait_for_work())
    while (take_chunk()) {
    }
}

/// False when the workers end.
bool Workers::wait_for_work() {
  for (Patience patience; !patience.is_over(); patience.pause()) {
    if (ends_) return false;
    if (has_work()) return true;
  }
  std::unique_lock lock(mutex_);
  ++sleepers_;
  wake_.wait(lock, [this] { return ends_ || has_work(); });
  --sleepers_;
  return !ends_;
}

}  // namespace calot

#include "base/workers.h"

#include <algorithm>
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

void ThrownByChunks::keep(std::exception_ptr thrown, int chunk) noexcept {
  const std::lock_guard lock(mutex_);
  if (chunk > by_) return;
  by_ = chunk;
  thrown_ = std::move(thrown);
}

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
  if (!threads_.empty() && chunks > 1)
    for (Loop& loop : loops_)
      if (!loop.busy.exchange(true)) return share(loop, chunks, call, on);
  for (int k = 0; k < chunks; ++k) call(on, k);
}

void Workers::share(Loop& loop, int chunks, Call call, const void* on) {
  loop.call = call;
  loop.on = on;
  loop.left = chunks;
  loop.ticket = ((loop.ticket >> 32) + 1) << 32 | static_cast<std::uint32_t>(chunks);
  if (sleepers_ > 0) {
    { const std::lock_guard lock(mutex_); }  // who is about to sleep does so before it is woken
    wake_.notify_all();
  }
  while (loop.take_chunk()) {
  }
  // What another thread still does of this loop may have loops within: these stand behind it.
  Patience patience;
  while (loop.left > 0)
    if (!std::any_of(&loop + 1, loops_.data() + loops_.size(),
                     [](Loop& within) { return within.take_chunk(); }))
      patience.pause();
  loop.busy = false;
}

bool Workers::Loop::take_chunk() {
  std::uint64_t taken = ticket;
  for (;;) {
    const auto chunk = static_cast<std::uint32_t>(taken);
    if (chunk == 0) return false;
    // Of this loop only if its ticket still stands: until all its chunks are done no other loop begins here.
    const Call called = call;
    const void* with = on;
    if (!ticket.compare_exchange_weak(taken, taken - 1)) continue;
    called(with, static_cast<int>(chunk) - 1);
    --left;
    return true;
  }
}

bool Workers::has_work() const {
  return std::any_of(loops_.begin(), loops_.end(), [](const Loop& loop) { return loop.has_work(); });
}

void Workers::work_on() {
  // Of the outermost loop first: its chunks are the longest.
  while (wait_for_work())
    std::any_of(loops_.begin(), loops_.end(), [](Loop& loop) { return loop.take_chunk(); });
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
